//! Smoothness, symmetry, special cases; forces against other programs stand in `tests/validation/tire_property_files.rs`.

use super::*;
use crate::tire::conformity;
use crate::tire::tir;
use mbody::description::finding::Findings;

/// What all dialects share: invented numbers of the size of a motorcycle tire.
const SHARED: &str = "
[UNITS]
LENGTH = 'meter'
[MODEL]
LONGVL = 16.7
VXLOW = 1
[DIMENSION]
UNLOADED_RADIUS = 0.3
[VERTICAL]
FNOMIN = 1400
VERTICAL_STIFFNESS = 150000
[INCLINATION_ANGLE_RANGE]
CAMMIN = -0.8
CAMMAX = 0.8
[VERTICAL_FORCE_RANGE]
FZMIN = 200
FZMAX = 2600
[LONGITUDINAL_COEFFICIENTS]
PCX1 = 1.6
PDX1 = 1.3
PDX2 = -0.05
PEX1 = 0.1
PEX2 = 0.2
PEX4 = 0.3
PKX1 = 25
PKX2 = -2
PKX3 = 0.2
RBX1 = 12
RBX2 = 10
RCX1 = 1.1
REX1 = -0.5
PTX1 = 0.8
PTX2 = -0.1
PTX3 = -0.2
[OVERTURNING_COEFFICIENTS]
QSX2 = 0.3
QSX3 = 0.05
[LATERAL_COEFFICIENTS]
PDY1 = 1.25
PDY2 = -0.04
RBY1 = 8
RBY2 = 7
RCY1 = 1.05
RHY1 = 0.003
RVY3 = 0.1
RVY4 = 8
RVY5 = 1.5
RVY6 = 10
PTY1 = 0.9
PTY2 = 1.8
PTY3 = 2
[ROLLING_COEFFICIENTS]
QSY1 = 0.01
QSY3 = 0.002
QSY4 = 0.0001
[ALIGNING_COEFFICIENTS]
QBZ1 = 9
QBZ2 = -0.3
QBZ5 = -0.1
QBZ9 = 15
QBZ10 = 0.1
QCZ1 = 1.1
QDZ1 = 0.06
QDZ2 = 0.01
QDZ4 = 0.1
QDZ8 = -0.08
QDZ9 = -0.01
QEZ1 = -1
QEZ2 = 0.1
QEZ5 = 0.4
QHZ3 = 0.05
SSZ2 = 0.01
SSZ3 = -0.1
";

/// Camber in the words of each dialect.
const OWN: [(&str, &str); 4] = [
    (
        "52",
        "FITTYP = 52\nPCY1 = 1.3\nPEY1 = -0.6\nPEY2 = 0.1\nPEY4 = -1\nPKY1 = -22\nPKY2 = 1.6\nPKY3 = 0.1\nPDY3 = 0.05\nPHY3 = 0.06\nPVY3 = -0.3\n",
    ),
    (
        "MC",
        "PROPERTY_FILE_FORMAT = 'PAC_MC'\nPCY1 = 0.9\nPCY2 = 0.85\nPEY1 = -1.2\nPEY2 = -2\nPEY4 = 3\nPEY5 = -8\nPKY1 = -22\nPKY2 = 2\nPKY3 = 1.8\nPKY4 = 0.1\nPKY5 = 0.1\n\
         PKY6 = -0.8\nPKY7 = 0.05\nPDY3 = -0.05\nQDZ3 = 0.2\nQDZ10 = 0.1\n",
    ),
    (
        "61",
        "FITTYP = 61\nPCY1 = 1.3\nPEY1 = -0.6\nPEY4 = -1\nPEY5 = 0.2\nPKY1 = -22\nPKY2 = 1.6\nPKY4 = 1.9\nPKY5 = 0.2\nPKY6 = -0.9\nPVY3 = -0.3\nRBX3 = 1\nRBY4 = 2\n",
    ),
    (
        "62",
        "FITTYP = 62\nPCY1 = 1.3\nPKY1 = -22\nPKY2 = 1.6\nPKY4 = 1.9\nPKY6 = -0.9\nQSX4 = 0.2\nQSX5 = 0.5\nQSX6 = 1\nQSX7 = 0.4\nQSX8 = 1\nQSX9 = 0.5\nQSX12 = 0.1\nQSY7 = 0.9\nNOMPRES = 200000\nINFLPRES = 220000\nPPX1 = -0.3\nPPY1 = 0.3\nQSY8 = -0.4\n",
    ),
];

fn law_of(own: &str, usage: Usage) -> MagicFormula {
    let mut findings = Findings::new();
    let file = tir::read("test.tir", &format!("{SHARED}[MODEL]\n{own}"), usage.axes, &mut findings).unwrap_or_else(|| panic!("{findings}"));
    MagicFormula::new(file.coefficients, file.dialect, usage)
}

fn slip(lateral: f64, longitudinal: f64, camber: f64) -> Slip<f64> {
    Slip { load: 1300.0, lateral, longitudinal, camber, speed: 20.0 }
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * a.abs().max(1.0)
}

#[test]
fn every_dialect_conforms_inside_and_outside_its_range() {
    for (name, own) in OWN {
        for beyond in [BeyondFit::Extrapolate, BeyondFit::Hold] {
            let law = law_of(own, Usage { side: Side::Symmetric, beyond, ..Usage::default() });
            let found = law.dialect().name.replace(['.', '_'], "");
            assert!(found.ends_with(name), "{name}: {found}");
            conformity::holds(&law);
        }
    }
}

/// Coefficients that tell left from right, all at once.
const LOPSIDED: &str = "RHX1 = 0.01\nQSX1 = 0.02\nPEY3 = 0.1\nPHY1 = 0.003\nPVY1 = 0.02\nRBY3 = 0.02\nRVY1 = 0.05\nQBZ4 = 0.2\nQDZ6 = 0.004\nQEZ4 = 0.1\nQHZ1 = 0.004\nSSZ1 = 0.02\n";

#[test]
fn a_tire_on_the_other_side_is_the_mirror_image() {
    for (name, own) in OWN {
        let own = format!("{own}{LOPSIDED}");
        let [measured, mirrored, symmetric] =
            [Side::Measured, Side::Mirrored, Side::Symmetric].map(|side| law_of(&own, Usage { side, ..Usage::default() }));
        let f = measured.friction(&slip(0.04, -0.03, 0.2));
        let m = mirrored.friction(&slip(-0.04, -0.03, -0.2));
        let pairs = [
            (f.longitudinal, m.longitudinal),
            (f.lateral, -m.lateral),
            (f.overturning_moment, -m.overturning_moment),
            (f.rolling_moment, m.rolling_moment),
            (f.aligning_moment, -m.aligning_moment),
        ];
        assert!(pairs.iter().all(|(a, b)| near(*a, *b)), "{name}: {pairs:?}");
        // it does tell left from right, and its symmetric use does not
        let other = measured.friction(&slip(-0.04, -0.03, -0.2));
        assert!((f.lateral + other.lateral).abs() > 1.0, "{name}");
        conformity::left_is_right_mirrored(&symmetric);
    }
}

/// The same tire in axes with y to the right has its stiffnesses with the other sign.
#[test]
fn axes_of_the_file_do_not_matter() {
    for (name, own) in OWN {
        let positive =
            own.replace("PKY1 = -", "PKY1 = ").replace("PKY6 = -", "PKY6 = ").replace("PVY3 = -", "PVY3 = ").replace("PKY7 = ", "PKY7 = -");
        let there = law_of(&positive, Usage { axes: FileAxes::AdaptedSae, ..Usage::default() });
        let here = law_of(own, Usage::default());
        let (a, b) = (there.friction(&slip(0.05, 0.0, 0.0)), here.friction(&slip(0.05, 0.0, 0.0)));
        assert!(near(a.lateral, b.lateral) && a.lateral > 0.0, "{name}: {} {}", a.lateral, b.lateral);
        let (a, b) = (there.friction(&slip(0.0, 0.0, 0.1)), here.friction(&slip(0.0, 0.0, 0.1)));
        // a tire that leans to the right pushes to the right
        assert!(near(a.lateral, b.lateral) && a.lateral < 0.0, "{name}: {} {}", a.lateral, b.lateral);
    }
}

/// Without camber, pressure and the newer coefficients 6.1 is 5.2, if it is asked the tangent for the angle.
#[test]
fn version_5_2_is_a_special_case_of_6_1() {
    let own = "PCY1 = 1.3\nPEY1 = -0.6\nPEY2 = 0.1\nPKY1 = -22\nPKY2 = 1.6\nPVY1 = 0.02\nPHY1 = 0.002\nPHX1 = 0.001\nRVY1 = 0.05\n";
    let old = law_of(&format!("FITTYP = 52\n{own}"), Usage::default());
    let new = law_of(&format!("FITTYP = 61\nPKY4 = 2\n{own}"), Usage::default());
    for angle in [-0.2, -0.03, 0.0, 0.05, 0.15_f64] {
        for kappa in [-0.1, 0.0, 0.04] {
            let (a, b) = (old.friction(&slip(angle.tan(), kappa, 0.0)), new.friction(&slip(angle, kappa, 0.0)));
            assert!(near(a.longitudinal, b.longitudinal) && near(a.lateral, b.lateral), "at {angle}, {kappa}: {a:?} {b:?}");
            assert!(near(a.rolling_moment, b.rolling_moment) && near(a.overturning_moment, b.overturning_moment));
        }
    }
}

#[test]
fn beyond_the_range_the_force_of_its_edge_holds() {
    let law = law_of(OWN[2].1, Usage::default());
    let at = |camber: f64| law.friction(&slip(0.02, 0.0, camber)).lateral;
    let plain = law_of(OWN[2].1, Usage { beyond: BeyondFit::Extrapolate, ..Usage::default() });
    assert_eq!(at(0.79), plain.friction(&slip(0.02, 0.0, 0.79)).lateral, "inside nothing is changed");
    assert!(near(at(1.0), at(1.3)));
    // forces go to zero with the load, friction stays above the range
    let load = |load: f64| law.friction(&Slip { load, ..slip(0.02, 0.0, 0.0) }).lateral / load;
    assert!(near(load(3000.0), load(4000.0)) && near(load(50.0), load(1.0)) && load(1.0).is_finite());
}

#[test]
fn shifts_fade_below_the_low_speed_of_the_file() {
    let own = format!("{}PHY1 = 0.01\nPHX1 = 0.01\n", OWN[0].1);
    let law = law_of(&own, Usage::default());
    let at = |speed: f64| law.friction(&Slip { speed, ..slip(0.0, 0.0, 0.0) });
    assert!(at(1.0).lateral.abs() > 10.0 && at(0.1).lateral.abs() < 0.03 * at(1.0).lateral.abs());
    assert_eq!(at(1.0).longitudinal, at(30.0).longitudinal);
}

#[test]
fn pressure_acts_where_the_file_knows_it() {
    let [soft, hard] = [1.8e5, 2.4e5].map(|p| law_of(OWN[3].1, Usage { pressure: Some(p), ..Usage::default() }));
    assert!(hard.cornering_stiffness(1300.0, 0.0) > 1.05 * soft.cornering_stiffness(1300.0, 0.0));
    // (p/p0)^QSY8
    let quotient = hard.friction(&slip(0.0, 0.0, 0.0)).rolling_moment / soft.friction(&slip(0.0, 0.0, 0.0)).rolling_moment;
    assert!(near(quotient, (2.4f64 / 1.8).powf(-0.4)), "{quotient}");
}

#[test]
fn relaxation_lengths_follow_the_load() {
    let law = law_of(OWN[0].1, Usage::default());
    // n = 1: PTX1 R0, and PTY1 sin(2 atan(1/PTY2)) R0
    let [lateral, longitudinal] = law.relaxation_lengths(1400.0, 0.0);
    assert!(near(longitudinal, 0.8 * 0.3) && near(lateral, 0.9 * 0.3 * (2.0 * (1.0f64 / 1.8).atan()).sin()), "{lateral} {longitudinal}");
    let none = law_of(OWN[2].1, Usage::default());
    assert_eq!(none.relaxation_lengths(1400.0, 0.0), [0.0, 0.0]);
}
