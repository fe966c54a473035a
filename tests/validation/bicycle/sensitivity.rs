//! How the eigenvalues of the benchmark bicycle move with its masses, inertias, mass centers, trail and wheelbase.

use super::formulas::{BENCHMARK, Bicycle};
use analyses::Sensitivity;
use fastbike::family::Vehicles;
use fastbike::library::Source;
use fastbike::{standard_kinds, steady};
use mbody::assembly::Blueprint;
use nalgebra::Complex;
use problem::At;
use validation::agreement::{Agreement, absolute};
use validation::evidence::Row;
use validation::vehicle::{Vehicle, running};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    eigenvalues_move_as_the_formulas_say => (
        "`whipple`: derivatives of weave, capsize and caster eigenvalues by 18 masses, inertias, mass centers, gravity, trail and wheelbase, 2 to 8 m/s",
        "Meijaard et al. (2007), appendix A: derivative of the characteristic polynomial",
        "relative 1e-8 of the derivative and of the eigenvalue over the parameter: extrapolated differences of exact matrices"
    ),
];

/// What a change of entries of our model does to a parameter of the paper.
type Change = (&'static [(&'static str, f64)], fn(&mut Bicycle, f64));

const SIN: f64 = 0.309_016_994_374_947_4;
const COS: f64 = 0.951_056_516_295_153_5;

/// Tensor entries xz and heights change their sign, z is down in the paper. Points of the front assembly are written along the steering axis: x of
/// the paper is x′ cos λ − z′ sin λ, z of the paper −(x′ sin λ + z′ cos λ).
const CHANGES: &[Change] = &[
    (&[("gravity", 1.0)], |b, d| b.g += d),
    (&[("link.chassis.mass", 1.0)], |b, d| b.m_B += d),
    (&[("link.chassis.com.x", 1.0)], |b, d| b.x_B += d),
    (&[("link.chassis.com.z", 1.0)], |b, d| b.z_B -= d),
    (&[("link.chassis.inertia.ixx", 1.0)], |b, d| b.IB_xx += d),
    (&[("link.chassis.inertia.ixz", 1.0)], |b, d| b.IB_xz -= d),
    (&[("link.chassis.inertia.izz", 1.0)], |b, d| b.IB_zz += d),
    (&[("link.rear_wheel_rim.mass", 1.0)], |b, d| b.m_R += d),
    (&[("link.rear_wheel_rim.inertia.iyy", 1.0)], |b, d| b.IR_yy += d),
    (&[("link.front_frame.mass", 1.0)], |b, d| b.m_H += d),
    (&[("link.front_frame.com.x", COS), ("link.front_frame.com.z", -SIN)], |b, d| b.x_H += d),
    (&[("link.front_frame.com.x", -SIN), ("link.front_frame.com.z", -COS)], |b, d| b.z_H += d),
    (&[("link.front_frame.inertia.ixx", 1.0)], |b, d| b.IH_xx += d),
    (&[("link.front_frame.inertia.ixz", 1.0)], |b, d| b.IH_xz -= d),
    (&[("link.front_frame.inertia.izz", 1.0)], |b, d| b.IH_zz += d),
    (&[("link.front_wheel_rim.mass", 1.0)], |b, d| b.m_F += d),
    (&[("link.front_wheel_rim.inertia.iyy", 1.0)], |b, d| b.IF_yy += d),
    // the axis moves ahead of wheel and front frame
    (
        &[
            ("joint.steer.origin.x", 1.0),
            ("joint.front_wheel.origin.x", -COS),
            ("joint.front_wheel.origin.z", SIN),
            ("link.front_frame.com.x", -COS),
            ("link.front_frame.com.z", SIN),
        ],
        |b, d| b.c += d,
    ),
    // axis and wheel move ahead of the front frame
    (&[("joint.steer.origin.x", 1.0), ("link.front_frame.com.x", -COS), ("link.front_frame.com.z", SIN)], |b, d| b.w += d),
];

/// `s′ = −(∂D/∂p) / (∂D/∂s)` of the characteristic polynomial D, whose derivatives are central differences: D is a polynomial of low degree in s, and
/// smooth in every parameter.
fn slope(s: Complex<f64>, speed: f64, change: fn(&mut Bicycle, f64)) -> Complex<f64> {
    let with = |d: f64| {
        let mut bicycle = BENCHMARK;
        change(&mut bicycle, d);
        bicycle.characteristic(s, speed)
    };
    let at = |d: f64| BENCHMARK.characteristic(s + d, speed);
    let extrapolated = |f: &dyn Fn(f64) -> Complex<f64>, h: f64| {
        let central = |h: f64| (f(h) - f(-h)) / (2.0 * h);
        let [a, b, c] = [central(h), central(0.5 * h), central(0.25 * h)];
        let [ab, bc] = [b + (b - a) / 3.0, c + (c - b) / 3.0];
        bc + (bc - ab) / 15.0
    };
    -extrapolated(&with, 2e-3) / extrapolated(&at, 2e-2 * s.norm().max(0.1))
}

#[test]
fn eigenvalues_move_as_the_formulas_say() {
    let mut agreement = Agreement::on("whipple: sensitivities");
    let (source, kinds) = (Source::find("whipple").expect("a bundled model"), standard_kinds());
    let (blueprint, _) = Blueprint::read(&source.file, &source, &kinds, &[]);
    let blueprint = blueprint.expect("a description");
    let family = Vehicles::of(&blueprint, &source, &kinds, false);
    let bicycle = Vehicle::bundled("whipple");
    for speed in [2.0, 5.0, 8.0] {
        let request = running(&[speed]);
        let state = bicycle.state(&request);
        let trim = steady::trim_at(&request, &bicycle.system, &state.point).unwrap_or_else(|failure| panic!("{failure}"));
        let states = ["chassis.roll", "steer.angle", "chassis.roll_rate", "steer.rate"].map(str::to_owned);
        let sensitivity = state.at(|at: At<'_>| Sensitivity::at(&family, &trim, at, &states)).unwrap_or_else(|error| panic!("{error}"));
        let by = |path: &str| {
            let id = family.find(path).unwrap_or_else(|| panic!("no parameter `{path}`"));
            sensitivity.by(id).unwrap_or_else(|error| panic!("{error}"))
        };
        for (entries, change) in CHANGES {
            let all: Vec<_> = entries.iter().map(|(path, factor)| (by(path), *factor)).collect();
            for (slot, &s) in sensitivity.spectrum.values.iter().enumerate().filter(|(_, s)| s.norm() > 1e-6) {
                let of_entry = |(by, factor): &(analyses::sensitivity::Derivatives, f64)| {
                    by.eigenvalues[slot].expect("an eigenvalue of its own").value * *factor
                };
                let found: Complex<f64> = all.iter().map(of_entry).sum();
                let expected = slope(s, speed, *change);
                let what = format!("{speed} m/s, {s:.3}, {}", entries.iter().map(|e| e.0).collect::<Vec<_>>().join(" and "));
                let close = absolute(1e-8 * expected.norm().max(s.norm())).because("extrapolated differences of exact matrices");
                agreement.near(&what, found.re, expected.re, &close);
                agreement.near(&what, found.im, expected.im, &close);
            }
        }
    }
    agreement.assert();
}
