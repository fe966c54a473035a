//! IDA on problems with published or exact solutions.

mod motion;

use motion::*;
use problem::{AlgebraicErrors, DaeMethod, DaeProblem, EvalError, Flow, IntegrationEnding, IntegrationOptions, LinearSolver, Matrix};
use std::f64::consts::PI;
use std::panic::{AssertUnwindSafe, catch_unwind};
use sundials::{Ida, RungeKutta};

const OSCILLATOR: (&[f64], &[f64]) = (&[0.0, 1.0], &[1.0, 0.0]);

fn ida(problem: &mut dyn DaeProblem, times: &[f64], start: (&[f64], &[f64]), options: &IntegrationOptions) -> Record {
    record_dae(&mut Ida::default(), problem, times, start, options)
}

/// Options for index 1.
fn tested(relative: f64) -> IntegrationOptions {
    IntegrationOptions { algebraic: AlgebraicErrors::Tested, ..tolerance(relative) }
}

/// E. Hairer, G. Wanner, *Solving Ordinary Differential Equations II*, Springer 1996, section IV.10, problem ROBER: the reference
/// values at t = 1, 10, …, 10¹¹ that accompany the book (y₁ and y₂).
#[allow(clippy::excessive_precision, reason = "as printed")]
const ROBERTSON: [(f64, [f64; 2]); 12] = [
    (1e0, [0.9664597373330035, 0.3074626578578675e-4]),
    (1e1, [0.8413699238414729, 0.1623390937990473e-4]),
    (1e2, [0.6172348823960878, 0.6153591274639123e-5]),
    (1e3, [0.3368745306607069, 0.2013702318261393e-5]),
    (1e4, [0.1073004285378040, 0.4800166972571660e-6]),
    (1e5, [0.1786592114209946e-1, 0.7274751468436319e-7]),
    (1e6, [0.2031483924973415e-2, 0.8142277783356159e-8]),
    (1e7, [0.2076093439016395e-3, 0.8306077485067610e-9]),
    (1e8, [0.2082417512179460e-4, 0.8329841429908955e-10]),
    (1e9, [0.2083229471647004e-5, 0.8332935037760723e-11]),
    (1e10, [0.2083328471883087e-6, 0.8333315602809495e-12]),
    (1e11, [0.2083340149701284e-7, 0.8333360770334744e-13]),
];

#[test]
fn robertson_over_eleven_decades() {
    let times: Vec<f64> = std::iter::once(0.0).chain(ROBERTSON.map(|row| row.0)).collect();
    let (y, yd) = Robertson::START;
    // absolute tolerances far below the values, so that the relative one counts
    for linear_solver in LINEAR_SOLVERS {
        let options = IntegrationOptions { absolute_tolerance_factor: 1e-8, linear_solver, ..tested(1e-8) };
        let record = ida(&mut Robertson { events: false }, &times, (&y, &yd), &options).finished(&times);
        for ((time, y, _), (_, published)) in record.samples[1..].iter().zip(ROBERTSON) {
            for (y, published) in y.iter().zip(published) {
                assert!((y / published - 1.0).abs() < 1e-5, "{y:e} for {published:e} at {time:e}");
            }
            assert!((y.iter().sum::<f64>() - 1.0).abs() < 1e-8);
        }
        assert_eq!(record.outcome.products > 0, linear_solver == LinearSolver::Gmres);
    }
}

#[test]
fn robertson_with_the_roots_of_the_guide() {
    // printed by the example idaRoberts_dns of SUNDIALS at a relative tolerance of 10⁻⁴: therefore three digits
    let printed = [(2.6402e-1, 1, true, [9.8997e-1, 3.4706e-5, 1.0e-2]), (2.0788e7, 0, false, [1.0e-4, 4.0004e-10, 9.999e-1])];
    let mut ida = Ida::default();
    let (mut y, mut yd, mut time) = (Robertson::START.0.to_vec(), Robertson::START.1.to_vec(), 0.0);
    for (at, event, rising, values) in printed {
        let options = IntegrationOptions { absolute_tolerance_factor: 1e-2, ..tested(1e-7) };
        let record = record_dae(&mut ida, &mut Robertson { events: true }, &[time, 4e10], (&y, &yd), &options);
        assert_eq!(record.outcome.ending, IntegrationEnding::Event { event, rising });
        assert!((record.outcome.time / at - 1.0).abs() < 1e-3, "{}", record.outcome.time);
        for (y, printed) in record.y.iter().zip(values) {
            assert!((y / printed - 1.0).abs() < 1e-3, "{:?}", record.y);
        }
        (y, yd, time) = (record.y, record.yd, record.outcome.time);
    }
}

#[test]
fn the_pendulum_of_index_two() {
    let times = Pendulum::times();
    let (y, yd) = Pendulum::IMPLICIT_START;
    let cases = [(1e-6, 1e-3), (1e-8, 1e-5), (1e-10, 1e-7)].into_iter().flat_map(|case| LINEAR_SOLVERS.map(|linear| (case, linear)));
    for ((relative, close), linear_solver) in cases {
        let options = IntegrationOptions { linear_solver, ..tolerance(relative) };
        let record = ida(&mut Pendulum { projected: false, watched: false }, &times, (&y, &yd), &options).finished(&times);
        let error = record.deviation(Pendulum::exact);
        // with fresh products the iteration ends sooner and leaves more: 1.03e-7 at 1e-10, and no less with tighter linear solves
        let close = if linear_solver == LinearSolver::Gmres { 2.0 * close } else { close };
        assert!(error < close, "{error:e} at {relative:e}");
        // λ = v² − g y, and the second multiplier vanishes
        for (time, s, _) in &record.samples[1..] {
            let lambda = s[2] * s[2] + s[3] * s[3] - 9.81 * s[1];
            // a multiplier is a quotient of errors and steps, and the steps are about 10⁻²
            assert!((s[4] - lambda).abs() < 1e4 * relative, "{} for {lambda} at {time}", s[4]);
            assert!(s[5].abs() < 1e3 * relative, "{} at {time}", s[5]);
            assert!((s[0].hypot(s[1]) - 1.0).abs() < 10.0 * relative);
        }
    }
}

#[test]
fn both_integrators_agree() {
    let times = grid(0.0, 10.0, 40);
    let (y, yd) = Pendulum::IMPLICIT_START;
    let implicit = ida(&mut Pendulum { projected: false, watched: false }, &times, (&y, &yd), &tolerance(1e-10)).finished(&times);
    let explicit = record_ode(
        &mut RungeKutta::explicit(),
        &mut Pendulum { projected: true, watched: false },
        &times,
        &Pendulum::START,
        &tolerance(1e-12),
    )
    .finished(&times);
    for ((_, implicit, _), (_, explicit, _)) in implicit.samples.iter().zip(&explicit.samples) {
        assert!(largest_difference(implicit, explicit) < 2e-6);
    }
}

#[test]
fn errors_follow_the_tolerance() {
    let times = grid(0.0, 10.0, 137);
    for relative in [1e-4, 1e-6, 1e-8, 1e-10] {
        let record = ida(&mut Oscillator { watched: false }, &times, OSCILLATOR, &tested(relative)).finished(&times);
        let error = record.deviation(Oscillator::exact);
        let rates = record.samples.iter().map(|(time, _, yd)| largest_difference(yd, &[time.cos(), -time.sin()])).fold(0.0, f64::max);
        // local errors of one tolerance add up over some hundred steps
        assert!(error < 500.0 * relative && rates < 500.0 * relative, "{error:e} {rates:e} at {relative:e}");
    }
}

#[test]
fn no_step_passes_the_last_time() {
    let mut walled = Scalar::decay();
    walled.rate = |time, y| if time > 1.0 { Err(EvalError::Fatal { equation: 0 }) } else { Ok(-y) };
    ida(&mut walled, &[0.0, 0.3, 1.0], (&[1.0], &[-1.0]), &tolerance(1e-8)).finished(&[0.0, 0.3, 1.0]);
}

#[test]
fn a_first_step_below_rounding_is_no_failure() {
    // IDA begins with a step of 0.5/‖ẏ‖, here 10⁻¹⁷ s
    let mut ramp = Scalar::decay();
    ramp.rate = |_, _| Ok(5e4);
    ramp.slope = |_, _| Ok(0.0);
    let record = ida(&mut ramp, &[10.0, 11.0], (&[0.0], &[5e4]), &tolerance(1e-12)).finished(&[10.0, 11.0]);
    assert!((record.y[0] - 5e4).abs() < 1e-6, "{:?} {:?}", record.y, record.outcome);
}

#[test]
fn an_event_ends_the_integration_at_its_root() {
    let times = grid(0.0, 10.0, 7);
    let record = ida(&mut Oscillator { watched: true }, &times, OSCILLATOR, &tested(1e-10));
    assert_eq!(record.outcome.ending, IntegrationEnding::Event { event: 1, rising: false });
    assert!((record.outcome.time - 2.0 * PI / 3.0).abs() < 1e-8, "{}", record.outcome.time);
    assert!((record.y[1] + 0.5).abs() < 1e-12, "the root of the polynomial that samples are taken from");
    assert!(largest_difference(&record.yd, &[-0.5, -0.75f64.sqrt()]) < 1e-7);
    assert_eq!(record.samples.len(), 2, "the event itself is no sample");

    let (y, yd) = Pendulum::IMPLICIT_START;
    let lowest = ida(&mut Pendulum { projected: false, watched: true }, &[0.0, 10.0], (&y, &yd), &tolerance(1e-10));
    assert_eq!(lowest.outcome.ending, IntegrationEnding::Event { event: 0, rising: true });
    assert!((lowest.outcome.time - Pendulum::lowest()).abs() < 1e-7, "{}", lowest.outcome.time);
}

#[test]
fn the_receiver_may_stop() {
    for at in 0..3 {
        let (mut y, mut yd) = ([0.0, 1.0], [1.0, 0.0]);
        let mut seen = 0;
        let state = (&mut y[..], &mut yd[..]);
        let outcome =
            Ida::default().integrate(&mut Oscillator { watched: false }, &[0.0, 1.0, 2.0], state, &tested(1e-9), &mut |time, _, _| {
                seen += 1;
                if time == f64::from(at) { Flow::Stop } else { Flow::Continue }
            });
        assert_eq!((outcome.ending, outcome.time, seen), (IntegrationEnding::Stopped, f64::from(at), at + 1));
        assert!(largest_difference(&y, &Oscillator::exact(outcome.time)) < 1e-7);
    }
}

#[test]
fn steps_that_cannot_be_evaluated_are_shortened() {
    let mut positive = Scalar::decay();
    positive.rate = |_, y| if y < 0.0 { Err(EvalError::Recoverable { equation: 0 }) } else { Ok(-y) };
    let options = IntegrationOptions { first_step: Some(5.0), ..tolerance(1e-8) };
    let record = ida(&mut positive, &[0.0, 10.0], (&[1.0], &[-1.0]), &options).finished(&[0.0, 10.0]);
    assert!(record.outcome.convergence_failures > 0, "{:?}", record.outcome);
    assert!(record.deviation(|time| vec![(-time).exp()]) < 1e-6);
}

#[test]
fn a_wall_is_reached_and_named() {
    LINEAR_SOLVERS.into_iter().for_each(walls_are_named_by);
}

fn walls_are_named_by(linear_solver: LinearSolver) {
    let mut walled = Scalar::decay();
    let options = IntegrationOptions { linear_solver, ..tolerance(1e-8) };
    let run = |walled: &mut Scalar| ida(walled, &[0.0, 0.25, 1.0], (&[1.0], &[-1.0]), &options);
    walled.rate = |time, y| if time > 0.5 { Err(EvalError::Recoverable { equation: 7 }) } else { Ok(-y) };
    let record = run(&mut walled);
    assert_eq!(record.outcome.ending, IntegrationEnding::Evaluation(EvalError::Recoverable { equation: 7 }));
    assert!((0.49..=0.5).contains(&record.outcome.time), "{:?}", record.outcome);
    assert!((record.y[0] - (-record.outcome.time).exp()).abs() < 1e-6 && (record.yd[0] + record.y[0]).abs() < 1e-5);
    assert_eq!(record.samples.len(), 2);

    walled.rate = |time, y| if time > 0.5 { Err(EvalError::Fatal { equation: 3 }) } else { Ok(-y) };
    assert_eq!(run(&mut walled).outcome.ending, IntegrationEnding::Evaluation(EvalError::Fatal { equation: 3 }));

    walled.rate = |_, y| Ok(-y);
    walled.slope = |_, _| Err(EvalError::Recoverable { equation: 5 });
    let record = run(&mut walled);
    assert_eq!(record.outcome.ending, IntegrationEnding::Evaluation(EvalError::Recoverable { equation: 5 }));
    assert_eq!((record.outcome.time, &record.y[..], &record.yd[..]), (0.0, &[1.0][..], &[-1.0][..]), "the start is kept");

    walled.slope = |_, _| Ok(-1.0);
    walled.event = Some(|time, _| if time > 0.5 { Err(EvalError::Fatal { equation: 1 }) } else { Ok(1.0) });
    let record = run(&mut walled);
    assert_eq!(record.outcome.ending, IntegrationEnding::Evaluation(EvalError::Fatal { equation: 1 }));
    assert!((record.y[0] - (-record.outcome.time).exp()).abs() < 1e-6, "{:?} {:?}", record.outcome, record.y);
}

/// ẋ = −10⁹ x and 0 = y with a matrix of somebody else.
struct Mistaken {
    matrix: fn(f64) -> [f64; 4],
}

impl DaeProblem for Mistaken {
    fn size(&self) -> usize {
        2
    }
    fn differential(&self) -> &[bool] {
        &[true, false]
    }
    fn absolute_tolerance(&self) -> &[f64] {
        &[1.0, 1.0]
    }
    fn residual(&mut self, _time: f64, y: &[f64], yd: &[f64], residual: &mut [f64]) -> Result<(), EvalError> {
        residual.copy_from_slice(&[yd[0] + 1e9 * y[0], y[1]]);
        Ok(())
    }
    fn jacobian(&mut self, _time: f64, c: f64, _y: &[f64], _yd: &[f64], jacobian: &mut Matrix) -> Result<(), EvalError> {
        jacobian.as_mut_slice().copy_from_slice(&(self.matrix)(c));
        Ok(())
    }
}

#[test]
fn endings_are_told_apart() {
    let few = IntegrationOptions { max_steps: 3, ..tested(1e-9) };
    let record = ida(&mut Oscillator { watched: false }, &[0.0, 100.0], OSCILLATOR, &few);
    assert_eq!((record.outcome.ending, record.outcome.steps), (IntegrationEnding::TooManySteps, 3));
    assert!(record.outcome.time > 0.0 && largest_difference(&record.y, &Oscillator::exact(record.outcome.time)) < 1e-8);

    for linear_solver in LINEAR_SOLVERS {
        let first = IntegrationOptions { first_step: Some(1.0), linear_solver, ..tolerance(1e-9) };
        let run = |matrix| ida(&mut Mistaken { matrix }, &[0.0, 1.0], (&[1.0, 0.0], &[-1e9, 0.0]), &first).outcome.ending;
        assert_eq!(run(|c| [c, 0.0, 0.0, 0.0]), IntegrationEnding::Singular);
        assert_eq!(run(|c| [-c, 0.0, 0.0, 1.0]), IntegrationEnding::Convergence);
    }

    let mut noise = Scalar::decay();
    noise.rate = |time, _| Ok(1e12 * (1e18 * time).sin());
    noise.slope = |_, _| Ok(0.0);
    let record = ida(&mut noise, &[1.0, 2.0], (&[0.0], &[0.0]), &tolerance(1e-9));
    assert_eq!(record.outcome.ending, IntegrationEnding::ErrorTest);

    for refused in [
        IntegrationOptions { relative_tolerance: -1.0, ..Default::default() },
        IntegrationOptions { relative_tolerance: 1e-18, absolute_tolerance_factor: 1e-18, ..Default::default() },
        IntegrationOptions { absolute_tolerance_factor: 0.0, ..Default::default() },
        IntegrationOptions { max_step: 0.0, ..Default::default() },
        IntegrationOptions { first_step: Some(-1.0), ..Default::default() },
    ] {
        let record = ida(&mut Oscillator { watched: false }, &[0.0, 1.0], OSCILLATOR, &refused);
        assert_eq!((record.outcome.ending, record.outcome.time), (IntegrationEnding::Refused, 0.0), "{refused:?}");
    }
}

#[test]
fn times_that_rounding_separates_have_the_same_state() {
    let times = [1.0, 1.0 + 2.0 * f64::EPSILON, 2.0, 2.0, 2.0 + 4.0 * f64::EPSILON];
    let start = (Oscillator::exact(1.0), vec![1f64.cos(), -1f64.sin()]);
    let start = (&start.0[..], &start.1[..]);
    let record = ida(&mut Oscillator { watched: false }, &times, start, &tested(1e-10)).finished(&times);
    assert!(record.deviation(Oscillator::exact) < 1e-8);
    ida(&mut Oscillator { watched: false }, &[1.0], start, &tested(1e-10)).finished(&[1.0]);
    ida(&mut Oscillator { watched: false }, &times[..2], start, &tested(1e-10)).finished(&times[..2]);
}

#[test]
fn a_panic_passes_through_and_leaves_the_integrator_usable() {
    let mut ida = Ida::default();
    let quiet = Scalar::decay;
    let raising: [fn(&mut Scalar); 3] = [
        |law| law.rate = |time, y| if time > 0.5 { panic!("the law has no value here") } else { Ok(-y) },
        |law| law.slope = |_, _| panic!("the law has no value here"),
        |law| law.event = Some(|time, _| if time > 0.5 { panic!("the law has no value here") } else { Ok(1.0) }),
    ];
    for (raise, linear_solver) in raising.into_iter().flat_map(|raise| LINEAR_SOLVERS.map(|linear| (raise, linear))) {
        let mut law = quiet();
        raise(&mut law);
        let options = IntegrationOptions { linear_solver, ..tolerance(1e-8) };
        let run = AssertUnwindSafe(|| record_dae(&mut ida, &mut law, &[0.0, 1.0], (&[1.0], &[-1.0]), &options).outcome);
        let panic = catch_unwind(run).unwrap_err();
        assert_eq!(panic.downcast_ref::<&str>(), Some(&"the law has no value here"));
        let record = record_dae(&mut ida, &mut quiet(), &[0.0, 1.0], (&[1.0], &[-1.0]), &options).finished(&[0.0, 1.0]);
        assert!(record.deviation(|time| vec![(-time).exp()]) < 1e-6);
    }
}

#[test]
fn the_start_does_not_remember_the_run_before() {
    let mut kept = Ida::default();
    let mut runs = Vec::new();
    for watched in [false, true, false] {
        let times = grid(0.0, 10.0, 13);
        let record = record_dae(&mut kept, &mut Oscillator { watched }, &times, OSCILLATOR, &tested(1e-9));
        runs.push((record.y, record.outcome.steps, record.outcome.residuals, record.outcome.jacobians));
    }
    assert_eq!(runs[0], runs[2]);
    assert!(runs[1].1 < runs[0].1);
}

#[test]
fn integrators_on_two_threads_agree_to_the_last_bit() {
    let solve = |mut ida: Ida| {
        let (y, yd) = Pendulum::IMPLICIT_START;
        let times = Pendulum::times();
        record_dae(&mut ida, &mut Pendulum { projected: false, watched: false }, &times, (&y, &yd), &tolerance(1e-8)).y
    };
    // created here, moved there
    let (here, there) = (Ida::default(), Ida::default());
    let other = std::thread::spawn(move || solve(there));
    assert_eq!(solve(here), other.join().unwrap());
}
