//! Drag, lift, pitching moment and side force of the air at one point of a body.
//!
//! ```text
//! v = v_P − w     V = √(v·v + V₀²)
//! F = −½ ρ V C_D A v  +  ½ ρ v·v C_L A z  −  ½ ρ V C_S A (v·y) y          M = −½ ρ v·v C_P A L y
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | v_P, w, v | m/s | velocity of the point, of the air, and of the point against the air |
//! | V₀ | m/s | 1e-6: keeps the drag differentiable at rest |
//! | ρ | kg/m³ | density of the air |
//! | C_D A, C_L A, C_S A | m² | drag, lift and side-force area; C_S per unit of the sine of the angle of attack from the side |
//! | C_P A L | m³ | pitching moment by dynamic pressure; **positive raises the nose**, hence the minus (y turns the nose down) |
//! | y, z | | left and up in the frame of the link |
//!
//! Source: quasi-steady aerodynamics, V. Cossalter, *Motorcycle Dynamics* (2006), chapter 3. Range: flow roughly from ahead; for the
//! side force `sin β = v·y/V` stands for β, 1 % off at 14 degrees. The wind blows horizontally, to the left of the heading.

use mbody::assembly::{ElementDescription, PointDescription, Site};
use mbody::description::quantity::dimension::{Area, Density, Volume};
use mbody::description::quantity::{NonNegativeQuantity, PositiveQuantity, Quantity};
use mbody::force::{Declared, Effort, Energy, Evaluated, ForceLaw, InputDeclared, OutputDeclared};
use mbody::model::BodyIndex;
use mbody::scalar::SystemScalar;
use mbody::spatial::{Pose, Vec3};
use schemars::JsonSchema;
use serde::Deserialize;

/// Density of the air where nothing else is said, kg/m³: standard atmosphere at sea level, 15 °C.
pub const STANDARD_DENSITY: f64 = 1.225;

/// Speed that keeps the drag differentiable at rest, m/s.
const ROUNDING: f64 = 1e-6;

/// Forces of the air at a point of a body.
#[derive(Clone, Debug)]
pub struct Aerodynamics {
    /// The body.
    pub body: BodyIndex,
    /// The point, and the axes of lift, side force and pitching moment, in the body.
    pub frame: Pose<f64>,
    /// C_D A, m².
    pub drag_area: f64,
    /// C_L A, m².
    pub lift_area: f64,
    /// C_S A, m².
    pub side_area: f64,
    /// C_P A L, m³, positive raises the nose.
    pub pitch_volume: f64,
    /// Density of the air, kg/m³.
    pub density: f64,
    /// First part of the name of the input: `wind` reads `wind.lateral`.
    pub wind: String,
}

/// What the air does at one instant, in the world.
struct Flow<S> {
    point: Vec3<S>,
    velocity: Vec3<S>,
    relative: Vec3<S>,
    speed: S,
    drag: Vec3<S>,
    lift: S,
    side: Vec3<S>,
    up: Vec3<S>,
    moment: Vec3<S>,
    nose_up: S,
}

impl Aerodynamics {
    fn flow<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Flow<S> {
        let X = at.X_WB(self.body);
        let [y, z] = [1, 2].map(|k| X.R.times_const(self.frame.R.columns[k]));
        let point = X.point_const(self.frame.p);
        // the horizontal part of y is across the heading, whatever roll and pitch
        let across = (y.x * y.x + y.y * y.y).sqrt().recip() * at.input(0);
        let wind = Vec3::new(y.x * across, y.y * across, S::zero());
        let velocity = at.v_WQ(self.body, point);
        let relative = velocity - wind;
        let squared = relative.dot(relative);
        let speed = (squared + ROUNDING * ROUNDING).sqrt();
        let pressure = squared * (0.5 * self.density);
        let drag = -relative.scaled(speed * (0.5 * self.density * self.drag_area));
        let side = -y.scaled(speed * relative.dot(y) * (0.5 * self.density * self.side_area));
        let nose_up = pressure * self.pitch_volume;
        Flow { point, velocity, relative, speed, drag, lift: pressure * self.lift_area, side, up: z, moment: -y.scaled(nose_up), nose_up }
    }
}

impl<S: SystemScalar> Flow<S> {
    fn force(&self) -> Vec3<S> {
        self.drag + self.side + self.up.scaled(self.lift)
    }
}

impl ForceLaw for Aerodynamics {
    fn declare(&self, element: &str) -> Declared {
        let output = |quantity, unit, about| OutputDeclared { name: format!("{element}.{quantity}"), unit, about };
        let outputs = vec![
            output("drag", "N", "force of the air against the motion"),
            output("lift", "N", "force of the air upward in the frame of the link"),
            output("pitch_moment", "N m", "moment of the air, positive raises the nose"),
            output("air_speed", "m/s", "speed against the air"),
        ];
        let about = "speed of the air across the heading, positive blows to the left";
        let wind = InputDeclared { name: format!("{}.lateral", self.wind), unit: "m/s", about, nominal: 10.0, rate: None, default: 0.0 };
        Declared { inputs: vec![wind], outputs, ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let flow = self.flow(at);
        out.force_and_moment(self.body, flow.point, flow.force(), flow.moment);
        let drag = flow.relative.dot(flow.relative) * (0.5 * self.density * self.drag_area);
        for (i, value) in [drag, flow.lift, flow.nose_up, flow.speed].into_iter().enumerate() {
            out.output(i, value);
        }
    }
    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        let flow = self.flow(at);
        // friction against the air is heat; what lift, moment and wind do comes from outside
        let dissipated = -(flow.drag + flow.side).dot(flow.relative);
        let power = flow.force().dot(flow.velocity) + flow.moment.dot(at.w_WB(self.body));
        Energy { supplied: power + dissipated, dissipated, ..Default::default() }
    }
}

/// Forces of the air at a point of a link.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AerodynamicsDescription {
    /// Center of pressure, or the reference point of the pitching moment; the link's axes point forward, left and up.
    point: PointDescription,
    /// Drag coefficient times frontal area.
    #[schemars(extend("plausible" = [0.01, 5.0]))]
    drag_area: NonNegativeQuantity<Area>,
    /// Lift coefficient times frontal area; positive lifts.
    lift_area: Option<Quantity<Area>>,
    /// Side-force coefficient (per radian of side wind angle) times frontal area, on top of the drag along the wind.
    side_area: Option<NonNegativeQuantity<Area>>,
    /// Pitching-moment coefficient times frontal area times reference length; positive raises the nose.
    pitch_volume: Option<Quantity<Volume>>,
    /// Density of the air; 1.225 kg/m³ where left out.
    #[schemars(extend("plausible" = [0.3, 2.0]))]
    density: Option<PositiveQuantity<Density>>,
    /// First part of the name of the input: `wind`, also where left out, reads `wind.lateral`.
    wind: Option<String>,
}

impl ElementDescription for AerodynamicsDescription {
    const KIND: &'static str = "aerodynamics";
    const ABOUT: &'static str = "drag, lift, pitching moment and side force of the air at a point, with the input `wind.lateral`";
    const EXAMPLE: &'static str = "{ point: { link: chassis, at: [0.7, 0, 0.6] }, drag_area: 0.32 m^2, lift_area: 0.05 m^2, \
        pitch_volume: 0.02 m^3, density: 1.225 kg/m^3 }";
    const TREE: &'static str = crate::EXAMPLE_TREE;
    type Law = Aerodynamics;
    fn assemble(self, site: &mut Site<'_>) -> Option<Aerodynamics> {
        let (body, X) = site.link("point.link", &self.point.link)?;
        let si = |area: Option<Quantity<Area>>| area.map_or(0.0, Quantity::si);
        Some(Aerodynamics {
            body,
            frame: X * Pose::from_xyz_rpy(self.point.at.map(Quantity::si), [0.0; 3]),
            drag_area: self.drag_area.si(),
            lift_area: si(self.lift_area),
            side_area: self.side_area.map_or(0.0, Quantity::si),
            pitch_volume: self.pitch_volume.map_or(0.0, Quantity::si),
            density: self.density.map_or(STANDARD_DENSITY, Quantity::si),
            wind: self.wind.unwrap_or_else(|| "wind".to_owned()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench_tree::{Bench, tree};
    use mbody::force::Force;

    /// Suzuki GSX-R1000 of Sharp, Evangelou and Limebeer (2004): Cd 0.48, Cl 0.078, Cpitch 0.189, A 0.65 m², L 1.41 m.
    fn gsxr1000() -> Aerodynamics {
        Aerodynamics {
            body: tree().1.chassis,
            frame: Pose::from_xyz_rpy([0.705, 0.0, 0.0], [0.0; 3]),
            drag_area: 0.48 * 0.65,
            lift_area: 0.078 * 0.65,
            side_area: 0.3,
            pitch_volume: 0.189 * 0.65 * 1.41,
            density: 1.225,
            wind: "wind".into(),
        }
    }

    #[test]
    fn upright_at_60_m_per_s() {
        let mut bench = Bench::new(vec![Force::new("aero", gsxr1000())]);
        bench.rest();
        bench.set("chassis.forward_speed", 60.0);
        let q = 0.5 * 1.225 * 3600.0;
        let close = |value: f64, expected: f64| assert!((value - expected).abs() < 1e-6 * expected.abs(), "{value} against {expected}");
        close(bench.output("aero.drag"), q * 0.312);
        close(bench.output("aero.lift"), q * 0.0507);
        close(bench.effort("chassis.forward_speed"), -q * 0.312);
        close(bench.effort("chassis.heave_rate"), q * 0.0507);
        // about the base point: nose up is negative, and so is the lift ahead of it
        close(bench.effort("chassis.pitch_rate"), -q * (0.189 * 0.65 * 1.41) - q * 0.0507 * 0.705);
        // wind to the left pushes to the left
        bench.set("wind.lateral", 5.0);
        assert!(bench.effort("chassis.lateral_speed") > 0.0);
    }

    #[test]
    fn wind_is_across_the_heading_whatever_yaw_roll_and_pitch() {
        let mut bench =
            Bench::new(vec![Force::new("aero", Aerodynamics { lift_area: 0.0, side_area: 0.0, pitch_volume: 0.0, ..gsxr1000() })]);
        bench.rest();
        for (signal, value) in [("chassis.yaw", 2.1), ("chassis.roll", 0.7), ("chassis.pitch", 0.2), ("wind.lateral", 12.0)] {
            bench.set(signal, value);
        }
        let expected = 0.5 * 1.225 * 0.312 * 144.0;
        assert!((bench.effort("chassis.lateral_speed") - expected).abs() < 1e-6 * expected);
        assert!(bench.effort("chassis.forward_speed").abs() < 1e-9 && bench.effort("chassis.heave_rate").abs() < 1e-9);
    }

    #[test]
    fn derivatives_are_exact_and_energy_balances() {
        let mut bench = Bench::new(vec![Force::new("aero", gsxr1000())]);
        for wind in [0.0, -7.0] {
            bench.set("wind.lateral", wind);
            bench.set("chassis.roll", 0.6);
            bench.assert_derivatives_are_exact();
            bench.assert_energy_balances();
        }
    }
}
