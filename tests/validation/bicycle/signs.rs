//! From the axes and signs of the papers to the signals of `models/vehicles/whipple`.
//!
//! Ours: x forward, y left, z up, `R = Rz(ψ) Rx(φ) Ry(θ)` of the rear frame: ψ to the left, φ lean to the right, θ nose down, steer to the left, wheels
//! positive rolling forward; the base point lies r below the rear wheel center along −z of the rear frame.
//!
//! *Meijaard et al. and the motion M1*: x forward, y right, z down, the same order of rotations. The axes differ by half a turn about x, D = diag(1, −1, −1),
//! and so `R' = D R D = Rz(−ψ) Rx(φ) Ry(−θ)`: yaw, pitch, steer and wheel angles change their sign, lean does not; (x, y, z) become (x, −y, −z).
//!
//! *Basu-Mandal et al.*: z up; ψ_B = π/2 and φ_B = π in the upright design pose, and the bicycle then heads along −x. Their axes differ from ours by half a turn
//! about z: (x, y, z) become (−x, −y, z). Angles: yaw θ_B, lean π/2 − ψ_B, pitch φ_B − π, steer ψ_f, wheels β_r, β_f; rates and accelerations likewise.
//! Nothing of this is stated in words in the data file: it is what their numbers say. The tests below hold it to their own rolling conditions, which
//! any other choice of signs breaks: twice for each of x, y, z, once in the rates and once in the accelerations.

use mbody::spatial::{Rotation, Vec3};
use validation::agreement::{Agreement, absolute};
use validation::reference::Table;
use validation::tree::Named;

/// Radius of the rear wheel, m.
pub const REAR_RADIUS: f64 = 0.3;
/// Radius of the front wheel, m.
pub const FRONT_RADIUS: f64 = 0.35;

/// A quantity with its first and second rate.
pub type Rates = [f64; 3];

/// Yaw, roll and pitch of the rear frame in our signs.
#[derive(Clone, Copy, Debug)]
pub struct Attitude {
    pub yaw: Rates,
    pub roll: Rates,
    pub pitch: Rates,
}

/// Position, velocity and acceleration of a point in the world.
pub type Point = [Vec3<f64>; 3];

/// Axes and angular motion of the rear frame.
struct Turning {
    /// Heading, horizontal.
    e1: Vec3<f64>,
    /// Axis of the wheel, to the left.
    e2: Vec3<f64>,
    /// Upward in the plane of the wheel.
    e3: Vec3<f64>,
    /// Angular velocity and its rate.
    w: Vec3<f64>,
    wd: Vec3<f64>,
    /// Orientation.
    R: Rotation<f64>,
}

impl Attitude {
    /// `ω = ψ̇ z + φ̇ e₁ + θ̇ e₂`, `ω̇ = ψ̈ z + φ̈ e₁ + θ̈ e₂ + φ̇ (ψ̇ z × e₁) + θ̇ (ψ̇ z + φ̇ e₁) × e₂`: e₁ turns with ψ̇ z, e₂ with ψ̇ z + φ̇ e₁.
    fn turning(&self) -> Turning {
        let ([yaw, r, rd], [roll, p, pd], [pitch, q, qd]) = (self.yaw, self.roll, self.pitch);
        let rolled = Rotation::about_z(yaw) * Rotation::about_x(roll);
        let [e1, e2, e3] = rolled.columns;
        let z = Vec3::new(0.0, 0.0, 1.0);
        let carried = z * r + e1 * p;
        Turning {
            e1,
            e2,
            e3,
            w: carried + e2 * q,
            wd: z * rd + e1 * pd + e2 * qd + z.cross(e1) * (r * p) + carried.cross(e2) * q,
            R: rolled * Rotation::about_y(pitch),
        }
    }

    /// The base point, from the rear wheel center: `p + R d`, `v + ω × R d`, `a + ω̇ × R d + ω × (ω × R d)` with `d = (0, 0, −r)`.
    pub fn base_point(&self, center: Point) -> Point {
        let t = self.turning();
        let d = t.R * Vec3::new(0.0, 0.0, -REAR_RADIUS);
        let [p, v, a] = center;
        [p + d, v + t.w.cross(d), a + t.wd.cross(d) + t.w.cross(t.w.cross(d))]
    }

    /// Motion of the center of the rear wheel that rolls without slip on z = 0, up to its place on the road.
    ///
    /// The contact lies −r e₃ from the center, so `z = r cos φ` and `v = ω_W × r e₃ = r (Ω e₁ − φ̇ e₂)` with the total spin about the axis
    /// `Ω = β̇ + θ̇ + ψ̇ sin φ`; the acceleration is the rate of that.
    pub fn rolling_center(&self, spin: Rates) -> (f64, Vec3<f64>, Vec3<f64>) {
        let t = self.turning();
        let ([_, r, rd], [roll, p, pd], [_, q, qd]) = (self.yaw, self.roll, self.pitch);
        let (s, c) = roll.sin_cos();
        let (total, total_rate) = (spin[1] + q + r * s, spin[2] + qd + rd * s + r * p * c);
        let z = Vec3::new(0.0, 0.0, 1.0);
        let v = (t.e1 * total - t.e2 * p) * REAR_RADIUS;
        let a = t.e1 * total_rate + z.cross(t.e1) * (total * r) - t.e2 * pd - (z * r + t.e1 * p).cross(t.e2) * p;
        (REAR_RADIUS * c, v, a * REAR_RADIUS)
    }
}

/// A state of the bicycle in our signals; accelerations are rates of the velocities, by the names of the velocities.
#[derive(Clone, Debug)]
pub struct Motion {
    pub coordinates: Vec<Named>,
    pub velocities: Vec<Named>,
    pub accelerations: Vec<Named>,
}

impl Motion {
    /// From the rear wheel center, the attitude, and steer, rear wheel, front wheel.
    ///
    /// The base moves with `V = Rz(−ψ) v` and `V̇ = Rz(−ψ) a − ψ̇ z × V`, both horizontal.
    fn new(center: Point, attitude: &Attitude, joints: [Rates; 3]) -> Self {
        let base = attitude.base_point(center);
        let [yaw, r, rd] = attitude.yaw;
        let back = Rotation::about_z(-yaw);
        let V = back * base[1];
        let Vd = back * base[2] - Vec3::new(0.0, 0.0, r).cross(V);
        let [steer, rear, front] = joints;
        let (roll, pitch) = (attitude.roll, attitude.pitch);
        let velocities = |base: [f64; 3], turning: [f64; 3], joints: [f64; 3]| {
            vec![
                ("chassis.forward_speed", base[0]),
                ("chassis.lateral_speed", base[1]),
                ("chassis.yaw_rate", turning[0]),
                ("chassis.heave_rate", base[2]),
                ("chassis.roll_rate", turning[1]),
                ("chassis.pitch_rate", turning[2]),
                ("steer.rate", joints[0]),
                ("rear_wheel.spin_rate", joints[1]),
                ("front_wheel.spin_rate", joints[2]),
            ]
        };
        Self {
            coordinates: vec![
                ("chassis.x", base[0].x),
                ("chassis.y", base[0].y),
                ("chassis.yaw", yaw),
                ("chassis.heave", base[0].z),
                ("chassis.roll", roll[0]),
                ("chassis.pitch", pitch[0]),
                ("steer.angle", steer[0]),
                ("rear_wheel.angle", rear[0]),
                ("front_wheel.angle", front[0]),
            ],
            velocities: velocities([V.x, V.y, V.z], [r, roll[1], pitch[1]], [steer[1], rear[1], front[1]]),
            accelerations: velocities([Vd.x, Vd.y, Vd.z], [rd, roll[2], pitch[2]], [steer[2], rear[2], front[2]]),
        }
    }
}

/// The state of Basu-Mandal et al. (2007), table 1, in our signals.
pub fn basu_mandal() -> Motion {
    let (center, attitude, joints) = basu_mandal_parts();
    Motion::new(center, &attitude, joints)
}

fn basu_mandal_parts() -> (Point, Attitude, [Rates; 3]) {
    use std::f64::consts::{FRAC_PI_2, PI};
    let table = Table::read("bicycle/basu_mandal.csv");
    let get = |quantity: &str| ["value", "rate", "acceleration"].map(|c| table.number(table.find(&[("quantity", quantity)]), c));
    let (x, y, z) = (get("x"), get("y"), get("z"));
    // half a turn about z
    let center = [0, 1, 2].map(|k| Vec3::new(-x[k], -y[k], z[k]));
    let (lean, pitch) = (get("psi"), get("phi"));
    let attitude =
        Attitude { yaw: get("theta"), roll: [FRAC_PI_2 - lean[0], -lean[1], -lean[2]], pitch: [pitch[0] - PI, pitch[1], pitch[2]] };
    (center, attitude, [get("psif"), get("betar"), get("betaf")])
}

/// A sample of the motion M1 in our signals, without accelerations. The wheels' angles are not recorded and stay zero.
///
/// The rear contact is recorded; the wheel center stands r e₃ from it.
pub fn m1(table: &Table, row: usize) -> Motion {
    let get = |column: &str| table.number(row, column);
    // half a turn about x
    let attitude = Attitude {
        yaw: [-get("yaw"), -get("yaw_rate"), 0.0],
        roll: [get("roll"), get("roll_rate"), 0.0],
        pitch: [-get("pitch"), -get("pitch_rate"), 0.0],
    };
    let spin = |column: &str| [0.0, -get(column), 0.0];
    let (rear, front) = (spin("rear_wheel_rate"), spin("front_wheel_rate"));
    let contact = Vec3::new(get("x_rear_contact"), -get("y_rear_contact"), 0.0);
    let (_, v, _) = attitude.rolling_center(rear);
    let center = [contact + attitude.turning().e3 * REAR_RADIUS, v, Vec3::zero()];
    let mut motion = Motion::new(center, &attitude, [[-get("steer"), -get("steer_rate"), 0.0], rear, front]);
    motion.accelerations.clear();
    motion
}

#[test]
fn the_state_of_basu_mandal_rolls_without_slip_in_our_signs() {
    let (center, attitude, joints) = basu_mandal_parts();
    let (height, v, a) = attitude.rolling_center(joints[1]);
    let mut agreement = Agreement::on("Basu-Mandal: rear wheel rolls");
    let printed = absolute(5e-12).because("thirteen printed digits");
    agreement.near("height", center[0].z, height, &printed);
    for (what, found, expected) in [("velocity", center[1], v), ("acceleration", center[2], a)] {
        agreement.all_near(what, &[found.x, found.y, found.z], &[expected.x, expected.y, expected.z], &printed);
    }
    agreement.assert();
}

#[test]
fn velocity_and_acceleration_of_the_base_point_are_its_rates() {
    // a motion with constant third rates, differentiated centrally
    let along = |t: f64, [x, v, a]: Rates| [x + t * (v + 0.5 * t * a), v + t * a, a];
    let (center, attitude, _) = basu_mandal_parts();
    let at = |t: f64| {
        let moved = Attitude { yaw: along(t, attitude.yaw), roll: along(t, attitude.roll), pitch: along(t, attitude.pitch) };
        let [p, v, a] = center;
        moved.base_point([p + v * t + a * (0.5 * t * t), v + a * t, a])
    };
    let (h, now) = (1e-4, at(0.0));
    let (before, after) = (at(-h), at(h));
    let mut agreement = Agreement::on("motion of the base point");
    let rule = absolute(1e-6).because("central differences over 0.1 ms");
    for (what, order) in [("velocity", 0), ("acceleration", 1)] {
        let d = (after[order] - before[order]) * (0.5 / h);
        let expected = now[order + 1];
        agreement.all_near(what, &[d.x, d.y, d.z], &[expected.x, expected.y, expected.z], &rule);
    }
    agreement.assert();
}
