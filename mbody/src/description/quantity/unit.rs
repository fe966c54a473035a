//! Units: spelling, value in SI as an exact ratio where there is one, exponents.
//!
//! Source: NIST Special Publication 811 (2008), tables 2 to 7 and appendix B.8.

use super::dimension::Exponents;
use std::f64::consts::PI;

/// A unit of measurement.
#[derive(Debug)]
pub struct Unit {
    /// As it is written; upper and lower case matter.
    pub symbol: &'static str,
    /// The unit is `ratio.0 / ratio.1` in SI: two numbers, so that `1400 mm` is 1.4 m to the last digit.
    pub(super) ratio: (f64, f64),
    /// Powers of the base units.
    pub exponents: Exponents,
}

impl Unit {
    /// The unit that is written so.
    pub fn of_symbol(symbol: &str) -> Option<&'static Self> {
        ALL.iter().find(|u| u.symbol == symbol)
    }
}

const LENGTH: [i8; 4] = [1, 0, 0, 0];
const MASS: [i8; 4] = [0, 1, 0, 0];
const TIME: [i8; 4] = [0, 0, 1, 0];
const ANGLE: [i8; 4] = [0, 0, 0, 1];
const NUMBER: [i8; 4] = [0, 0, 0, 0];
const FREQUENCY: [i8; 4] = [0, 0, -1, 0];
const SPEED: [i8; 4] = [1, 0, -1, 0];
const FORCE: [i8; 4] = [1, 1, -2, 0];
const TORQUE: [i8; 4] = [2, 1, -2, 0];
const POWER: [i8; 4] = [2, 1, -3, 0];
const PRESSURE: [i8; 4] = [-1, 1, -2, 0];

const fn unit(symbol: &'static str, over: f64, under: f64, exponents: [i8; 4]) -> Unit {
    Unit { symbol, ratio: (over, under), exponents: Exponents::of(exponents) }
}

/// Every unit that is understood.
pub const ALL: &[Unit] = &[
    unit("1", 1.0, 1.0, NUMBER),
    unit("%", 1.0, 100.0, NUMBER),
    unit("m", 1.0, 1.0, LENGTH),
    unit("dm", 1.0, 10.0, LENGTH),
    unit("cm", 1.0, 100.0, LENGTH),
    unit("mm", 1.0, 1e3, LENGTH),
    unit("um", 1.0, 1e6, LENGTH),
    unit("µm", 1.0, 1e6, LENGTH),
    unit("μm", 1.0, 1e6, LENGTH),
    unit("km", 1e3, 1.0, LENGTH),
    unit("in", 254.0, 1e4, LENGTH),
    unit("ft", 3048.0, 1e4, LENGTH),
    unit("mi", 1_609_344.0, 1e3, LENGTH),
    unit("kg", 1.0, 1.0, MASS),
    unit("g", 1.0, 1e3, MASS),
    unit("t", 1e3, 1.0, MASS),
    unit("lb", 45_359_237.0, 1e8, MASS),
    unit("s", 1.0, 1.0, TIME),
    unit("ms", 1.0, 1e3, TIME),
    unit("us", 1.0, 1e6, TIME),
    unit("µs", 1.0, 1e6, TIME),
    unit("μs", 1.0, 1e6, TIME),
    unit("min", 60.0, 1.0, TIME),
    unit("h", 3600.0, 1.0, TIME),
    unit("rad", 1.0, 1.0, ANGLE),
    unit("mrad", 1.0, 1e3, ANGLE),
    unit("deg", PI, 180.0, ANGLE),
    unit("°", PI, 180.0, ANGLE),
    unit("rev", 2.0 * PI, 1.0, ANGLE),
    unit("Hz", 1.0, 1.0, FREQUENCY),
    unit("kHz", 1e3, 1.0, FREQUENCY),
    unit("rpm", PI, 30.0, [0, 0, -1, 1]),
    unit("mph", 44_704.0, 1e5, SPEED),
    unit("gn", 980_665.0, 1e5, [1, 0, -2, 0]),
    unit("N", 1.0, 1.0, FORCE),
    unit("mN", 1.0, 1e3, FORCE),
    unit("kN", 1e3, 1.0, FORCE),
    unit("MN", 1e6, 1.0, FORCE),
    unit("kgf", 980_665.0, 1e5, FORCE),
    unit("lbf", 44_482_216_152_605.0, 1e13, FORCE),
    unit("Nm", 1.0, 1.0, TORQUE),
    unit("kNm", 1e3, 1.0, TORQUE),
    unit("J", 1.0, 1.0, TORQUE),
    unit("kJ", 1e3, 1.0, TORQUE),
    unit("MJ", 1e6, 1.0, TORQUE),
    unit("W", 1.0, 1.0, POWER),
    unit("kW", 1e3, 1.0, POWER),
    unit("MW", 1e6, 1.0, POWER),
    // 550 ft lbf/s, and 75 kgf m/s
    unit("hp", 745.699_871_582_270_2, 1.0, POWER),
    unit("PS", 73_549_875.0, 1e5, POWER),
    unit("Pa", 1.0, 1.0, PRESSURE),
    unit("hPa", 100.0, 1.0, PRESSURE),
    unit("kPa", 1e3, 1.0, PRESSURE),
    unit("MPa", 1e6, 1.0, PRESSURE),
    unit("GPa", 1e9, 1.0, PRESSURE),
    unit("mbar", 100.0, 1.0, PRESSURE),
    unit("bar", 1e5, 1.0, PRESSURE),
    unit("psi", 6_894.757_293_168_361, 1.0, PRESSURE),
];

/// Spellings that are met but not accepted, and what to write instead.
const INSTEAD: &[(&str, &str)] = &[
    ("kmh", "km/h"),
    ("kph", "km/h"),
    ("sec", "s"),
    ("hr", "h"),
    ("lbs", "lb"),
    ("inch", "in"),
    ("foot", "ft"),
    ("feet", "ft"),
    ("meter", "m"),
    ("meters", "m"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("radian", "rad"),
    ("radians", "rad"),
    ("turn", "rev"),
    ("turns", "rev"),
    ("percent", "%"),
    ("ton", "t"),
    ("PSI", "psi"),
    ("nm", "Nm"),
    ("NM", "Nm"),
    ("Ns", "N s"),
    ("Nmm", "N mm"),
    ("Nms", "N m s"),
    ("kgm", "kg m"),
];

/// What an unknown unit probably stands for.
pub(in crate::description) fn nearest(symbol: &str) -> Option<&'static str> {
    let instead = INSTEAD.iter().find(|(wrong, _)| *wrong == symbol).map(|(_, right)| *right);
    instead.or_else(|| crate::description::finding::nearest(symbol, ALL.iter().map(|u| u.symbol).filter(|s| *s != "1")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::quantity::parse::parse;
    use approx::assert_relative_eq;

    // NIST SP 811, appendix B.8: factors to the digits printed there
    #[test]
    fn factors_are_those_of_the_published_table() {
        for (text, si, digits) in [
            ("1 in", 2.54e-2, 1e-15),
            ("1 ft", 3.048e-1, 1e-15),
            ("1 mi", 1.609_344e3, 1e-15),
            ("1 lb", 4.535_924e-1, 1e-7),
            ("1 lbf", 4.448_222, 1e-7),
            ("1 kgf", 9.806_65, 1e-15),
            ("1 psi", 6.894_757e3, 1e-7),
            ("1 hp", 7.456_999e2, 1e-7),
            ("1 PS", 7.354_988e2, 1e-7),
            ("1 mph", 4.4704e-1, 1e-15),
            ("1 km/h", 2.777_778e-1, 1e-7),
            ("1 rpm", 1.047_198e-1, 1e-6),
            ("1 deg", 1.745_329e-2, 1e-6),
            ("1 lbf/in", 1.751_268e2, 1e-6),
            ("1 ft*lbf", 1.355_818, 1e-6),
            ("1 bar", 1e5, 1e-15),
        ] {
            match parse(text) {
                Ok(parsed) => assert_relative_eq!(parsed.value, si, max_relative = digits),
                Err(e) => panic!("{text}: {e}"),
            }
        }
    }

    #[test]
    fn every_unit_has_one_spelling_per_row() {
        for (k, unit) in ALL.iter().enumerate() {
            assert!(!ALL[..k].iter().any(|u| u.symbol == unit.symbol), "`{}` twice", unit.symbol);
        }
        assert!(INSTEAD.iter().all(|(wrong, _)| Unit::of_symbol(wrong).is_none()));
    }

    #[test]
    fn unknown_units_point_to_known_ones() {
        for (wrong, right) in [("KN", "kN"), ("kmh", "km/h"), ("Kg", "kg"), ("mmm", "mm"), ("psii", "psi"), ("RPM", "rpm")] {
            assert_eq!(nearest(wrong), Some(right));
        }
        assert_eq!(nearest("furlong"), None);
    }
}
