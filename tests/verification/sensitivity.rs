//! Sensitivities against eigenvalues and steady states that are computed anew with other parameters.

use analyses::Sensitivity;
use analyses::eigen::eigen;
use fastbike::family::Vehicles;
use fastbike::library::Source;
use fastbike::plan::Request;
use fastbike::{standard_kinds, steady};
use mbody::assembly::Blueprint;
use nalgebra::Complex;
use validation::agreement::{Agreement, absolute};
use validation::evidence::Row;
use validation::vehicle::{State, Vehicle, accelerating, leaning, running};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    whole_models_made_anew_move_as_predicted => (
        "sensitivities of all eigenvalues and signals of `moto11` and `ref11`, straight, leaning and braking, by masses, places of joints, springs, tires",
        "steady states and eigenvalues of models that were read, assembled and trimmed anew; extrapolated central differences",
        "relative 1e-6 of the derivative and of the value over the parameter: tolerance of the trims over the step"
    ),
];

const MOTO11: &[&str] = &["link.chassis.mass", "joint.steer.origin.x", "steering_damper.coefficient", "front_tire.cornering_stiffness"];
const REF11: &[&str] =
    &["link.chassis.com.z", "joint.steer.rpy.p", "rear_suspension.spring.stiffness", "rear_tire.carcass.deformable.lateral.stiffness"];

/// Eigenvalues of a model with one entry changed, in the order of known ones; then all signals.
fn anew(name: &str, path: &str, value: f64, request: &Request, known: &[Complex<f64>]) -> (Vec<Complex<f64>>, Vec<f64>) {
    let state = Vehicle::with(name, &[(path, &format!("{value:?}"))]).state(request);
    let spectrum = eigen(&state.linear()).unwrap_or_else(|error| panic!("{error}"));
    let nearest = |s: &Complex<f64>| {
        let distance = |z: &Complex<f64>| (z - s).norm();
        spectrum.values.iter().copied().min_by(|a, b| distance(a).total_cmp(&distance(b))).expect("an eigenvalue")
    };
    (known.iter().map(nearest).collect(), state.point.values)
}

/// Central differences with steps h, h/2 and h/4, extrapolated: eigenvalues that lie close together bend sharply.
fn extrapolated<T>(at: &dyn Fn(f64) -> Vec<T>, h: f64) -> Vec<T>
where
    T: Copy + std::ops::Sub<Output = T> + std::ops::Add<Output = T> + std::ops::Mul<f64, Output = T>,
{
    let central = |h: f64| -> Vec<T> { at(h).into_iter().zip(at(-h)).map(|(up, down)| (up - down) * (0.5 / h)).collect() };
    let finer = |coarse: Vec<T>, fine: Vec<T>, power: f64| -> Vec<T> {
        coarse.into_iter().zip(fine).map(|(a, b)| b + (b - a) * (1.0 / (power - 1.0))).collect()
    };
    let [a, b, c] = [h, 0.5 * h, 0.25 * h].map(central);
    finer(finer(a, b.clone(), 4.0), finer(b, c, 4.0), 16.0)
}

fn compare(agreement: &mut Agreement, name: &str, what: &str, request: &Request, paths: &[&str]) {
    let (source, kinds) = (Source::find(name).expect("a bundled model"), standard_kinds());
    let blueprint = Blueprint::read(&source.file, &source, &kinds, &[]).0.expect("a description");
    let family = Vehicles::of(&blueprint, &source, &kinds, false);
    let vehicle = Vehicle::bundled(name);
    let state: State = vehicle.state(request);
    let trim = steady::trim_at(request, &vehicle.system, &state.point).unwrap_or_else(|failure| panic!("{failure}"));
    let sensitivity = state.at(|at| Sensitivity::at(&family, &trim, at, &[])).unwrap_or_else(|error| panic!("{error}"));
    for path in paths {
        let id = family.find(path).unwrap_or_else(|| panic!("no parameter `{path}`"));
        let value = problem::Family::parameters(&family)[id.0].value;
        let found = sensitivity.by(id).unwrap_or_else(|error| panic!("{error}"));
        let known = &sensitivity.spectrum.values;
        let h = 4e-3 * value.abs();
        let slopes = extrapolated(&|d| anew(name, path, value + d, request, known).0, h);
        for ((found, slope), s) in found.eigenvalues.iter().zip(slopes).zip(known) {
            let found = found.expect("an eigenvalue of its own").value;
            let close = absolute(1e-6 * slope.norm().max(s.norm() / value.abs())).because("1e-10 of the trims over steps of 4e-3 and less");
            agreement.near(&format!("{name} {what}, {path}, {s:.3}: real part"), found.re, slope.re, &close);
            agreement.near(&format!("{name} {what}, {path}, {s:.3}: imaginary part"), found.im, slope.im, &close);
        }
        let slopes = extrapolated(&|d| anew(name, path, value + d, request, known).1, h);
        let signals = found.unknowns.iter().chain(&found.inputs).chain(&found.outputs);
        for ((found, slope), (signal, at)) in signals.zip(slopes).zip(state.signals.iter().zip(&state.point.values)) {
            let size = slope.abs().max(at.abs().max(1e-2) / value.abs());
            let close = absolute(1e-6 * size).because("1e-10 of the trims over steps of 4e-3 and less");
            agreement.near(&format!("{name} {what}, {path}: {}", signal.name), found.value, slope, &close);
        }
    }
}

#[test]
fn whole_models_made_anew_move_as_predicted() {
    let mut agreement = Agreement::on("sensitivities: models made anew");
    for (name, paths) in [("moto11", MOTO11), ("ref11", REF11)] {
        compare(&mut agreement, name, "straight", &running(&[30.0]), paths);
        compare(&mut agreement, name, "leaning", &leaning(&[25.0], &[0.5]), paths);
        let braking = Request { front_brake_share: 0.7, ..accelerating(running(&[35.0]), -3.0) };
        compare(&mut agreement, name, "braking", &braking, paths);
    }
    agreement.assert();
}

/// What a user overrides by the path of a parameter is this parameter and no other.
#[test]
fn paths_of_parameters_are_those_of_overrides() {
    for name in ["moto11", "ref11", "gsxr1000", "whipple", "gsxr1000_linkage"] {
        let (source, kinds) = (Source::find(name).expect("a bundled model"), standard_kinds());
        let read = |overrides: &[(String, String)]| {
            let (blueprint, findings) = Blueprint::read(&source.file, &source, &kinds, overrides);
            blueprint.unwrap_or_else(|| panic!("{name}: {findings}"))
        };
        let before = read(&[]);
        assert!(before.entries().len() > 30, "{name} has {} parameters", before.entries().len());
        // every fourth will do: names of all sections and of both files are among them; a link without inertia takes no single moment
        for (k, entry) in before.entries().iter().enumerate().filter(|(_, e)| e.value != 0.0 && !e.derived).step_by(4) {
            let value = 1.001 * entry.value;
            let after = read(&[(entry.path.clone(), format!("{value:?}"))]);
            // what follows from others may move with them
            for (i, (old, new)) in before.entries().iter().zip(after.entries()).enumerate().filter(|(_, (e, _))| !e.derived) {
                assert_eq!(new.value, if i == k { value } else { old.value }, "{name}: {} by {}", old.path, entry.path);
            }
        }
    }
}
