//! Dimensions: what a quantity measures, under the name an engineer gives it.
//!
//! A dimension is a product of powers of length, mass, time and angle. The angle is tracked (so that `N m/deg` converts as it
//! should) but has no dimension in the SI: where mass or length take part, a unit that mentions no angle is accepted for one that
//! does, `N m` for `N m/rad`. Purely kinematic dimensions are kept apart, because `3 Hz` is not `3 rad/s`.

use std::fmt;

/// Powers of length, mass, time and angle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exponents {
    /// Power of the meter.
    pub length: i8,
    /// Power of the kilogram.
    pub mass: i8,
    /// Power of the second.
    pub time: i8,
    /// Power of the radian.
    pub angle: i8,
}

impl Exponents {
    pub(in crate::description) const fn of([length, mass, time, angle]: [i8; 4]) -> Self {
        Self { length, mass, time, angle }
    }

    /// Product with the n-th power of `b`; `None` beyond any sensible unit.
    pub(in crate::description) fn times_power(self, b: Self, n: i8) -> Option<Self> {
        let term = |a: i8, b: i8| a.checked_add(b.checked_mul(n)?);
        Some(Self {
            length: term(self.length, b.length)?,
            mass: term(self.mass, b.mass)?,
            time: term(self.time, b.time)?,
            angle: term(self.angle, b.angle)?,
        })
    }
}

/// In base units: `kg m²/s³`.
impl fmt::Display for Exponents {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let powers = [("kg", self.mass), ("m", self.length), ("rad", self.angle), ("s", self.time)];
        let side = |sign: i8| -> Vec<String> {
            let on_side = powers.iter().filter(|(_, n)| n.signum() == sign);
            on_side
                .map(|(unit, n)| if n.abs() == 1 { (*unit).to_string() } else { format!("{unit}{}", superscript(n.unsigned_abs())) })
                .collect()
        };
        let (above, below) = (side(1), side(-1));
        f.write_str(&if above.is_empty() { "1".to_string() } else { above.join(" ") })?;
        match below.len() {
            0 => Ok(()),
            1 => write!(f, "/{}", below[0]),
            _ => write!(f, "/({})", below.join(" ")),
        }
    }
}

fn superscript(n: u8) -> String {
    n.to_string().bytes().map(|digit| ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][usize::from(digit - b'0')]).collect()
}

/// What a quantity measures.
#[derive(Debug, PartialEq, Eq)]
pub struct Dimension {
    /// Name with article: `a stiffness`.
    pub name: &'static str,
    /// Unit in which the value is kept and shown: `N/m`. Unique among all dimensions; `1` for a plain number.
    pub unit: &'static str,
    /// Powers of the base units.
    pub exponents: Exponents,
}

impl Dimension {
    /// The dimension that is shown in this unit.
    pub fn of_unit(unit: &str) -> Option<&'static Self> {
        ALL.iter().copied().find(|d| d.unit == unit)
    }

    /// The dimension with these exponents; where several have them, the one of general purpose.
    pub fn of_exponents(exponents: Exponents) -> Option<&'static Self> {
        ALL.iter().copied().find(|d| d.exponents == exponents)
    }

    /// Whether a value with these exponents may stand for this dimension.
    pub(in crate::description) fn accepts(&self, given: Exponents) -> bool {
        let own = self.exponents;
        let without_angle = Exponents { angle: 0, ..own };
        given == own || (given == without_angle && (own.length != 0 || own.mass != 0))
    }
}

/// `a stiffness (N/m)`; a plain number has no unit to show.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.unit == "1" { f.write_str(self.name) } else { write!(f, "{} ({})", self.name, self.unit) }
    }
}

/// `a mass (kg)`, or the bare unit for a dimension without a name.
pub(in crate::description) fn describe(exponents: Exponents) -> String {
    match ALL.iter().find(|d| d.exponents == exponents) {
        Some(dimension) => dimension.to_string(),
        None => format!("in {exponents}"),
    }
}

/// A type that stands for one dimension; see [`super::Quantity`].
pub trait Dimensioned {
    /// The dimension.
    const DIMENSION: &'static Dimension;
}

macro_rules! dimensions {
    ($($marker:ident $name:literal $unit:literal $exponents:tt)*) => {
        $(
            #[doc = concat!("Stands for ", $name, ", `", $unit, "`.")]
            #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
            pub struct $marker;
            impl Dimensioned for $marker {
                const DIMENSION: &'static Dimension =
                    &Dimension { name: $name, unit: $unit, exponents: Exponents::of($exponents) };
            }
        )*
        /// Every dimension; where two have the same exponents, the first gives its name to a value of unknown purpose.
        pub const ALL: &[&Dimension] = &[$(<$marker as Dimensioned>::DIMENSION),*];
    };
}

// powers of: length, mass, time, angle
dimensions! {
    Number "a plain number" "1" [0, 0, 0, 0]
    Length "a length" "m" [1, 0, 0, 0]
    Area "an area" "m²" [2, 0, 0, 0]
    Volume "a volume" "m³" [3, 0, 0, 0]
    Curvature "a curvature" "1/m" [-1, 0, 0, 0]
    Angle "an angle" "rad" [0, 0, 0, 1]
    PerAngle "a number per angle" "1/rad" [0, 0, 0, -1]
    Time "a time" "s" [0, 0, 1, 0]
    Frequency "a frequency" "Hz" [0, 0, -1, 0]
    Speed "a speed" "m/s" [1, 0, -1, 0]
    Acceleration "an acceleration" "m/s²" [1, 0, -2, 0]
    AngularSpeed "an angular speed" "rad/s" [0, 0, -1, 1]
    AngularAcceleration "an angular acceleration" "rad/s²" [0, 0, -2, 1]
    Mass "a mass" "kg" [0, 1, 0, 0]
    MassPerLength "a mass per length" "kg/m" [-1, 1, 0, 0]
    Density "a density" "kg/m³" [-3, 1, 0, 0]
    Inertia "a moment of inertia" "kg m²" [2, 1, 0, 0]
    Force "a force" "N" [1, 1, -2, 0]
    ForceRate "a force rate" "N/s" [1, 1, -3, 0]
    ForcePerAngle "a force per angle" "N/rad" [1, 1, -2, -1]
    ForcePerSpeedSquared "a force per squared speed" "N s²/m²" [-1, 1, 0, 0]
    Stiffness "a stiffness" "N/m" [0, 1, -2, 0]
    Damping "a damping" "N s/m" [0, 1, -1, 0]
    Torque "a torque" "N m" [2, 1, -2, 0]
    TorqueRate "a torque rate" "N m/s" [2, 1, -3, 0]
    AngularStiffness "an angular stiffness" "N m/rad" [2, 1, -2, -1]
    AngularDamping "an angular damping" "N m s/rad" [2, 1, -1, -1]
    Energy "an energy" "J" [2, 1, -2, 0]
    Power "a power" "W" [2, 1, -3, 0]
    Pressure "a pressure" "Pa" [-1, 1, -2, 0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::quantity::parse_quantity;

    #[test]
    fn every_unit_is_unique_and_measures_its_own_dimension() {
        for d in ALL {
            assert_eq!(Dimension::of_unit(d.unit), Some(*d), "{}", d.unit);
            let text = if d.unit == "1" { "2.5".to_string() } else { format!("2.5 {}", d.unit) };
            assert_eq!(parse_quantity(&text, d).ok(), Some(2.5), "{text}");
        }
    }

    #[test]
    fn dimensions_without_a_name_are_shown_in_base_units() {
        assert_eq!(describe(Exponents::of([2, 1, -3, -1])), "in kg m²/(rad s³)");
        assert_eq!(describe(Exponents::of([0, 0, -2, 0])), "in 1/s²");
        assert_eq!(describe(Exponents::of([0, 1, -2, 0])), "a stiffness (N/m)");
    }

    #[test]
    fn the_angle_may_be_left_out_where_mass_or_length_take_part() {
        let torque = Torque::DIMENSION.exponents;
        assert!(AngularStiffness::DIMENSION.accepts(torque));
        assert!(!Torque::DIMENSION.accepts(AngularStiffness::DIMENSION.exponents));
        assert!(!AngularSpeed::DIMENSION.accepts(Frequency::DIMENSION.exponents));
        assert!(!Number::DIMENSION.accepts(Angle::DIMENSION.exponents));
    }
}
