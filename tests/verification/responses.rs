//! Frequency responses of assembled vehicles: the matrices solved as they stand, and a road that is followed slowly.

use analyses::{Excitation, FrequencyResponse, LinearModel, linearize};
use fastbike::plan::Request;
use mbody::dynamics::{Formulation, TreePlant};
use nalgebra::{Complex, DMatrix};
use problem::{At, Dae};
use std::f64::consts::TAU;
use validation::agreement::{Agreement, relative};
use validation::evidence::Row;
use validation::vehicle::{Vehicle, leaning, running};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    responses_are_those_of_the_matrices => (
        "frequency responses of every state to every input in a turn of `ref11`, `gsxr1000` and (with a loop) `gsxr1000_linkage`, 0.05 to 80 Hz, \
         roads with their rates",
        "complex LU of `jωE − A` as it stands",
        "1e-9 of the largest response of the state: double precision over the condition of the matrices"
    ),
    slow_roads_are_followed => (
        "`ref11` and `gsxr1000` follow a road that rises slowly under both wheels: heave over height is one, the acceleration of the saddle is that of the road",
        "statics",
        "1e-3: the road is not quite the same under both wheels"
    ),
];

fn model(name: &str, request: &Request) -> LinearModel {
    let state = Vehicle::bundled(name).state(request);
    let mut plant = TreePlant::in_formulation(state.system.clone(), Formulation::Ggl);
    let (y, u) = state.arguments();
    let padded = |values: &[f64]| {
        let mut values = values.to_vec();
        values.resize(plant.unknowns().len(), 0.0);
        values
    };
    let (y, yd) = (padded(y), padded(&state.point.rates));
    linearize(&mut plant, At { time: 0.0, y: &y, yd: &yd, u }, &Default::default()).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn responses_are_those_of_the_matrices() {
    let mut agreement = Agreement::on("frequency responses: direct solution");
    let double = relative(1e-9).because("double precision over the condition of the matrices");
    for name in ["ref11", "gsxr1000", "gsxr1000_linkage"] {
        let model = model(name, &leaning(&[25.0], &[0.4]));
        let values: Vec<usize> = (0..model.inputs.len()).filter(|k| model.inputs.iter().all(|i| i.rate != Some(*k))).collect();
        let excitations: Vec<Excitation> = values.iter().map(|&k| Excitation::input(model.inputs[k].signal.name.clone())).collect();
        let states: Vec<String> = model.states.iter().map(|s| s.signal.name.clone()).collect();
        let mut response = FrequencyResponse::of(&model, &excitations, &states).unwrap_or_else(|error| panic!("{error}"));
        let mut found = vec![Complex::new(0.0, 0.0); excitations.len() * states.len()];
        let complex = |m: &DMatrix<f64>| m.map(|e| Complex::new(e, 0.0));
        for frequency in [0.05, 0.7, 3.0, 9.0, 25.0, 80.0] {
            let s = Complex::new(0.0, TAU * frequency);
            let B = DMatrix::from_fn(model.states.len(), values.len(), |i, k| {
                let by_rate = model.inputs[values[k]].rate.map_or(0.0, |rate| model.B[(i, rate)]);
                Complex::new(model.B[(i, values[k])], 0.0) + s * by_rate
            });
            let direct = (complex(&model.E) * s - complex(&model.A)).lu().solve(&B).expect("no undamped mode");
            response.at(TAU * frequency, &mut found);
            for i in 0..states.len() {
                let parts = |of: &dyn Fn(usize) -> Complex<f64>| -> Vec<f64> {
                    // in typical sizes of the inputs
                    (0..values.len()).flat_map(|k| [of(k).re, of(k).im].map(|part| part * model.inputs[values[k]].nominal)).collect()
                };
                let (found, direct) = (parts(&|k| found[k * states.len() + i]), parts(&|k| direct[(i, k)]));
                agreement.all_near(&format!("{name}: {} at {frequency} Hz", states[i]), &found, &direct, &double);
            }
        }
    }
    agreement.assert();
}

#[test]
fn slow_roads_are_followed() {
    let mut agreement = Agreement::on("frequency responses: slow roads");
    let same = relative(1e-3).because("the road is not quite the same under both wheels");
    for name in ["ref11", "gsxr1000"] {
        let speed = 30.0;
        let state = Vehicle::bundled(name).state(&running(&[speed]));
        let delay = state.get("wheelbase") / speed;
        let road = Excitation::delayed("road", [("front_road.height".to_owned(), 0.0), ("rear_road.height".to_owned(), delay)]);
        let answers = ["chassis.heave", "saddle.acceleration_z"].map(str::to_owned);
        let mut response = FrequencyResponse::of(&state.linear(), &[road], &answers).unwrap_or_else(|error| panic!("{error}"));
        let mut found = [Complex::new(0.0, 0.0); 2];
        let omega = TAU * 0.01;
        response.at(omega, &mut found);
        agreement.near(&format!("{name}: heave"), found[0].norm(), 1.0, &same);
        agreement.near(&format!("{name}: acceleration"), found[1].norm(), omega * omega, &same);
    }
    agreement.assert();
}
