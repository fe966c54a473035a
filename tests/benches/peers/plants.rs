//! Residuals and matrices of assembled motorcycles.

use crate::clock::Clock;
use analyses::{Excitation, FrequencyResponse};
use fastbike::library::Source;
use fastbike::standard_kinds;
use mbody::assembly::assemble;
use mbody::dynamics::{System, TreePlant};
use nalgebra::{Complex, DMatrix, DVector};
use problem::{At, Dae, Differentiable, Matrix, Outputs, Seeds, UnknownKind};
use std::hint::black_box;
use std::sync::Arc;
use validation::vehicle::{Vehicle, running as straight};

/// A bundled model.
pub fn bundled(name: &str) -> Arc<System> {
    let source = Source::find(name).unwrap_or_else(|findings| panic!("{findings:?}"));
    let (assembled, findings) = assemble(&source.file, &source, &standard_kinds(), &[]);
    assembled.unwrap_or_else(|| panic!("{findings:?}")).system
}

/// Values of unknowns in the design pose, running at 30 m/s.
fn running(plant: &TreePlant) -> Vec<f64> {
    let mut y: Vec<f64> = plant.unknowns().iter().map(|u| u.design).collect();
    for (value, unknown) in y.iter_mut().zip(plant.unknowns()) {
        match unknown.signal.name.rsplit('.').next() {
            Some("forward_speed") => *value = 30.0,
            Some("spin_rate") => *value = 95.0,
            _ => {}
        }
    }
    y
}

fn residual(clock: &mut Clock, name: &str) {
    let mut plant = TreePlant::new(bundled(name));
    let y = running(&plant);
    let (yd, u) = (vec![0.0; y.len()], plant.inputs().iter().map(|i| i.default).collect::<Vec<f64>>());
    let mut f = vec![0.0; plant.equations().len()];
    clock.case(&format!("residual {name}"), 1, |_| {
        plant.residual(At { time: 0.0, y: &y, yd: &yd, u: &u }, &mut f).expect("a finite residual");
        black_box(&f);
    });
}

/// Seeds over every unknown that the residual depends on, then over the rates of the velocities.
fn linearization_seeds(plant: &TreePlant) -> (Seeds, usize) {
    let unknowns = plant.unknowns();
    let live = |i: &usize| !(unknowns[*i].cyclic && unknowns[*i].kind == UnknownKind::Position);
    let states: Vec<usize> = (0..unknowns.len()).filter(live).collect();
    let velocities: Vec<usize> = (0..unknowns.len()).filter(|&i| unknowns[i].kind == UnknownKind::Velocity).collect();
    let mut seeds = Seeds::zeros(unknowns.len(), plant.inputs().len(), states.len() + velocities.len());
    for (column, &i) in states.iter().enumerate() {
        seeds.y[(i, column)] = 1.0;
    }
    for (column, &i) in velocities.iter().enumerate() {
        seeds.yd[(i, states.len() + column)] = 1.0;
    }
    (seeds, states.len())
}

fn state_matrix(clock: &mut Clock) {
    let mut plant = TreePlant::new(bundled("moto11"));
    let y = running(&plant);
    let (yd, u) = (vec![0.0; y.len()], plant.inputs().iter().map(|i| i.default).collect::<Vec<f64>>());
    let (seeds, states) = linearization_seeds(&plant);
    let (nf, nz, nv) = (plant.equations().len(), plant.outputs().len(), seeds.columns() - states);
    let mut values = (vec![0.0; nf], vec![0.0; nz]);
    let (mut dF, mut dz) = (Matrix::zeros(nf, seeds.columns()), Matrix::zeros(nz, seeds.columns()));
    clock.case("jacobian moto11", 1, |_| {
        let at = At { time: 0.0, y: &y, yd: &yd, u: &u };
        plant.along(at, &seeds, (&mut values.0, &mut values.1), &mut dF, &mut dz).expect("finite derivatives");
        black_box(&dF);
    });
    // v̇ = −M⁻¹ ∂F/∂y: the dynamic rows follow the kinematic ones
    let nq = nf - nv;
    clock.case("state matrix moto11", 1, |_| {
        let at = At { time: 0.0, y: &y, yd: &yd, u: &u };
        plant.along(at, &seeds, (&mut values.0, &mut values.1), &mut dF, &mut dz).expect("finite derivatives");
        let M = DMatrix::from_fn(nv, nv, |i, j| dF[(nq + i, states + j)]);
        let K = DMatrix::from_fn(nv, states, |i, j| -dF[(nq + i, j)]);
        black_box(M.lu().solve(&K));
    });
    let M = DMatrix::from_fn(nv, nv, |i, j| dF[(nq + i, states + j)]);
    let f = DVector::from_element(nv, 1.0);
    clock.case("lu 11 x 11, one right-hand side", 1, |_| {
        black_box(black_box(&M).clone().lu().solve(&f));
    });
}

/// One frequency of the response of a trimmed vehicle: two inputs (the road with its rate among them), three outputs.
fn frequency_point(clock: &mut Clock, name: &str) {
    let state = Vehicle::bundled(name).state(&straight(&[30.0]));
    let excitations = ["steer.torque", "front_road.height"].map(Excitation::input);
    let outputs = ["chassis.roll", "chassis.heave", "chassis.yaw_rate"].map(str::to_owned);
    let mut response = FrequencyResponse::of(&state.linear(), &excitations, &outputs).expect("responses");
    let mut found = vec![Complex::new(0.0, 0.0); excitations.len() * outputs.len()];
    let mut omega = 1.0;
    clock.case(&format!("frequency point {name}"), 1, |_| {
        omega = if omega > 100.0 { 1.0 } else { omega * 1.01 };
        response.at(omega, &mut found);
        black_box(&found);
    });
}

/// Times residuals and matrices.
pub fn run(clock: &mut Clock) {
    residual(clock, "moto11");
    residual(clock, "gsxr1000");
    residual(clock, "whipple");
    residual(clock, "gsxr1000_linkage");
    state_matrix(clock);
    frequency_point(clock, "moto11");
    frequency_point(clock, "gsxr1000");
}
