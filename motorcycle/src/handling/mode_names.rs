//! How the modes of a vehicle are recognized: single tracks, and those with more wheels beside.
//!
//! Out of the plane of symmetry: weave, wobble and rear wobble oscillate, capsize and caster are real, lags of the tires are fast and real. In the
//! plane: bounce, pitch and the hops of the wheels; a suspension that is damped beyond its critical value has two real ones of the same name.
//! The spins of the wheels against their slip are fast and real, the speed against the drag is slow. A rider who leans and a structure that
//! gives way have oscillations of their own.
//!
//! Bands: R. S. Sharp, S. Evangelou, D. J. N. Limebeer, “Advances in the modelling of motorcycle dynamics”, Multibody Syst. Dyn. 12 (2004)
//! 251–283 (weave below 4 Hz, wobble 6 to 10 Hz, hops 10 to 15 Hz); V. Cossalter, *Motorcycle Dynamics*, 2nd ed. 2006, chapter 7 (capsize, rear
//! wobble); weights of participation: chosen here, on the bundled vehicles between 5 and 80 m/s.

use problem::{ModeRule, Nature, Occurs};

/// An oscillation that occurs once.
const fn oscillation(
    name: &'static str,
    about: &'static str,
    takes_part: &'static [(&'static str, f64)],
    frequency: (f64, f64),
    damping: (f64, f64),
) -> ModeRule {
    ModeRule { name, about, takes_part, frequency, damping, nature: Nature::Oscillation, occurs: Occurs::Once }
}

/// A real eigenvalue.
const fn real(
    name: &'static str,
    about: &'static str,
    takes_part: &'static [(&'static str, f64)],
    frequency: (f64, f64),
    occurs: Occurs,
) -> ModeRule {
    ModeRule { name, about, takes_part, frequency, damping: ANY, nature: Nature::Real, occurs }
}

/// Any damping, unstable too.
const ANY: (f64, f64) = (-1.0, 1.0);

/// The rules, for `analyses::modes`.
pub const MODE_RULES: &[ModeRule] = &[
    oscillation(
        "weave",
        "the whole vehicle yaws and rolls, the steering follows",
        &[("*.yaw_rate", 1.0), ("*.roll", 1.0), ("*.lateral_speed", 1.0), ("steer.angle", 0.5)],
        (0.2, 4.5),
        ANY,
    ),
    oscillation(
        "wobble",
        "the front assembly shakes about the steering axis",
        &[
            ("steer.angle", 1.0),
            ("front_tire.*lateral*", 1.0),
            ("*.yaw_rate", 0.6),
            ("frame_torsion.*", 0.6),
            ("fork_*.angle", 0.6),
            ("*.lateral_speed", 0.5),
            ("*.roll", 0.4),
            ("rider_lean.*", 0.2),
        ],
        (5.0, 11.0),
        ANY,
    ),
    // well damped as far as it is known; at rest its damping vanishes with that of the tires
    oscillation(
        "rear wobble",
        "the rear end shakes sideways on its tire",
        &[
            ("rear_tire.*lateral*", 1.0),
            ("swingarm_torsion.*", 0.8),
            ("rear_torsion.*", 0.8),
            ("*.lateral_speed", 0.7),
            ("*.roll", 0.6),
            ("rider_lean.*", 0.3),
            ("*.yaw_rate", 0.2),
        ],
        (5.0, 12.0),
        (0.3, 1.0),
    ),
    oscillation(
        "bounce",
        "the body moves up and down on both suspensions",
        &[("*.heave", 1.0), ("fork.travel", 0.3), ("swingarm.angle", 0.3)],
        (1.0, 5.0),
        ANY,
    ),
    oscillation(
        "pitch",
        "the body pitches on both suspensions",
        &[("*.pitch", 1.0), ("fork.travel", 0.3), ("swingarm.angle", 0.3)],
        (1.0, 7.0),
        ANY,
    ),
    oscillation(
        "front hop",
        "the front wheel hops on its tire",
        &[("fork.travel", 1.0), ("front_*fork.travel", 1.0), ("front_*arm.angle", 1.0), ("knee.angle", 1.0), ("*.pitch", 0.3)],
        (7.0, 25.0),
        ANY,
    ),
    // the tail of a rear end in a loop or on a link: bevel housing, unit swing engine
    oscillation(
        "rear hop",
        "the rear wheel hops on its tire",
        &[("swingarm.angle", 1.0), ("final_drive.angle", 1.0), ("engine_swing.angle", 1.0), ("*.heave", 0.3)],
        (7.0, 25.0),
        ANY,
    ),
    oscillation("side hop", "the wheel of the sidecar hops on its tire", &[("side_*arm.angle", 1.0), ("*.roll", 0.3)], (7.0, 25.0), ANY),
    oscillation(
        "tramp",
        "two front wheels hop against each other and tilt their linkage",
        &[("tilt*.angle", 1.0), ("front_*fork.travel", 0.9)],
        (7.0, 25.0),
        ANY,
    ),
    oscillation("rider lean", "the rider's upper body leans against the saddle", &[("rider_lean.*", 1.0)], (0.5, 15.0), ANY),
    // structure: names of joints as in the bundled vehicles
    oscillation("frame twist", "the frame twists ahead of the engine", &[("frame_torsion.*", 1.0)], (10.0, 40.0), ANY),
    oscillation("head bending", "the steering head gives way sideways", &[("head_lateral.*", 1.0)], (30.0, 200.0), ANY),
    oscillation("fork bending", "the fork bends sideways", &[("fork_bending.*", 1.0)], (20.0, 120.0), ANY),
    oscillation("fork twist", "the fork twists between bar and wheel", &[("fork_torsion.*", 1.0)], (20.0, 80.0), ANY),
    oscillation(
        "swingarm twist",
        "the swing arm twists with the rear wheel",
        &[("swingarm_torsion.*", 1.0), ("rear_torsion.*", 1.0)],
        (25.0, 100.0),
        ANY,
    ),
    real("capsize", "the vehicle falls over slowly, or comes up", &[("*.roll", 1.0), ("*.yaw_rate", 0.3)], (0.0, 0.7), Occurs::Once),
    real("speed", "the speed settles between drive and drag", &[("*.forward_speed", 1.0), ("*.spin_rate", 0.9)], (0.0, 0.2), Occurs::Once),
    real(
        "caster",
        "the front assembly turns into its direction of travel",
        &[("steer.angle", 1.0), ("*.yaw_rate", 0.3)],
        (0.7, 8.0),
        Occurs::Once,
    ),
    real(
        "rear wobble",
        "what is left of the rear wobble where it does not oscillate",
        &[("*.lateral_speed", 1.0), ("*.roll", 0.7), ("*.yaw_rate", 0.6)],
        (2.0, 5.0),
        Occurs::Once,
    ),
    real(
        "front hop",
        "an overdamped front suspension",
        &[("fork.travel", 1.0), ("front_*fork.travel", 1.0), ("front_*arm.angle", 1.0), ("knee.angle", 1.0), ("*.pitch", 0.3)],
        (0.5, 60.0),
        Occurs::Often,
    ),
    real("tramp", "what is left of the tramp where it does not oscillate", &[("tilt*.angle", 1.0)], (0.5, 60.0), Occurs::Often),
    real("rear hop", "an overdamped rear suspension", &[("swingarm.angle", 1.0), ("*.heave", 0.3)], (0.5, 60.0), Occurs::Often),
    ModeRule {
        name: "tire",
        about: "a side force follows its slip",
        takes_part: &[("*_tire.*lateral*", 1.0), ("*.lateral_speed", 0.6), ("*.yaw_rate", 0.4), ("steer.angle", 0.3)],
        frequency: (6.0, 1000.0),
        damping: (0.5, 1.0),
        nature: Nature::Any,
        occurs: Occurs::Often,
    },
    ModeRule {
        name: "front wheel spin",
        about: "the front wheel comes up to speed against its slip",
        takes_part: &[("front_wheel.spin_rate", 1.0), ("front_*_wheel.spin_rate", 1.0)],
        frequency: (2.0, 5000.0),
        damping: (0.5, 1.0),
        nature: Nature::Any,
        occurs: Occurs::Often,
    },
    ModeRule {
        name: "rear wheel spin",
        about: "the rear wheel comes up to speed against its slip",
        takes_part: &[("rear_wheel.spin_rate", 1.0)],
        frequency: (2.0, 5000.0),
        damping: (0.5, 1.0),
        nature: Nature::Any,
        occurs: Occurs::Often,
    },
    ModeRule {
        name: "side wheel spin",
        about: "the wheel of the sidecar comes up to speed against its slip",
        takes_part: &[("side_wheel.spin_rate", 1.0)],
        frequency: (2.0, 5000.0),
        damping: (0.5, 1.0),
        nature: Nature::Any,
        occurs: Occurs::Often,
    },
];
