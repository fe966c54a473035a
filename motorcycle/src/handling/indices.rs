//! Handling indices: how much steering torque a vehicle asks for, and how it turns.
//!
//! ```text
//! Koch index             K = max|τ| / (V max|φ̇|)               at the entrance of a curve
//! lane change roll index C = (max τ − min τ) / ((max φ̇ − min φ̇) V̄)
//! acceleration, roll and yaw index  τ/a_y,  τ/φ,  τ/ψ̇          in a steady turn
//! steering ratio         ξ = R₀/R                              in a steady turn; ξ > 1 oversteers, 0 < ξ < 1 understeers
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | τ | N m | steering torque, positive to the left |
//! | φ, φ̇ | rad, rad/s | roll, its rate, positive to the right |
//! | a_y, ψ̇ | m/s², rad/s | lateral acceleration, yaw rate, positive to the left |
//! | V, V̄ | m/s | speed; mean speed |
//! | R₀ | m | radius of the rear contact point if no wheel slipped sideways: where the axles, projected onto the road, meet |
//! | R | m | radius of the rear contact point |
//!
//! Where ξ < 0, the bar is turned out of the turn: so much do leaning wheels push. Koch and lane change roll index are of magnitudes, N s²/rad. A negative acceleration index (or a positive roll index) means that the rider pushes the bar
//! out of the turn, which riders prefer.
//!
//! Source: V. Cossalter, *Motorcycle Dynamics* (2006), chapters 4 and 8; V. Cossalter, J. Sadauckas, Vehicle System Dynamics 44 (2006) 1–17 (lane change);
//! theory manual 11. Range: level road; the first two while the rider neither falls nor loses the path.

/// Largest magnitude.
fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, v| most.max(v.abs()))
}

/// From the smallest to the largest value.
fn span(values: &[f64]) -> f64 {
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)));
    high - low
}

/// Koch index, N s²/rad, of torques (N m) and roll rates (rad/s) at the entrance of a curve at a speed (m/s).
pub fn koch(torque: &[f64], roll_rate: &[f64], speed: f64) -> f64 {
    peak(torque) / (speed * peak(roll_rate))
}

/// Lane change roll index, N s²/rad, of torques (N m), roll rates (rad/s) and speeds (m/s) of a lane change.
pub fn lane_change_roll(torque: &[f64], roll_rate: &[f64], speed: &[f64]) -> f64 {
    let mean = speed.iter().sum::<f64>() / speed.len() as f64;
    span(torque) / (span(roll_rate) * mean)
}

/// Curvature, 1/m and positive to the left, of the path of a point at (x, y) (m, in axes of the heading, from the base point) of a body with the speeds
/// (m/s) and the yaw rate (rad/s) of its base point.
pub fn curvature((x, y): (f64, f64), (forward, lateral): (f64, f64), yaw_rate: f64) -> f64 {
    yaw_rate / (forward - yaw_rate * y).hypot(lateral + yaw_rate * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_of_numbers_by_hand() {
        // 18 N m at 0.6 rad/s and 20 m/s
        assert!((koch(&[0.0, -18.0, 7.0], &[0.1, -0.6, 0.3], 20.0) - 1.5).abs() < 1e-15);
        // 30 N m from peak to peak, 1.5 rad/s, 20 m/s on the average
        assert!((lane_change_roll(&[-10.0, 20.0], &[0.5, -1.0], &[19.0, 21.0]) - 1.0).abs() < 1e-15);
        assert!((lane_change_roll(&[10.0, -20.0], &[-0.5, 1.0], &[19.0, 21.0]) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn points_turn_about_one_center() {
        // center 50 m to the left of the base point, which moves straight ahead
        let (forward, yaw_rate) = (20.0, 0.4);
        assert!((curvature((0.0, 0.0), (forward, 0.0), yaw_rate) - 0.02).abs() < 1e-15);
        assert!((curvature((0.0, 10.0), (forward, 0.0), yaw_rate) - 1.0 / 40.0).abs() < 1e-15);
        assert!((curvature((30.0, 10.0), (forward, 0.0), yaw_rate) - 1.0 / 50.0).abs() < 1e-15);
        assert!((curvature((0.0, -10.0), (forward, 0.0), -yaw_rate) + 1.0 / 40.0).abs() < 1e-15);
    }
}
