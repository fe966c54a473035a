//! The methods of one step on problems with published or exact solutions.

#[path = "../../sundials/tests/motion/mod.rs"]
mod motion;

use motion::*;
use native::{Diffsol, DormandPrince, GeneralizedAlpha, Rosenbrock};
use problem::{EvalError, Flow, IntegrationEnding, IntegrationOptions, OdeMethod};
use std::f64::consts::PI;

/// Explicit-form methods with a step length for those that need one.
fn explicit() -> [(Box<dyn OdeMethod>, f64, f64); 3] {
    // method, step, error allowed over ten units of time of the oscillator at 1e-8
    [
        (Box::<DormandPrince>::default(), 1.0, 1e-6),
        (Box::new(Rosenbrock::second_order()), 1e-3, 1e-5),
        (Box::new(Rosenbrock::euler()), 1e-3, 1e-2),
    ]
}

fn options(relative: f64, fixed_step: f64) -> IntegrationOptions {
    IntegrationOptions { fixed_step, ..tolerance(relative) }
}

/// The methods of `diffsol`, with the error allowed as above.
fn foreign() -> [(Box<dyn OdeMethod>, f64, f64); 3] {
    [(Box::new(Diffsol::bdf()), 1.0, 1e-5), (Box::new(Diffsol::esdirk34()), 1.0, 1e-5), (Box::new(Diffsol::tsit45()), 1.0, 1e-5)]
}

/// Order from errors at two lengths of steps.
fn order(error: impl Fn(f64) -> f64, step: f64) -> f64 {
    (error(step) / error(0.5 * step)).log2()
}

#[test]
fn orders_are_those_of_the_theory() {
    let times = [0.0, 10.0];
    let of = |make: fn() -> Box<dyn OdeMethod>| {
        move |step: f64| {
            // with a tolerance that nothing violates, every step has the length allowed
            let options = IntegrationOptions { first_step: Some(step), max_step: step, ..options(1e3, step) };
            let record =
                record_ode(&mut *make(), &mut Oscillator { watched: false }, &times, &Oscillator::START, &options).finished(&times);
            assert_eq!(record.outcome.steps, (10.0 / step).round() as usize);
            record.deviation(Oscillator::exact)
        }
    };
    let explicit = order(of(|| Box::<DormandPrince>::default()), 0.25);
    assert!((4.7..5.5).contains(&explicit), "{explicit}");
    let second = order(of(|| Box::new(Rosenbrock::second_order())), 0.02);
    assert!((1.9..2.2).contains(&second), "{second}");
    let euler = order(of(|| Box::new(Rosenbrock::euler())), 0.005);
    assert!((0.9..1.1).contains(&euler), "{euler}");
}

/// The pendulum A01 of the IFToMM library in index 2 with stabilization: coordinates against Jacobi's elliptic functions.
#[test]
fn generalized_alpha_converges_with_order_two_on_a_constrained_system() {
    let times = &Pendulum::times()[..5];
    for radius in [0.0, 0.5, 0.8, 1.0] {
        let error = |step: f64| {
            let mut method = GeneralizedAlpha::new(radius).with_fixed_steps();
            let start = (&Pendulum::IMPLICIT_START.0[..], &Pendulum::IMPLICIT_START.1[..]);
            let problem = &mut Pendulum { projected: false, watched: false };
            let record = record_dae(&mut method, problem, times, start, &options(1e-9, step)).finished(times);
            record.deviation(Pendulum::exact)
        };
        let order = order(error, 1.0 / 512.0);
        assert!((1.85..2.2).contains(&order), "order {order} at {radius}");
    }
}

#[test]
fn generalized_alpha_leaves_its_share_of_the_fastest_oscillations() {
    for radius in [0.3, 0.6, 0.9] {
        let step = 1e5;
        let times = grid(0.0, 60.0 * step, 60);
        let mut method = GeneralizedAlpha::new(radius).with_fixed_steps();
        let record = record_dae(&mut method, &mut Oscillator { watched: false }, &times, (&[0.0, 1.0], &[1.0, 0.0]), &options(1e-12, step))
            .finished(&times);
        let size = |k: usize| record.samples[k].1[0].hypot(record.samples[k].1[1]);
        // the eigenvalue is double, so powers of it go with a linear factor
        let share = (size(60) / size(40)).powf(1.0 / 20.0);
        assert!((share / radius - 1.0).abs() < 0.05, "{share} at {radius}");
    }
}

#[test]
fn generalized_alpha_chooses_its_steps() {
    let times = Pendulum::times();
    for (relative, allowed) in [(1e-5, 2e-2), (1e-7, 1e-3)] {
        let start = (&Pendulum::IMPLICIT_START.0[..], &Pendulum::IMPLICIT_START.1[..]);
        let options = IntegrationOptions { first_step: Some(1e-6), ..tolerance(relative) };
        let problem = &mut Pendulum { projected: false, watched: false };
        let record = record_dae(&mut GeneralizedAlpha::new(0.8), problem, &times, start, &options).finished(&times);
        assert!(3 * record.outcome.jacobians < record.outcome.steps, "matrices serve many steps: {:?}", record.outcome);
        assert!(record.deviation(Pendulum::exact) < allowed, "{:e} {:?}", record.deviation(Pendulum::exact), record.outcome);
    }
    let start = (&Robertson::START.0[..], &Robertson::START.1[..]);
    let options = IntegrationOptions { algebraic: problem::AlgebraicErrors::Tested, first_step: Some(1e-8), ..tolerance(1e-5) };
    let options = IntegrationOptions { absolute_tolerance_factor: 1.0, ..options };
    let record = record_dae(&mut GeneralizedAlpha::new(0.0), &mut Robertson { events: false }, &[0.0, 40.0], start, &options);
    let record = record.finished(&[0.0, 40.0]);
    // the table of Robertson's problem at t = 40
    assert!(largest_difference(&record.y, &[0.7158, 9.185e-6, 0.2842]) < 1e-4, "{:?} {:?}", record.y, record.outcome);
}

#[test]
fn errors_follow_tolerances_and_samples_lie_on_steps_as_well_as_between() {
    let times: Vec<f64> = grid(0.0, 10.0, 173);
    for (mut method, step, allowed) in explicit().into_iter().chain(foreign()) {
        let record = record_ode(&mut *method, &mut Oscillator { watched: false }, &times, &Oscillator::START, &options(1e-8, step));
        let record = record.finished(&times);
        assert!(record.deviation(Oscillator::exact) < allowed, "{} {:e}", method.name(), record.deviation(Oscillator::exact));
        for (_, y, yd) in &record.samples {
            assert!(largest_difference(yd, &[y[1], -y[0]]) < 1e-15, "rates are those of the sample");
        }
    }
}

#[test]
fn the_arenstorf_orbit_closes() {
    let times = [0.0, Arenstorf::PERIOD];
    let record = record_ode(&mut DormandPrince::default(), &mut Arenstorf, &times, &Arenstorf::START, &tolerance(1e-10)).finished(&times);
    assert!(largest_difference(&record.y, &Arenstorf::START) < 1e-4, "{:?}", record.outcome);
}

#[test]
fn stiff_decay_is_no_matter_for_linearly_implicit_methods() {
    let mut stiff = Scalar::decay();
    stiff.rate = |time, y| Ok(-1e6 * (y - time.cos()));
    stiff.slope = |_, _| Ok(-1e6);
    for make in [Rosenbrock::second_order, Rosenbrock::euler] {
        let record = record_ode(&mut make(), &mut stiff, &[0.0, 1.0], &[1.0], &options(1e-6, 0.01)).finished(&[0.0, 1.0]);
        assert!((record.y[0] - 1f64.cos()).abs() < 1e-2, "{:?}", record.y);
        assert_eq!((record.outcome.steps, record.outcome.jacobians), (100, 100));
    }
}

#[test]
fn samples_lie_on_the_manifold() {
    let times = Pendulum::times();
    for (mut method, step, _) in explicit().into_iter().chain(foreign()) {
        let record =
            record_ode(&mut *method, &mut Pendulum { projected: true, watched: false }, &times, &Pendulum::START, &options(1e-9, step));
        let off = record.finished(&times).samples.iter().map(|(_, s, _)| (s[0].hypot(s[1]) - 1.0).abs()).fold(0.0, f64::max);
        assert!(off < 1e-15, "{} {off:e}", method.name());
    }
}

#[test]
fn an_event_ends_the_integration_at_its_root() {
    let times = grid(0.0, 10.0, 7);
    let root = 2.0 * PI / 3.0;
    for (mut method, step, allowed) in explicit().into_iter().chain(foreign()) {
        let record = record_ode(&mut *method, &mut Oscillator { watched: true }, &times, &Oscillator::START, &options(1e-10, step));
        assert_eq!(record.outcome.ending, IntegrationEnding::Event { event: 1, rising: false }, "{}", method.name());
        assert!((record.outcome.time - root).abs() < allowed, "{} {}", method.name(), record.outcome.time - root);
        assert!((record.y[1] + 0.5).abs() < 1e-12, "{}", record.y[1]);
        assert_eq!(record.samples.len(), 2, "the event itself is no sample");
    }
    let start = (&[0.0, 1.0][..], &[1.0, 0.0][..]);
    let record = record_dae(&mut GeneralizedAlpha::new(0.8), &mut Oscillator { watched: true }, &times, start, &tolerance(1e-8));
    assert_eq!(record.outcome.ending, IntegrationEnding::Event { event: 1, rising: false });
    assert!((record.outcome.time - root).abs() < 1e-3 && record.samples.len() == 2, "{:?}", record.outcome);
}

#[test]
fn the_receiver_of_samples_may_stop() {
    for (mut method, step, _) in explicit().into_iter().chain(foreign()) {
        for at in [0, 1] {
            let (mut y, mut seen) = (Oscillator::START, 0);
            let outcome =
                method.integrate(&mut Oscillator { watched: false }, &[0.0, 1.0, 2.0], &mut y, &options(1e-9, step), &mut |time, _, _| {
                    seen += 1;
                    if time == f64::from(at) { Flow::Stop } else { Flow::Continue }
                });
            assert_eq!((outcome.ending, outcome.time, seen), (IntegrationEnding::Stopped, f64::from(at), at + 1));
        }
    }
}

#[test]
fn a_wall_is_reached_and_named() {
    let mut walled = Scalar::decay();
    walled.rate = |time, y| if time > 0.5 { Err(EvalError::Recoverable { equation: 7 }) } else { Ok(-y) };
    let record = record_ode(&mut DormandPrince::default(), &mut walled, &[0.0, 0.25, 1.0], &[1.0], &tolerance(1e-9));
    assert_eq!(record.outcome.ending, IntegrationEnding::Evaluation(EvalError::Recoverable { equation: 7 }));
    assert!((0.49..=0.5).contains(&record.outcome.time), "{:?}", record.outcome);
    assert!((record.y[0] - (-record.outcome.time).exp()).abs() < 1e-7 && record.samples.len() == 2);
    for (mut method, _, _) in foreign() {
        let record = record_ode(&mut *method, &mut walled, &[0.0, 0.25, 1.0], &[1.0], &tolerance(1e-9));
        assert_eq!(record.outcome.ending, IntegrationEnding::Evaluation(EvalError::Recoverable { equation: 7 }), "{}", method.name());
        assert!((0.4..=0.5).contains(&record.outcome.time) && record.samples.len() == 2, "{} {:?}", method.name(), record.outcome);
    }
    // a step that cannot be shortened ends there
    let record = record_ode(&mut Rosenbrock::second_order(), &mut walled, &[0.0, 0.25, 1.0], &[1.0], &options(1e-9, 0.01));
    assert_eq!(record.outcome.ending, IntegrationEnding::Evaluation(EvalError::Recoverable { equation: 7 }));
    assert!((record.outcome.time - 0.5).abs() < 0.011, "{:?}", record.outcome);
    walled.rate = |_, _| Ok(f64::NAN);
    for (mut method, step, _) in explicit() {
        let record = record_ode(&mut *method, &mut walled, &[0.0, 1.0], &[1.0], &options(1e-9, step));
        assert_eq!(record.outcome.ending, IntegrationEnding::Evaluation(EvalError::Recoverable { equation: 0 }));
        assert_eq!((record.outcome.time, record.samples.len()), (0.0, 0));
    }
}

#[test]
fn endings_are_told_apart() {
    for (mut method, step, _) in explicit().into_iter().chain(foreign()) {
        let few = IntegrationOptions { max_steps: 3, ..options(1e-9, step) };
        let record = record_ode(&mut *method, &mut Oscillator { watched: false }, &[0.0, 100.0], &Oscillator::START, &few);
        assert_eq!((record.outcome.ending, record.outcome.steps), (IntegrationEnding::TooManySteps, 3));
        for refused in
            [IntegrationOptions { max_step: 0.0, ..Default::default() }, IntegrationOptions { fixed_step: 0.0, ..Default::default() }]
        {
            let record = record_ode(&mut *method, &mut Oscillator { watched: false }, &[0.0, 1.0], &Oscillator::START, &refused);
            assert_eq!((record.outcome.ending, record.outcome.time), (IntegrationEnding::Refused, 0.0), "{refused:?}");
        }
    }
    let none = IntegrationOptions { absolute_tolerance_factor: 0.0, ..Default::default() };
    let record = record_ode(&mut DormandPrince::default(), &mut Oscillator { watched: false }, &[0.0, 1.0], &Oscillator::START, &none);
    assert_eq!(record.outcome.ending, IntegrationEnding::Refused);
}

#[test]
fn the_second_integration_of_a_size_allocates_nothing() {
    for (mut method, step, _) in explicit() {
        let mut run = || {
            let mut y = Oscillator::START;
            method.integrate(&mut Oscillator { watched: true }, &[0.0, 1.0, 3.0], &mut y, &options(1e-9, step), &mut |_, _, _| {
                Flow::Continue
            });
        };
        run();
        assert_eq!(allocation_counter::measure(run).count_total, 0);
    }
}
