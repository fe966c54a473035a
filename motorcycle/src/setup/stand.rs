//! A vehicle on a stand with a jack under the wheels of one axle: suspension travel in equilibrium.
//!
//! ```text
//! ∂L/∂q:  Q(q, λ) + Σ F_w ∂z_w/∂q = 0     Φ(q) = 0     z_w(q) = z_w0 + s
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | q | m, rad | coordinates between the held chassis and the wheels of the axle, without steering and spin |
//! | Q, λ, Φ | | forces of springs, bushings and weights on them; multipliers and rows of loops |
//! | z_w, s | m | height of a wheel center along the middle plane of the chassis; travel, positive in bump, the same for all wheels |
//! | F_w | N | force of the jack under a wheel, upward |
//!
//! Nothing moves, so dampers are silent; the jack carries what the road did, so tires are silent too. The weight of wheel and suspension is carried by the jack, as
//! it is by the road. Any mechanism has this equilibrium: fork, arm, linkage, loops, rubber bushings.
//!
//! Source: virtual work. Range: springs whose force does not depend on the road; loops that are independent.

use super::parts::{Parts, Wheel};
use mbody::algorithm::jacobian::jacobian;
use mbody::dynamics::{Element, System, TreePlant};
use mbody::model::{BodyIndex, Outline};
use mbody::spatial::{Pose, Twist, Vec3};
use problem::{AlgebraicMethod, AlgebraicOptions, AlgebraicProblem, At, Dae, EvalError, Matrix, Outputs, UnknownKind};
use std::sync::Arc;

/// Step of the differences from which the Jacobian comes, in units of each unknown.
const DIFFERENCE: f64 = 1e-6;
/// Scaled residual of an equilibrium.
const TOLERANCE: f64 = 1e-10;

/// The equilibrium as a system of equations in `(q, λ, F)`.
struct Jack {
    plant: TreePlant,
    wheels: Vec<Wheel>,
    /// Upward in the middle plane.
    up: Vec3<f64>,
    /// Coordinates of y that move, and the rows of their velocities among the independent velocities.
    coordinates: Vec<(usize, usize)>,
    /// Multipliers that act; row and unknown have one index.
    multipliers: Vec<usize>,
    /// Heights that are asked for, m.
    heights: Vec<f64>,
    y: Vec<f64>,
    yd: Vec<f64>,
    u: Vec<f64>,
    unknown_scale: Vec<f64>,
    equation_scale: Vec<f64>,
    residual: Vec<f64>,
    columns: Vec<Twist<f64>>,
    tree: Vec<f64>,
    independent: Vec<f64>,
}

impl Jack {
    fn load(&mut self, x: &[f64]) {
        let indices = self.coordinates.iter().map(|c| c.0).chain(self.multipliers.iter().copied());
        indices.zip(x).for_each(|(i, &value)| self.y[i] = value);
    }

    /// Writes the equations at x.
    fn write(&mut self, x: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.load(x);
        let forces = &x[x.len() - self.wheels.len()..];
        let system = self.plant.system().clone();
        let model = system.model();
        let layout = model.layout();
        let at = At { time: 0.0, y: &self.y, yd: &self.yd, u: &self.u };
        let done = self.plant.evaluate_at(at);
        self.residual.copy_from_slice(&done.residual);
        let (n, m) = (self.coordinates.len(), self.multipliers.len());
        for (k, &(_, row)) in self.coordinates.iter().enumerate() {
            f[k] = self.residual[layout.nq() + row];
        }
        for (k, &row) in self.multipliers.iter().enumerate() {
            f[n + k] = self.residual[row];
        }
        for (w, wheel) in self.wheels.iter().enumerate() {
            let X = done.tree.world.X_WB[wheel.body.get()];
            f[n + m + w] = X.point(wheel.center).dot(self.up) - self.heights[w];
            jacobian(model, &done.tree.position, wheel.body, &mut self.columns);
            for (slot, column) in self.tree.iter_mut().zip(&self.columns) {
                *slot = (X.R * column.at_point(wheel.center)).dot(self.up);
            }
            layout.reduce(&mut self.tree, &mut self.independent);
            for (k, &(_, row)) in self.coordinates.iter().enumerate() {
                f[k] -= forces[w] * self.independent[row];
            }
        }
        match f.iter().position(|v| !v.is_finite()) {
            Some(equation) => Err(EvalError::Recoverable { equation }),
            None => Ok(()),
        }
    }
}

impl AlgebraicProblem for Jack {
    fn size(&self) -> usize {
        self.unknown_scale.len()
    }
    fn unknown_scale(&self) -> &[f64] {
        &self.unknown_scale
    }
    fn equation_scale(&self) -> &[f64] {
        &self.equation_scale
    }
    fn residual(&mut self, x: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.write(x, f)
    }
    fn jacobian(&mut self, x: &[f64], f: &mut [f64], jacobian: &mut Matrix) -> Result<(), EvalError> {
        let mut moved = x.to_vec();
        let mut other = vec![0.0; f.len()];
        for j in 0..x.len() {
            // linear in multipliers and forces
            let step = if j < self.coordinates.len() { DIFFERENCE } else { 1.0 };
            moved[j] = x[j] + step;
            self.write(&moved, f)?;
            moved[j] = x[j] - step;
            self.write(&moved, &mut other)?;
            moved[j] = x[j];
            for (entry, (a, b)) in jacobian.column_mut(j).iter_mut().zip(f.iter().zip(&other)) {
                *entry = (a - b) / (2.0 * step);
            }
        }
        self.write(x, f)
    }
}

/// The vehicle in equilibrium at one travel.
#[derive(Clone, Debug)]
pub(super) struct Posture {
    /// Force of the jack under all wheels of the axle, N.
    pub force: f64,
    /// Poses of all bodies in the world.
    pub poses: Vec<Pose<f64>>,
    /// Unknowns of the system.
    pub y: Vec<f64>,
    /// Outputs of the system.
    pub outputs: Vec<f64>,
    x: Vec<f64>,
}

/// A vehicle on a stand, with a jack under one axle.
pub(super) struct Stand<'m> {
    jack: Jack,
    method: &'m mut dyn AlgebraicMethod,
    /// Heights of the wheel centers at no travel, m.
    level: Vec<f64>,
}

impl<'m> Stand<'m> {
    /// Holds the chassis of a vehicle in a pose; `None` where no joint lets these wheels move against the chassis.
    pub fn new(system: &Arc<System>, parts: &Parts, wheels: &[Wheel], pose: &[f64], method: &'m mut dyn AlgebraicMethod) -> Option<Self> {
        let model = system.model();
        let mut y: Vec<f64> = system.unknowns().iter().map(|u| u.design).collect();
        let nq = model.layout().nq();
        y[..nq].copy_from_slice(&pose[..nq]);
        for (value, unknown) in y.iter_mut().zip(system.unknowns()) {
            match unknown.kind {
                UnknownKind::Velocity | UnknownKind::Algebraic => *value = 0.0,
                UnknownKind::Position | UnknownKind::State => {}
            }
        }
        let (coordinates, multipliers) = moving(system, parts, wheels);
        if coordinates.is_empty() {
            return None;
        }
        let tire = |element: &Element| element.force.outlines(model).iter().any(|o| matches!(o, Outline::Round { .. }));
        let mut plant = TreePlant::without(system.clone(), tire);
        let u: Vec<f64> = system.inputs().iter().map(|i| i.default).collect();
        let yd = vec![0.0; y.len()];
        let poses = plant.evaluate_at(At { time: 0.0, y: &y, yd: &yd, u: &u }).tree.world.X_WB.clone();
        let left = poses[parts.base.get()].R.columns[1];
        let up = Vec3::new(0.0, 0.0, 1.0) - left.scaled(left.z);
        let up = up.normalized()?;
        let level: Vec<f64> = wheels.iter().map(|w| w.center(&poses).dot(up)).collect();
        let (unknowns, equations) = (plant.unknowns(), plant.equations());
        let weight = (model.total_mass() * model.gravity().norm()).max(1.0);
        let unknown_scale = coordinates.iter().map(|c| unknowns[c.0].nominal).chain(multipliers.iter().map(|&i| unknowns[i].nominal));
        let equation_scale =
            coordinates.iter().map(|c| equations[nq + c.1].nominal).chain(multipliers.iter().map(|&i| equations[i].nominal));
        let jack = Jack {
            unknown_scale: unknown_scale.chain(wheels.iter().map(|_| weight)).collect(),
            equation_scale: equation_scale.chain(wheels.iter().map(|_| 0.1)).collect(),
            residual: vec![0.0; equations.len()],
            columns: vec![Twist::zero(); model.layout().tree_nv],
            tree: vec![0.0; model.layout().tree_nv],
            independent: vec![0.0; model.layout().nv()],
            wheels: wheels.to_vec(),
            heights: level.clone(),
            up,
            coordinates,
            multipliers,
            y,
            yd,
            u,
            plant,
        };
        let mut stand = Self { jack, method, level };
        stand.moves().then_some(stand)
    }

    /// Whether any coordinate moves a wheel along the middle plane: flexible parts that only twist do not.
    fn moves(&mut self) -> bool {
        let jack = &mut self.jack;
        let mut f = vec![0.0; jack.size()];
        let at: Vec<f64> = jack.coordinates.iter().map(|c| jack.y[c.0]).chain(vec![0.0; f.len() - jack.coordinates.len()]).collect();
        let level = jack.wheels.len();
        (0..jack.coordinates.len()).any(|k| {
            let mut moved = at.clone();
            moved[k] += DIFFERENCE;
            let heights = |f: &[f64]| f[f.len() - level..].iter().map(|h| h.abs()).sum::<f64>();
            jack.write(&moved, &mut f).is_ok() && heights(&f) > 1e-3 * DIFFERENCE
        })
    }

    /// The equilibrium at a travel from the given pose, m, from a neighbor where there is one; `None` where none is found.
    pub fn at(&mut self, travel: f64, near: Option<&Posture>) -> Option<Posture> {
        let jack = &mut self.jack;
        jack.heights.iter_mut().zip(&self.level).for_each(|(h, level)| *h = level + travel);
        let start = jack.coordinates.iter().map(|c| jack.y[c.0]).chain(jack.multipliers.iter().map(|&i| jack.y[i]));
        let mut x: Vec<f64> = match near {
            Some(near) => near.x.clone(),
            None => start.chain(jack.wheels.iter().map(|_| 0.0)).collect(),
        };
        let options = AlgebraicOptions { residual_tolerance: TOLERANCE, ..Default::default() };
        if !self.method.solve(jack, &mut x, &options).converged() {
            return None;
        }
        jack.load(&x);
        let Jack { plant, y, yd, u, residual, .. } = jack;
        let mut outputs = vec![0.0; plant.outputs().len()];
        let at = At { time: 0.0, y, yd, u };
        plant.evaluate(at, residual, &mut outputs).ok()?;
        let poses = plant.evaluate_at(at).tree.world.X_WB.clone();
        let force = x[x.len() - jack.wheels.len()..].iter().sum();
        Some(Posture { force, poses, y: jack.y.clone(), outputs, x })
    }
}

/// Bodies between one and the base.
fn path(system: &System, parts: &Parts, mut at: BodyIndex) -> Vec<BodyIndex> {
    let mut bodies = Vec::new();
    while at != BodyIndex::WORLD && at != parts.base {
        bodies.push(at);
        at = system.model().body(at).parent;
    }
    bodies
}

/// Coordinates that let the wheels move (index in y, row of the velocity), and multipliers of the loops that they belong to.
fn moving(system: &System, parts: &Parts, wheels: &[Wheel]) -> (Vec<(usize, usize)>, Vec<usize>) {
    let model = system.model();
    let held = |body: BodyIndex| parts.wheels().any(|w| w.body == body) || parts.steer.is_some_and(|(steer, _)| steer == body);
    let mut bodies: Vec<BodyIndex> = wheels.iter().flat_map(|w| path(system, parts, w.body)).collect();
    let mut loops: Vec<usize> = Vec::new();
    loop {
        // a loop that one of these bodies moves moves the bodies of its other side
        let joined = system.constraints().iter().enumerate().find(|(k, c)| {
            let ends = [c.from().body, c.to().body];
            let touches = ends.iter().any(|&end| path(system, parts, end).iter().any(|b| bodies.contains(b) && !held(*b)));
            touches && !loops.contains(k) && ends.iter().all(|end| *end != BodyIndex::WORLD)
        });
        let Some((k, constraint)) = joined else { break };
        loops.push(k);
        bodies.extend([constraint.from().body, constraint.to().body].into_iter().flat_map(|end| path(system, parts, end)));
    }
    bodies.retain(|&b| !held(b));
    let layout = model.layout();
    let mut coordinates = Vec::new();
    for b in bodies.into_iter().map(|b| model.body(b)).filter(|b| b.q.len() == b.v.len()) {
        for (q, v) in b.q.clone().zip(b.v.clone()) {
            // a follower moves with its leader
            let (q, v) = layout.followers.iter().rev().fold((q, v), |(q, v), f| if f.q == q { (f.leader_q, f.leader_v) } else { (q, v) });
            let place = layout.independent_q.iter().position(|&i| i == q).zip(layout.independent_v.iter().position(|&i| i == v));
            coordinates.extend(place.filter(|p| !coordinates.contains(p)));
        }
    }
    let names: Vec<String> = loops.iter().map(|&k| format!("{}.", system.constraints()[k].name())).collect();
    let acts = |name: &str| names.iter().any(|n| name.starts_with(n.as_str()));
    let unknowns = system.unknowns().iter().enumerate();
    let multipliers = unknowns.filter(|(_, u)| u.kind == UnknownKind::Algebraic && acts(&u.signal.name)).map(|(i, _)| i).collect();
    (coordinates, multipliers)
}
