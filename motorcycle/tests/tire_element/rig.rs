//! A plant from a tree and elements, with its arguments by name.

use mbody::description::urdf::{self, JointKind};
use mbody::dynamics::{System, TreePlant};
use mbody::force::Force;
use mbody::joint::{Joint, Prismatic, Revolute, VehicleBase};
use mbody::model::{BodyIndex, Model, ModelBuilder};
use mbody::spatial::{MassProperties, Pose};
use problem::{At, Dae, Differentiable, EquationKind, Matrix, Outputs, Seeds};
use std::sync::Arc;

/// The tree of a vehicle on a vehicle base.
pub fn vehicle(urdf: &str) -> Model {
    let (robot, findings) = urdf::read("test.urdf", urdf);
    let robot = robot.unwrap_or_else(|| panic!("{findings:?}"));
    let mut builder = ModelBuilder::new();
    let mass = |name: &str| robot.link(name).and_then(|l| l.mass).unwrap_or(MassProperties::NONE);
    builder.body(&robot.root, BodyIndex::WORLD, &robot.root, Joint::new(VehicleBase), Pose::identity(), mass(&robot.root)).expect("a base");
    for joint in &robot.joints {
        let (parent, X) = builder.find(&joint.parent).expect("parents first");
        let motion = match joint.kind {
            JointKind::Prismatic => Joint::new(Prismatic::new(joint.axis)),
            _ => Joint::new(Revolute::new(joint.axis)),
        };
        builder.body(&joint.child, parent, &joint.name, motion, X * joint.origin, mass(&joint.child)).expect("a body");
    }
    builder.finish().expect("a tree")
}

/// A place in the arguments of a plant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slot {
    /// An unknown.
    Y(usize),
    /// An input.
    U(usize),
}

/// A plant with its arguments, by name.
pub struct Rig {
    pub plant: TreePlant,
    pub y: Vec<f64>,
    pub yd: Vec<f64>,
    pub u: Vec<f64>,
}

impl Rig {
    pub fn new(model: Model, forces: Vec<Force>) -> Self {
        let plant = TreePlant::new(Arc::new(System::new(model, forces).expect("a system")));
        let y: Vec<f64> = plant.unknowns().iter().map(|u| u.design).collect();
        let (n, u) = (y.len(), plant.inputs().iter().map(|i| i.default).collect());
        Self { plant, y, yd: vec![0.0; n], u }
    }

    pub fn slot(&self, name: &str) -> Slot {
        let y = self.plant.unknowns().iter().position(|u| u.signal.name == name).map(Slot::Y);
        y.or_else(|| self.plant.inputs().iter().position(|u| u.signal.name == name).map(Slot::U))
            .unwrap_or_else(|| panic!("no unknown or input is called {name}"))
    }

    pub fn get(&self, name: &str) -> f64 {
        match self.slot(name) {
            Slot::Y(i) => self.y[i],
            Slot::U(i) => self.u[i],
        }
    }

    pub fn set(&mut self, name: &str, value: f64) {
        let slot = self.slot(name);
        self.set_slot(slot, value);
    }

    fn set_slot(&mut self, slot: Slot, value: f64) {
        match slot {
            Slot::Y(i) => self.y[i] = value,
            Slot::U(i) => self.u[i] = value,
        }
    }

    /// Sets the rate of an unknown.
    pub fn set_rate(&mut self, name: &str, rate: f64) {
        let Slot::Y(i) = self.slot(name) else { panic!("{name} is an input") };
        self.yd[i] = rate;
    }

    pub fn output_index(&self, name: &str) -> usize {
        self.plant.outputs().iter().position(|o| o.name == name).unwrap_or_else(|| panic!("no output is called {name}"))
    }

    /// Residual and outputs.
    pub fn evaluate(&mut self) -> (Vec<f64>, Vec<f64>) {
        let (mut r, mut z) = (vec![0.0; self.plant.equations().len()], vec![0.0; self.plant.outputs().len()]);
        let at = At { time: 0.0, y: &self.y, yd: &self.yd, u: &self.u };
        self.plant.evaluate(at, &mut r, &mut z).expect("finite");
        (r, z)
    }

    pub fn output(&mut self, name: &str) -> f64 {
        let i = self.output_index(name);
        self.evaluate().1[i]
    }

    /// Rows that must vanish in a steady motion: of motion and of elements.
    pub fn steady_rows(&self) -> Vec<usize> {
        let rows = self.plant.equations().iter().enumerate();
        rows.filter(|(_, e)| e.kind != EquationKind::Kinematic).map(|(i, _)| i).collect()
    }

    /// Derivatives of residual and outputs along directions.
    pub fn along(&mut self, seeds: &Seeds) -> (Matrix, Matrix) {
        let (nr, nz) = (self.plant.equations().len(), self.plant.outputs().len());
        let (mut r, mut z) = (vec![0.0; nr], vec![0.0; nz]);
        let (mut dr, mut dz) = (Matrix::zeros(nr, seeds.columns()), Matrix::zeros(nz, seeds.columns()));
        let at = At { time: 0.0, y: &self.y, yd: &self.yd, u: &self.u };
        self.plant.along(at, seeds, (&mut r, &mut z), &mut dr, &mut dz).expect("finite");
        (dr, dz)
    }
}
