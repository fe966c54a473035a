//! One steady state inside the sweep of 400 that the peers were timed on.
//!
//! 20 speeds of the chassis mass center from 10 to 60 m/s, at each 20 lateral accelerations from 0 to 8 m/s²; each trim starts from its
//! neighbor with the lean moved by the change of `atan(a/g)`, each speed from the straight running of the last one.
//! Source: `models/vehicles/moto11/SOURCE.md`, `tests/reference/moto11/moto11_checks.yaml`.

use crate::clock::Clock;
use crate::plants::bundled;
use analyses::trim::{Trim, TrimProblem, Walk};
use mbody::dynamics::TreePlant;
use problem::{AlgebraicMethod, AlgebraicOptions, Plant};
use std::hint::black_box;

const LINE: usize = 20;

/// Roles of the sweep: speed of the mass center and yaw rate are given, in this order.
fn roles(plant: &dyn Plant) -> Trim {
    let mut trim = Trim::steady(plant);
    let told = "a signal of moto11";
    trim.give("mass_center.point_speed", 10.0).expect(told);
    trim.give("chassis.yaw_rate", 0.0).expect(told);
    trim.free("chassis.forward_speed", 10.0).expect(told);
    trim.free("steer.torque", 0.0).expect(told);
    trim.free("drive.torque", 50.0).expect(told);
    // wheels that touch the road: 1 cm of compression carries half the weight
    trim.guess("chassis.heave", -0.01);
    trim.guess("front_wheel.spin_rate", 10.0 / 0.30);
    trim.guess("rear_wheel.spin_rate", 10.0 / 0.32);
    trim
}

/// What the walk over the grid needs to know of x.
struct Places {
    roll: usize,
    forward: usize,
    spins: [usize; 2],
}

/// All 400 trims; returns the iterations. `visit` sees every solution with its grid place.
fn sweep(
    problem: &mut TrimProblem<'_>,
    method: &mut dyn AlgebraicMethod,
    places: &Places,
    work: &mut [Vec<f64>; 2],
    mut visit: impl FnMut(usize, usize, &[f64]),
) -> usize {
    // the peers stop at 1e-9 kN; rows are scaled by the weight of 2.6 kN
    let options = AlgebraicOptions { residual_tolerance: 4e-10, max_iterations: 40, ..Default::default() };
    let walk = Walk { options, ..Default::default() };
    let [straight, x] = work;
    straight.copy_from_slice(problem.guess());
    let mut iterations = 0;
    let mut last_speed = 10.0;
    for i in 0..LINE {
        let speed = 10.0 + 50.0 * i as f64 / (LINE - 1) as f64;
        x.copy_from_slice(straight);
        for place in [places.forward, places.spins[0], places.spins[1]] {
            x[place] *= speed / last_speed;
        }
        last_speed = speed;
        for j in 0..LINE {
            let lateral = |j: usize| 8.0 * j as f64 / (LINE - 1) as f64;
            let lean = |j: usize| (lateral(j) / 9.81).atan();
            x[places.roll] -= lean(j) - lean(j.saturating_sub(1));
            let outcome = walk.solve(problem, method, &[speed, lateral(j) / speed], x);
            assert!(outcome.converged(), "{} m/s, {} m/s²: {outcome:?}", speed, lateral(j));
            iterations += outcome.effort.iterations;
            if j == 0 {
                straight.copy_from_slice(x);
            }
            visit(i, j, x);
        }
    }
    iterations
}

/// Times the sweep with both backends, and says how many iterations it takes.
pub fn run(clock: &mut Clock) {
    let mut plant = TreePlant::new(bundled("moto11"));
    let trim = roles(&plant);
    let mut problem = TrimProblem::new(&mut plant, &trim).expect("a square problem");
    let place = |name: &str| {
        let variable = problem.variables().find(name).expect("a signal of moto11");
        problem.unknowns().iter().position(|&v| v == variable).expect("an unknown of the trim")
    };
    let places = Places {
        roll: place("chassis.roll"),
        forward: place("chassis.forward_speed"),
        spins: [place("front_wheel.spin_rate"), place("rear_wheel.spin_rate")],
    };
    let (steer, drive) = (place("steer.torque"), place("drive.torque"));
    let mut work = [problem.guess().to_vec(), problem.guess().to_vec()];
    let methods: [(&str, Box<dyn AlgebraicMethod>); 2] = [
        ("trim moto11, native Newton", Box::new(native::Newton::new())),
        ("trim moto11, KINSOL", Box::new(sundials::Kinsol::new(sundials::Strategy::LineSearch))),
    ];
    for (name, mut method) in methods {
        let iterations = sweep(&mut problem, method.as_mut(), &places, &mut work, |i, j, x| {
            // the point that the peers publish, to the digits they print
            if (i, j) == (10, 10) {
                assert!((x[places.roll].to_degrees() + 23.694_738).abs() < 1e-6, "roll {}", x[places.roll].to_degrees());
                assert!((x[steer] - 1.156_57).abs() < 1e-5 && (x[drive] - 101.6514).abs() < 1e-4, "torques {} {}", x[steer], x[drive]);
            }
        });
        println!("{name}: {:.2} iterations each", iterations as f64 / (LINE * LINE) as f64);
        clock.case(name, LINE * LINE, |_| {
            black_box(sweep(&mut problem, method.as_mut(), &places, &mut work, |_, _, _| {}));
        });
    }
}
