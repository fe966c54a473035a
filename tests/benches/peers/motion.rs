//! Motion over time: the benchmark bicycle uncontrolled for 5 s from 4 m/s and 0.05 rad/s roll rate (IFToMM problem, M1).

use crate::clock::Clock;
use crate::plants::bundled;
use analyses::transient::{Constant, Method, Simulation, Start, Transient, everything};
use mbody::dynamics::{Formulation, TreePlant};
use problem::{At, Dae, IntegrationOptions};
use std::hint::black_box;

/// Largest change of energy that counts, as a share: 1e-3 %.
const ALLOWED: f64 = 1e-5;

fn simulate(plant: &mut TreePlant, implicit: bool, relative_tolerance: f64) -> Simulation {
    let options = IntegrationOptions { relative_tolerance, ..Default::default() };
    let mut start = Start::stated(plant);
    let at = |name: &str| plant.unknowns().iter().position(|u| u.signal.name == name).expect("a velocity of the bicycle");
    start.hold(plant, &[(at("chassis.forward_speed"), 4.0), (at("chassis.roll_rate"), 0.05)]);
    let inputs = Constant::defaults(plant);
    let record = everything(plant).into_iter().take(1).collect();
    let transient =
        Transient { start, times: vec![0.0, 5.0], options, algebraic_factor: None, record, ends: Vec::new(), breaks: Vec::new() };
    match implicit {
        true => transient.run(plant, &inputs, Method::Dae(&mut sundials::Ida::default())),
        false => transient.run(plant, &inputs, Method::Ode(&mut sundials::RungeKutta::explicit())),
    }
    .expect("the bicycle rolls")
}

fn energy(plant: &mut TreePlant, y: &[f64], yd: &[f64]) -> f64 {
    let a = plant.account_at(At { time: 0.0, y, yd, u: &[0.0] });
    a.kinetic + a.gravity
}

/// Times the loosest tolerance that keeps the energy.
fn bicycle(clock: &mut Clock, name: &str, implicit: bool) {
    let mut plant = TreePlant::in_formulation(bundled("whipple"), Formulation::Ggl);
    // kinetic and potential energy of the source at t = 0
    let before = 1_575.172_902_477;
    for exponent in 3..12 {
        let tolerance = 10_f64.powi(-exponent);
        let run = simulate(&mut plant, implicit, tolerance);
        let change = (energy(&mut plant, &run.y, &run.yd) - before).abs() / before;
        if change < ALLOWED {
            println!("{name}: energy changes by {change:.1e} at a relative tolerance of {tolerance:e}; {:?}", run.statistics);
            clock.case(name, 1, |_| {
                black_box(simulate(&mut plant, implicit, tolerance));
            });
            return;
        }
    }
    println!("{name}: no tolerance keeps the energy");
}

/// Times motions.
pub fn run(clock: &mut Clock) {
    bicycle(clock, "bicycle 5 s, IDA", true);
    bicycle(clock, "bicycle 5 s, erk", false);
}
