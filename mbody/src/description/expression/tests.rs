use super::*;
use crate::description::quantity::{Dimension, parse_quantity};
use approx::assert_relative_eq;

const NAMES: [&str; 5] = ["k", "trail", "load", "caster", "teeth"];

fn known(name: &str) -> Option<Value> {
    let quantity = |text: &str, unit: &str| {
        let dimension = Dimension::of_unit(unit)?;
        Some(Value { si: parse_quantity(text, dimension).ok()?, exponents: dimension.exponents })
    };
    match name {
        "k" => quantity("20 kN/m", "N/m"),
        "trail" => quantity("100 mm", "m"),
        "load" => quantity("1.5 kN", "N"),
        "caster" => quantity("24 deg", "rad"),
        "teeth" => quantity("17", "1"),
        _ => None,
    }
}

fn value(text: &str) -> Result<Value, ExpressionError> {
    Expression::parse(text)?.value(&known, &NAMES)
}

fn said(text: &str) -> String {
    value(text).map_or_else(|e| e.to_string(), |v| format!("no error: {v:?}"))
}

#[test]
fn formulas_have_values_and_units() {
    for (text, si, unit) in [
        ("0.5 * k + 2 kN/m", 12_000.0, "N/m"),
        ("load / trail", 15_000.0, "N/m"),
        ("2 m / trail", 20.0, "1"),
        ("2 m/s * 3 s", 6.0, "m"),
        ("2 kN * s/m", 2000.0, "N s/m"),
        ("3 kg/(m s)", 3.0, "kg/(m s)"),
        ("2 m / (trail + 0.1 m)", 10.0, "1"),
        ("sqrt(k / 20 kg)", 1000.0_f64.sqrt(), "1/s"),
        ("sqrt(trail^2 + (0.2 m)^2)", 0.05_f64.sqrt(), "m"),
        ("trail^2", 0.01, "m²"),
        ("-trail + 1e2 mm", 0.0, "m"),
        ("2 * min(trail, 90 mm, 1 m)", 0.18, "m"),
        ("max(1, teeth)", 17.0, "1"),
        ("abs(-load)", 1500.0, "N"),
        ("atan2(trail, 0.1 m)", std::f64::consts::FRAC_PI_4, "rad"),
        ("1 m * cos(caster)", 0.418_879_020_478_639_1_f64.cos(), "m"),
        ("15.875 mm / (2 * sin(pi / teeth))", 0.015_875 / (2.0 * (std::f64::consts::PI / 17.0).sin()), "m"),
    ] {
        match value(text) {
            Ok(found) => {
                assert_relative_eq!(found.si, si, max_relative = 1e-14, epsilon = 1e-16);
                let same = crate::description::quantity::parse::parse(&format!("1 {unit}"));
                let exponents = same.map(|p| p.unit.unwrap_or(PLAIN));
                assert_eq!(exponents.as_ref().ok(), Some(&found.exponents), "{text}");
            }
            Err(error) => panic!("{text}: {error}"),
        }
    }
}

#[test]
fn quantities_of_different_kinds_do_not_go_together() {
    assert_eq!(said("trail + load"), "`trail` is a length (m), `load` is a force (N): they cannot be added");
    assert_eq!(said("k - (2 * load)"), "`k` is a stiffness (N/m), `(2 * load)` is a force (N): they cannot be subtracted");
    assert_eq!(said("trail + 1"), "`trail` is a length (m), `1` is a plain number: they cannot be added");
    assert_eq!(said("max(trail, load)"), "`trail` is a length (m), `load` is a force (N): they cannot be compared");
    assert_eq!(said("sin(trail)"), "the argument of an angle function is a plain number, but `trail` is a length (m)");
    assert_eq!(said("2 ^ trail"), "the exponent is a plain number, but `trail` is a length (m)");
    assert_eq!(said("sqrt(trail)"), "a power or root in `sqrt(trail)` has no unit");
    // the radian may be left out beside mass or length, not alone
    assert!(value("2 N m/rad + 1 N m").is_ok());
    assert!(value("caster + 1").is_err());
}

#[test]
fn what_is_misplaced_is_told() {
    assert_eq!(said("0.5 *"), "expected a number, a parameter or `(` at `the end` in the formula `0.5 *`");
    assert_eq!(said("(k"), "expected `)` at `the end` in the formula `(k`");
    assert_eq!(said("k load"), "expected an operator or the end at `load` in the formula `k load`");
    assert_eq!(said("sqrt(k, 2)"), "`sqrt` takes one argument, but 2 stand there");
    assert_eq!(said("min(k)"), "`min` takes 2 to 16 arguments, but 1 stand there");
    assert_eq!(said("trial"), "there is no parameter `trial`");
    assert_eq!(said("2 / 0"), "the formula `2 / 0` gives inf");
    assert!(said("2 kN/mm + 3 furlong").contains("`3 furlong`") || said("3furlong").contains("furlong"), "{}", said("3 furlong"));
    assert!(said(&"(".repeat(1000)).contains("fewer"));
    assert!(said(&"-".repeat(1000)).contains("fewer"));
}

#[test]
fn names_of_units_and_functions_are_reserved() {
    for (word, free) in [("m", false), ("sqrt", false), ("pi", false), ("spring_rate", true), ("2x", false), ("a.b", false), ("k", true)] {
        assert_eq!(reserved(word).is_none(), free, "{word}");
    }
    assert_eq!(Expression::parse("k * trail + k").map(|e| e.names().len()), Ok(3));
}
