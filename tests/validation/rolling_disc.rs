//! A thin disc that rolls without slip: the equations of motion of the literature, steady precession among their solutions.
//!
//! Axes: e₁ along the heading, e₂ along the axis of the disc, e₃ upward in its plane; φ lean, ψ yaw, θ spin, total spin `Ω = θ̇ + ψ̇ sin φ`.
//! Rolling on −r e₃: `v = r Ω e₁ − r φ̇ e₂`. Momentum and angular momentum about the center give
//!
//! ```text
//! (A + m r²) φ̈ = (C + m r²) Ω ψ̇ cos φ − A ψ̇² sin φ cos φ + m g r sin φ
//! A ψ̈ cos φ    = 2 A ψ̇ φ̇ sin φ − C Ω φ̇
//! (C + m r²) Ω̇ = −m r² ψ̇ φ̇ cos φ
//! ```
//!
//! A across, C along the axis. With φ̇ = 0 and the first right side zero the precession is steady.
//! Source: E. J. Routh, *Dynamics of a System of Rigid Bodies*, advanced part, art. 244; K. T. McDonald, "The rolling motion of a disk on a horizontal
//! plane", arXiv physics/0008227 (2000), section 2. Derivation in our signs: `models/mechanisms/rolling_disc/SOURCE.md`.

use validation::agreement::{Agreement, absolute, relative};
use validation::evidence::Row;
use validation::instant::Instant;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    a_disc_precesses_steadily => (
        "`rolling_disc`: steady precession at leans from −70° to 70° needs no acceleration; the road carries weight and centripetal force",
        "Routh, art. 244; McDonald (2000), section 2",
        "1e-13 of the largest term: double precision"
    ),
    a_disc_moves_as_routh_says => (
        "`rolling_disc`: accelerations of lean, yaw and spin in arbitrary rolling motion",
        "Routh, art. 244; McDonald (2000), section 2",
        "1e-13 of the largest: double precision"
    ),
];

const M: f64 = 2.0;
const R: f64 = 0.5;
const G: f64 = 9.81;
const ACROSS: f64 = M * R * R / 4.0;
const ALONG: f64 = M * R * R / 2.0;

/// Total spin of the steady precession.
fn steady_spin(lean: f64, yaw_rate: f64) -> f64 {
    let (s, c) = lean.sin_cos();
    (ACROSS * yaw_rate * yaw_rate * s * c - M * G * R * s) / ((ALONG + M * R * R) * yaw_rate * c)
}

/// The rolling disc in a motion; speed and height follow from rolling.
fn rolling(lean: f64, lean_rate: f64, yaw_rate: f64, total_spin: f64) -> Instant {
    let mut disc = Instant::of("rolling_disc");
    disc.put(&[
        ("disc.yaw", 0.7),
        ("disc.roll", lean),
        ("disc.pitch", 0.3),
        ("disc.roll_rate", lean_rate),
        ("disc.yaw_rate", yaw_rate),
        ("disc.pitch_rate", total_spin - yaw_rate * lean.sin()),
    ]);
    disc
}

#[test]
fn a_disc_precesses_steadily() {
    let mut agreement = Agreement::on("rolling_disc: steady precession");
    for lean in [-70.0, -40.0, -10.0, 5.0, 30.0, 70.0_f64].map(f64::to_radians) {
        for yaw_rate in [-6.0, -1.5, 0.8, 4.0] {
            let spin = steady_spin(lean, yaw_rate);
            let disc = rolling(lean, 0.0, yaw_rate, spin);
            let what = format!("lean {lean:.2} rad, yaw rate {yaw_rate} rad/s");
            let force = M * (G + R * (spin * yaw_rate).abs());
            let double = absolute(1e-13 * force * R / ACROSS).because("double precision of the largest term");
            for name in ["forward_speed", "lateral_speed", "yaw_rate", "heave_rate", "roll_rate", "pitch_rate"] {
                agreement.near(&format!("{what}: {name}"), disc.rate(&format!("disc.{name}")), 0.0, &double);
            }
            let double = absolute(1e-13 * force).because("double precision of the largest term");
            agreement.near(&format!("{what}: speed"), disc.get("disc.forward_speed"), R * spin, &double);
            agreement.near(&format!("{what}: height"), disc.get("disc.heave"), R * lean.cos(), &double);
            agreement.near(&format!("{what}: load"), disc.get("contact.normal_force"), M * G, &double);
            agreement.near(&format!("{what}: side force"), disc.get("contact.lateral_force"), M * R * spin * yaw_rate, &double);
        }
    }
    agreement.assert();
}

#[test]
fn a_disc_moves_as_routh_says() {
    let mut agreement = Agreement::on("rolling_disc: accelerations");
    let double = relative(1e-13).because("double precision");
    for (lean, p, r, spin) in [(0.3, 0.7, -1.2, 6.0), (-0.9, -2.0, 3.0, -4.0), (1.2, 0.4, 0.1, 9.0), (0.0, 1.0, 2.0, 3.0)] {
        let (s, c) = f64::sin_cos(lean);
        let rolled = M * R * R;
        let lean_acceleration = ((ALONG + rolled) * spin * r * c - ACROSS * r * r * s * c + M * G * R * s) / (ACROSS + rolled);
        let yaw_acceleration = (2.0 * ACROSS * r * p * s - ALONG * spin * p) / (ACROSS * c);
        let spin_acceleration = -rolled * r * p * c / (ALONG + rolled);
        let pitch_acceleration = spin_acceleration - yaw_acceleration * s - r * p * c;
        let disc = rolling(lean, p, r, spin);
        let found = ["disc.roll_rate", "disc.yaw_rate", "disc.pitch_rate"].map(|name| disc.rate(name));
        agreement.all_near(&format!("lean {lean} rad"), &found, &[lean_acceleration, yaw_acceleration, pitch_acceleration], &double);
    }
    agreement.assert();
}
