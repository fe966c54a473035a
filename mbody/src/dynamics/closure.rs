//! Closing of loops: coordinates and velocities that satisfy the constraints, and the rows that are independent.
//!
//! ```text
//! coordinates: q ← q ⊕ N δ,  δ = −J⁺ Φ        velocities: v ← v − J⁺ (J v)        (J⁺: least norm over what is not held)
//! ```
//!
//! Lengths count in meters and angles in radians. Rows that depend on others at the closed pose and at poses nearby are redundant.
//! Sources: J. García de Jalón, E. Bayo, *Kinematic and Dynamic Simulation of Multibody Systems*, 1994, section 3.3 (assembly);
//! rank by Gram–Schmidt with pivoting: G. H. Golub, C. F. Van Loan, *Matrix Computations*, section 5.4.

use crate::algorithm::kinematics;
use crate::constraint::{Constraint, Level, Moment, RowValue};
use crate::model::{BodyIndex, Model};
use crate::spatial::{Pose, Wrench};
use crate::stage::Workspace;
use nalgebra::{DMatrix, DVector};
use problem::Off;

/// Largest change of a coordinate in one step, m or rad.
const LARGEST_STEP: f64 = 0.3;
/// Most steps.
const MOST_STEPS: usize = 200;
/// Error below which a loop is closed, m or rad.
pub const CLOSED: f64 = 1e-11;
/// Part of a row of J that must not depend on the others for the row to count.
const INDEPENDENT: f64 = 1e-7;

/// Constraints over a tree, with work arrays.
pub struct Closure<'a> {
    model: &'a Model,
    constraints: &'a [Constraint],
    work: Work,
}

/// Work arrays of a [`Closure`], to be kept between uses.
#[derive(Debug)]
pub(super) struct Work {
    w: Workspace<f64>,
    values: Vec<RowValue<f64>>,
    directions: Vec<Wrench<f64>>,
    /// [constraints] time and inputs of each.
    moments: Vec<Moment<f64>>,
    /// [constraints] pose of the second frame in the first.
    poses: Vec<Pose<f64>>,
}

impl Work {
    pub(super) fn new(model: &Model, constraints: &[Constraint]) -> Self {
        let rows = constraints.iter().map(|c| c.rows().len()).sum();
        let n = constraints.len();
        Self {
            w: Workspace::new(model),
            values: vec![RowValue::default(); rows],
            directions: vec![Wrench::zero(); rows],
            moments: vec![Moment::at(0.0); n],
            poses: vec![Pose::identity(); n],
        }
    }
}

/// Rows that are held, and what was found on the way.
#[derive(Debug, Default)]
pub struct Independent {
    /// Held rows: constraint and row.
    pub held: Vec<(usize, usize)>,
    /// Rows that follow from those held.
    pub redundant: Vec<(usize, usize)>,
    /// How many of the held rows depend on others at the given pose itself, though not nearby: a singular position.
    pub singular: usize,
}

/// Adds the generalized forces of a wrench on a body (in its axes about its origin).
pub fn spread(model: &Model, w: &Workspace<f64>, body: BodyIndex, mut F: Wrench<f64>, tau: &mut [f64]) {
    let mut at = body;
    while at != BodyIndex::WORLD {
        let b = model.body(at);
        for j in b.v.clone() {
            tau[j] += w.position.H[j].dot(F);
        }
        F = b.turned(&w.position.X_PB[at.get()]).wrench_to_parent(F);
        at = b.parent;
    }
}

/// Writes one row of the Jacobian over tree velocities: generalized forces of a unit multiplier.
pub fn tree_row(model: &Model, w: &Workspace<f64>, constraint: &Constraint, X_FM: &Pose<f64>, direction: Wrench<f64>, row: &mut [f64]) {
    row.fill(0.0);
    let (from, to) = (constraint.from(), constraint.to());
    spread(model, w, to.body, to.X_BF.wrench_to_parent(direction), row);
    spread(model, w, from.body, -from.X_BF.wrench_to_parent(X_FM.wrench_to_parent(direction)), row);
}

impl<'a> Closure<'a> {
    /// Constraints over a tree, with new work arrays.
    pub fn new(model: &'a Model, constraints: &'a [Constraint]) -> Self {
        Self::with(model, constraints, Work::new(model, constraints))
    }

    /// Constraints over a tree, with the work arrays of another use.
    pub(super) fn with(model: &'a Model, constraints: &'a [Constraint], work: Work) -> Self {
        Self { model, constraints, work }
    }

    /// Sets time and inputs; `inputs` are the indices in u of the inputs of each constraint.
    pub(super) fn at_moment(&mut self, time: f64, u: &[f64], inputs: &[Vec<usize>]) {
        for (moment, indices) in self.work.moments.iter_mut().zip(inputs) {
            moment.time = time;
            moment.inputs.iter_mut().zip(indices).for_each(|(x, &i)| *x = u[i]);
        }
    }

    /// Gives the work arrays back.
    pub(super) fn into_work(self) -> Work {
        self.work
    }

    /// All rows: constraint and row.
    pub fn rows(&self) -> Vec<(usize, usize)> {
        self.constraints.iter().enumerate().flat_map(|(c, k)| (0..k.rows().len()).map(move |r| (c, r))).collect()
    }

    /// Evaluates all rows at independent coordinates and velocities; accelerations are zero.
    pub fn evaluate(&mut self, q: &[f64], v: &[f64]) {
        let (model, Work { w, values, directions, moments, poses }) = (self.model, &mut self.work);
        model.layout.expand_q(q, &mut w.position.q);
        model.layout.expand_v(v, &mut w.velocity.v);
        w.acceleration.vd.fill(0.0);
        kinematics::position(model, &mut w.position);
        kinematics::world(model, &w.position, &mut w.world);
        kinematics::velocity(model, &w.position, &mut w.velocity);
        kinematics::acceleration(model, &w.position, &w.velocity, &mut w.acceleration);
        let mut first = 0;
        for ((c, moment), X_FM) in self.constraints.iter().zip(moments).zip(poses) {
            let rows = first..first + c.rows().len();
            first = rows.end;
            *X_FM = c.observe(model, w, moment, &mut values[rows.clone()], &mut directions[rows]);
        }
    }

    /// Position of a row among all.
    fn index(&self, (constraint, row): (usize, usize)) -> usize {
        self.constraints[..constraint].iter().map(|c| c.rows().len()).sum::<usize>() + row
    }

    fn level(&self, (constraint, row): (usize, usize)) -> Level {
        self.constraints[constraint].rows()[row].level
    }

    /// The value of a row at the last evaluated point.
    pub fn value(&self, row: (usize, usize)) -> RowValue<f64> {
        self.work.values[self.index(row)]
    }

    /// Jacobian of rows over independent velocities at the last evaluated point.
    pub fn jacobian(&self, rows: &[(usize, usize)]) -> DMatrix<f64> {
        let (model, nv) = (self.model, self.model.layout.nv());
        let mut J = DMatrix::zeros(rows.len(), nv);
        let (mut tree, mut independent) = (vec![0.0; model.layout.tree_nv], vec![0.0; nv]);
        for (i, &row) in rows.iter().enumerate() {
            let c = &self.constraints[row.0];
            tree_row(model, &self.work.w, c, &self.work.poses[row.0], self.work.directions[self.index(row)], &mut tree);
            model.layout.reduce(&mut tree, &mut independent);
            J.row_mut(i).copy_from_slice(&independent);
        }
        J
    }

    /// Moves coordinates by a small change of the velocities' kind.
    fn step(&self, q: &[f64], change: &[f64]) -> Vec<f64> {
        let layout = &self.model.layout;
        let (mut tree_q, mut tree_v) = (vec![0.0; layout.tree_nq], vec![0.0; layout.tree_nv]);
        layout.expand_q(q, &mut tree_q);
        layout.expand_v(change, &mut tree_v);
        let mut moved = tree_q.clone();
        for body in self.model.bodies.iter().skip(1) {
            let mut rates = [0.0; 7];
            body.joint.rates(&tree_q[body.q.clone()], &tree_v[body.v.clone()], &mut rates[..body.q.len()]);
            for (k, rate) in body.q.clone().zip(rates) {
                moved[k] += rate;
            }
        }
        layout.independent_q.iter().map(|&k| moved[k]).collect()
    }

    fn largest(&self, rows: &[(usize, usize)]) -> f64 {
        rows.iter().map(|&r| self.value(r).error.abs()).fold(0.0, f64::max)
    }

    /// Closes the loops by moving coordinates as little as possible; velocities in `held` do not take part.
    ///
    /// # Errors
    /// The rows that stay open, worst first.
    pub fn close(&mut self, q: &mut [f64], held: &[bool]) -> Result<(), Vec<Off>> {
        let rows: Vec<_> = self.rows().into_iter().filter(|&r| self.level(r) == Level::Position).collect();
        let still = vec![0.0; self.model.layout.nv()];
        self.evaluate(q, &still);
        let mut error = self.largest(&rows);
        for _ in 0..MOST_STEPS {
            if error == 0.0 || rows.is_empty() {
                return Ok(());
            }
            let phi = DVector::from_iterator(rows.len(), rows.iter().map(|&r| -self.value(r).error));
            let mut change = least_norm(self.jacobian(&rows), &phi, held);
            let longest = change.amax();
            if longest > LARGEST_STEP {
                change *= LARGEST_STEP / longest;
            }
            // halve where the errors grow, but let them grow a little far from the goal: loops open before they close
            let mut share = 1.0;
            let moved = loop {
                let trial = self.step(q, (&change * share).as_slice());
                self.evaluate(&trial, &still);
                let now = self.largest(&rows);
                if now < error || share < 1e-3 {
                    break (now < error).then_some((trial, now));
                }
                share *= 0.5;
            };
            match moved {
                Some((trial, now)) => {
                    q.copy_from_slice(&trial);
                    error = now;
                }
                None => break,
            }
        }
        self.evaluate(q, &still);
        if error <= CLOSED {
            return Ok(());
        }
        Err(self.off(&rows, CLOSED, |r| r.error, ""))
    }

    /// Corrects velocities by as little as possible so that all rows hold; those in `held` stay.
    ///
    /// # Errors
    /// The rows that stay violated, worst first.
    pub fn project_velocity(&mut self, q: &[f64], v: &mut [f64], held: &[bool]) -> Result<(), Vec<Off>> {
        let rows = self.rows();
        for _ in 0..2 {
            self.evaluate(q, v);
            let rate = DVector::from_iterator(rows.len(), rows.iter().map(|&r| -self.value(r).rate));
            let change = least_norm(self.jacobian(&rows), &rate, held);
            v.iter_mut().zip(change.iter()).for_each(|(v, c)| *v += c);
        }
        self.evaluate(q, v);
        let speed = v.iter().fold(1.0, |m: f64, v| m.max(v.abs()));
        let off = self.off(&rows, 1e-10 * speed, |r| r.rate, "/s");
        if off.is_empty() { Ok(()) } else { Err(off) }
    }

    /// Smallest part of one of the rows of J that does not depend on the others, at the last evaluated point: 0 in a singular position.
    ///
    /// Rows are not made of equal length: near a singular position a row may vanish as a whole.
    pub fn independence(&self, rows: &[(usize, usize)]) -> f64 {
        let R = self.jacobian(rows).transpose().col_piv_qr().r();
        (0..rows.len()).map(|i| if i < R.nrows() { R[(i, i)].abs() } else { 0.0 }).fold(f64::INFINITY, f64::min)
    }

    /// Rows beyond a tolerance, worst first.
    fn off(&self, rows: &[(usize, usize)], tolerance: f64, value: fn(&RowValue<f64>) -> f64, per: &str) -> Vec<Off> {
        let mut off: Vec<Off> = Vec::new();
        for &row in rows {
            let (c, r) = (&self.constraints[row.0], &self.constraints[row.0].rows()[row.1]);
            let by = value(&self.value(row));
            if by.abs() > tolerance || !by.is_finite() {
                let unit = if r.level == Level::Position { format!("{}{per}", r.error_unit) } else { r.error_unit.to_owned() };
                off.push(Off { row: format!("{} of {}", r.error, c.name()), by, unit });
            }
        }
        off.sort_by(|a, b| b.by.abs().total_cmp(&a.by.abs()));
        off
    }

    /// Chooses independent rows at a closed pose.
    pub fn independent(&mut self, q: &[f64]) -> Independent {
        let (rows, still) = (self.rows(), vec![0.0; self.model.layout.nv()]);
        self.evaluate(q, &still);
        let here = self.jacobian(&rows);
        let at_start = independent_rows(&here);
        let mut best = at_start.clone();
        for round in 0..2 {
            let Some(nearby) = self.nearby(q, &here, round) else { continue };
            self.evaluate(&nearby, &still);
            let there = independent_rows(&self.jacobian(&rows));
            if there.len() > best.len() {
                best = there;
            }
        }
        self.evaluate(q, &still);
        let kept = |i: &usize| best.contains(i);
        Independent {
            held: (0..rows.len()).filter(kept).map(|i| rows[i]).collect(),
            redundant: (0..rows.len()).filter(|i| !kept(i)).map(|i| rows[i]).collect(),
            singular: best.len() - at_start.len(),
        }
    }

    /// A closed pose somewhat away, along motions that the constraints allow.
    fn nearby(&mut self, q: &[f64], J: &DMatrix<f64>, round: usize) -> Option<Vec<f64>> {
        let nv = J.ncols();
        let spread = |i: usize| 0.1 * (((i + 1) as f64 * 0.618_034 + round as f64 * 0.414_214).fract() - 0.5);
        let wish = DVector::from_fn(nv, |i, _| spread(i));
        let allowed = &wish + least_norm(J.clone(), &-(J * &wish), &[]);
        let mut moved = self.step(q, allowed.as_slice());
        self.close(&mut moved, &[]).ok().map(|()| moved)
    }
}

/// The shortest x with J x = b in the sense of least squares; entries in `held` stay zero.
///
/// Complete orthogonal decomposition: `Jᵀ P = Q₁ R₁` with the rank of J, then `R₁ᵀ = Q₂ R₂`; `x = Q₁ R₂⁻¹ Q₂ᵀ Pᵀ b`.
pub fn least_norm(mut J: DMatrix<f64>, b: &DVector<f64>, held: &[bool]) -> DVector<f64> {
    for (j, _) in held.iter().enumerate().filter(|(_, held)| **held) {
        J.column_mut(j).fill(0.0);
    }
    let n = J.ncols();
    let qr = J.transpose().col_piv_qr();
    let (Q, R) = (qr.q(), qr.r());
    // wide where there are more rows than velocities
    let diagonal = || (0..R.nrows()).map(|i| R[(i, i)].abs());
    let largest = diagonal().fold(1e-3, f64::max);
    let rank = diagonal().take_while(|d| *d > 1e-9 * largest).count();
    if rank == 0 {
        return DVector::zeros(n);
    }
    let mut pivoted = b.clone();
    qr.p().permute_rows(&mut pivoted);
    let second = R.rows(0, rank).transpose().qr();
    let mut x = second.q().tr_mul(&pivoted);
    // the diagonal of R₂ is not zero: its rank was counted
    let solved = second.r().solve_upper_triangular_mut(&mut x);
    debug_assert!(solved);
    Q.columns(0, rank) * x
}

/// Indices of a largest set of independent rows, in order.
fn independent_rows(J: &DMatrix<f64>) -> Vec<usize> {
    let mut rest: Vec<DVector<f64>> = (0..J.nrows()).map(|i| J.row(i).transpose()).collect();
    let mut chosen: Vec<usize> = Vec::new();
    loop {
        let left = (0..rest.len()).filter(|i| !chosen.contains(i));
        // the first of those that are about as good as the best, so that equal rows keep their order
        let best = left.clone().map(|i| rest[i].norm()).fold(0.0, f64::max);
        let Some(pick) = left.clone().find(|&i| rest[i].norm() >= 0.5 * best).filter(|_| best > INDEPENDENT) else { break };
        let direction = rest[pick].normalize();
        chosen.push(pick);
        for row in &mut rest {
            let along = row.dot(&direction);
            *row -= &direction * along;
        }
    }
    chosen.sort_unstable();
    chosen
}
