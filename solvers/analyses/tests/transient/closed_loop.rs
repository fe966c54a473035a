//! A plant under the command of controllers is the plant that one would write by hand.

use crate::methods::{ImplicitEuler, RungeKutta};
use crate::plants::{BOB, DAMPING, GRAVITY, MASS, STIFFNESS, driven_pendulum, oscillator};
use analyses::linearize::Options;
use analyses::transient::{Constant, Method, Transient, TransientEnding, evenly};
use analyses::{ClosedLoop, LoopError, linearize};
use problem::{
    Answer, AnswerAlong, At, Controller, Dae, Differentiable, EvalError, Limit, Limits, Matrix, Outputs, Seeds, Side, Signal, Unknown,
    UnknownKind,
};

/// Proportional gain, N/m; gain on the filtered speed, N s/m; time constant of the filter, s.
const GAINS: [f64; 3] = [7.0, 3.0, 0.2];

/// Commands a force `−kp x − kd f + ε x f` from a position x and a filtered speed f: `ḟ = (v − f)/T`.
#[derive(Clone)]
struct Pd {
    measured: Vec<String>,
    commanded: Vec<String>,
    states: Vec<Unknown>,
    outputs: Vec<Signal>,
    limits: Vec<Limit>,
    /// ε, which makes the law nonlinear.
    epsilon: f64,
    /// Time from which on it does not answer.
    ends: f64,
}

fn pd(body: &str, input: &str, name: &str, epsilon: f64) -> Pd {
    let filter = Unknown {
        signal: Signal::new(format!("{name}.speed"), "m/s", ""),
        kind: UnknownKind::State,
        cyclic: false,
        differential: true,
        nominal: 1.0,
        absolute_tolerance: 1e-8,
        design: 0.0,
        start: None,
    };
    let effort = format!("{name}.effort");
    let limit = Limit { name: "weak".into(), signal: effort.clone(), threshold: 0.6, side: Side::Above, nominal: 1.0, about: "".into() };
    let (measured, outputs) = (vec![format!("{body}.x"), format!("{body}.{}", if body == "cart" { "speed" } else { "x_rate" })], effort);
    Pd {
        measured,
        commanded: vec![input.to_owned()],
        states: vec![filter],
        outputs: vec![Signal::new(outputs, "N", "")],
        limits: vec![limit],
        epsilon,
        ends: f64::INFINITY,
    }
}

impl Controller for Pd {
    fn measured(&self) -> &[String] {
        &self.measured
    }
    fn commanded(&self) -> &[String] {
        &self.commanded
    }
    fn states(&self) -> &[Unknown] {
        &self.states
    }
    fn outputs(&self) -> &[Signal] {
        &self.outputs
    }
    fn limits(&self) -> &[Limit] {
        &self.limits
    }
    fn answer(&mut self, time: f64, z: &[f64], x: &[f64], answer: Answer<'_>) -> Result<(), EvalError> {
        let [kp, kd, t] = GAINS;
        answer.commands[0] = -kp * z[0] - kd * x[0] + self.epsilon * z[0] * x[0];
        answer.rates[0] = (z[1] - x[0]) / t;
        answer.outputs[0] = answer.commands[0] * answer.commands[0];
        if time > self.ends { Err(EvalError::Recoverable { equation: 0 }) } else { Ok(()) }
    }
    fn answer_along(
        &mut self,
        time: f64,
        (z, x): (&[f64], &[f64]),
        (dz, dx): (&Matrix, &Matrix),
        answer: Answer<'_>,
        along: AnswerAlong<'_>,
    ) -> Result<(), EvalError> {
        let [kp, kd, t] = GAINS;
        let Answer { commands, rates, outputs } = answer;
        self.answer(time, z, x, Answer { commands: &mut *commands, rates, outputs })?;
        for k in 0..dz.columns() {
            let d = -kp * dz[(0, k)] - kd * dx[(0, k)] + self.epsilon * (dz[(0, k)] * x[0] + z[0] * dx[(0, k)]);
            along.commands[(0, k)] = d;
            along.rates[(0, k)] = (dz[(1, k)] - dx[(0, k)]) / t;
            along.outputs[(0, k)] = 2.0 * commands[0] * d;
        }
        Ok(())
    }
}

fn names<'a>(signals: impl Iterator<Item = &'a Signal>) -> Vec<&'a str> {
    signals.map(|s| s.name.as_str()).collect()
}

#[test]
fn commanded_inputs_become_outputs_and_states_come_last() {
    let closed = ClosedLoop::new(driven_pendulum(), vec![Box::new(pd("bob", "bob.push", "rider", 0.0))]).expect("a loop");
    let unknowns = names(closed.unknowns().iter().map(|u| &u.signal));
    assert_eq!(unknowns, ["bob.x", "bob.y", "bob.x_rate", "bob.y_rate", "rod.tension", "rod.correction", "rider.speed"]);
    assert_eq!(names(closed.inputs().iter().map(|i| &i.signal)), ["bob.weight"]);
    assert_eq!(names(closed.outputs().iter()), ["bob.energy", "bob.push", "rider.effort"]);
    assert_eq!(closed.equations()[6].name, "rate of rider.speed");
    assert_eq!(closed.limits().len(), 1);
}

#[test]
fn derivatives_are_those_of_plant_and_controllers_together() {
    let mut closed = ClosedLoop::new(driven_pendulum(), vec![Box::new(pd("bob", "bob.push", "rider", 0.4))]).expect("a loop");
    let y = [0.3, -0.9, 0.7, 0.2, 5.0, 0.1, -0.6];
    let yd = [0.5, -0.4, 1.0, 0.3, 0.0, 0.0, 0.8];
    let u = [1.3];
    let (ny, columns) = (y.len(), 2 * y.len() + u.len());
    let mut seeds = Seeds::zeros(ny, 1, columns);
    for i in 0..ny {
        (seeds.y[(i, i)], seeds.yd[(i, ny + i)]) = (1.0, 1.0);
    }
    seeds.u[(0, 2 * ny)] = 1.0;
    let (mut r, mut z) = (vec![0.0; ny], vec![0.0; 3]);
    let (mut dr, mut dz) = (Matrix::zeros(ny, columns), Matrix::zeros(3, columns));
    closed.along(At { time: 0.0, y: &y, yd: &yd, u: &u }, &seeds, (&mut r, &mut z), &mut dr, &mut dz).expect("finite");
    let mut values = |side: f64, k: usize| {
        let moved = |x: &[f64], d: &[f64]| -> Vec<f64> { x.iter().zip(d).map(|(x, d)| x + side * 1e-5 * d).collect() };
        let (y, yd, u) = (moved(&y, seeds.y.column(k)), moved(&yd, seeds.yd.column(k)), moved(&u, seeds.u.column(k)));
        let (mut r, mut z) = (vec![0.0; ny], vec![0.0; 3]);
        closed.evaluate(At { time: 0.0, y: &y, yd: &yd, u: &u }, &mut r, &mut z).expect("finite");
        [r, z].concat()
    };
    assert_eq!([r, z].concat(), values(0.0, 0));
    for k in 0..columns {
        let exact = [dr.column(k), dz.column(k)].concat();
        for (i, (ahead, behind)) in values(1.0, k).iter().zip(values(-1.0, k)).enumerate() {
            // central differences of a step of 1e-5 and values of some tens
            assert!(((ahead - behind) / 2e-5 - exact[i]).abs() < 1e-8, "{i} {k}");
        }
    }
}

/// The pendulum in its angle from the downward vertical under the same force, by hand.
fn by_hand(duration: f64, steps: usize) -> [f64; 3] {
    let [kp, kd, t] = GAINS;
    let f = |[a, w, x]: [f64; 3]| {
        let push = -kp * a.sin() - kd * x + 0.4 * a.sin() * x;
        [w, -GRAVITY * a.sin() + push * a.cos() / BOB, (w * a.cos() - x) / t]
    };
    let moved = |s: [f64; 3], k: [f64; 3], h: f64| std::array::from_fn(|i| s[i] + h * k[i]);
    let (mut s, h) = ([std::f64::consts::FRAC_PI_2, 0.0, 0.0], duration / steps as f64);
    for _ in 0..steps {
        let k1 = f(s);
        let k2 = f(moved(s, k1, h / 2.0));
        let k3 = f(moved(s, k2, h / 2.0));
        let k4 = f(moved(s, k3, h));
        s = std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    s
}

#[test]
fn a_controlled_pendulum_swings_as_the_one_written_by_hand() {
    let mut closed = ClosedLoop::new(driven_pendulum(), vec![Box::new(pd("bob", "bob.push", "rider", 0.4))]).expect("a loop");
    let transient = Transient::new(&closed, evenly(1.5, 31));
    let inputs = Constant::defaults(&closed);
    let exact = by_hand(1.5, 3000);
    let distance = |y: &[f64]| f64::max((y[0] - exact[0].sin()).abs(), (y[6] - exact[2]).abs());
    let explicit = transient.run(&mut closed, &inputs, Method::Ode(&mut RungeKutta { step: 1e-3 })).expect("a start");
    assert!(explicit.ending.reached() && distance(&explicit.y) < 1e-9, "{:?}", explicit.y);
    // the commanded input is recorded, and the controller's limit is watched
    let last = |name: &str| explicit.trajectory.column(name).and_then(|c| c.last().copied()).expect("recorded");
    assert_eq!(last("rider.effort"), last("bob.push") * last("bob.push"));
    assert_eq!(explicit.limits[0].name, "weak");
    // first order: half the step, half the error
    let errors = [1e-3, 5e-4].map(|step| {
        let implicit = transient.run(&mut closed, &inputs, Method::Dae(&mut ImplicitEuler { step })).expect("a start");
        distance(&implicit.y)
    });
    assert!(errors[1] < 0.02 && (1.8..2.2).contains(&(errors[0] / errors[1])), "{errors:?}");
}

#[test]
fn a_linear_model_of_a_closed_loop_is_a_plus_b_k() {
    let rest = |plant: &mut dyn problem::Plant| {
        let (ny, nu) = (plant.unknowns().len(), plant.inputs().len());
        linearize(plant, At { time: 0.0, y: &vec![0.0; ny], yd: &vec![0.0; ny], u: &vec![0.0; nu] }, &Options::default()).expect("a trim")
    };
    let open = rest(&mut oscillator());
    let closed = rest(&mut ClosedLoop::new(oscillator(), vec![Box::new(pd("cart", "cart.force", "spring2", 0.0))]).expect("a loop"));
    let [kp, kd, t] = GAINS;
    assert_eq!(names(closed.states.iter().map(|s| &s.signal)), ["cart.x", "cart.speed", "spring2.speed"]);
    for i in 0..2 {
        let row = [open.A[(i, 0)] - kp * open.B[(i, 0)], open.A[(i, 1)], -kd * open.B[(i, 0)]];
        (0..3).for_each(|j| assert!((closed.A[(i, j)] - row[j]).abs() < 1e-14, "{} {i} {j}", closed.A));
    }
    assert!((closed.A[(2, 1)] - 1.0 / t).abs() < 1e-14 && (closed.A[(2, 2)] + 1.0 / t).abs() < 1e-14, "{}", closed.A);
    assert!((closed.E[(1, 1)] - MASS).abs() < 1e-14 && (closed.A[(1, 0)] + STIFFNESS + kp).abs() < 1e-13);
    assert!((closed.A[(1, 1)] + DAMPING).abs() < 1e-14);
    // behind multipliers too: the states of a controller are no multipliers
    let hanging = |plant: &mut dyn problem::Plant, y: &[f64]| {
        linearize(plant, At { time: 0.0, y, yd: &vec![0.0; y.len()], u: &[0.0] }, &Options::default()).expect("a trim")
    };
    let mut pendulum = ClosedLoop::new(driven_pendulum(), vec![Box::new(pd("bob", "bob.push", "rider", 0.0))]).expect("a loop");
    let small = hanging(&mut pendulum, &[0.0, -1.0, 0.0, 0.0, BOB * GRAVITY, 0.0, 0.0]);
    assert_eq!(names(small.states.iter().map(|s| &s.signal)), ["bob.x", "bob.x_rate", "rider.speed"]);
    assert!((small.A[(1, 0)] + BOB * GRAVITY + kp).abs() < 1e-12 && (small.A[(1, 2)] + kd).abs() < 1e-12, "{}", small.A);
}

#[test]
fn what_does_not_go_together_is_told_in_names() {
    let refused = |change: &dyn Fn(&mut Pd)| {
        let mut law = pd("bob", "bob.push", "rider", 0.0);
        change(&mut law);
        ClosedLoop::new(driven_pendulum(), vec![Box::new(law)]).err().expect("refused")
    };
    assert!(matches!(refused(&|l| l.measured[0] = "bob.z".into()), LoopError::UnknownMeasured { signal, known }
        if signal == "bob.z" && known == ["bob.x", "bob.y", "bob.x_rate", "bob.y_rate"]));
    for name in ["rod.tension", "bob.energy", "bob.weight", "rate(bob.x_rate)"] {
        assert_eq!(refused(&|l| l.measured[1] = name.into()), LoopError::Unmeasurable { signal: name.into() });
    }
    assert!(matches!(refused(&|l| l.commanded[0] = "bob.x".into()), LoopError::UnknownCommanded { input, known }
        if input == "bob.x" && known == ["bob.push", "bob.weight"]));
    let other = pd("bob", "bob.push", "wind", 0.0);
    let both: Vec<Box<dyn Controller>> = vec![Box::new(pd("bob", "bob.push", "rider", 0.0)), Box::new(other)];
    let twice = ClosedLoop::new(driven_pendulum(), both).err().expect("two masters");
    assert_eq!(twice.to_string(), "two controllers command `bob.push`");
    let taken = refused(&|l| l.outputs[0] = Signal::new("bob.energy", "J", ""));
    assert_eq!(taken, LoopError::NameTaken { signal: "bob.energy".into() });
}

#[test]
fn a_failure_of_a_controller_names_its_row() {
    let law = Pd { ends: 0.27, ..pd("bob", "bob.push", "rider", 0.0) };
    let mut closed = ClosedLoop::new(driven_pendulum(), vec![Box::new(law)]).expect("a loop");
    let transient = Transient::new(&closed, evenly(1.0, 21));
    let inputs = Constant::defaults(&closed);
    let simulation = transient.run(&mut closed, &inputs, Method::Ode(&mut RungeKutta { step: 1e-3 })).expect("a start");
    let TransientEnding::Failed { cause } = &simulation.ending else { panic!("{:?}", simulation.ending) };
    assert_eq!(cause.to_string(), "`rate of rider.speed` has no finite value beyond this point");
}

/// However many samples and steps there are, the same memory is asked for as often.
#[test]
fn nothing_is_allocated_on_the_way() {
    let mut closed = ClosedLoop::new(driven_pendulum(), vec![Box::new(pd("bob", "bob.push", "rider", 0.4))]).expect("a loop");
    let inputs = Constant::defaults(&closed);
    let mut count = |times: Vec<f64>, implicit: bool| {
        let transient = Transient::new(&closed, times);
        let counted = allocation_counter::measure(|| {
            let simulation = match implicit {
                true => transient.run(&mut closed, &inputs, Method::Dae(&mut ImplicitEuler { step: 1e-3 })),
                false => transient.run(&mut closed, &inputs, Method::Ode(&mut RungeKutta { step: 1e-3 })),
            };
            assert!(simulation.is_ok_and(|s| s.ending.reached()));
        });
        counted.count_total
    };
    count(evenly(0.01, 2), true);
    for implicit in [true, false] {
        assert_eq!(count(evenly(0.01, 2), implicit), count(evenly(0.2, 101), implicit));
    }
}
