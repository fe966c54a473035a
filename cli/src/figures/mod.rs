//! From reports to figures: what an engineer expects to see.

pub mod modes;
pub mod ride;
pub mod setup;
pub mod tire;

use crate::output::Angles;

/// `speed 30 m/s`.
pub fn quantity(name: &str, unit: &str, value: f64) -> String {
    let shown = Angles::Degrees.show(unit);
    let rounded = (value * shown.factor * 1e6).round() / 1e6;
    format!("{} {rounded} {}", name.replace('_', " "), shown.unit).trim_end().to_owned()
}
