//! Names of rows: forces and moments along axes of a frame.

use super::law::{Level, RowDeclared};
use crate::spatial::Vec3;

/// Two unit vectors that form a right-handed triad with a unit axis; axes of the frame where the axis is one of them.
pub fn across(axis: Vec3<f64>) -> [Vec3<f64>; 2] {
    let unit = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)];
    if let Some(k) = (0..3).find(|&k| unit[k].dot(axis) == 1.0) {
        return [unit[(k + 1) % 3], unit[(k + 2) % 3]];
    }
    // the unit vector farthest from the axis, made perpendicular
    let far = (0..3).min_by(|&a, &b| axis[a].abs().total_cmp(&axis[b].abs())).unwrap_or(0);
    let e1 = unit[far] - axis * unit[far].dot(axis);
    let e1 = e1 * (1.0 / e1.norm());
    [e1, axis.cross(e1)]
}

/// `x`, `y` or `z` for a direction along an axis of the frame, else a number.
fn suffix(direction: Vec3<f64>, number: usize) -> String {
    let axis = ["x", "y", "z"].iter().zip([direction.x, direction.y, direction.z]).find(|(_, part)| *part == 1.0);
    axis.map_or_else(|| number.to_string(), |(name, _)| (*name).to_owned())
}

/// A row that keeps a distance along a direction of the first frame.
pub fn gap(direction: Vec3<f64>, number: usize) -> RowDeclared {
    let s = suffix(direction, number);
    RowDeclared {
        multiplier: format!("force_{s}").into(),
        unit: "N",
        about: "force of the first body on the second along this axis of the first frame",
        error: format!("gap along {s}").into(),
        error_unit: "m",
        nominal: 0.01,
        level: Level::Position,
    }
}

/// A row that keeps an angle about a direction of the first frame.
pub fn tilt(direction: Vec3<f64>, number: usize) -> RowDeclared {
    let s = suffix(direction, number);
    RowDeclared {
        multiplier: format!("moment_{s}").into(),
        unit: "N m",
        about: "moment of the first body on the second about this axis of the first frame",
        error: format!("tilt about {s}").into(),
        error_unit: "rad",
        nominal: 0.01,
        level: Level::Position,
    }
}
