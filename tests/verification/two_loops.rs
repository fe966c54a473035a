//! The rider in two loops: what was designed is what rides, and it keeps to its lane.

use analyses::ClosedLoop;
use analyses::transient::{Driven, Start, Transient, evenly};
use fastbike::rider::{Designed, Task};
use mbody::description::Library;
use mbody::dynamics::Formulation;
use mbody::dynamics::TreePlant;
use motorcycle::maneuver::{Course, LateralLaw, Layout, RiderDescription, Speed, section};
use nalgebra::{Complex, DMatrix};
use problem::{At, Dae, Differentiable, Matrix, Outputs, Seeds};
use validation::agreement::{Agreement, absolute};
use validation::course::By;
use validation::evidence::Row;
use validation::vehicle::{State, Vehicle, running};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    the_loops_that_ride_are_those_of_the_design => (
        "`ref11` and `gsxr1000` at 15 and 30 m/s with the rider in two loops: eigenvalues of vehicle, rider and path, linearized as a whole",
        "poles of the design from the linear model",
        "5 % of their size: gains of the table are interpolated between speeds up to 12 % apart"
    ),
    lanes_are_changed_by_two_loops => (
        "`ref11` and `gsxr1000` from 15 to 35 m/s change lanes with 5 m/s² to the side: offset from the path",
        "theory manual 10.3: half a meter",
        "0.5 m, a bound"
    ),
];

struct Nothing;

impl Library for Nothing {
    fn text(&self, _: &str) -> Option<std::borrow::Cow<'_, str>> {
        None
    }
}

fn designed(state: &State, speed: f64, path: &[(&str, String)]) -> Designed {
    let mut layout = Layout::default();
    for (kind, parameters) in path {
        let kind = section::KINDS.iter().find(|k| k.name == *kind).expect("a kind");
        (kind.lay)(&serde_yaml::from_str(parameters).expect("parameters"), &mut layout, &Nothing).unwrap_or_else(|e| panic!("{e}"));
    }
    let course = Course { path: layout.path(), speed: Speed::Constant(speed), torque_pulses: Vec::new() };
    let wishes = RiderDescription { lateral: LateralLaw::Pid, ..RiderDescription::default() };
    let task = Task { system: &state.system, backend: "kinsol", wishes: &wishes, front_brake_share: 0.7 };
    task.design(course).unwrap_or_else(|failure| panic!("{failure}"))
}

/// Vehicle and rider at a steady state.
fn ridden(state: &State, designed: Designed) -> (ClosedLoop<TreePlant>, Vec<f64>, Vec<f64>) {
    let plant = TreePlant::in_formulation(state.system.clone(), Formulation::Ggl);
    let closed = ClosedLoop::new(plant, vec![Box::new(designed.rider)]).expect("a loop");
    let (y, u) = state.arguments();
    let mut start = Start::stated(&closed).y;
    start[..y.len()].copy_from_slice(y);
    let names: Vec<&String> = closed.plant().inputs().iter().map(|i| &i.signal.name).collect();
    let free = closed.inputs().iter().map(|i| u[names.iter().position(|n| **n == i.signal.name).expect("an input")]).collect();
    (closed, start, free)
}

/// Eigenvalues of the vehicle alone with its speed and the spins of its wheels held.
fn held(state: &State) -> Vec<Complex<f64>> {
    let model = state.linear();
    let name = |k: &usize| model.states[*k].signal.name.as_str();
    let kept: Vec<usize> =
        (0..model.states.len()).filter(|k| name(k) != "chassis.forward_speed" && !name(k).ends_with("_wheel.spin_rate")).collect();
    let part = |m: &DMatrix<f64>| DMatrix::from_fn(kept.len(), kept.len(), |i, j| m[(kept[i], kept[j])]);
    let own = part(&model.E).lu().solve(&part(&model.A)).expect("inertia");
    own.complex_eigenvalues().iter().copied().collect()
}

/// Finite eigenvalues of `E δẏ = A δy`, all positions among the unknowns: the rider knows where he is.
fn eigenvalues(plant: &mut ClosedLoop<TreePlant>, at: At<'_>) -> Vec<Complex<f64>> {
    const SHIFT: f64 = 60.0;
    let (n, nu, nz) = (at.y.len(), at.u.len(), plant.outputs().len());
    let mut derivatives = |by_rates: bool| {
        let mut seeds = Seeds::zeros(n, nu, n);
        let seeded = if by_rates { &mut seeds.yd } else { &mut seeds.y };
        (0..n).for_each(|k| seeded[(k, k)] = 1.0);
        let (mut rows, mut outputs) = (Matrix::zeros(n, n), Matrix::zeros(nz, n));
        plant.along(at, &seeds, (&mut vec![0.0; n], &mut vec![0.0; nz]), &mut rows, &mut outputs).expect("evaluable");
        DMatrix::from_fn(n, n, |i, j| rows[(i, j)])
    };
    let (E, A) = (derivatives(true), -derivatives(false));
    let inverse = (&E * SHIFT - A).lu().solve(&E).expect("no eigenvalue at the shift");
    let values = inverse.complex_eigenvalues();
    values.iter().filter(|m| m.norm() > 1e-7).map(|m| Complex::new(SHIFT, 0.0) - m.inv()).collect()
}

#[test]
fn the_loops_that_ride_are_those_of_the_design() {
    let mut agreement = Agreement::on("two loops: poles");
    for (model, speed) in [("ref11", 15.0), ("ref11", 30.0), ("gsxr1000", 15.0), ("gsxr1000", 30.0)] {
        let state = Vehicle::bundled(model).state(&running(&[speed]));
        let designed = designed(&state, speed, &[("straight", "{ length: 200 m }".to_owned())]);
        let near = |node: &&fastbike::rider::Node| (node.speed - speed).abs() + node.lateral_acceleration.abs();
        let node = designed.nodes.iter().min_by(|a, b| near(a).total_cmp(&near(b))).expect("nodes");
        // what the steering does not move is bounce and pitch, in which speed and spins take part that the design holds
        let unmoved = held(&Vehicle::bundled(model).state(&running(&[node.speed])));
        let moved = |s: &Complex<f64>| unmoved.iter().all(|u| (u - s).norm() > 1e-4 * s.norm());
        let poles: Vec<Complex<f64>> =
            node.regulator.closed.iter().copied().filter(|s| s.im >= 0.0 && s.norm() < 30.0 && moved(s)).collect();
        agreement.holds(&format!("{model}, {speed} m/s: {} poles are moved", poles.len()), poles.len() >= 5);
        let (mut closed, y, u) = ridden(&state, designed);
        let mut yd = vec![0.0; y.len()];
        yd[..state.point.rates.len()].copy_from_slice(&state.point.rates);
        let station = closed.unknowns().iter().position(|k| k.signal.name == "rider.station").expect("a station");
        yd[station] = speed;
        let found = eigenvalues(&mut closed, At { time: 0.0, y: &y, yd: &yd, u: &u });
        agreement.holds(&format!("{model}, {speed} m/s: nothing grows"), found.iter().all(|s| s.re < 1e-6));
        for pole in poles {
            let distance = found.iter().map(|s| (s - pole).norm()).fold(f64::INFINITY, f64::min);
            let interpolated = absolute(0.05 * pole.norm()).because("gains are interpolated between speeds");
            agreement.near(&format!("{model}, {speed} m/s: pole {pole:.3}"), distance, 0.0, &interpolated);
        }
    }
    agreement.assert();
}

#[test]
fn lanes_are_changed_by_two_loops() {
    const WIDTH: f64 = 3.6;
    let mut agreement = Agreement::on("two loops: lane changes");
    for (model, speed) in [15.0, 20.0, 25.0, 30.0, 35.0].into_iter().flat_map(|v| [("ref11", v), ("gsxr1000", v)]) {
        let state = Vehicle::bundled(model).state(&running(&[speed]));
        // the length over which the acceleration across the lane reaches 5 m/s²
        let length = (10.0 * WIDTH * speed * speed / (3f64.sqrt() * 5.0)).sqrt();
        let path = [
            ("straight", format!("{{ length: {speed} }}")),
            ("lane_change", format!("{{ width: {WIDTH}, length: {length} }}")),
            ("straight", format!("{{ length: {} }}", 6.0 * speed)),
        ];
        let (mut closed, y, u) = ridden(&state, designed(&state, speed, &path));
        let mut transient = Transient::new(&closed, evenly(6.0, 601));
        transient.start = Start { held: vec![false; y.len()], y };
        let simulation = By::Ida(1e-6, 1.0).run(transient, &mut closed, &Driven::new(u));
        agreement.holds(&format!("{model}, {speed} m/s: {:?}", simulation.ending), simulation.ending.reached());
        let offset = simulation.trajectory.column("rider.path_error").expect("recorded");
        let largest = offset.iter().fold(0.0, |m: f64, e| m.max(e.abs()));
        agreement.near(&format!("{model}, {speed} m/s: offset, m"), largest, 0.0, &absolute(0.5).because("theory manual 10.3"));
        let lean = simulation.trajectory.column("chassis.roll").expect("recorded").iter().fold(0.0, |m: f64, r| m.max(r.abs()));
        agreement.holds(&format!("{model}, {speed} m/s: it leans by {lean} rad"), lean > 0.25);
    }
    agreement.assert();
}
