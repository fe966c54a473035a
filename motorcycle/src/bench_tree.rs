//! The example tree, assembled by hand, and what every element is held to: exact derivatives, a closed energy account.

use mbody::dynamics::{System, TreePlant};
use mbody::force::Force;
use mbody::joint::{Joint, Prismatic, Revolute, VehicleBase};
use mbody::model::{BodyIndex, Model, ModelBuilder};
use mbody::spatial::{MassProperties, Pose, Vec3};
use problem::{At, Dae, Differentiable, Matrix, Outputs, Seeds};
use std::sync::Arc;

/// Indices of the bodies, in the order in which [`builder`] adds them.
pub struct Bodies {
    pub chassis: BodyIndex,
    pub front_upper: BodyIndex,
    pub front_lower: BodyIndex,
    pub front_rim: BodyIndex,
    pub arm: BodyIndex,
    pub rear_rim: BodyIndex,
}

fn mass(mass: f64, center: [f64; 3], xx: f64, yy: f64, zz: f64, xz: f64) -> MassProperties {
    MassProperties { mass, center: center.into(), inertia: [xx, yy, zz, 0.0, xz, 0.0] }
}

/// The tree of `example_tree.urdf` on a vehicle base, still open for more bodies.
pub fn builder() -> (ModelBuilder, Bodies) {
    let mut b = ModelBuilder::new();
    let left = || Joint::new(Revolute::new(Vec3::new(0.0, 1.0, 0.0)));
    let at = Pose::from_xyz_rpy;
    let zero = [0.0; 3];
    let mut add = |name: &str, parent, joint: &str, law, X, m| b.body(name, parent, joint, law, X, m).unwrap();
    let chassis = add(
        "chassis",
        BodyIndex::WORLD,
        "chassis",
        Joint::new(VehicleBase),
        Pose::identity(),
        mass(200.0, [0.7, 0.0, 0.6], 20.0, 35.0, 25.0, -2.0),
    );
    let steer = Joint::new(Revolute::new(Vec3::new(0.0, 0.0, 1.0)));
    let upper_mass = mass(12.0, [0.0, 0.0, 0.05], 0.6, 0.5, 0.35, 0.0);
    let front_upper = add("front_upper", chassis, "steer", steer, at([1.2, 0.0, 0.75], [0.0, -0.42, 0.0]), upper_mass);
    let slide = Joint::new(Prismatic::new(Vec3::new(0.0, 0.0, 1.0)));
    let front_lower = add("front_lower", front_upper, "fork", slide, at([0.03, 0.0, -0.3], zero), mass(8.0, zero, 0.25, 0.25, 0.05, 0.0));
    let front_place = at([0.0, 0.0, -0.19], [0.0, 0.42, 0.0]);
    let front_rim = add("front_rim", front_lower, "front_wheel", left(), front_place, mass(11.0, zero, 0.28, 0.5, 0.28, 0.0));
    let arm = add("arm", chassis, "swingarm", left(), at([0.56, 0.0, 0.4], zero), mass(9.0, [-0.3, 0.0, -0.05], 0.1, 0.3, 0.3, 0.0));
    let rear_rim = add("rear_rim", arm, "rear_wheel", left(), at([-0.56, 0.0, -0.08], zero), mass(15.0, zero, 0.4, 0.75, 0.4, 0.0));
    (b, Bodies { chassis, front_upper, front_lower, front_rim, arm, rear_rim })
}

/// The finished example tree.
pub fn tree() -> (Model, Bodies) {
    let (builder, bodies) = builder();
    (builder.finish().unwrap(), bodies)
}

/// A system in some motion, with the same tree without elements beside it.
pub struct Bench {
    plant: TreePlant,
    bare: TreePlant,
    pub y: Vec<f64>,
    pub yd: Vec<f64>,
    pub u: Vec<f64>,
}

impl Bench {
    /// Elements on the example tree, in a lively motion.
    pub fn new(forces: Vec<Force>) -> Self {
        Self::on(tree().0, tree().0, forces)
    }

    /// Elements on a tree that is given twice.
    pub fn on(model: Model, same: Model, forces: Vec<Force>) -> Self {
        let plant = TreePlant::new(Arc::new(System::new(model, forces).unwrap()));
        let bare = TreePlant::new(Arc::new(System::new(same, Vec::new()).unwrap()));
        let n = plant.unknowns().len();
        let inputs = plant.inputs().len();
        // incommensurate numbers: nothing cancels by accident
        let wave = |i: usize, scale: f64| scale * (1.7 * i as f64 + 0.4).sin();
        let y = (0..n).map(|i| wave(i, 0.06)).collect();
        let yd = (0..n).map(|i| wave(i + 50, 3.0)).collect();
        let u = (0..inputs).map(|i| 40.0 + wave(i, 10.0)).collect();
        let mut bench = Self { plant, bare, y, yd, u };
        for (signal, value) in [("chassis.forward_speed", 17.0), ("chassis.lateral_speed", 0.4), ("chassis.yaw_rate", -0.5)] {
            bench.set(signal, value);
        }
        for signal in ["front_wheel.rate", "rear_wheel.rate"] {
            bench.set(signal, 55.0);
        }
        bench
    }

    /// Sets an unknown or an input.
    pub fn set(&mut self, signal: &str, value: f64) {
        if let Some(i) = self.plant.unknowns().iter().position(|u| u.signal.name == signal) {
            self.y[i] = value;
        } else {
            let i = self.plant.inputs().iter().position(|u| u.signal.name == signal).expect(signal);
            self.u[i] = value;
        }
        self.make_consistent();
    }

    /// Sets everything to rest in the design pose, without inputs.
    pub fn rest(&mut self) {
        for x in self.y.iter_mut().chain(&mut self.yd).chain(&mut self.u) {
            *x = 0.0;
        }
        self.make_consistent();
    }

    fn tree_size(&self) -> usize {
        self.bare.unknowns().len()
    }

    /// Makes the coordinate rates those of the velocities and closes the rows of the states.
    fn make_consistent(&mut self) {
        let at = At { time: 0.0, y: &self.y, yd: &self.yd, u: &self.u };
        let mut residual = vec![0.0; self.y.len()];
        self.plant.residual(at, &mut residual).unwrap();
        let positions = self.bare.system().model().layout().nq();
        let (tree, n) = (self.tree_size(), self.y.len());
        for i in 0..positions {
            self.yd[i] -= residual[i];
        }
        // rows of states are linear in the state rates
        let mut seeds = Seeds::zeros(n, self.u.len(), n - tree);
        for k in tree..n {
            seeds.yd.column_mut(k - tree)[k] = 1.0;
        }
        let (mut z, mut dF) = (vec![0.0; self.plant.outputs().len()], Matrix::zeros(n, n - tree));
        let mut dz = Matrix::zeros(z.len(), n - tree);
        let at = At { time: 0.0, y: &self.y, yd: &self.yd, u: &self.u };
        self.plant.along(at, &seeds, (&mut residual, &mut z), &mut dF, &mut dz).unwrap();
        for k in tree..n {
            let slope = dF[(k, k - tree)];
            if slope != 0.0 {
                self.yd[k] -= residual[k] / slope;
            }
        }
    }

    /// Residual and outputs.
    pub fn evaluate(&mut self) -> (Vec<f64>, Vec<f64>) {
        let (mut r, mut z) = (vec![0.0; self.y.len()], vec![0.0; self.plant.outputs().len()]);
        let at = At { time: 0.0, y: &self.y, yd: &self.yd, u: &self.u };
        self.plant.evaluate(at, &mut r, &mut z).unwrap();
        (r, z)
    }

    /// Value of an output.
    pub fn output(&mut self, name: &str) -> f64 {
        let i = self.plant.outputs().iter().position(|s| s.name == name).expect(name);
        self.evaluate().1[i]
    }

    /// Generalized force of the elements along a velocity.
    pub fn effort(&mut self, velocity: &str) -> f64 {
        let i = self.plant.unknowns().iter().position(|u| u.signal.name == velocity).expect(velocity);
        self.efforts()[i]
    }

    /// Generalized forces of the elements, one per row of the tree.
    pub fn efforts(&mut self) -> Vec<f64> {
        let n = self.tree_size();
        let mut bare = vec![0.0; n];
        self.bare.residual(At { time: 0.0, y: &self.y[..n], yd: &self.yd[..n], u: &[] }, &mut bare).unwrap();
        let with = self.evaluate().0;
        bare.iter().zip(with).map(|(without, with)| without - with).collect()
    }

    /// Names and thresholds of the limits.
    pub fn limits(&self) -> Vec<(String, String, f64)> {
        use problem::Limits;
        self.plant.limits().iter().map(|l| (l.name.to_string(), l.signal.clone(), l.threshold)).collect()
    }

    /// Derivatives of residual and outputs along every unknown, rate and input against central differences.
    pub fn assert_derivatives_are_exact(&mut self) {
        let (n, m, nz) = (self.y.len(), self.u.len(), self.plant.outputs().len());
        let columns = 2 * n + m;
        let mut seeds = Seeds::zeros(n, m, columns);
        for i in 0..n {
            seeds.y.column_mut(i)[i] = 1.0;
            seeds.yd.column_mut(n + i)[i] = 1.0;
        }
        for i in 0..m {
            seeds.u.column_mut(2 * n + i)[i] = 1.0;
        }
        let (mut r, mut z) = (vec![0.0; n], vec![0.0; nz]);
        let (mut dF, mut dz) = (Matrix::zeros(n, columns), Matrix::zeros(nz, columns));
        let at = At { time: 0.0, y: &self.y, yd: &self.yd, u: &self.u };
        self.plant.along(at, &seeds, (&mut r, &mut z), &mut dF, &mut dz).unwrap();
        let step = 1e-6;
        for column in 0..columns {
            let mut shifted = |sign: f64| {
                let saved = (self.y.clone(), self.yd.clone(), self.u.clone());
                match column {
                    c if c < n => self.y[c] += sign * step,
                    c if c < 2 * n => self.yd[c - n] += sign * step,
                    c => self.u[c - 2 * n] += sign * step,
                }
                let result = self.evaluate();
                (self.y, self.yd, self.u) = saved;
                result
            };
            let (plus, minus) = (shifted(1.0), shifted(-1.0));
            for (rows, exact, plus, minus, floor) in [(n, &dF, &plus.0, &minus.0, 3e-5), (nz, &dz, &plus.1, &minus.1, 1e-7)] {
                for i in 0..rows {
                    let difference = (plus[i] - minus[i]) / (2.0 * step);
                    // rounding of the values (of sums of about 1e5 N in the rows) over the step, third derivatives over its square
                    let tolerance = 1e-15 * plus[i].abs() / step + 1e-6 * difference.abs() + floor;
                    let error = (exact[(i, column)] - difference).abs();
                    assert!(error < tolerance, "row {i}, column {column}: {} against {difference}", exact[(i, column)]);
                }
            }
        }
    }

    /// `P = −d(stored)/dt + supplied − dissipated`, with the power P that the elements deliver to the tree.
    pub fn assert_energy_balances(&mut self) {
        self.make_consistent();
        let n = self.tree_size();
        let at = At { time: 0.0, y: &self.y, yd: &self.yd, u: &self.u };
        let bare = At { time: 0.0, y: &self.y[..n], yd: &self.yd[..n], u: &[] };
        let system = self.plant.system().clone();
        let power = self.plant.evaluate_at(at).delivered_power(&system);
        let (total, account) = self.plant.energy_rate_at(at);
        let (tree, _) = self.bare.energy_rate_at(bare);
        let stored_rate = total - tree;
        let expected = -stored_rate + account.elements.supplied - account.elements.dissipated;
        let scale = 1.0 + power.abs() + account.elements.supplied.abs() + account.elements.dissipated.abs() + 1e-2 * tree.abs();
        assert!((power - expected).abs() < 1e-10 * scale, "delivered {power} W, accounted {expected} W");
    }
}
