//! Endings: how a steady state or a motion ends, and the limits that stand in the way.

/// Name and explanation.
#[rustfmt::skip]
pub const ENDINGS: &[(&str, &str)] = &[
    ("reached", "What was asked for was computed."),
    ("not_converged", "No solution was found, and no physical limit explains it; the message names the signals that are involved."),
    ("stopped", "Somebody stopped the computation; what was computed is kept."),
    ("fallen", "The vehicle lies on its side."),
    ("tire_saturated", "The tire has no friction left: its use of friction has reached one."),
    ("wheel_lifted", "The wheel leaves the road: its normal force is nearly zero."),
    ("camber_limit", "The wheel leans further than its tire is described for."),
    ("suspension_stop", "The travel of a suspension has used up a stop."),
    ("joint_stop", "The travel of a joint has used up a stop."),
    ("spring_stop", "The deflection of a spring between two points has used up a stop."),
    ("steering_stop", "The handlebar is at its stop."),
    ("engine_limit", "The engine would have to give more torque than its map has, or to turn faster than it may."),
];
