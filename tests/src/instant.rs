//! A model at one instant, by signal names: constraints, accelerations and their forces.

use crate::tree::Named;
use fastbike::library::Source;
use fastbike::standard_kinds;
use mbody::assembly::assemble;
use mbody::dynamics::{Formulation, TreePlant};
use mbody::spatial::{Pose, Vec3};
use problem::{At, Dae, Explicit, Outputs, Projection};
use std::env;

/// A plant with a point at which it is looked at.
pub struct Instant {
    plant: TreePlant,
    y: Vec<f64>,
    yd: Vec<f64>,
    u: Vec<f64>,
}

impl Instant {
    /// A bundled model, or a description of the repository by its path from the top, at its start.
    ///
    /// # Panics
    /// It does not assemble.
    pub fn of(model: &str) -> Self {
        let path = format!("{}/../{model}", env!("CARGO_MANIFEST_DIR"));
        let source = Source::find(if model.contains('/') { &path } else { model }).unwrap_or_else(|findings| panic!("{findings}"));
        let (assembled, findings) = assemble(&source.file, &source, &standard_kinds(), &[]);
        let system = assembled.unwrap_or_else(|| panic!("{model}: {findings}")).system;
        let plant = TreePlant::in_formulation(system, Formulation::Acceleration { decay: 0.0 });
        let y: Vec<f64> = plant.unknowns().iter().map(|k| k.start.unwrap_or(k.design)).collect();
        let u = plant.inputs().iter().map(|i| i.default).collect();
        let mut instant = Self { yd: vec![0.0; y.len()], plant, y, u };
        let stated: Vec<bool> = instant.plant.unknowns().iter().map(|k| k.start.is_some()).collect();
        instant.project(&stated);
        instant.solve();
        instant
    }

    fn project(&mut self, held: &[bool]) {
        self.plant.project(0.0, &mut self.y, &self.u, held).unwrap_or_else(|error| panic!("{error:?}"));
    }

    fn solve(&mut self) {
        self.plant.solve_rates(0.0, &mut self.y, &self.u, &mut self.yd).unwrap_or_else(|error| panic!("{error:?}"));
    }

    fn unknown(&self, name: &str) -> usize {
        let at = self.plant.unknowns().iter().position(|k| k.signal.name == name);
        at.unwrap_or_else(|| {
            panic!("no unknown `{name}` among {:?}", self.plant.unknowns().iter().map(|k| &k.signal.name).collect::<Vec<_>>())
        })
    }

    /// Puts coordinates, velocities and inputs, each by its name, moves the others onto the constraints and finds accelerations and forces.
    ///
    /// # Panics
    /// An unknown name, constraints that cannot hold.
    pub fn put(&mut self, values: &[Named]) {
        let mut held = vec![false; self.y.len()];
        for (name, value) in values {
            if let Some(i) = self.plant.inputs().iter().position(|i| i.signal.name == *name) {
                self.u[i] = *value;
                continue;
            }
            let i = self.unknown(name);
            self.y[i] = *value;
            held[i] = true;
        }
        self.project(&held);
        self.solve();
    }

    /// Value of a coordinate, a velocity or the multiplier of a constraint.
    pub fn get(&self, name: &str) -> f64 {
        self.y[self.unknown(name)]
    }

    /// Rate of a coordinate or a velocity.
    pub fn rate(&self, name: &str) -> f64 {
        self.yd[self.unknown(name)]
    }

    /// All names, of coordinates and velocities first.
    pub fn names(&self) -> Vec<String> {
        self.plant.unknowns().iter().map(|k| k.signal.name.clone()).collect()
    }

    /// Value of an output.
    ///
    /// # Panics
    /// There is no such output.
    pub fn output(&mut self, name: &str) -> f64 {
        let (mut r, mut z) = (vec![0.0; self.plant.equations().len()], vec![0.0; self.plant.outputs().len()]);
        let Self { plant, y, yd, u } = self;
        plant.evaluate(At { time: 0.0, y, yd, u }, &mut r, &mut z).unwrap_or_else(|error| panic!("{error:?}"));
        z[self.plant.outputs().iter().position(|o| o.name == name).unwrap_or_else(|| panic!("no output `{name}`"))]
    }

    /// Largest residual in units of its nominal value.
    pub fn residual(&mut self) -> f64 {
        let mut r = vec![0.0; self.plant.equations().len()];
        let Self { plant, y, yd, u } = self;
        plant.residual(At { time: 0.0, y, yd, u }, &mut r).unwrap_or_else(|error| panic!("{error:?}"));
        r.iter().zip(self.plant.equations()).map(|(r, e)| (r / e.nominal).abs()).fold(0.0, f64::max)
    }

    /// Force and moment about its origin, in axes of the world, that a joint exerts on the link it carries.
    ///
    /// # Panics
    /// There is no such joint.
    pub fn reaction(&mut self, joint: &str) -> (Vec3<f64>, Vec3<f64>) {
        let Self { plant, y, yd, u } = self;
        let body = plant.system().model().joint(joint).unwrap_or_else(|| panic!("no joint `{joint}`")).get();
        let tree = &plant.evaluate_at(At { time: 0.0, y, yd, u }).tree;
        let (R, F) = (tree.world.X_WB[body].R, tree.transmitted[body]);
        (R * F.f, R * F.n)
    }

    /// Pose of a link in the world.
    ///
    /// # Panics
    /// There is no such link.
    pub fn pose(&mut self, link: &str) -> Pose<f64> {
        let Self { plant, y, yd, u } = self;
        let frame = plant.system().model().frame(link).unwrap_or_else(|| panic!("no link `{link}`")).clone();
        let tree = &plant.evaluate_at(At { time: 0.0, y, yd, u }).tree;
        tree.world.X_WB[frame.body.get()] * frame.X_BF
    }
}
