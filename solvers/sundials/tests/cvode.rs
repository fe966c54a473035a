//! Both families of CVODE on problems with published or exact solutions.

mod motion;

use motion::*;
use problem::{EvalError, Flow, IntegrationEnding, IntegrationOptions, OdeMethod, OdeProblem};
use std::f64::consts::PI;
use std::panic::{AssertUnwindSafe, catch_unwind};
use sundials::Cvode;

/// Both families.
const MAKE: [fn() -> Cvode; 2] = [Cvode::adams, Cvode::bdf];

fn run(make: fn() -> Cvode, problem: &mut dyn OdeProblem, times: &[f64], start: &[f64], options: &IntegrationOptions) -> Record {
    record_ode(&mut make(), problem, times, start, options)
}

#[test]
fn errors_follow_the_tolerance() {
    for make in MAKE {
        let times = grid(0.0, 10.0, 17);
        let [coarse, fine] = [1e-5, 1e-10].map(|tolerance_| {
            let record = run(make, &mut Oscillator { watched: false }, &times, &Oscillator::START, &tolerance(tolerance_)).finished(&times);
            for (_, y, yd) in &record.samples {
                assert_eq!(yd, &[y[1], -y[0]], "rates are those of the sample");
            }
            record.deviation(Oscillator::exact) / tolerance_
        });
        // errors of a hundred steps add up
        assert!(coarse < 100.0 && fine < 1000.0, "{} {coarse} {fine}", make().name());
    }
}

#[test]
fn a_stiff_decay_takes_few_steps_by_backward_differentiation() {
    let mut stiff = Scalar::decay();
    stiff.rate = |time, y| Ok(-1e6 * (y - time.cos()));
    stiff.slope = |_, _| Ok(-1e6);
    let steps = MAKE.map(|make| run(make, &mut stiff, &[0.0, 1.0], &[1.0], &tolerance(1e-6)).outcome);
    assert_eq!(steps[1].ending, IntegrationEnding::Finished);
    assert!(steps[1].steps < 200 && steps[1].jacobians > 0, "{:?}", steps[1]);
    assert!(steps[0].steps > 20 * steps[1].steps, "{:?}", steps[0]);
}

#[test]
fn samples_lie_on_the_manifold() {
    let times = Pendulum::times();
    for make in MAKE {
        let off = |record: &Record| record.samples.iter().map(|(_, s, _)| (s[0].hypot(s[1]) - 1.0).abs()).fold(0.0, f64::max);
        let free =
            run(make, &mut Pendulum { projected: false, watched: false }, &times, &Pendulum::START, &tolerance(1e-6)).finished(&times);
        let held =
            run(make, &mut Pendulum { projected: true, watched: false }, &times, &Pendulum::START, &tolerance(1e-6)).finished(&times);
        assert!(off(&held) < 1e-15 && off(&free) > 1e-9, "{} {:e} {:e}", make().name(), off(&held), off(&free));
        // thousands of steps of a method of order 5 at most add up
        let bound = if make().name() == "cvode" { 1e-7 } else { 1e-8 };
        let tight =
            run(make, &mut Pendulum { projected: true, watched: false }, &times, &Pendulum::START, &tolerance(1e-11)).finished(&times);
        assert!(tight.deviation(Pendulum::exact) < bound, "{} {:e}", make().name(), tight.deviation(Pendulum::exact));
    }
}

#[test]
fn an_event_ends_the_integration_at_its_root() {
    for make in MAKE {
        let times = grid(0.0, 10.0, 7);
        let record = run(make, &mut Oscillator { watched: true }, &times, &Oscillator::START, &tolerance(1e-11));
        assert_eq!(record.outcome.ending, IntegrationEnding::Event { event: 1, rising: false });
        assert!((record.outcome.time - 2.0 * PI / 3.0).abs() < 1e-9, "{}", record.outcome.time);
        assert!(largest_difference(&record.y, &[0.75f64.sqrt(), -0.5]) < 1e-9);
        assert_eq!(record.samples.len(), 2, "the event itself is no sample");
    }
}

#[test]
fn the_receiver_of_samples_may_stop() {
    for make in MAKE {
        for at in [0, 1] {
            let mut y = Oscillator::START;
            let mut seen = 0;
            let problem = &mut Oscillator { watched: false };
            let outcome = make().integrate(problem, &[0.0, 1.0, 2.0], &mut y, &tolerance(1e-9), &mut |time, _, _| {
                seen += 1;
                if time == f64::from(at) { Flow::Stop } else { Flow::Continue }
            });
            assert_eq!((outcome.ending, outcome.time, seen), (IntegrationEnding::Stopped, f64::from(at), at + 1));
        }
    }
}

#[test]
fn a_wall_is_reached_and_named() {
    for make in MAKE {
        let mut walled = Scalar::decay();
        walled.rate = |time, y| if time > 0.5 { Err(EvalError::Recoverable { equation: 7 }) } else { Ok(-y) };
        let record = run(make, &mut walled, &[0.0, 0.25, 1.0], &[1.0], &tolerance(1e-9));
        assert_eq!(record.outcome.ending, IntegrationEnding::Evaluation(EvalError::Recoverable { equation: 7 }));
        assert!((0.49..=0.5).contains(&record.outcome.time), "{:?}", record.outcome);
        assert!((record.y[0] - (-record.outcome.time).exp()).abs() < 1e-7 && record.samples.len() == 2);
        walled.rate = |_, _| Ok(f64::NAN);
        let record = run(make, &mut walled, &[0.0, 1.0], &[1.0], &tolerance(1e-9));
        assert_eq!(record.outcome.ending, IntegrationEnding::Evaluation(EvalError::Recoverable { equation: 0 }));
        assert_eq!((record.outcome.time, record.samples.len()), (0.0, 0));
    }
}

#[test]
fn endings_are_told_apart() {
    for make in MAKE {
        let few = IntegrationOptions { max_steps: 3, ..tolerance(1e-9) };
        let record = run(make, &mut Oscillator { watched: false }, &[0.0, 100.0], &Oscillator::START, &few);
        assert_eq!((record.outcome.ending, record.outcome.steps), (IntegrationEnding::TooManySteps, 3));
        for refused in [
            IntegrationOptions { relative_tolerance: -1.0, ..Default::default() },
            IntegrationOptions { max_step: 0.0, ..Default::default() },
            IntegrationOptions { first_step: Some(-1.0), ..Default::default() },
        ] {
            let record = run(make, &mut Oscillator { watched: false }, &[0.0, 1.0], &Oscillator::START, &refused);
            assert_eq!((record.outcome.ending, record.outcome.time), (IntegrationEnding::Refused, 0.0), "{refused:?}");
        }
    }
}

#[test]
fn a_panic_passes_through_and_nothing_is_remembered() {
    for make in MAKE {
        let mut kept = make();
        let mut law = Scalar::decay();
        law.rate = |time, y| if time > 0.5 { panic!("the law has no value here") } else { Ok(-y) };
        let panic = catch_unwind(AssertUnwindSafe(|| record_ode(&mut kept, &mut law, &[0.0, 1.0], &[1.0], &tolerance(1e-9)).outcome));
        assert_eq!(panic.unwrap_err().downcast_ref::<&str>(), Some(&"the law has no value here"));
        let runs = [(); 2].map(|()| {
            let record = record_ode(&mut kept, &mut Scalar::decay(), &[0.0, 1.0], &[1.0], &tolerance(1e-9)).finished(&[0.0, 1.0]);
            assert!(record.deviation(|time| vec![(-time).exp()]) < 1e-7);
            (record.y, record.outcome.steps, record.outcome.residuals)
        });
        assert_eq!(runs[0], runs[1]);
    }
}

#[test]
fn times_that_rounding_separates_have_the_same_state() {
    for make in MAKE {
        let times = [1.0, 1.0 + 2.0 * f64::EPSILON, 2.0, 2.0];
        let start = Oscillator::exact(1.0);
        let record = run(make, &mut Oscillator { watched: false }, &times, &start, &tolerance(1e-11)).finished(&times);
        assert!(record.deviation(Oscillator::exact) < 1e-8);
        run(make, &mut Oscillator { watched: false }, &[1.0], &start, &tolerance(1e-11)).finished(&[1.0]);
    }
}
