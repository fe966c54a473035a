//! An element on its example tree, in motion: states in general position, at rest rates of element states, moved bases.

use crate::numbers::Numbers;
use crate::reference::repository_text;
use mbody::assembly::{Assembled, ElementKind, Kinds, assemble};
use mbody::description::Library;
use mbody::description::finding::Findings;
use mbody::dynamics::{System, TreePlant};
use nalgebra::{DMatrix, DVector};
use problem::{At, Dae, Differentiable, EquationKind, Matrix, Outputs, Seeds, UnknownKind};
use std::borrow::Cow;
use std::sync::Arc;

/// The tree of an example and a description of one element; files of tires come from the bundled models.
struct Texts {
    tree: &'static str,
    description: String,
}

impl Library for Texts {
    fn text(&self, name: &str) -> Option<Cow<'_, str>> {
        Some(match name {
            "tree.urdf" => Cow::Borrowed(self.tree),
            "example.yaml" => Cow::Borrowed(&self.description),
            file if file.ends_with(".tir") => Cow::Owned(repository_text(&format!("tests/reference/tire/{file}"))),
            tire => Cow::Owned(repository_text(&format!("models/tires/{tire}"))),
        })
    }
}

/// Assembles the tree of a kind with elements given as YAML.
pub fn on_tree(kinds: &Kinds, kind: &ElementKind, elements: &str) -> (Option<Assembled>, Findings) {
    let description = format!("fastbike: 1\nname: example\nurdf: tree.urdf\nbase: vehicle_base\nelements: {elements}\n");
    assemble("example.yaml", &Texts { tree: kind.tree, description }, kinds, &[])
}

/// What the vehicle does.
#[derive(Clone, Copy, Debug)]
pub enum Regime {
    /// Rolling, slightly leaning.
    Straight,
    /// Leaning far.
    Leaning,
    /// Leaning, the wheels much slower than the road.
    Braking,
    /// Wheels off the road.
    Flying,
}

/// All of them.
pub const REGIMES: [Regime; 4] = [Regime::Straight, Regime::Leaning, Regime::Braking, Regime::Flying];

/// The example of a kind, assembled, and its tree without elements.
#[derive(Debug)]
pub struct Example {
    /// The kind.
    pub kind: ElementKind,
    system: Arc<System>,
    bare: Arc<System>,
}

impl Example {
    /// An element of the kind as `written`.
    ///
    /// # Panics
    /// Where it is refused.
    pub fn of(kinds: &Kinds, kind: &ElementKind, written: &str) -> Self {
        let assembled = |elements: &str| {
            let (assembled, findings) = on_tree(kinds, kind, elements);
            assembled.unwrap_or_else(|| panic!("{}: {findings}", kind.name)).system
        };
        Self { system: assembled(&format!("{{ example: {{ {}: {written} }} }}", kind.name)), bare: assembled("{}"), kind: *kind }
    }
}

/// A plant with its arguments, and the same tree without elements.
pub struct Motion {
    /// With the element.
    pub plant: TreePlant,
    /// Without it.
    pub bare: TreePlant,
    /// Unknowns.
    pub y: Vec<f64>,
    /// Their rates.
    pub yd: Vec<f64>,
    /// Inputs.
    pub u: Vec<f64>,
}

impl Motion {
    /// An example at rest in the design pose.
    pub fn of(example: &Example) -> Self {
        let plant = TreePlant::new(example.system.clone());
        let y: Vec<f64> = plant.unknowns().iter().map(|u| u.design).collect();
        let (yd, u) = (vec![0.0; y.len()], plant.inputs().iter().map(|i| i.default).collect());
        Self { plant, bare: TreePlant::new(example.bare.clone()), y, yd, u }
    }

    /// Residual and outputs.
    pub fn evaluate(&mut self) -> (Vec<f64>, Vec<f64>) {
        let (mut r, mut z) = (vec![0.0; self.plant.equations().len()], vec![0.0; self.plant.outputs().len()]);
        let at = At { time: 0.0, y: &self.y, yd: &self.yd, u: &self.u };
        self.plant.evaluate(at, &mut r, &mut z).expect("finite");
        (r, z)
    }

    /// Derivatives of residual and outputs along directions, and the values computed on the way.
    pub fn along(&mut self, seeds: &Seeds) -> ([Vec<f64>; 2], [Matrix; 2]) {
        let (nr, nz) = (self.plant.equations().len(), self.plant.outputs().len());
        let (mut r, mut z) = (vec![0.0; nr], vec![0.0; nz]);
        let (mut dr, mut dz) = (Matrix::zeros(nr, seeds.columns()), Matrix::zeros(nz, seeds.columns()));
        let at = At { time: 0.0, y: &self.y, yd: &self.yd, u: &self.u };
        self.plant.along(at, seeds, (&mut r, &mut z), &mut dr, &mut dz).expect("finite");
        ([r, z], [dr, dz])
    }

    /// Goes to a state in general position.
    pub fn go(&mut self, regime: Regime, numbers: &mut Numbers) {
        let (lean, slip) = match regime {
            Regime::Straight => (0.05, 0.01),
            Regime::Leaning => (0.6, -0.01),
            Regime::Braking => (-0.4, -0.07),
            Regime::Flying => (0.2, 0.0),
        };
        let speed = 22.0 + 8.0 * numbers.signed();
        let spread = |nominal: f64, numbers: &mut Numbers| nominal * numbers.signed();
        for (i, unknown) in self.plant.unknowns().iter().enumerate() {
            let (owner, quantity) = unknown.signal.name.split_once('.').expect("owner and quantity");
            let wheel = owner.ends_with("wheel") || owner.ends_with("axle");
            self.y[i] = match quantity {
                "forward_speed" => speed,
                "lateral_speed" => spread(0.4, numbers),
                "yaw_rate" => spread(0.6, numbers),
                "roll" => lean + spread(0.03, numbers),
                "rate" | "spin_rate" if wheel => speed / 0.31 * (1.0 + slip + spread(0.005, numbers)),
                "angle" if wheel => spread(3.0, numbers),
                "rate" | "speed" => 0.3 + spread(0.1, numbers),
                _ => match unknown.kind {
                    UnknownKind::Position => spread(unknown.nominal.min(0.01), numbers),
                    UnknownKind::Velocity => spread(unknown.nominal.min(0.3), numbers),
                    UnknownKind::State | UnknownKind::Algebraic => spread(0.3 * unknown.nominal, numbers),
                },
            };
            self.yd[i] = spread(3.0 * unknown.nominal, numbers);
        }
        for (i, input) in self.plant.inputs().iter().enumerate() {
            // torques of brakes are not negative
            self.u[i] = input.nominal * (0.5 + 0.3 * numbers.signed());
        }
        self.settle(regime, numbers);
        self.make_consistent();
    }

    /// Lifts or lowers the base until a tire, where there is one, is pressed onto the road, or in the air.
    fn settle(&mut self, regime: Regime, numbers: &mut Numbers) {
        let Some(deflection) = self.plant.outputs().iter().position(|o| o.name == "example.deflection") else { return };
        let heave = self.unknown("heave");
        let target = if matches!(regime, Regime::Flying) { -0.02 } else { 0.009 + 0.003 * numbers.signed() };
        for _ in 0..40 {
            let (_, z) = self.evaluate();
            self.y[heave] -= 0.7 * (target - z[deflection]);
        }
    }

    /// Index of a quantity of the base.
    pub fn unknown(&self, quantity: &str) -> usize {
        let base = self.plant.unknowns()[0].signal.name.split('.').next().unwrap_or_default();
        let name = format!("{base}.{quantity}");
        self.plant.unknowns().iter().position(|u| u.signal.name == name).unwrap_or_else(|| panic!("no unknown `{name}`"))
    }

    /// Makes coordinate rates those of the velocities, and element rows vanish by the rates of their states.
    pub fn make_consistent(&mut self) {
        let of_kind = |kind: EquationKind, plant: &TreePlant| -> Vec<usize> {
            (0..plant.equations().len()).filter(|&i| plant.equations()[i].kind == kind).collect()
        };
        let kinematic = of_kind(EquationKind::Kinematic, &self.plant);
        let rows = of_kind(EquationKind::Element, &self.plant);
        kinematic.iter().for_each(|&i| self.yd[i] = 0.0);
        let (r, _) = self.evaluate();
        kinematic.iter().for_each(|&i| self.yd[i] = -r[i]);
        let mut seeds = Seeds::zeros(self.y.len(), self.u.len(), rows.len());
        // rows and states stand in the same order, at the end
        rows.iter().enumerate().for_each(|(k, &i)| seeds.yd[(i, k)] = 1.0);
        for _ in 0..if rows.is_empty() { 0 } else { 40 } {
            let ([r, _], [dr, _]) = self.along(&seeds);
            let J = DMatrix::from_fn(rows.len(), rows.len(), |i, k| dr[(rows[i], k)]);
            let step = J.lu().solve(&DVector::from_fn(rows.len(), |i, _| r[rows[i]])).expect("rows determine the rates of their states");
            rows.iter().zip(step.iter()).for_each(|(&i, dx)| self.yd[i] -= dx);
            if step.iter().zip(&rows).all(|(dx, &i)| dx.abs() <= 1e-14 * (1.0 + self.yd[i].abs())) {
                break;
            }
        }
    }
}
