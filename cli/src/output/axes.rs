//! ISO and SAE axes for printed signals.
//!
//! Inside everything is ISO 8855: x forward, y left, z up. The older SAE J670e axes, used by Cossalter, Sharp and Pacejka, are
//! x forward, y right, z down. With D = diag(1, −1, −1) a vector, polar or axial, becomes D a:
//! components along x keep their sign, components along y and z change it.
//!
//! What is a magnitude with a sense of its own stays as it is: compression of a suspension, travel of the swinging arm (bump),
//! normal load, brake and drive torque, chain tension, camber, slip, friction use, and the steering torque that is
//! already referred to the sense of the yaw rate. Slip angle: J670e's α = atan2(V_right, V_forward) is the internal, force-positive α.
//!
//! Source: SAE J670e (1976); ISO 8855 (2011).

/// The axis system of printed values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axes {
    /// x forward, y left, z up (ISO 8855).
    #[default]
    Iso,
    /// x forward, y right, z down (SAE J670e).
    Sae,
}

impl Axes {
    /// Name after `--axes` and in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Iso => "iso",
            Self::Sae => "sae",
        }
    }

    /// The axis system with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Iso, Self::Sae].into_iter().find(|axes| axes.name() == name)
    }

    /// The signs, as the header of every table states them.
    pub(super) fn signs(self) -> [&'static str; 2] {
        match self {
            Self::Iso => [
                "ISO: x forward, y left, z up; lean > 0 to the right, pitch > 0 nose down",
                "steer angle, steer torque, yaw rate, curvature, lateral acceleration and force > 0 to the left",
            ],
            Self::Sae => [
                "SAE: x forward, y right, z down; lean > 0 to the right, pitch > 0 nose up",
                "steer angle, steer torque, yaw rate, curvature, lateral acceleration and force > 0 to the right; ~ opposite to the description",
            ],
        }
    }
}

/// Sign of SAE over ISO, by element and quantity; `*` stands for anything. The first row that fits holds, otherwise +1.
const RULES: &[(&str, &str, f64)] = &[
    // steering torque in the sense of the yaw rate: both factors change sign
    ("steer", "torque_normalized", 1.0),
    ("steer", "*", -1.0),
    ("*_steer", "angle", -1.0),
    ("*_steer", "rate", -1.0),
    ("chassis", "y", -1.0),
    ("chassis", "z", -1.0),
    ("chassis", "heave", -1.0),
    ("chassis", "heave_*", -1.0),
    ("chassis", "vertical_*", -1.0),
    ("chassis", "pitch", -1.0),
    ("chassis", "pitch_*", -1.0),
    ("chassis", "yaw", -1.0),
    ("chassis", "yaw_*", -1.0),
    // positive rotation about y to the left: forward; about y to the right: backward
    ("*_wheel", "spin_*", -1.0),
    ("*_tire", "rolling_moment", -1.0),
    ("*_tire", "aligning_moment", -1.0),
    ("*_road", "height", -1.0),
    ("*_road", "height_*", -1.0),
    ("", "road", -1.0),
    // sensors of points
    ("*", "height", -1.0),
    ("*", "velocity_y", -1.0),
    ("*", "velocity_z", -1.0),
    ("*", "acceleration_y", -1.0),
    ("*", "acceleration_z", -1.0),
    ("wind", "lateral", -1.0),
    ("*", "lateral_*", -1.0),
    ("*", "*_lateral", -1.0),
    ("*", "force_y", -1.0),
    ("*", "force_z", -1.0),
    ("*", "moment_y", -1.0),
    ("*", "moment_z", -1.0),
    ("", "curvature", -1.0),
    ("", "kinematic_curvature", -1.0),
    ("", "radius", -1.0),
    ("", "yaw_rate", -1.0),
    ("", "steer_torque", -1.0),
    ("", "steer_angle", -1.0),
];

/// What a value of the signal `name` is multiplied with to change between ISO and SAE axes: +1 or −1; a rate turns with its signal.
pub(super) fn factor(name: &str) -> f64 {
    let name = name.strip_prefix("rate(").and_then(|rest| rest.strip_suffix(')')).unwrap_or(name);
    let (element, quantity) = name.rsplit_once('.').unwrap_or(("", name));
    RULES.iter().find(|(e, q, _)| fits(e, element) && fits(q, quantity)).map_or(1.0, |rule| rule.2)
}

/// Whether `name` fits `pattern`, which may begin or end with `*`.
fn fits(pattern: &str, name: &str) -> bool {
    match (pattern.strip_prefix('*'), pattern.strip_suffix('*')) {
        (Some(""), _) => true,
        (Some(ending), _) => name.ends_with(ending),
        (_, Some(beginning)) => name.starts_with(beginning),
        _ => pattern == name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table of the module's header, signal by signal.
    #[test]
    fn components_along_y_and_z_change_sign() {
        let same = "chassis.roll chassis.roll_rate chassis.x chassis.forward_speed fork.travel fork.rate swingarm.angle \
            front_tire.normal_force rear_tire.longitudinal_force rear_tire.overturning_moment front_tire.slip_angle \
            front_tire.longitudinal_slip rear_tire.camber rear_tire.friction_use chain.upper_tension drive.torque front_brake.torque \
            saddle.point_speed saddle.velocity_x saddle.acceleration_x rate(chassis.roll_rate) \
            engine.speed drivetrain.gear swingarm.force_x swingarm.moment_x steer.torque_normalized speed lean acceleration";
        let changed = "chassis.y chassis.heave chassis.heave_rate chassis.lateral_speed chassis.pitch chassis.pitch_rate chassis.yaw \
            chassis.yaw_rate chassis.yaw_acceleration steer.angle steer.rate steer.torque front_wheel.spin_rate rear_wheel.spin_rate \
            side_wheel.spin_rate front_left_wheel.spin_rate front_left_steer.angle \
            front_tire.lateral_force rear_tire.rolling_moment rear_tire.aligning_moment front_tire.carcass_lateral front_road.height \
            rear_road.height_rate road saddle.height saddle.velocity_y saddle.acceleration_z rate(chassis.pitch_rate) wind.lateral swingarm.force_y swingarm.force_z swingarm.moment_y swingarm.moment_z \
            lateral_acceleration curvature radius yaw_rate steer_torque";
        for name in same.split_whitespace() {
            assert_eq!(factor(name), 1.0, "{name}");
        }
        for name in changed.split_whitespace() {
            assert_eq!(factor(name), -1.0, "{name}");
        }
    }

    #[test]
    fn names_are_read_back() {
        assert_eq!([Axes::Iso, Axes::Sae].map(|a| Axes::from_name(a.name())), [Some(Axes::Iso), Some(Axes::Sae)]);
        assert_eq!(Axes::from_name("din"), None);
    }
}
