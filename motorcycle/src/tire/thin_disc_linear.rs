//! Thin disc with linear friction and a hard cut of the load: the tire of the `moto11` benchmark.
//!
//! ```text
//! P = C − R e          N = max(0, k δ + c δ̇),      δ = −(P − P0)·k,   δ̇ = −v·k + δ k̇_z/k_z,   v = v_C + (w − n (n·w)) × (P − C)
//! V* = √((v·x)² + V0²)           α = −atan2(v·y, V*)        κ = −(v·x − R Ω')/V*
//! Fx = Kκ κ N          Fy = (Kα α − Kγ γ) N                  all forces at P, no moments
//! ```
//!
//! C center, n spin axis to the left, e upward in the plane of the disc, x, y forward and left on the road through P0, k its normal, v against
//! the road; R radius, m; w angular velocity of the carrier, Ω' = Ω + n·w spin of the disc in space, rad/s; k N/m, c N s/m; K per load. The force acts at the lowest
//! point of the undeformed disc, below the road. Camber γ is positive leaning right; the benchmark counts it positive leaning left.
//!
//! Source: definition of the benchmark, see `models/vehicles/moto11/SOURCE.md`.
//! Range: slips below about 0.1; no saturation. The cut of the load has a kink, so do not let the wheel hover.

use super::carcass::{Elastic, RoadContact};
use super::description::{LOW_SPEED, checked, wheel};
use super::law::{Friction, Slip, TireLaw};
use super::linear_normalized::{LinearNormalized, LinearNormalizedParameters};
use super::patch::{Patch, limits, outputs};
use super::wheel::{Rolling, Wheel};
use mbody::assembly::{ElementDescription, Site};
use mbody::contact::Profile;
use mbody::description::quantity::dimension::{Damping, Length, Number, PerAngle, Speed, Stiffness};
use mbody::description::quantity::{NonNegativeQuantity, PositiveQuantity, Quantity};
use mbody::force::{Declared, Effort, Energy, Evaluated, ForceLaw};
use mbody::scalar::SystemScalar;
use schemars::JsonSchema;
use serde::Deserialize;

/// A disc on a vertical spring, with friction linear in slip, camber and load.
#[derive(Clone, Debug)]
pub struct ThinDiscLinear {
    /// The wheel, with the cross-section of a disc.
    pub wheel: Wheel,
    /// Spring and damper along the normal of the road.
    pub normal: Elastic,
    /// Friction.
    pub law: LinearNormalized,
    /// Speed V0 below which slips are rounded, m/s.
    pub low_speed: f64,
}

impl ThinDiscLinear {
    #[inline]
    fn patch<S: SystemScalar>(&self, wheel: &Rolling<S>) -> Patch<S> {
        let (frame, radius) = (&wheel.frame, self.wheel.profile.radius());
        let arm = frame.e * -radius;
        // without the part of the carrier's rotation about the axle, which the benchmark counts as spin
        let about_axle = wheel.angular_velocity.dot(wheel.axis);
        let v = wheel.velocity_at(arm) + frame.x.scaled(about_axle * radius);
        let depth = wheel.penetration;
        // the force acts below a road that may steepen
        let depth_rate = depth * wheel.road.steepening() - v.dot(frame.k);
        let force = self.normal.force(depth, depth_rate);
        let load = if force.value() > 0.0 { force } else { S::zero() };

        let (speed_x, speed_y) = (v.dot(frame.x), v.dot(frame.y));
        let reference = (speed_x * speed_x + self.low_speed * self.low_speed).sqrt();
        // V* is positive: the arc tangent of the quotient is the angle
        let slip = Slip {
            load,
            lateral: -(speed_y / reference).atan(),
            longitudinal: (speed_x - (wheel.spin + about_axle) * radius) * -reference.recip(),
            camber: frame.camber,
            speed: reference,
        };
        let friction: Friction<S> = self.law.friction(&slip);
        let [stored, stored_rate] = self.normal.stored(RoadContact::Lifting.compressed(depth), depth_rate);
        Patch {
            arm,
            velocity: wheel.velocity_at(arm),
            lever: S::from_f64(radius),
            deflection: depth,
            effective_radius: S::from_f64(radius),
            load,
            support: load,
            friction,
            rolling_moment: S::zero(),
            slip_angle: slip.lateral,
            longitudinal_slip: slip.longitudinal,
            rows: [S::zero(); 2],
            stored,
            stored_rate,
        }
    }
}

impl ForceLaw for ThinDiscLinear {
    fn declare(&self, element: &str) -> Declared {
        Declared {
            inputs: self.wheel.inputs(),
            outputs: outputs(element),
            limits: limits(element, &self.wheel, self.law.saturates()),
            spinning: vec![self.wheel.body],
            ..Default::default()
        }
    }

    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let rolling = self.wheel.rolling(at);
        self.patch(&rolling).apply(&self.wheel, &rolling, out);
    }

    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        let rolling = self.wheel.rolling(at);
        self.patch(&rolling).energy(&rolling)
    }
}

/// Thin disc with linear friction and a hard cut of the load.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ThinDiscLinearDescription {
    /// Name of the wheel joint; its axis points left.
    wheel: String,
    /// Radius.
    radius: PositiveQuantity<Length>,
    /// Vertical stiffness.
    stiffness: PositiveQuantity<Stiffness>,
    /// Vertical damping.
    damping: NonNegativeQuantity<Damping>,
    /// Force forward per longitudinal slip and load.
    longitudinal_stiffness: NonNegativeQuantity<Number>,
    /// Side force per slip angle and load.
    cornering_stiffness: PositiveQuantity<PerAngle>,
    /// Side force toward the lean per camber and load.
    camber_stiffness: NonNegativeQuantity<PerAngle>,
    /// Speed below which slips are rounded; 0.1 m/s where left out.
    low_speed: Option<PositiveQuantity<Speed>>,
    /// Name of the road under this wheel: inputs `<road>.height`, `<road>.grade`, `<road>.cross_slope` and their rates; `road` where left out. Its friction changes nothing, because the law has no peak.
    road: Option<String>,
}

impl ElementDescription for ThinDiscLinearDescription {
    const KIND: &'static str = "thin_disc_linear";
    const ABOUT: &'static str = "tire of a benchmark: a thin disc on a vertical spring, friction linear in slip, camber and load";
    const EXAMPLE: &'static str = "{ wheel: rear_axle, radius: 0.32 m, stiffness: 150 kN/m, damping: 500 N s/m, \
        longitudinal_stiffness: 12, cornering_stiffness: 12 1/rad, camber_stiffness: 1 1/rad, road: rear_road }";
    type Law = ThinDiscLinear;
    fn assemble(self, site: &mut Site<'_>) -> Option<ThinDiscLinear> {
        let profile = Profile::Disc { radius: self.radius.si() };
        let parameters = LinearNormalizedParameters {
            longitudinal_stiffness: self.longitudinal_stiffness.si(),
            cornering_stiffness: self.cornering_stiffness.si(),
            camber_stiffness: self.camber_stiffness.si(),
            aligning_stiffness: 0.0,
            twisting_stiffness: 0.0,
        };
        let law = checked("cornering_stiffness", parameters.law(), site);
        Some(ThinDiscLinear {
            wheel: wheel(site, &self.wheel, profile, self.road)?,
            normal: Elastic { stiffness: self.stiffness.si(), damping: self.damping.si() },
            law: law?,
            low_speed: self.low_speed.map_or(LOW_SPEED, Quantity::si),
        })
    }
}
