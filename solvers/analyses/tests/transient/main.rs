//! Does the time-domain service find consistent starts, hand out the right problem in both forms, and keep what it computed?

mod closed_loop;
mod methods;
mod plants;

use analyses::transient::{
    Cause, Constant, Driven, Inputs, Method, Simulation, Start, Step, Transient, TransientEnding, TransientError, evenly,
};
use analyses::{Variable, Variables};
use methods::{ImplicitEuler, RungeKutta};
use plants::{DAMPING, GRAVITY, MASS, Plant, STIFFNESS, oscillator, pendulum};
use problem::{EvalError, Flow, Limit, Off, ProjectionError, Side};

fn run(plant: &mut Plant, transient: &Transient, method: Method<'_>) -> Result<Simulation, TransientError> {
    let inputs = Constant::defaults(plant);
    transient.run(plant, &inputs, method)
}

fn by_runge_kutta(plant: &mut Plant, transient: &Transient, step: f64) -> Simulation {
    run(plant, transient, Method::Ode(&mut RungeKutta { step })).expect("a start")
}

fn by_euler(plant: &mut Plant, transient: &Transient, step: f64) -> Simulation {
    run(plant, transient, Method::Dae(&mut ImplicitEuler { step })).expect("a start")
}

fn column<'a>(simulation: &'a Simulation, name: &str) -> &'a [f64] {
    simulation.trajectory.column(name).unwrap_or_else(|| panic!("`{name}` was recorded"))
}

/// Largest distance between a column and a function of time.
fn distance(simulation: &Simulation, name: &str, exact: impl Fn(f64) -> f64) -> f64 {
    let pairs = simulation.trajectory.time.iter().zip(column(simulation, name));
    pairs.map(|(&t, x)| (x - exact(t)).abs()).fold(0.0, f64::max)
}

/// x₀ e^(−δt) (cos ωt + δ/ω sin ωt): released at rest from x₀ = 0.1 m.
fn released(t: f64) -> f64 {
    let decay = DAMPING / (2.0 * MASS);
    let omega = (STIFFNESS / MASS - decay * decay).sqrt();
    0.1 * (-decay * t).exp() * ((omega * t).cos() + decay / omega * (omega * t).sin())
}

#[test]
fn both_forms_find_the_motion_of_an_oscillator() {
    let mut plant = oscillator();
    let transient = Transient::new(&plant, evenly(2.0, 41));
    let explicit = by_runge_kutta(&mut plant, &transient, 1e-3);
    assert!(explicit.ending.reached() && explicit.trajectory.len() == 41);
    // fourth order: (5 rad/s · 1 ms)⁴ of 0.1 m
    assert!(distance(&explicit, "cart.x", released) < 1e-9);
    assert!(distance(&explicit, "spring.force", |t| STIFFNESS * released(t)) < 1e-7);
    // first order: half the step, half the error; the amplitude 0.1 m e^(-δt) is damped too much by the factor 1 - ω²h t/2
    let [coarse, fine] = [2e-3, 1e-3].map(|step| distance(&by_euler(&mut plant, &transient, step), "cart.x", released));
    assert!(coarse < 3e-3 && (1.8..2.2).contains(&(coarse / fine)), "{coarse} {fine}");
}

#[test]
fn inputs_may_be_functions_of_time() {
    let mut plant = oscillator();
    let mut transient = Transient::new(&plant, evenly(1.0, 21));
    // a force that makes the cart follow x = 0.1 cos 3t
    let force = |t: f64, u: &mut [f64]| {
        u[0] = 0.1 * ((STIFFNESS - 9.0 * MASS) * (3.0 * t).cos() - 3.0 * DAMPING * (3.0 * t).sin());
    };
    transient.record = vec![Variable::Input(0), Variable::Unknown(0), Variable::Rate(1)];
    let simulation = transient.run(&mut plant, &force, Method::Ode(&mut RungeKutta { step: 1e-3 })).expect("a start");
    assert!(distance(&simulation, "cart.x", |t| 0.1 * (3.0 * t).cos()) < 1e-10);
    assert!(distance(&simulation, "rate(cart.speed)", |t| -0.9 * (3.0 * t).cos()) < 1e-9);
    let mut u = [0.0];
    force.at(1.0, &mut u);
    assert_eq!(column(&simulation, "cart.force").last(), Some(&u[0]));
    assert_eq!(simulation.trajectory.signals[2].unit, "m/s²");
}

/// A jump between two samples costs no accuracy: the integration starts anew there. A sample on a jump is that after it.
#[test]
fn inputs_may_jump() {
    let mut plant = oscillator();
    let transient = Transient::new(&plant, evenly(2.0, 41));
    let mut inputs = Driven::new(vec![0.0]);
    for (time, height) in [(0.333, 8.0), (1.5, -8.0)] {
        inputs.add(&plant, 0, Box::new(Step { time, height }));
    }
    // a step of the force releases the cart from where it would rest in the end
    let pushed = |t: f64, at: f64| if t < at { 0.0 } else { 8.0 / STIFFNESS * (1.0 - 10.0 * released(t - at)) };
    let exact = |t: f64| released(t) + pushed(t, 0.333) - pushed(t, 1.5);
    let explicit = transient.run(&mut plant, &inputs, Method::Ode(&mut RungeKutta { step: 1e-3 })).expect("a start");
    assert!(explicit.ending.reached() && explicit.trajectory.time == transient.times);
    assert!(distance(&explicit, "cart.x", exact) < 1e-9);
    let force = |s: &Simulation| [29, 30, 31].map(|k| column(s, "cart.force")[k]);
    assert_eq!(force(&explicit), [8.0, 0.0, 0.0]);
    let implicit = transient.run(&mut plant, &inputs, Method::Dae(&mut ImplicitEuler { step: 1e-3 })).expect("a start");
    assert!(distance(&implicit, "cart.x", exact) < 3e-3 && force(&implicit) == force(&explicit));
}

#[test]
fn a_watcher_may_stop_and_a_condition_may_hold_at_once() {
    let mut plant = oscillator();
    let mut transient = Transient::new(&plant, evenly(2.0, 41));
    let mut seen = Vec::new();
    let stopped = transient.run_watched(&mut plant, &Constant(vec![0.0]), Method::Ode(&mut RungeKutta { step: 1e-2 }), &mut |sample| {
        seen.push(sample.time);
        if sample.time < 0.5 { Flow::Continue } else { Flow::Stop }
    });
    let stopped = stopped.expect("a start");
    assert_eq!((stopped.ending.name(), &stopped.trajectory.time), ("stopped", &seen));
    assert!((seen.len(), seen.last()) == (11, Some(&0.5)));
    let limit = |signal: &str| Limit {
        name: "until".into(),
        signal: signal.to_owned(),
        threshold: 0.05,
        side: Side::Above,
        nominal: 1.0,
        about: "".into(),
    };
    transient.ends = vec![limit("cart.x")];
    let met = by_runge_kutta(&mut plant, &transient, 1e-2);
    assert_eq!((met.ending.name(), met.trajectory.time.as_slice()), ("until", &[0.0][..]));
    transient.ends = vec![limit("cart.y")];
    let error = run(&mut plant, &transient, Method::Ode(&mut RungeKutta { step: 0.1 })).expect_err("no signal");
    assert_eq!(error, TransientError::UnknownSignal { signal: "cart.y".to_owned() });
}

/// The same pendulum in its angle from the downward vertical, released horizontally: θ̈ = −g sin θ.
fn swing(t: f64) -> (f64, f64) {
    let f = |[a, w]: [f64; 2]| [w, -GRAVITY * f64::sin(a)];
    let (mut s, n) = ([std::f64::consts::FRAC_PI_2, 0.0], (t / 1e-3).ceil().max(1.0));
    let h = t / n;
    let moved = |s: [f64; 2], k: [f64; 2], h: f64| [s[0] + h * k[0], s[1] + h * k[1]];
    for _ in 0..n as usize {
        let k1 = f(s);
        let k2 = f(moved(s, k1, h / 2.0));
        let k3 = f(moved(s, k2, h / 2.0));
        let k4 = f(moved(s, k3, h));
        for i in 0..2 {
            s[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
    }
    (s[0].sin(), -s[0].cos())
}

#[test]
fn a_pendulum_with_a_multiplier_swings_as_one_in_its_angle() {
    let mut plant = pendulum();
    let transient = Transient::new(&plant, evenly(1.5, 31));
    let explicit = by_runge_kutta(&mut plant, &transient, 1e-3);
    assert!(distance(&explicit, "bob.x", |t| swing(t).0) < 1e-9 && distance(&explicit, "bob.y", |t| swing(t).1) < 1e-9);
    assert!(column(&explicit, "bob.energy").iter().all(|e| e.abs() < 1e-8));
    // tension in the lowest pose, once it is reached: m g + m v² = 3 m g
    let tension = column(&explicit, "rod.tension").iter().copied().fold(0.0, f64::max);
    assert!((tension / (plants::BOB * GRAVITY) - 3.0).abs() < 0.05, "{tension}");
    let [coarse, fine] = [1e-3, 5e-4].map(|step| by_euler(&mut plant, &transient, step));
    let [coarse_off, fine_off] = [&coarse, &fine].map(|s| distance(s, "bob.x", |t| swing(t).0));
    assert!(coarse_off < 0.02 && (1.8..2.2).contains(&(coarse_off / fine_off)), "{coarse_off} {fine_off}");
    // the stabilized form holds coordinates and velocities on the constraints
    for simulation in [&explicit, &coarse, &fine] {
        let (position, velocity) = (simulation.drift.position.as_ref(), simulation.drift.velocity.as_ref());
        let (position, velocity) = (position.expect("a row on coordinates"), velocity.expect("a row on velocities"));
        assert_eq!((position.off.row.as_str(), velocity.off.row.as_str()), ("length of rod", "stretching of rod"));
        assert!(position.off.by < 1e-12 && velocity.off.by < 1e-10, "{position:?} {velocity:?}");
    }
}

#[test]
fn a_start_is_made_consistent_and_held_values_stay() {
    let mut plant = pendulum();
    let mut transient = Transient::new(&plant, evenly(0.1, 2));
    transient.start.hold(&plant, &[(0, 0.6)]);
    transient.start.y[2] = 1.0;
    let start = by_runge_kutta(&mut plant, &transient, 1e-2);
    let first = |name: &str| column(&start, name)[0];
    assert_eq!((first("bob.x"), first("bob.y")), (0.6, -0.8));
    assert!((first("bob.x_rate") - 0.64).abs() < 1e-15 && (first("bob.y_rate") - 0.48).abs() < 1e-15);
    // λ = m (v² − g y)/l²
    assert!((first("rod.tension") - plants::BOB * (0.64 + 0.8 * GRAVITY)).abs() < 1e-12);
    assert_eq!(first("rod.correction"), 0.0);
}

#[test]
fn what_is_given_releases_what_is_stated() {
    let mut plant = pendulum();
    (plant.unknowns[0].start, plant.unknowns[3].start) = (Some(0.8), Some(-1.0));
    let mut start = Start::stated(&plant);
    assert_eq!((start.y[..4].to_vec(), start.held[..4].to_vec()), (vec![0.8, 0.0, 0.0, -1.0], vec![true, false, false, true]));
    start.hold(&plant, &[(1, -0.6)]);
    // the stated coordinate is a first guess now; the stated velocity still holds
    assert_eq!((start.y[..4].to_vec(), start.held[..4].to_vec()), (vec![0.8, -0.6, 0.0, -1.0], vec![false, true, false, true]));
}

#[test]
fn an_impossible_start_is_told_in_names() {
    let mut plant = pendulum();
    let mut transient = Transient::new(&plant, evenly(0.1, 2));
    transient.start.hold(&plant, &[(0, 1.2)]);
    let error = run(&mut plant, &transient, Method::Ode(&mut RungeKutta { step: 0.1 })).expect_err("the rod is too short");
    assert_eq!(error.to_string(), "the coordinates of the start cannot satisfy the constraints; `length of rod` is off by 2.200000e-1 m²");
    transient.start = Start::stated(&plant);
    plant.rates = |_, _, _| Err(EvalError::Recoverable { equation: 3 });
    let error = run(&mut plant, &transient, Method::Ode(&mut RungeKutta { step: 0.1 })).expect_err("no rates");
    assert_eq!(error.to_string(), "`force along bob.y` has no finite value at the start");
    for times in [vec![], vec![0.0], vec![0.0, 0.0], vec![0.0, f64::NAN]] {
        let transient = Transient::new(&plant, times);
        let error = run(&mut plant, &transient, Method::Ode(&mut RungeKutta { step: 0.1 }));
        assert_eq!(error.expect_err("no sequence"), TransientError::Times);
    }
}

#[test]
fn what_was_computed_before_a_failure_is_kept() {
    let mut plant = oscillator();
    plant.ends = Some((0.27, 1));
    let transient = Transient::new(&plant, evenly(2.0, 41));
    for simulation in [by_runge_kutta(&mut plant, &transient, 1e-3), by_euler(&mut plant, &transient, 1e-3)] {
        let TransientEnding::Failed { cause } = &simulation.ending else { panic!("{:?}", simulation.ending) };
        assert_eq!(cause.to_string(), "`force along cart` has no finite value beyond this point");
        assert_eq!(simulation.ending.name(), "not_converged");
        // samples of 50 ms from 0 to 0.25 s, and the time reached
        let (time, x) = (&simulation.trajectory.time, column(&simulation, "cart.x"));
        assert!(time.len() == 7 && x.len() == 7 && time[6] == simulation.statistics.time, "{time:?}");
        assert!((0.2689..0.2701).contains(&time[6]) && x[6] == simulation.y[0] && (x[6] - released(time[6])).abs() < 1e-3, "{x:?}");
    }
}

#[test]
fn failures_name_signals_and_equations() {
    // two rods that hold the same cart
    let mut plant = pendulum();
    plant.rows = |at, r| {
        r.copy_from_slice(&[at.yd[0] - at.y[2], at.yd[1] - at.y[3], at.yd[2] + at.y[4] + at.y[5], at.yd[3], at.y[2], at.y[2]]);
        Ok(())
    };
    let transient = Transient::new(&plant, evenly(1.0, 3));
    let simulation = by_euler(&mut plant, &transient, 0.1);
    let TransientEnding::Failed { cause: Cause::Singular { together } } = &simulation.ending else { panic!("{:?}", simulation.ending) };
    assert!(together.len() == 2 && together[0].starts_with("`rod.") && together[1].starts_with("`rod."), "{together:?}");
    assert_eq!(simulation.trajectory.time, [0.0]);

    // a row that nothing can satisfy
    let mut plant = pendulum();
    plant.rows = |at, r| {
        r[..5].copy_from_slice(&[at.yd[0] - at.y[2], at.yd[1] - at.y[3], at.yd[2] + at.y[4], at.yd[3] + at.y[5], at.y[2]]);
        r[5] = at.y[3] * at.y[3] + 0.5;
        Ok(())
    };
    let mut moving = transient.clone();
    moving.start.y[3] = 1.0;
    let simulation = by_euler(&mut plant, &moving, 0.1);
    let TransientEnding::Failed { cause: Cause::Convergence { rows } } = &simulation.ending else { panic!("{:?}", simulation.ending) };
    assert_eq!((rows[0].row.as_str(), rows[0].unit.as_str()), ("stretching of rod", "m²/s"));

    // a step from which no way leads back
    let mut plant = pendulum();
    plant.onto = |y, _| match y[0] < 0.5 {
        true => Err(ProjectionError::Open { rows: vec![Off { row: "length of rod".to_owned(), by: 0.1, unit: "m²".to_owned() }] }),
        false => Ok(()),
    };
    let simulation = by_runge_kutta(&mut plant, &transient, 0.01);
    let TransientEnding::Failed { cause } = &simulation.ending else { panic!("{:?}", simulation.ending) };
    assert_eq!(cause.to_string(), "the motion leaves the constraints; `length of rod` is off by 1.000000e-1 m²");
    assert!(column(&simulation, "bob.x").last().is_some_and(|x| (0.4..0.51).contains(x)));

    // patience
    let mut plant = pendulum();
    let mut transient = Transient::new(&plant, evenly(1.0, 3));
    transient.options.max_steps = 10;
    let simulation = by_runge_kutta(&mut plant, &transient, 1e-3);
    let TransientEnding::Failed { cause } = &simulation.ending else { panic!("{:?}", simulation.ending) };
    assert!(cause.to_string().starts_with("more than 10 steps to the next sample; fastest are `bob.y_rate` (by -9.8"), "{cause}");
}

#[test]
fn limits_are_watched_and_do_not_end_the_motion() {
    let mut plant = oscillator();
    let transient = Transient::new(&plant, evenly(2.0, 201));
    let simulation = by_runge_kutta(&mut plant, &transient, 1e-3);
    let [met] = &simulation.limits[..] else { panic!("{:?}", simulation.limits) };
    assert_eq!((met.name.as_str(), met.signal.as_str(), met.threshold), ("spring_stop", "spring.force", -2.0));
    let force = column(&simulation, "spring.force");
    let first = force.iter().position(|f| *f < -2.0).expect("the stop is met");
    assert_eq!((met.time, met.value), (simulation.trajectory.time[first], force[first]));
}

/// However many samples and steps there are, the same memory is asked for as often.
#[test]
fn nothing_is_allocated_on_the_way() {
    let mut plant = pendulum();
    let variables = Variables::of(&plant);
    assert_eq!(variables.find("bob.energy"), Some(Variable::Output(0)));
    let mut count = |times: Vec<f64>, implicit: bool| {
        let transient = Transient::new(&plant, times);
        let counted = allocation_counter::measure(|| {
            let simulation = if implicit { by_euler(&mut plant, &transient, 1e-3) } else { by_runge_kutta(&mut plant, &transient, 1e-3) };
            assert!(simulation.ending.reached());
        });
        counted.count_total
    };
    for implicit in [true, false] {
        assert_eq!(count(evenly(0.01, 2), implicit), count(evenly(0.2, 101), implicit));
    }
}
