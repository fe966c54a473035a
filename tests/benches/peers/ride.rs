//! Motions of vehicles: the second of `moto11` with a pulse at the handlebar, and the lane change of the seed paper with the virtual rider.

use crate::clock::Clock;
use analyses::ClosedLoop;
use analyses::transient::{Driven, Method, Start, Step, Transient, evenly};
use fastbike::maneuver;
use mbody::dynamics::{Formulation, TreePlant};
use problem::{Dae, IntegrationOptions};
use std::hint::black_box;
use validation::course::By;
use validation::vehicle::{Vehicle, running};

/// Relative and absolute tolerances of the yardstick: 1e-6 and 1e-8.
const TOLERANCES: (f64, f64) = (1e-6, 1e-2);

fn pulse(clock: &mut Clock, name: &str, by: By) {
    let straight = Vehicle::bundled("moto11").state(&running(&[30.0]));
    let mut plant = TreePlant::in_formulation(straight.system.clone(), Formulation::Ggl);
    let (y, u) = straight.arguments();
    let mut transient = Transient::new(&plant, vec![0.0, 1.0]);
    transient.start = Start { y: y.to_vec(), held: vec![false; y.len()] };
    transient.record.truncate(1);
    let mut inputs = Driven::new(u.to_vec());
    let torque = plant.inputs().iter().position(|i| i.signal.name == "steer.torque").expect("an input");
    for (time, height) in [(0.1, 20.0), (0.2, -20.0)] {
        inputs.add(&plant, torque, Box::new(Step { time, height }));
    }
    let once = by.run(transient.clone(), &mut plant, &inputs);
    println!("{name}: {:?}", once.statistics);
    clock.case(name, 1, |_| {
        black_box(by.run(transient.clone(), &mut plant, &inputs));
    });
}

fn lane_change(clock: &mut Clock, name: &str, implicit: bool) {
    let maneuver = maneuver::read("lane_change", &[]).unwrap_or_else(|_| panic!("a bundled maneuver"));
    let vehicle = Vehicle::bundled("gsxr1000").state(&running(&[maneuver.course.speed.first()]));
    let ride = maneuver::ride("lane_change", maneuver, &vehicle.system).unwrap_or_else(|_| panic!("a rider"));
    let tree = TreePlant::in_formulation(vehicle.system.clone(), Formulation::Ggl);
    let mut plant = ClosedLoop::new(tree, ride.controllers).unwrap_or_else(|e| panic!("{e}"));
    let (y, u) = vehicle.arguments();
    let mut transient = Transient::new(&plant, evenly(6.0, 601));
    transient.start.held.fill(false);
    transient.start.y[..y.len()].copy_from_slice(y);
    transient.record.truncate(1);
    transient.options = IntegrationOptions { relative_tolerance: 1e-6, ..IntegrationOptions::default() };
    let of = |name: &str| vehicle.system.inputs().iter().position(|i| i.signal.name == name).map_or(0.0, |k| u[k]);
    let inputs = Driven::new(plant.inputs().iter().map(|i| of(&i.signal.name)).collect());
    let mut run = || {
        let (mut ida, mut erk) = (sundials::Ida::default(), sundials::RungeKutta::explicit());
        let method = if implicit { Method::Dae(&mut ida) } else { Method::Ode(&mut erk) };
        transient.run(&mut plant, &inputs, method).unwrap_or_else(|e| panic!("{e}"))
    };
    println!("{name}: {:?}", run().statistics);
    clock.case(name, 1, |_| {
        black_box(run());
    });
}

/// Times rides.
pub fn run(clock: &mut Clock) {
    let (relative, absolute) = TOLERANCES;
    pulse(clock, "second of moto11, IDA", By::Ida(relative, absolute));
    pulse(clock, "second of moto11, dopri5", By::Dopri5(relative, absolute));
    pulse(clock, "second of moto11, erk", By::Erk(relative, absolute));
    pulse(clock, "second of moto11, CVODE", By::Bdf(relative, absolute));
    lane_change(clock, "lane change of gsxr1000, IDA", true);
    lane_change(clock, "lane change of gsxr1000, erk", false);
}
