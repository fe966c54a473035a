//! Modes at one more speed of a sweep, and a whole map of steady turns.
//!
//! A sweep of 200 speeds of straight running from 10 to 60 m/s: each trim starts from its neighbor; then the linear model with all its outputs, then
//! all eigenvalues with right and left vectors. A map of 600 turns: 30 speeds from 10 to 45 m/s, at each 20 lateral accelerations from 0 to
//! 8 m/s², walked as the sweep of the peers is. One thread.

use crate::clock::Clock;
use crate::plants::bundled;
use analyses::linearize::Options;
use analyses::trim::{Trim, TrimProblem, Walk};
use analyses::{Variable, eigen, linearize};
use mbody::dynamics::TreePlant;
use problem::{AlgebraicMethod, AlgebraicOptions, At, Plant};
use std::hint::black_box;

/// Speed and yaw rate are given, in this order.
fn roles(plant: &dyn Plant) -> Trim {
    let mut trim = Trim::steady(plant);
    let told = "a signal of every motorcycle";
    trim.give("chassis.forward_speed", 10.0).expect(told);
    trim.give("chassis.yaw_rate", 0.0).expect(told);
    trim.free("steer.torque", 0.0).expect(told);
    trim.free("drive.torque", 50.0).expect(told);
    // wheels that touch the road: 1 cm of compression carries half the weight
    trim.guess("chassis.heave", -0.01);
    trim.guess("front_wheel.spin_rate", 10.0 / 0.30);
    trim.guess("rear_wheel.spin_rate", 10.0 / 0.31);
    trim
}

fn walk() -> Walk {
    let options = AlgebraicOptions { residual_tolerance: 4e-10, max_iterations: 40, ..Default::default() };
    Walk { options, ..Default::default() }
}

/// Place of a signal among the unknowns of a trim.
fn place(problem: &TrimProblem<'_>, name: &str) -> usize {
    let variable: Variable = problem.variables().find(name).expect("a signal");
    problem.unknowns().iter().position(|&v| v == variable).expect("an unknown of the trim")
}

fn speeds(count: usize, last: f64) -> impl Iterator<Item = f64> {
    (0..count).map(move |k| 10.0 + (last - 10.0) * k as f64 / (count - 1) as f64)
}

/// Trim, linear model and eigenvalues at 200 speeds.
fn sweep(clock: &mut Clock, model: &str) {
    const COUNT: usize = 200;
    let system = bundled(model);
    let (mut plant, mut linear) = (TreePlant::new(system.clone()), TreePlant::new(system));
    let trim = roles(&plant);
    let mut problem = TrimProblem::new(&mut plant, &trim).expect("a square problem");
    let spins = ["front_wheel.spin_rate", "rear_wheel.spin_rate"].map(|name| place(&problem, name));
    let (mut method, walk, options) = (native::Newton::new(), walk(), Options::default());
    let mut x = problem.guess().to_vec();
    clock.case(&format!("modes {model}, one of {COUNT} speeds"), COUNT, |_| {
        x.copy_from_slice(problem.guess());
        let mut last = 10.0;
        for speed in speeds(COUNT, 60.0) {
            spins.iter().for_each(|&spin| x[spin] *= speed / last);
            last = speed;
            let outcome = walk.solve(&mut problem, &mut method, &[speed, 0.0], &mut x);
            assert!(outcome.converged(), "{model}, {speed} m/s: {outcome:?}");
            let (y, yd, u, _) = problem.point();
            let linear = linearize(&mut linear, At { time: 0.0, y, yd, u }, &options).expect("a linear model");
            black_box(eigen(&linear).expect("eigenvalues"));
        }
    });
}

/// 600 steady turns.
fn map(clock: &mut Clock, model: &str) {
    let mut plant = TreePlant::new(bundled(model));
    let trim = roles(&plant);
    let mut problem = TrimProblem::new(&mut plant, &trim).expect("a square problem");
    let [roll, front, rear] = ["chassis.roll", "front_wheel.spin_rate", "rear_wheel.spin_rate"].map(|name| place(&problem, name));
    let (mut method, walk) = (native::Newton::new(), walk());
    let method: &mut dyn AlgebraicMethod = &mut method;
    let (mut straight, mut x) = (problem.guess().to_vec(), problem.guess().to_vec());
    clock.case(&format!("map {model}, 600 trims"), 1, |_| {
        straight.copy_from_slice(problem.guess());
        let mut last = 10.0;
        for speed in speeds(30, 45.0) {
            x.copy_from_slice(&straight);
            [front, rear].iter().for_each(|&spin| x[spin] *= speed / last);
            last = speed;
            for k in 0..20_usize {
                let lateral = |k: usize| 8.0 * k as f64 / 19.0;
                let lean = |k: usize| (lateral(k) / 9.81).atan();
                x[roll] -= lean(k) - lean(k.saturating_sub(1));
                let outcome = walk.solve(&mut problem, method, &[speed, lateral(k) / speed], &mut x);
                assert!(outcome.converged(), "{model}, {speed} m/s, {} m/s²: {outcome:?}", lateral(k));
                if k == 0 {
                    straight.copy_from_slice(&x);
                }
            }
        }
        black_box(&x);
    });
}

/// Times both, on the common problem and on the motorcycle with the most elaborate tires.
pub fn run(clock: &mut Clock) {
    for model in ["moto11", "gsxr1000"] {
        sweep(clock, model);
        map(clock, model);
    }
}
