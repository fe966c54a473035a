//! Which coordinates belong to whom, and which follow others.
//!
//! Every joint has *tree* coordinates. A follower (URDF `mimic`, a gear) takes its tree coordinate from a leader,
//! `q = ratio·q_leader + offset`, `v = ratio·v_leader`; what is left are the independent coordinates. With `v = Z v_ind`
//! constant, generalized forces come back as `τ_ind = Zᵀ τ` and no multiplier is needed.
//! Source: standard velocity transformation, e.g. Jain, *Robot and Multibody Dynamics* (2011), chapter 10.

use crate::scalar::Real;

/// A tree coordinate that follows another one. Both belong to joints with one coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follower {
    /// Tree coordinate that follows.
    pub q: usize,
    /// Tree velocity that follows.
    pub v: usize,
    /// Tree coordinate that leads.
    pub leader_q: usize,
    /// Tree velocity that leads.
    pub leader_v: usize,
    /// Ratio of the velocities.
    pub ratio: f64,
    /// Offset of the coordinates.
    pub offset: f64,
}

/// Sizes and maps between tree and independent coordinates.
#[derive(Clone, Debug, Default)]
pub struct Layout {
    /// Number of tree coordinates.
    pub tree_nq: usize,
    /// Number of tree velocities.
    pub tree_nv: usize,
    /// \[nq\] tree coordinate of each independent coordinate.
    pub independent_q: Vec<usize>,
    /// \[nv\] tree velocity of each independent velocity.
    pub independent_v: Vec<usize>,
    /// Followers, each after its leader.
    pub followers: Vec<Follower>,
}

impl Layout {
    /// Number of independent coordinates.
    pub fn nq(&self) -> usize {
        self.independent_q.len()
    }

    /// Number of independent velocities.
    pub fn nv(&self) -> usize {
        self.independent_v.len()
    }

    /// Whether tree and independent coordinates are the same.
    pub fn is_identity(&self) -> bool {
        self.followers.is_empty()
    }

    /// Writes the tree coordinates.
    #[inline]
    pub fn expand_q<S: Real>(&self, q: &[S], tree: &mut [S]) {
        if self.is_identity() {
            tree.copy_from_slice(q);
            return;
        }
        for (&t, &x) in self.independent_q.iter().zip(q) {
            tree[t] = x;
        }
        for f in &self.followers {
            tree[f.q] = tree[f.leader_q] * f.ratio + f.offset;
        }
    }

    /// Writes the tree velocities (or accelerations).
    #[inline]
    pub fn expand_v<S: Real>(&self, v: &[S], tree: &mut [S]) {
        if self.is_identity() {
            tree.copy_from_slice(v);
            return;
        }
        for (&t, &x) in self.independent_v.iter().zip(v) {
            tree[t] = x;
        }
        for f in &self.followers {
            tree[f.v] = tree[f.leader_v] * f.ratio;
        }
    }

    /// Writes the independent generalized forces `Zᵀ τ`; `tree` is used up.
    #[inline]
    pub fn reduce<S: Real>(&self, tree: &mut [S], tau: &mut [S]) {
        for f in self.followers.iter().rev() {
            let share = tree[f.v] * f.ratio;
            tree[f.leader_v] += share;
        }
        for (&t, x) in self.independent_v.iter().zip(tau) {
            *x = tree[t];
        }
    }

    /// Writes the tree velocities `Z Zᵀ τ` in place of tree generalized forces τ.
    #[inline]
    pub fn spread<S: Real>(&self, tree: &mut [S]) {
        for f in self.followers.iter().rev() {
            let share = tree[f.v] * f.ratio;
            tree[f.leader_v] += share;
        }
        for f in &self.followers {
            tree[f.v] = tree[f.leader_v] * f.ratio;
        }
    }
}
