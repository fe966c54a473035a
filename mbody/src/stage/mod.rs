//! Stages of an evaluation are separate results: a function that needs velocities takes them.
//!
//! All arrays are indexed by body (0 = world); twists and accelerations are written in body axes about the body origin.

use crate::algorithm::kinematics;
use crate::model::Model;
use crate::scalar::{Family, Make, SystemScalar};
use crate::spatial::{ArticulatedInertia, Inertia, Pose, Twist, Wrench};

/// What follows from the coordinates.
#[derive(Clone, Debug)]
pub struct Position<S> {
    /// [tree nq] tree coordinates.
    pub q: Vec<S>,
    /// \[bodies\] pose of each body in its parent.
    pub X_PB: Vec<Pose<S>>,
    /// [tree nv] motion subspace of each joint: columns, in body axes.
    pub H: Vec<Twist<S>>,
}

/// Poses of all bodies in the world; needed by everything outside the tree recursion.
#[derive(Clone, Debug)]
pub struct World<S> {
    /// \[bodies\] pose of each body in the world.
    pub X_WB: Vec<Pose<S>>,
}

/// What follows from coordinates and velocities.
#[derive(Clone, Debug)]
pub struct Velocity<S> {
    /// [tree nv] tree velocities.
    pub v: Vec<S>,
    /// \[bodies\] twist of each body in the world.
    pub V_WB: Vec<Twist<S>>,
    /// \[bodies\] velocity-dependent part of each joint's acceleration: `Ḣ v + V × H v`.
    pub bias: Vec<Twist<S>>,
}

/// What follows from coordinates, velocities and accelerations.
#[derive(Clone, Debug)]
pub struct Acceleration<S> {
    /// [tree nv] tree accelerations.
    pub vd: Vec<S>,
    /// \[bodies\] spatial acceleration of each body relative to free fall (the world accelerates with −g).
    pub A_WB: Vec<Twist<S>>,
}

/// Work arrays of the tree algorithms. Allocated once; evaluation allocates nothing.
#[derive(Clone, Debug)]
pub struct Workspace<S> {
    /// Stage 1.
    pub position: Position<S>,
    /// Stage 1, in the world.
    pub world: World<S>,
    /// Stage 2.
    pub velocity: Velocity<S>,
    /// Stage 3.
    pub acceleration: Acceleration<S>,
    /// \[bodies\] applied wrench on each body, in body axes about the body origin.
    pub applied: Vec<Wrench<S>>,
    /// \[bodies\] wrench transmitted by each joint onto its body, in body axes about the body origin.
    pub transmitted: Vec<Wrench<S>>,
    /// [tree nv] generalized forces.
    pub tau: Vec<S>,
    /// \[bodies\] composite inertias.
    pub composite: Vec<Inertia<S>>,
    /// \[bodies\] articulated inertias.
    pub articulated: Vec<ArticulatedInertia<S>>,
    /// \[bodies\] bias wrenches of the articulated bodies.
    pub articulated_bias: Vec<Wrench<S>>,
    /// [tree nv] `U = Iᴬ H`.
    pub U: Vec<Wrench<S>>,
    /// [tree nv] `u = τ − Hᵀ pᴬ`.
    pub u: Vec<S>,
    /// \[bodies\] Cholesky factors of `D = Hᵀ U`, packed 6 × 6, with reciprocal diagonals; 1/D for a joint with one velocity.
    pub D: Vec<[[S; 6]; 6]>,
}

impl<S: SystemScalar> Workspace<S> {
    /// Work arrays for a model.
    pub fn new(model: &Model) -> Self {
        let n = model.bodies.len();
        let (nq, nv) = (model.layout.tree_nq, model.layout.tree_nv);
        let mut position = Position { q: vec![S::zero(); nq], X_PB: vec![Pose::identity(); n], H: vec![Twist::zero(); nv] };
        // subspaces that do not depend on q are written here, once and for all
        for (body, X_PB) in model.bodies.iter().zip(&mut position.X_PB).skip(1) {
            let q = &mut position.q[body.q.clone()];
            q.iter_mut().zip(body.joint.reference()).for_each(|(q, &reference)| *q = S::from_f64(reference));
            *X_PB = body.joint.place(&body.X_PF, q, &mut position.H[body.v.clone()]);
        }
        Self {
            position,
            world: World { X_WB: vec![Pose::identity(); n] },
            velocity: Velocity { v: vec![S::zero(); nv], V_WB: vec![Twist::zero(); n], bias: vec![Twist::zero(); n] },
            acceleration: Acceleration { vd: vec![S::zero(); nv], A_WB: vec![Twist::zero(); n] },
            applied: vec![Wrench::zero(); n],
            transmitted: vec![Wrench::zero(); n],
            tau: vec![S::zero(); nv],
            composite: vec![Inertia::from_f64(&Inertia::default()); n],
            articulated: vec![ArticulatedInertia::default(); n],
            articulated_bias: vec![Wrench::zero(); n],
            U: vec![Wrench::zero(); nv],
            u: vec![S::zero(); nv],
            D: vec![[[S::zero(); 6]; 6]; n],
        }
    }
}

impl Workspace<f64> {
    /// Poses of all bodies with every joint at its reference.
    pub fn to_design(&mut self, model: &Model) {
        for body in model.bodies.iter().skip(1) {
            self.position.q[body.q.clone()].copy_from_slice(body.joint.reference());
        }
        kinematics::position(model, &mut self.position);
        kinematics::world(model, &self.position, &mut self.world);
    }

    /// Poses of all bodies at the given independent coordinates.
    pub fn to_coordinates(&mut self, model: &Model, q: impl Iterator<Item = f64>) {
        let q: Vec<f64> = q.collect();
        model.layout.expand_q(&q, &mut self.position.q);
        kinematics::position(model, &mut self.position);
        kinematics::world(model, &self.position, &mut self.world);
    }
}

/// One workspace for each scalar of the assembled system.
pub struct Workspaces;

impl Family for Workspaces {
    type Of<S: SystemScalar> = Workspace<S>;
}

impl Make<Workspaces> for Model {
    fn make<S: SystemScalar>(&self) -> Workspace<S> {
        Workspace::new(self)
    }
}
