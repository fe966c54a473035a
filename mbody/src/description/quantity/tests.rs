//! What quantities say and accept.

use super::dimension::*;
use super::*;
use proptest::prelude::*;
use serde_json::json;

fn message(text: &str, dimension: &'static Dimension) -> String {
    match parse_quantity(text, dimension) {
        Ok(value) => format!("accepted as {value}"),
        Err(e) => format!("{} | {e} | {}", e.code(), e.hint().unwrap_or_default()),
    }
}

#[test]
fn messages_name_what_is_given_and_what_is_expected() {
    let cases: [(&str, &'static Dimension, &str); 15] = [
        ("58 kg", Stiffness::DIMENSION, "wrong_dimension | `58 kg` is a mass (kg), expected a stiffness (N/m) | "),
        ("35 deg", Length::DIMENSION, "wrong_dimension | `35 deg` is an angle (rad), expected a length (m) | "),
        ("35 deg", Number::DIMENSION, "wrong_dimension | `35 deg` is an angle (rad), expected a plain number | "),
        ("5 %", Angle::DIMENSION, "wrong_dimension | `5 %` is a plain number, expected an angle (rad) | "),
        (
            "3 Hz",
            AngularSpeed::DIMENSION,
            "wrong_dimension | `3 Hz` is a frequency (Hz), expected an angular speed (rad/s) | write `rad/s`, `rev/s` or `rpm`",
        ),
        (
            "60 rpm",
            Frequency::DIMENSION,
            "wrong_dimension | `60 rpm` is an angular speed (rad/s), expected a frequency (Hz) | write `Hz` or `1/s`",
        ),
        (
            "0.5 g",
            Acceleration::DIMENSION,
            "wrong_dimension | `0.5 g` is a mass (kg), expected an acceleration (m/s²) | `g` is the gram; write `gn` for standard gravity",
        ),
        (
            "500 lb/in",
            Stiffness::DIMENSION,
            "wrong_dimension | `500 lb/in` is a mass per length (kg/m), expected a stiffness (N/m) | \
             `kg` and `lb` are masses; write `kgf` or `lbf` for forces",
        ),
        ("2 kg m/s^4", Force::DIMENSION, "wrong_dimension | `2 kg m/s^4` is in kg m/s⁴, expected a force (N) | "),
        ("58 KN/m", Stiffness::DIMENSION, "unknown_unit | unknown unit `KN` in `58 KN/m` | did you mean `kN`?"),
        ("108 kmh", Speed::DIMENSION, "unknown_unit | unknown unit `kmh` in `108 kmh` | did you mean `km/h`?"),
        ("2,3 bar", Pressure::DIMENSION, "bad_number | `2,3 bar` has a comma | write `2.3 bar`"),
        ("soft", Stiffness::DIMENSION, "bad_number | `soft` is not a number | write a number with an optional unit, like `58 kN/m`"),
        (
            "2 kg/m s",
            Damping::DIMENSION,
            "bad_unit | the unit of `2 kg/m s` can be read in two ways | write `kg/(m s)` or `kg s/m`, not `kg/m s`",
        ),
        (
            "2 m +",
            Length::DIMENSION,
            "bad_unit | `2 m +` cannot be read as a number with a unit from `+` on | write a unit like `kN/m`, `N s/m`, `kg m^2`",
        ),
    ];
    for (text, dimension, expected) in cases {
        assert_eq!(message(text, dimension), expected);
    }
}

#[test]
fn a_bare_number_is_accepted_for_every_dimension() {
    for dimension in ALL {
        assert_eq!(parse_quantity("-2.5", dimension), Ok(-2.5));
    }
}

#[test]
fn the_angle_may_be_left_out() {
    assert_eq!(parse_quantity("380 N m", AngularStiffness::DIMENSION), Ok(380.0));
    assert_eq!(parse_quantity("380 N m/rad", AngularStiffness::DIMENSION), Ok(380.0));
    assert!(parse_quantity("380 N m/deg", Torque::DIMENSION).is_err());
}

#[test]
fn reads_numbers_and_texts_and_writes_numbers() {
    type Q = Quantity<Stiffness>;
    let read = |value| serde_json::from_value::<Q>(value).map(Quantity::si).map_err(|e| e.to_string());
    assert_eq!(read(json!(58000)), Ok(58e3));
    assert_eq!(read(json!("58 kN/m")), Ok(58e3));
    assert_eq!(read(json!(-2)), Ok(-2.0));
    assert_eq!(read(json!("58 kg")), Err("`58 kg` is a mass (kg), expected a stiffness (N/m)".to_string()));
    assert!(read(json!(true)).is_err());
    assert_eq!(serde_json::to_value(Q::new(5.0).ok()).ok(), Some(json!(5.0)));
    assert_eq!(Q::new(5.0).map(|q| q.to_string()), Ok("5 N/m".to_string()));
}

#[test]
fn ranges_hold_for_texts_too() {
    let read = |value| serde_json::from_value::<PositiveQuantity<Mass>>(value).map(Quantity::si).map_err(|e| e.to_string());
    assert_eq!(read(json!("3 kg")), Ok(3.0));
    assert_eq!(read(json!("-3 g")), Err("`-3 g` is out of range: it must be greater than 0 kg".to_string()));
    assert!(NonNegativeQuantity::<Mass>::new(0.0).is_ok());
    assert!(Quantity::<Number, Fraction>::new(1.01).is_err());
    assert!(Quantity::<Number>::new(f64::NAN).is_err());
}

#[test]
fn the_schema_states_unit_and_bounds() {
    let schema = schemars::SchemaGenerator::default().into_root_schema_for::<PositiveQuantity<Stiffness>>();
    assert_eq!(schema.get("type"), Some(&json!(["number", "string"])));
    assert_eq!(schema.get(KEYWORD), Some(&json!("N/m")));
    assert_eq!(schema.get("exclusiveMinimum"), Some(&json!(0.0)));
}

#[test]
fn large_bare_angles_are_suspicious() {
    let angle = Angle::DIMENSION;
    let doubt = "24 rad is 3.8 turns; did you mean `24 deg`?";
    assert_eq!(suspicion(&json!(24), angle).as_deref(), Some(doubt));
    assert_eq!(suspicion(&json!("24"), angle).as_deref(), Some(doubt));
    assert_eq!(suspicion(&json!("24 deg"), angle), None);
    assert_eq!(suspicion(&json!("24 rad"), angle).as_deref(), Some(doubt));
    assert_eq!(suspicion(&json!("4 rev"), angle), None);
    assert_eq!(suspicion(&json!(-6.2), angle), None);
    assert_eq!(suspicion(&json!(24), Length::DIMENSION), None);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_text_makes_it_panic(text in "\\PC{0,24}", unit in "[-0-9a-zA-Z°%µ²³⁻()*/^· .,]{0,16}") {
        let _ = parse_quantity(&text, Length::DIMENSION);
        let _ = parse_quantity(&format!("1{unit}"), Force::DIMENSION);
    }

    #[test]
    fn what_is_written_in_si_comes_back(value in -1e12..1e12_f64) {
        prop_assert_eq!(parse_quantity(&format!("{value} N/m"), Stiffness::DIMENSION), Ok(value));
        prop_assert_eq!(parse_quantity(&format!("{value:e}"), Stiffness::DIMENSION), Ok(value));
    }
}
