//! Machines without published numbers to compare with: what their sources say of them in words and ranges, and modes that keep their names.

use fastbike::output::modes::{ModesAlong, NamedMode};
use fastbike::small_motions::{Shapes, SmallMotions};
use fastbike::steady;
use nalgebra::Complex;
use std::f64::consts::TAU;
use validation::agreement::Agreement;
use validation::evidence::Row;
use validation::vehicle::{Vehicle, running};

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    hands_on_the_bar_damp_the_wobble => (
        "`sharp1994`: a rider who holds the handlebar damps the wobble, at every speed from 5 to 60 m/s",
        "Sharp (1994), in words",
        "a higher damping ratio at each of 12 speeds"
    ),
    modes_are_where_they_are_published => (
        "`sl2001`, `sharp1994`, `sport_tourer`: weave below 4 Hz, wobble 6 to 10 Hz from 10 to 60 m/s; `sl2001`: hops 10 to 15 Hz",
        "ranges of Sharp, Limebeer (2001); Sharp, Evangelou, Limebeer (2004)",
        "within the range at each speed"
    ),
    flexible_motorcycles_keep_the_names_of_their_modes => (
        "`gsxr1000` with rider lean and four flexibilities, 5 to 80 m/s: seven oscillations keep their names; weave and rider lean exchange them once, where they veer",
        "continuity of eigenvalues",
        "neighboring eigenvalues of a name within 3 1/s per m/s"
    ),
];

/// Modes along speeds, by the way of `modes`.
fn along(vehicle: &Vehicle, speeds: &[f64]) -> ModesAlong {
    let (request, system) = (running(speeds), vehicle.system.clone());
    let steady = steady::run(&request, &system, "kinsol", "modes").unwrap_or_else(|failure| panic!("{failure}"));
    let small = SmallMotions { request: &request, system: &system, backend: "kinsol", residual_tolerance: 1e-6 };
    small.along(&steady, Shapes::LeftOut).unwrap_or_else(|failure| panic!("{failure}"))
}

/// The oscillation of a name at a point.
fn the<'a>(modes: &'a ModesAlong, point: usize, name: &str) -> &'a NamedMode {
    let all = &modes.points[point].as_ref().unwrap_or_else(|because| panic!("{because}")).modes;
    let mut found = all.iter().filter(|m| m.name == name && m.value.im > 0.0);
    match (found.next(), found.next()) {
        (Some(mode), None) => mode,
        (first, _) => panic!("{} modes are called `{name}` at point {point}", if first.is_some() { "several" } else { "no" }),
    }
}

fn frequency(z: Complex<f64>) -> f64 {
    z.norm() / TAU
}

#[test]
fn hands_on_the_bar_damp_the_wobble() {
    let speeds: Vec<f64> = (1..=12).map(|k| 5.0 * f64::from(k)).collect();
    let on = along(&Vehicle::bundled("sharp1994"), &speeds);
    let off = Vehicle::with("sharp1994", &[("hands.spring.stiffness", "0"), ("hands.damper.coefficient", "1")]);
    let off = along(&off, &speeds);
    let mut agreement = Agreement::on("sharp1994: hands on the bar");
    for (k, speed) in speeds.iter().enumerate() {
        let [on, off] = [&on, &off].map(|modes| the(modes, k, "wobble").damping_ratio);
        agreement.holds(&format!("{speed} m/s: {on} with hands, {off} without"), on > off);
    }
    agreement.assert();
}

#[test]
fn modes_are_where_they_are_published() {
    let speeds: Vec<f64> = (2..=12).map(|k| 5.0 * f64::from(k)).collect();
    let mut agreement = Agreement::on("sl2001, sharp1994, sport_tourer: ranges");
    for name in ["sl2001", "sharp1994", "sport_tourer"] {
        let modes = along(&Vehicle::bundled(name), &speeds);
        let mut ranges = vec![("weave", 0.2, 4.0), ("wobble", 6.0, 10.0)];
        if name == "sl2001" {
            ranges.extend([("front hop", 10.0, 15.0), ("rear hop", 10.0, 15.0)]);
        }
        for (k, speed) in speeds.iter().enumerate() {
            for &(mode, low, high) in &ranges {
                let f = frequency(the(&modes, k, mode).value);
                agreement.holds(&format!("{name} at {speed} m/s: {mode} {f} Hz"), (low..=high).contains(&f));
            }
        }
    }
    agreement.assert();
}

#[test]
fn flexible_motorcycles_keep_the_names_of_their_modes() {
    let joints = ["rider_lean", "frame_torsion", "fork_bending", "fork_torsion", "swingarm_torsion"].map(|j| format!("joint.{j}.locked"));
    let unlocked: Vec<(&str, &str)> = joints.iter().map(|path| (path.as_str(), "false")).collect();
    let speeds: Vec<f64> = (5..=80).map(f64::from).collect();
    let modes = along(&Vehicle::with("gsxr1000", &unlocked), &speeds);
    let mut agreement = Agreement::on("gsxr1000 with flexibilities: names");
    let mut exchanges = 0;
    for k in 1..speeds.len() {
        let near = |before: &str, after: &str| (the(&modes, k, after).value - the(&modes, k - 1, before).value).norm() < 3.0;
        for name in ["wobble", "frame twist", "fork bending", "fork twist", "swingarm twist"] {
            agreement.holds(&format!("{name} at {} m/s", speeds[k]), near(name, name));
        }
        let (weave, lean) = ("weave", "rider lean");
        let kept = near(weave, weave) && near(lean, lean);
        exchanges += usize::from(!kept);
        agreement.holds(&format!("{weave} and {lean} at {} m/s", speeds[k]), kept || (near(weave, lean) && near(lean, weave)));
    }
    agreement.holds("one exchange", exchanges == 1);
    agreement.assert();
}
