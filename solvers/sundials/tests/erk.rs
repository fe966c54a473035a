//! The Runge–Kutta methods of ARKODE on problems with published or exact solutions.

mod motion;

use motion::*;
use problem::{EvalError, Flow, IntegrationEnding, IntegrationOptions, OdeMethod, OdeProblem};
use std::f64::consts::PI;
use std::panic::{AssertUnwindSafe, catch_unwind};
use sundials::RungeKutta;

fn erk(problem: &mut dyn OdeProblem, times: &[f64], start: &[f64], options: &IntegrationOptions) -> Record {
    record_ode(&mut RungeKutta::explicit(), problem, times, start, options)
}

#[test]
fn the_order_is_eight() {
    // with a tolerance that nothing violates, every step has the length allowed
    let error = |step: f64| {
        let options = IntegrationOptions { first_step: Some(step), max_step: step, ..tolerance(1e3) };
        let record = erk(&mut Oscillator { watched: false }, &[0.0, 10.0], &Oscillator::START, &options).finished(&[0.0, 10.0]);
        assert_eq!(record.outcome.steps, (10.0 / step).round() as usize);
        assert_eq!(
            record.outcome.residuals,
            13 * record.outcome.steps + 1,
            "13 stages; the start is evaluated once, every end serves twice"
        );
        record.deviation(Oscillator::exact)
    };
    let order = (error(0.625) / error(0.3125)).log2();
    assert!((7.5..9.0).contains(&order), "{order}");
}

#[test]
fn the_arenstorf_orbit_closes() {
    // errors grow by about 10⁴ along the orbit: it passes the moon at a distance of 0.006
    for (relative, returns) in [(1e-8, 1e-4), (1e-10, 1e-6), (1e-12, 1e-8)] {
        let times = [0.0, Arenstorf::PERIOD];
        let record = erk(&mut Arenstorf, &times, &Arenstorf::START, &tolerance(relative)).finished(&times);
        let gap = largest_difference(&record.y, &Arenstorf::START);
        assert!(gap < returns, "{gap:e} at {relative:e}: {:?}", record.outcome);
    }
}

#[test]
fn samples_are_as_accurate_as_steps() {
    let options = tolerance(1e-12);
    let ends = erk(&mut Oscillator { watched: false }, &[0.0, 10.0], &Oscillator::START, &options).finished(&[0.0, 10.0]);
    // times that fit no step
    let times: Vec<f64> = grid(0.0, 10.0, 173).iter().map(|t| t + 0.02 * (7.0 * t).sin() * (10.0 - t) * t / 25.0).collect();
    let record = erk(&mut Oscillator { watched: false }, &times, &Oscillator::START, &options).finished(&times);
    assert!(ends.deviation(Oscillator::exact) < 1e-12);
    assert!(record.deviation(Oscillator::exact) < 1e-12);
    for (_, y, yd) in &record.samples {
        assert_eq!(yd, &[y[1], -y[0]], "rates are those of the sample");
    }
}

#[test]
fn projection_keeps_the_pendulum_on_its_circle() {
    let off_circle = |record: &Record| record.samples.iter().map(|(_, s, _)| (s[0].hypot(s[1]) - 1.0).abs()).fold(0.0, f64::max);
    let times = Pendulum::times();
    let run = |projected| erk(&mut Pendulum { projected, watched: false }, &times, &Pendulum::START, &tolerance(1e-6)).finished(&times);
    let (projected, free) = (run(true), run(false));
    assert!(off_circle(&projected) < 1e-15, "{:e}", off_circle(&projected));
    assert!(off_circle(&free) > 1e-9, "{:e}", off_circle(&free));
    let tight = erk(&mut Pendulum { projected: true, watched: false }, &times, &Pendulum::START, &tolerance(1e-12)).finished(&times);
    assert!(tight.deviation(Pendulum::exact) < 1e-10);
}

#[test]
fn an_event_ends_the_integration_at_its_root() {
    let times = grid(0.0, 10.0, 7);
    let record = erk(&mut Oscillator { watched: true }, &times, &Oscillator::START, &tolerance(1e-12));
    assert_eq!(record.outcome.ending, IntegrationEnding::Event { event: 1, rising: false });
    assert!((record.outcome.time - 2.0 * PI / 3.0).abs() < 1e-12, "{}", record.outcome.time);
    assert!(largest_difference(&record.y, &[0.75f64.sqrt(), -0.5]) < 1e-12);
    assert_eq!(record.samples.len(), 2, "the event itself is no sample");

    let lowest = erk(&mut Pendulum { projected: true, watched: true }, &[0.0, 10.0], &Pendulum::START, &tolerance(1e-12));
    assert_eq!(lowest.outcome.ending, IntegrationEnding::Event { event: 0, rising: true });
    assert!((lowest.outcome.time - Pendulum::lowest()).abs() < 1e-12, "{}", lowest.outcome.time);
}

#[test]
fn the_integration_goes_on_after_an_event() {
    let mut erk = RungeKutta::explicit();
    let mut pendulum = Pendulum { projected: true, watched: true };
    let (mut y, mut time) = (Pendulum::START.to_vec(), 0.0);
    for passage in 0..4 {
        let record = record_ode(&mut erk, &mut pendulum, &[time, 10.0], &y, &tolerance(1e-12));
        assert_eq!(record.outcome.ending, IntegrationEnding::Event { event: 0, rising: passage % 2 == 0 });
        (y, time) = (record.y, record.outcome.time);
    }
    assert!((time - 7.0 * Pendulum::lowest()).abs() < 1e-11, "{time}");
}

#[test]
fn the_receiver_may_stop() {
    for at in 0..3 {
        let mut y = Oscillator::START;
        let mut seen = 0;
        let outcome = RungeKutta::explicit().integrate(
            &mut Oscillator { watched: false },
            &[0.0, 1.0, 2.0],
            &mut y,
            &tolerance(1e-9),
            &mut |time, _, _| {
                seen += 1;
                if time == f64::from(at) { Flow::Stop } else { Flow::Continue }
            },
        );
        assert_eq!((outcome.ending, outcome.time, seen), (IntegrationEnding::Stopped, f64::from(at), at + 1));
        assert!(largest_difference(&y, &Oscillator::exact(outcome.time)) < 1e-8);
    }
}

#[test]
fn steps_that_cannot_be_evaluated_are_shortened() {
    let mut positive = Scalar::decay();
    positive.rate = |_, y| if y < 0.0 { Err(EvalError::Recoverable { equation: 0 }) } else { Ok(-y) };
    let options = IntegrationOptions { first_step: Some(30.0), ..tolerance(1e-9) };
    let record = erk(&mut positive, &[0.0, 40.0], &[1.0], &options).finished(&[0.0, 40.0]);
    assert!(record.outcome.convergence_failures > 0, "{:?}", record.outcome);
    assert!(record.deviation(|time| vec![(-time).exp()]) < 1e-8);
}

#[test]
fn a_wall_is_reached_and_named() {
    let mut walled = Scalar::decay();
    walled.rate = |time, y| if time > 0.5 { Err(EvalError::Recoverable { equation: 7 }) } else { Ok(-y) };
    let record = erk(&mut walled, &[0.0, 0.25, 1.0], &[1.0], &tolerance(1e-9));
    assert_eq!(record.outcome.ending, IntegrationEnding::Evaluation(EvalError::Recoverable { equation: 7 }));
    assert!((0.49..=0.5).contains(&record.outcome.time), "{:?}", record.outcome);
    assert!((record.y[0] - (-record.outcome.time).exp()).abs() < 1e-8);
    assert_eq!(record.samples.len(), 2);

    walled.rate = |time, y| if time > 0.5 { Err(EvalError::Fatal { equation: 3 }) } else { Ok(-y) };
    let record = erk(&mut walled, &[0.0, 0.25, 1.0], &[1.0], &tolerance(1e-9));
    assert_eq!(record.outcome.ending, IntegrationEnding::Evaluation(EvalError::Fatal { equation: 3 }));

    walled.rate = |_, _| Ok(f64::NAN);
    let record = erk(&mut walled, &[0.0, 1.0], &[1.0], &tolerance(1e-9));
    assert_eq!(record.outcome.ending, IntegrationEnding::Evaluation(EvalError::Recoverable { equation: 0 }));
    assert_eq!((record.outcome.time, record.samples.len()), (0.0, 0));
}

#[test]
fn endings_are_told_apart() {
    let few = IntegrationOptions { max_steps: 3, ..tolerance(1e-9) };
    let record = erk(&mut Oscillator { watched: false }, &[0.0, 100.0], &Oscillator::START, &few);
    assert_eq!((record.outcome.ending, record.outcome.steps), (IntegrationEnding::TooManySteps, 3));
    assert!(record.outcome.time > 0.0 && largest_difference(&record.y, &Oscillator::exact(record.outcome.time)) < 1e-8);

    let mut noise = Scalar::decay();
    noise.rate = |time, _| Ok(1e12 * (1e18 * time).sin());
    let record = erk(&mut noise, &[1.0, 2.0], &[0.0], &tolerance(1e-9));
    assert_eq!(record.outcome.ending, IntegrationEnding::ErrorTest);

    for refused in [
        IntegrationOptions { relative_tolerance: -1.0, ..Default::default() },
        IntegrationOptions { relative_tolerance: 1e-18, absolute_tolerance_factor: 1e-18, ..Default::default() },
        IntegrationOptions { absolute_tolerance_factor: 0.0, ..Default::default() },
        IntegrationOptions { max_step: 0.0, ..Default::default() },
        IntegrationOptions { first_step: Some(-1.0), ..Default::default() },
    ] {
        let record = erk(&mut Oscillator { watched: false }, &[0.0, 1.0], &Oscillator::START, &refused);
        assert_eq!((record.outcome.ending, record.outcome.time), (IntegrationEnding::Refused, 0.0), "{refused:?}");
    }
}

#[test]
fn times_that_rounding_separates_have_the_same_state() {
    let times = [1.0, 1.0 + 2.0 * f64::EPSILON, 2.0, 2.0, 2.0 + 4.0 * f64::EPSILON];
    let start = Oscillator::exact(1.0);
    let record = erk(&mut Oscillator { watched: false }, &times, &start, &tolerance(1e-12)).finished(&times);
    assert!(record.deviation(Oscillator::exact) < 1e-12);
    erk(&mut Oscillator { watched: false }, &[1.0], &start, &tolerance(1e-12)).finished(&[1.0]);
    erk(&mut Oscillator { watched: false }, &times[..2], &start, &tolerance(1e-12)).finished(&times[..2]);
}

#[test]
fn a_panic_passes_through_and_leaves_the_integrator_usable() {
    let mut erk = RungeKutta::explicit();
    let mut law = Scalar::decay();
    law.rate = |time, y| if time > 0.5 { panic!("the law has no value here") } else { Ok(-y) };
    let panic =
        catch_unwind(AssertUnwindSafe(|| record_ode(&mut erk, &mut law, &[0.0, 1.0], &[1.0], &tolerance(1e-9)).outcome)).unwrap_err();
    assert_eq!(panic.downcast_ref::<&str>(), Some(&"the law has no value here"));
    let record = record_ode(&mut erk, &mut Scalar::decay(), &[0.0, 1.0], &[1.0], &tolerance(1e-9)).finished(&[0.0, 1.0]);
    assert!(record.deviation(|time| vec![(-time).exp()]) < 1e-8);
}

#[test]
fn the_start_does_not_remember_the_run_before() {
    let mut kept = RungeKutta::explicit();
    let mut runs = Vec::new();
    for _ in 0..2 {
        let times = Pendulum::times();
        let record = record_ode(&mut kept, &mut Pendulum { projected: true, watched: false }, &times, &Pendulum::START, &tolerance(1e-9));
        runs.push((record.y, record.outcome.steps, record.outcome.residuals));
        // same size, other system
        record_ode(&mut kept, &mut Arenstorf, &[0.0, 1.0], &Arenstorf::START, &tolerance(1e-6));
    }
    assert_eq!(runs[0], runs[1]);
}

fn dirk(problem: &mut dyn OdeProblem, times: &[f64], start: &[f64], options: &IntegrationOptions) -> Record {
    record_ode(&mut RungeKutta::implicit(), problem, times, start, options)
}

#[test]
fn the_implicit_pair_has_order_five() {
    let error = |step: f64| {
        // tight enough for Newton's method, loose enough for the steps
        let options = IntegrationOptions { first_step: Some(step), max_step: step, ..tolerance(1e-4) };
        let record = dirk(&mut Oscillator { watched: false }, &[0.0, 10.0], &Oscillator::START, &options).finished(&[0.0, 10.0]);
        assert_eq!(record.outcome.steps, (10.0 / step).round() as usize);
        record.deviation(Oscillator::exact)
    };
    let order = (error(0.25) / error(0.125)).log2();
    assert!((4.5..6.5).contains(&order), "{order}");
}

#[test]
fn the_implicit_pair_takes_stiff_decay_in_few_steps() {
    let mut stiff = Scalar::decay();
    stiff.rate = |time, y| Ok(-1e6 * (y - time.cos()));
    stiff.slope = |_, _| Ok(-1e6);
    let record = dirk(&mut stiff, &[0.0, 1.0], &[1.0], &tolerance(1e-6)).finished(&[0.0, 1.0]);
    assert!((record.y[0] - 1f64.cos()).abs() < 1e-5, "{:?}", record.y);
    assert!(record.outcome.steps < 200 && record.outcome.jacobians > 0 && record.outcome.iterations > 0, "{:?}", record.outcome);
}

#[test]
fn the_implicit_pair_stays_on_the_manifold_and_finds_events() {
    let times = Pendulum::times();
    let record = dirk(&mut Pendulum { projected: true, watched: false }, &times, &Pendulum::START, &tolerance(1e-9)).finished(&times);
    assert!(record.samples.iter().all(|(_, s, _)| (s[0].hypot(s[1]) - 1.0).abs() < 1e-15));
    assert!(record.deviation(Pendulum::exact) < 1e-6, "{:e}", record.deviation(Pendulum::exact));
    let record = dirk(&mut Oscillator { watched: true }, &[0.0, 10.0], &Oscillator::START, &tolerance(1e-10));
    assert_eq!(record.outcome.ending, IntegrationEnding::Event { event: 1, rising: false });
    assert!((record.outcome.time - 2.0 * PI / 3.0).abs() < 1e-8, "{}", record.outcome.time);
}
