//! Units for readers: angles in degrees, everything else as it is.

/// Unit of angles in the table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Angles {
    /// Degrees for angles; rates stay in rad/s, since a wheel in deg/s tells nobody anything.
    #[default]
    Degrees,
    /// Radians.
    Radians,
}

/// A unit for readers and the factor from SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shown<'a> {
    /// Unit as text; empty for a pure number.
    pub unit: &'a str,
    /// Value shown over value in SI.
    pub factor: f64,
}

impl Angles {
    /// How a quantity with this SI unit is shown.
    pub fn show(self, unit: &str) -> Shown<'_> {
        match (self, unit) {
            (Self::Degrees, "rad") => Shown { unit: "deg", factor: 180.0 / std::f64::consts::PI },
            (_, "-") => Shown { unit: "", factor: 1.0 },
            _ => Shown { unit, factor: 1.0 },
        }
    }
}

/// How an error of a constraint with this SI unit is shown: mm, deg and their rates.
pub fn small(unit: &str) -> Shown<'_> {
    const DEGREES: f64 = 180.0 / std::f64::consts::PI;
    let (unit, factor) = match unit {
        "m" => ("mm", 1e3),
        "m/s" => ("mm/s", 1e3),
        "rad" => ("deg", DEGREES),
        "rad/s" => ("deg/s", DEGREES),
        "-" => ("", 1.0),
        unit => (unit, 1.0),
    };
    Shown { unit, factor }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_angles_change() {
        assert_eq!(Angles::Degrees.show("rad").unit, "deg");
        assert!((Angles::Degrees.show("rad").factor * std::f64::consts::FRAC_PI_2 - 90.0).abs() < 1e-12);
        assert_eq!(Angles::Radians.show("rad"), Shown { unit: "rad", factor: 1.0 });
        assert_eq!(Angles::Degrees.show("rad/s"), Shown { unit: "rad/s", factor: 1.0 });
        assert_eq!(Angles::Degrees.show("-").unit, "");
    }
}
