//! Signals of a single-track vehicle as a whole; no forces.
//!
//! ```text
//! a_y = V_x r     κ = r/√(V_x² + V₀²)     τ_n = τ r/√(r² + r₀²)     p = |P_f − P_r|
//! trail = (G − P_f)·x     normal trail = ((P_f − O) × s)·n     κ₀ = (y_r·x)/((P_f − P_r)·x)
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | V_x, r | m/s, rad/s | speed of the base point along the heading, yaw rate, positive to the left |
//! | a_y, κ | m/s², 1/m | lateral acceleration and curvature, positive in a turn to the left |
//! | τ, τ_n | N m | torque of the rider; the same, positive when it acts in the sense of the yaw rate |
//! | P_f, P_r | m | contact points of undeformed tires with the road under each of them |
//! | O, s, G | m | point of the steering axis, its upward direction, its intersection with the road under the front wheel |
//! | x, n | | forward along the contact, axis of the front wheel to the left |
//! | κ₀, y_r | 1/m | kinematic curvature: that of the path of P_r if no wheel slipped sideways, positive to the left; y_r across the contact at the rear |
//! | V₀, r₀ | | 0.001 m/s, 0.001 rad/s: keep the signals differentiable at rest and in straight running |
//!
//! Where several wheels stand side by side in front or at the rear ([`super::MultiTrack`]), P, x, n and y are means over them.
//!
//! Source: V. Cossalter, *Motorcycle Dynamics* (2006), chapters 1, 4 and 7 (definitions). Range: a road that inputs tell, level where no road is named; lean as in `mbody`'s contact geometry.

use crate::road::Footing;
use crate::road::footing::QUANTITIES;
use crate::signal::turning_axis;
use mbody::assembly::{ElementDescription, Site};
use mbody::contact::{Contact, Plane, Profile, Surface, TangentPlane};
use mbody::description::finding::Finding;
use mbody::description::quantity::dimension::Length;
use mbody::description::quantity::{NonNegativeQuantity, PositiveQuantity, Quantity};
use mbody::force::{Declared, Effort, Energy, Evaluated, ForceLaw, InputDeclared, OutputDeclared};
use mbody::model::BodyIndex;
use mbody::scalar::{SystemScalar, smooth::sabs};
use mbody::spatial::Vec3;
use schemars::JsonSchema;
use serde::Deserialize;

/// Speed that keeps the curvature differentiable at rest, m/s.
const SPEED_ROUNDING: f64 = 1e-3;
/// Yaw rate over which the normalized torque turns its sign, rad/s.
const YAW_RATE_ROUNDING: f64 = 1e-3;

/// A wheel with the shape of its tire.
#[derive(Clone, Debug)]
pub struct Wheel {
    /// The wheel.
    pub body: BodyIndex,
    /// Unit axis of the spin, to the left, in the wheel.
    pub axis: Vec3<f64>,
    /// Shape of the tire.
    pub profile: Profile,
    /// The road as inputs tell it; none: the plane z = 0.
    pub road: Option<Footing>,
}

impl Wheel {
    /// Contact, spin axis and road; `first` is the place of the road among the inputs.
    pub(super) fn contact<S: SystemScalar>(&self, at: &Evaluated<'_, S>, first: usize) -> (Contact<S>, Vec3<S>, TangentPlane<S>) {
        let X = at.X_WB(self.body);
        let axis = X.R.times_const(self.axis);
        let plane = match &self.road {
            Some(road) => road.under(at, first).plane,
            None => Plane::LEVEL.tangent_plane(X.p.x, X.p.y),
        };
        (Contact::with_plane(&self.profile, X.p, axis, &plane), axis, plane)
    }

    pub(super) fn inputs(&self) -> Vec<InputDeclared> {
        self.road.as_ref().map(Footing::inputs).unwrap_or_default()
    }
}

/// Number of inputs that tell the roads of these wheels.
pub(super) fn inputs_of(wheels: &[Wheel]) -> usize {
    wheels.iter().filter(|wheel| wheel.road.is_some()).count() * QUANTITIES.len()
}

/// Where an axle touches the road: means over its wheels.
struct Touch<S> {
    point: Vec3<S>,
    forward: Vec3<S>,
    across: Vec3<S>,
    axis: Vec3<S>,
    /// A point of the road and its normal.
    ground: Vec3<S>,
    normal: Vec3<S>,
}

impl<S: SystemScalar> Touch<S> {
    /// `first` is the place of the roads among the inputs.
    fn of(wheels: &[Wheel], at: &Evaluated<'_, S>, first: usize) -> Self {
        let touch = |k: usize| {
            let (contact, axis, road) = wheels[k].contact(at, first + inputs_of(&wheels[..k]));
            let (forward, across) = (contact.frame.x, contact.frame.y);
            Self { point: contact.point, forward, across, axis, ground: road.point, normal: road.normal }
        };
        let mut sum = touch(0);
        if wheels.len() == 1 {
            return sum;
        }
        for k in 1..wheels.len() {
            let one = touch(k);
            sum = Self {
                point: sum.point + one.point,
                forward: sum.forward + one.forward,
                across: sum.across + one.across,
                axis: sum.axis + one.axis,
                ground: sum.ground + one.ground,
                normal: sum.normal + one.normal,
            };
        }
        let unit = |v: Vec3<S>| v.scaled(v.norm().recip());
        let mean = |v: Vec3<S>| v.scaled(S::from_f64(1.0 / wheels.len() as f64));
        Self {
            point: mean(sum.point),
            forward: unit(sum.forward),
            across: unit(sum.across),
            axis: unit(sum.axis),
            ground: mean(sum.ground),
            normal: unit(sum.normal),
        }
    }
}

/// Observer of a single-track vehicle.
#[derive(Clone, Debug)]
pub struct SingleTrack {
    /// The body on the vehicle base.
    pub base: BodyIndex,
    /// The body carried by the steering joint, whose origin lies on the steering axis.
    pub steer: BodyIndex,
    /// Unit axis of the steering, upward, in that body.
    pub steer_axis: Vec3<f64>,
    /// Front wheels, at least one.
    pub front: Vec<Wheel>,
    /// Rear wheels, at least one.
    pub rear: Vec<Wheel>,
    /// First part of the name of the input: `steer` reads `steer.torque`.
    pub input: String,
}

/// Number of outputs.
pub(super) const OUTPUTS: usize = 7;

impl ForceLaw for SingleTrack {
    fn declare(&self, _element: &str) -> Declared {
        let about = "torque of the rider on the handlebar, positive turns it to the left";
        let torque = InputDeclared { name: format!("{}.torque", self.input), unit: "N m", about, nominal: 100.0, rate: None, default: 0.0 };
        let output = |name: &str, unit, about| OutputDeclared { name: name.into(), unit, about };
        let outputs = vec![
            output("lateral_acceleration", "m/s²", "forward speed times yaw rate, positive to the left"),
            output("curvature", "1/m", "yaw rate over speed, positive to the left"),
            output("steer.torque_normalized", "N m", "steering torque, positive when it acts in the sense of the yaw rate"),
            output("wheelbase", "m", "distance of the contact points"),
            output("trail", "m", "from the front contact point forward to the steering axis, on the road"),
            output("normal_trail", "m", "distance of the front contact point from the steering axis, positive behind it"),
            output("kinematic_curvature", "1/m", "curvature of the rear contact's path if no wheel slipped sideways, positive to the left"),
        ];
        let inputs = [torque].into_iter().chain(self.front.iter().chain(&self.rear).flat_map(Wheel::inputs)).collect();
        Declared { inputs, outputs, tells_only: true, ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let (V, r) = (at.speeds(self.base)[0], at.speeds(self.base)[2]);
        out.output(0, V * r);
        out.output(1, r / sabs(V, SPEED_ROUNDING));
        out.output(2, at.input(0) * r / sabs(r, YAW_RATE_ROUNDING));

        let behind = 1 + inputs_of(&self.front);
        let (front, rear) = (Touch::of(&self.front, at, 1), Touch::of(&self.rear, at, behind));
        out.output(3, (front.point - rear.point).norm());
        let X = at.X_WB(self.steer);
        let s = X.R.times_const(self.steer_axis);
        let on_road = X.p - s.scaled((X.p - front.ground).dot(front.normal) / s.dot(front.normal));
        out.output(4, (on_road - front.point).dot(front.forward));
        out.output(5, (front.point - X.p).cross(s).dot(front.axis));
        // the axles, projected onto the road, meet at P_r + y_r/κ₀
        out.output(6, rear.across.dot(front.forward) / (front.point - rear.point).dot(front.forward));
    }
    fn energy<S: SystemScalar>(&self, _at: &Evaluated<'_, S>) -> Energy<S> {
        Energy::default()
    }
}

/// Mass of vehicles of this sort with their riders, kg: from a child's bicycle frame to the heaviest sidecar outfit.
const USUAL_MASS: (f64, f64) = (5.0, 1500.0);

/// A wheel with the shape of its tire.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WheelDescription {
    /// Name of the joint of the wheel.
    joint: String,
    /// Radius of the tire.
    #[schemars(extend("plausible" = [0.05, 1.0]))]
    radius: PositiveQuantity<Length>,
    /// Radius of the cross-section of the tire; zero, a sharp edge, where left out.
    #[schemars(extend("plausible" = [0.001, 0.3]))]
    crown_radius: Option<NonNegativeQuantity<Length>>,
    /// Name of the road under this wheel, as its tire has it; the level z = 0 where left out.
    road: Option<String>,
}

/// Signals of a single-track vehicle as a whole.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SingleTrackDescription {
    /// Name of the link that moves on the vehicle base.
    base: String,
    /// Name of the steering joint.
    steer: String,
    /// Front wheel.
    front_wheel: WheelDescription,
    /// Rear wheel.
    rear_wheel: WheelDescription,
    /// First part of the name of the torque of the rider: `steer`, also where left out, reads `steer.torque`.
    input: Option<String>,
}

impl WheelDescription {
    pub(super) fn wheel(&self, key: &str, site: &mut Site<'_>) -> Option<Wheel> {
        let body = site.joint_with(&format!("{key}.joint"), &self.joint, "rad")?;
        match Profile::torus(self.radius.si(), self.crown_radius.map_or(0.0, Quantity::si)) {
            Ok(profile) => {
                let road = self.road.as_ref().map(|road| Footing::new(site.model(), body, road.clone()).below(site, body));
                Some(Wheel { body, axis: turning_axis(site.model(), body), profile, road })
            }
            Err(error) => {
                site.refuse(&format!("{key}.crown_radius"), "invalid_profile", error.to_string());
                None
            }
        }
    }
}

impl ElementDescription for SingleTrackDescription {
    const KIND: &'static str = "single_track";
    const ABOUT: &'static str = "signals of a single-track vehicle: lateral_acceleration, curvature, steer.torque_normalized, wheelbase, trail, normal_trail, kinematic_curvature";
    const EXAMPLE: &'static str = "{ base: chassis, steer: steer, front_wheel: { joint: front_wheel, radius: 0.3 m, crown_radius: 60 mm, road: front_road }, \
        rear_wheel: { joint: rear_wheel, radius: 0.32 m, crown_radius: 95 mm, road: rear_road } }";
    const TREE: &'static str = crate::EXAMPLE_TREE;
    type Law = SingleTrack;
    fn assemble(self, site: &mut Site<'_>) -> Option<SingleTrack> {
        let course = Course::find(&self.base, &self.steer, site);
        let (front, rear) = (self.front_wheel.wheel("front_wheel", site), self.rear_wheel.wheel("rear_wheel", site));
        let (course, front, rear) = (course?, front?, rear?);
        Some(course.observer(vec![front], vec![rear], self.input))
    }
}

/// The base and the steering of a vehicle.
pub(super) struct Course {
    base: BodyIndex,
    steer: BodyIndex,
    steer_axis: Vec3<f64>,
}

impl Course {
    /// Link on the vehicle base and steering joint of these names; `None` with a finding where they are something else.
    pub(super) fn find(base_name: &str, steer_name: &str, site: &mut Site<'_>) -> Option<Self> {
        let base = site.link("base", base_name);
        let steer = site.joint_with("steer", steer_name, "rad");
        let (base, steer) = (base?.0, steer?);
        let names: Vec<_> = site.model().body(base).joint.velocities().iter().map(|v| v.name).collect();
        if names.first() != Some(&"forward_speed") || names.get(2) != Some(&"yaw_rate") {
            let message = format!("link `{base_name}` does not move on a vehicle base, so it has no forward speed and no yaw rate");
            site.refuse("base", "wrong_link", message);
            return None;
        }
        let mass = site.model().total_mass();
        if !(USUAL_MASS.0..=USUAL_MASS.1).contains(&mass) {
            let message = format!("the vehicle has a mass of {mass} kg, {} to {} kg are usual", USUAL_MASS.0, USUAL_MASS.1);
            site.find("", Finding::warning("suspicious_value", message).with_hint("masses of a URDF are in kg, inertias in kg m²"));
        }
        let steer_axis = turning_axis(site.model(), steer);
        if (site.design_pose(steer).R * steer_axis).z <= 0.0 {
            site.refuse("steer", "wrong_joint", format!("the axis of joint `{steer_name}` does not point upward"));
            return None;
        }
        Some(Self { base, steer, steer_axis })
    }

    /// The observer with these wheels, each list at least one.
    pub(super) fn observer(self, front: Vec<Wheel>, rear: Vec<Wheel>, input: Option<String>) -> SingleTrack {
        let Self { base, steer, steer_axis } = self;
        SingleTrack { base, steer, steer_axis, front, rear, input: input.unwrap_or_else(|| "steer".to_owned()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench_tree::{Bench, tree};
    use mbody::force::Force;

    fn observer() -> Bench {
        let bodies = tree().1;
        let left = Vec3::new(0.0, 1.0, 0.0);
        let wheel = |body, radius, crown| Wheel { body, axis: left, profile: Profile::torus(radius, crown).unwrap(), road: None };
        let law = SingleTrack {
            base: bodies.chassis,
            steer: bodies.front_upper,
            steer_axis: Vec3::new(0.0, 0.0, 1.0),
            front: vec![wheel(bodies.front_rim, 0.3, 0.06)],
            rear: vec![wheel(bodies.rear_rim, 0.32, 0.095)],
            input: "steer".into(),
        };
        Bench::new(vec![Force::new("handling", law)])
    }

    #[test]
    fn design_geometry_is_that_of_the_drawing() {
        let mut bench = observer();
        bench.rest();
        // 0.03 m offset and 0.49 m down an axis inclined by 0.42 rad from (1.2, 0.75)
        let (sin, cos) = 0.42f64.sin_cos();
        let axle = (1.2 + 0.03 * cos + 0.49 * sin, 0.75 + 0.03 * sin - 0.49 * cos);
        let wheelbase = axle.0;
        assert!((bench.output("wheelbase") - wheelbase).abs() < 1e-12);
        let trail = 1.2 + 0.75 * sin / cos - wheelbase;
        assert!((bench.output("trail") - trail).abs() < 1e-12);
        assert!((bench.output("normal_trail") - trail * cos).abs() < 1e-12);
    }

    /// Upright, a bar turned by δ points the front wheel by `atan(sin δ cos ε / cos δ)` to the side: `tan Δ = tan δ cos ε` (Cossalter, 1.4).
    #[test]
    fn an_upright_bar_turns_as_the_caster_says() {
        let mut bench = observer();
        bench.rest();
        assert!(bench.output("kinematic_curvature").abs() < 1e-15);
        for angle in [0.2_f64, -0.1] {
            bench.set("steer.angle", angle);
            let (wheelbase, curvature) = (bench.output("wheelbase"), bench.output("kinematic_curvature"));
            // the contact point moves aside with the trail: the wheelbase along x is shorter by less than its square over p
            let expected = angle.tan() * 0.42_f64.cos() / wheelbase;
            assert!((curvature / expected - 1.0).abs() < 3e-2 && curvature * angle > 0.0, "{curvature} {expected}");
        }
    }

    #[test]
    fn signs_in_a_left_and_a_right_turn() {
        let mut bench = observer();
        bench.rest();
        bench.set("chassis.forward_speed", 20.0);
        bench.set("steer.torque", 3.0);
        for (rate, normalized) in [(0.25, 3.0), (-0.25, -3.0), (0.0, 0.0)] {
            bench.set("chassis.yaw_rate", rate);
            assert!((bench.output("lateral_acceleration") - 20.0 * rate).abs() < 1e-12);
            assert!((bench.output("curvature") - rate / 20.0).abs() < 1e-10);
            // rounded over 0.001 rad/s: (0.001/0.25)²/2 of 3 N m
            assert!((bench.output("steer.torque_normalized") - normalized).abs() < 3e-5);
        }
    }

    #[test]
    fn derivatives_are_exact_and_nothing_acts() {
        let mut bench = observer();
        bench.assert_derivatives_are_exact();
        bench.assert_energy_balances();
        assert!(bench.efforts().iter().all(|e| e.abs() == 0.0));
    }
}
