//! Shock absorber of a swingarm: a one-dimensional law on the length of the shock, carried over to the angle of the arm.
//!
//! `x = l(a₀) − l(a)`, `F = F(x, ẋ)` with `ẋ = −(dl/da) ȧ`, moment opposing bump `M = −F dl/da`.
//!
//! | symbol | unit | |
//! |---|---|---|
//! | a, a₀ | rad | angle of the arm, positive in bump; in the design pose |
//! | l(a), dl/da | m, m/rad | length of the shock and motion ratio, by the geometry: direct, table, or linkage; the slope by jets, exact |
//! | x, F | m, N | compression, and force of the shock, positive when it pushes |
//! | M | N m | on the joint of the arm, positive against a positive angle |
//!
//! Source: virtual work, `M δa = −F δl`; V. Cossalter, *Motorcycle Dynamics* (2006), chapter 5. The parts of F are those of `mbody`'s
//! one-dimensional laws. No mass in the shock. Range of a linkage: see [`Linkage`].

use super::{Linkage, LinkagePoints, SUSPENSION_STOP};
use crate::Planar;
use crate::signal::turning_axis;
use mbody::assembly::characteristic::{
    AirDescription, DamperDescription, FrictionDescription, LawDescription, Sliding, SpringDescription, StopsDescription,
};
use mbody::assembly::{ElementDescription, PointDescription, Site};
use mbody::description::quantity::dimension::{Angle, Length};
use mbody::description::quantity::{PositiveQuantity, Quantity};
use mbody::force::{Declared, Effort, Energy, Evaluated, ForceLaw, LimitDeclared, OutputDeclared, SpringDamperLaw, stop_limits};
use mbody::model::BodyIndex;
use mbody::scalar::{CubicSpline, Jet, Real, SystemScalar, spline::Ends};
use mbody::spatial::{Rotation, Vec3};
use problem::Side;
use schemars::JsonSchema;
use serde::Deserialize;

/// How the length of the shock depends on the angle of the arm.
#[derive(Clone, Debug)]
pub enum ShockGeometry {
    /// A point of the frame and a point of the arm.
    Direct {
        /// Unit axis of the arm, in the body that carries it.
        axis: Vec3<f64>,
        /// From the pivot to the mount on the frame, in the body that carries the arm.
        frame: Vec3<f64>,
        /// From the pivot to the mount on the arm in the design pose, in the body that carries the arm.
        arm: Vec3<f64>,
    },
    /// Length against angle.
    Table(CubicSpline),
    /// Pull rod and rocker.
    Linkage {
        /// The linkage, in terms of the angle about y to the left.
        linkage: Linkage,
        /// 1 where the joint turns about +y, −1 where it turns about −y.
        sense: f64,
    },
}

impl ShockGeometry {
    /// Length of the shock, m, at the arm angle `a` from the design pose.
    #[inline]
    pub fn length<S: Real>(&self, a: S) -> S {
        match self {
            Self::Direct { axis, frame, arm } => (Rotation::about_axis(*axis, a).times_const(*arm) - Vec3::from_f64(*frame)).norm(),
            Self::Table(table) => table.value(a),
            Self::Linkage { linkage, sense } => linkage.length(a * *sense),
        }
    }
}

/// A shock between frame and arm.
#[derive(Clone, Debug)]
pub struct SwingarmShock {
    /// The body carried by the joint of the arm.
    pub joint: BodyIndex,
    /// Angle of the joint in the design pose, rad.
    pub design_angle: f64,
    /// Length of the shock in the design pose, m.
    pub design_length: f64,
    /// Length against angle.
    pub geometry: ShockGeometry,
    /// The law of the shock in terms of its compression.
    pub law: SpringDamperLaw,
}

impl SwingarmShock {
    /// Length of the shock and its derivative by the angle.
    #[inline]
    fn length<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> (S, S) {
        let l = self.geometry.length(Jet::new(at.coordinate(self.joint) - self.design_angle, S::one(), S::zero()));
        (l.x, l.d)
    }
}

impl ForceLaw for SwingarmShock {
    fn declare(&self, element: &str) -> Declared {
        let output = |quantity, unit, about| OutputDeclared { name: format!("{element}.{quantity}"), unit, about };
        let mut outputs = vec![
            output("force", "N", "force of the shock, positive when it pushes"),
            output("length", "m", "length of the shock"),
            output("compression", "m", "length in the design pose minus length"),
            output("motion_ratio", "m/rad", "length of the shock by angle of the arm; negative where bump compresses"),
            output("moment", "N m", "moment on the joint of the arm, positive when it opposes a positive angle"),
        ];
        let mut limits = stop_limits(&self.law, SUSPENSION_STOP, &format!("{element}.compression"));
        if let ShockGeometry::Linkage { .. } = self.geometry {
            outputs.push(output("linkage_margin", "-", "sine squared of the rocker angle: zero where pull rod and rocker are in line"));
            limits.push(LimitDeclared {
                name: SUSPENSION_STOP,
                signal: format!("{element}.linkage_margin"),
                threshold: 0.0,
                side: Side::Below,
                nominal: 1.0,
                about: "pull rod and rocker are in line: the linkage is at its dead center",
            });
        }
        Declared { outputs, limits, ..Default::default() }
    }
    fn apply<S: SystemScalar>(&self, at: &Evaluated<'_, S>, out: &mut Effort<'_, S>) {
        let (l, slope) = self.length(at);
        let x = -l + self.design_length;
        let F = self.law.force(x, -(slope * at.speed(self.joint)));
        let M = -(F * slope);
        out.joint(self.joint, -M);
        for (i, value) in [F, l, x, slope, M].into_iter().enumerate() {
            out.output(i, value);
        }
        if let ShockGeometry::Linkage { linkage, sense } = &self.geometry {
            out.output(5, linkage.margin((at.coordinate(self.joint) - self.design_angle) * *sense));
        }
    }
    fn energy<S: SystemScalar>(&self, at: &Evaluated<'_, S>) -> Energy<S> {
        let (l, slope) = self.length(at);
        let v = -(slope * at.speed(self.joint));
        Energy { stored: self.law.stored(-l + self.design_length), supplied: S::zero(), dissipated: self.law.viscous(v) * v }
    }
}

/// A shock mounted directly between frame and arm.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DirectDescription {
    /// Mount on the frame.
    from: PointDescription,
    /// Mount on the arm.
    to: PointDescription,
}

/// Length of the shock against angle of the arm; a twice differentiable curve goes through the points.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LengthTableDescription {
    /// Angles of the joint from the design pose, increasing; positive in bump.
    angle: Vec<Quantity<Angle>>,
    /// Lengths at the angles.
    length: Vec<PositiveQuantity<Length>>,
}

/// Pull rod and rocker. Points are [x, z], all of them in the design pose, in the frame of the body that carries the arm's joint
/// (for a motorcycle the chassis: forward and up from its origin), also those that move with the arm or the rocker.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinkageDescription {
    /// Pivot of the rocker on the frame.
    rocker_pivot: [Quantity<Length>; 2],
    /// End of the pull rod on the rocker.
    rocker_to_rod: [Quantity<Length>; 2],
    /// Mount of the shock on the rocker.
    rocker_to_shock: [Quantity<Length>; 2],
    /// End of the pull rod on the arm.
    rod_on_arm: [Quantity<Length>; 2],
    /// Mount of the shock on the frame.
    shock_on_frame: [Quantity<Length>; 2],
}

/// How the shock is mounted.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum GeometryDescription {
    /// Directly between frame and arm.
    Direct(DirectDescription),
    /// By a table of lengths.
    Table(LengthTableDescription),
    /// Through pull rod and rocker.
    Linkage(LinkageDescription),
}

/// Shock absorber of a swingarm.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SwingarmShockDescription {
    /// Name of the joint of the arm; its angle is positive in bump.
    joint: String,
    /// How the shock is mounted: `direct`, `table` or `linkage`.
    geometry: GeometryDescription,
    /// Spring; the deflection is the compression of the shock from the design pose, the preload acts in the design pose.
    #[schemars(extend("plausible" = { "stiffness": [500.0, 2e6], "preload": [1.0, 2e5] }))]
    spring: Option<SpringDescription<Sliding>>,
    /// Damper; bump is compression.
    #[schemars(extend("plausible" = { "coefficient": [10.0, 2e5], "bump": [10.0, 2e5], "rebound": [10.0, 2e5] }))]
    damper: Option<DamperDescription<Sliding>>,
    /// Gas spring.
    air: Option<AirDescription>,
    /// End stops, in terms of the compression.
    #[schemars(extend("plausible" = { "lower": [1e-4, 1.0], "upper": [1e-4, 1.0], "stiffness": [3e3, 1e8], "width": [1e-4, 0.2] }))]
    stops: Option<StopsDescription<Sliding>>,
    /// Friction of seals and bearings.
    friction: Option<FrictionDescription<Sliding>>,
}

impl ElementDescription for SwingarmShockDescription {
    const KIND: &'static str = "swingarm_shock";
    const ABOUT: &'static str = "shock absorber of a swingarm: direct, by a table of lengths, or through pull rod and rocker";
    const EXAMPLE: &'static str = "{ joint: swingarm, geometry: { linkage: { rocker_pivot: [0.54, 0.2], rocker_to_rod: [0.5, 0.17], \
        rocker_to_shock: [0.45, 0.19], rod_on_arm: [0.38, 0.3], shock_on_frame: [0.49, 0.5] } }, \
        spring: { stiffness: 58 kN/m, preload: 2 kN }, damper: { coefficient: 11 kN s/m }, \
        stops: { lower: -25 mm, upper: 30 mm, stiffness: 1 MN/m, width: 5 mm } }";
    const TREE: &'static str = crate::EXAMPLE_TREE;
    type Law = SwingarmShock;
    fn assemble(self, site: &mut Site<'_>) -> Option<SwingarmShock> {
        let Self { joint, geometry, spring, damper, air, stops, friction } = self;
        let joint = site.joint_with("joint", &joint, "rad");
        let law = LawDescription { spring, damper, air, stops, friction }.law(site);
        let (joint, law) = (joint?, law?);
        let geometry = match geometry {
            GeometryDescription::Direct(direct) => direct.geometry(site, joint),
            GeometryDescription::Table(table) => table.geometry(site),
            GeometryDescription::Linkage(linkage) => linkage.geometry(site, joint),
        }?;
        let design_angle = site.model().body(joint).joint.reference()[0];
        Some(SwingarmShock { joint, design_angle, design_length: geometry.length(0.0), geometry, law })
    }
}

impl DirectDescription {
    fn geometry(&self, site: &mut Site<'_>, joint: BodyIndex) -> Option<ShockGeometry> {
        let (from, to) = (site.point("geometry.direct.from", &self.from), site.point("geometry.direct.to", &self.to));
        let (from, to) = (from?, to?);
        let parent = site.model().body(joint).parent;
        for (key, body, carrier, what) in [("from", from.0, parent, "carries the joint of the arm"), ("to", to.0, joint, "is the arm")] {
            if body != carrier {
                let name = site.model().body(carrier).name.clone();
                let message = format!("this mount must be on the body that {what}, `{name}`");
                site.refuse(&format!("geometry.direct.{key}.link"), "wrong_link", message);
                return None;
            }
        }
        let (carrier, pivot) = (site.design_pose(parent), site.design_pose(joint));
        let in_parent = |p: Vec3<f64>| carrier.R.inverse_times(p - pivot.p);
        let (frame, arm) = (in_parent(site.design_position(from.0, from.1)), in_parent(site.design_position(to.0, to.1)));
        if (frame - arm).norm() < 1e-6 {
            site.refuse("geometry.direct.to", "points_coincide", "the two mounts of the shock coincide in the design pose");
            return None;
        }
        Some(ShockGeometry::Direct { axis: axis_in_parent(site, joint), frame, arm })
    }
}

impl LengthTableDescription {
    fn geometry(self, site: &mut Site<'_>) -> Option<ShockGeometry> {
        let angle: Vec<f64> = self.angle.into_iter().map(Quantity::si).collect();
        let length: Vec<f64> = self.length.into_iter().map(Quantity::si).collect();
        let ends = if angle.len() < 4 { Ends::Natural } else { Ends::NotAKnot };
        match CubicSpline::new(&angle, &length, ends) {
            Ok(spline) => Some(ShockGeometry::Table(spline)),
            Err(error) => {
                site.refuse("geometry.table", "invalid_table", error.to_string());
                None
            }
        }
    }
}

impl LinkageDescription {
    fn geometry(self, site: &mut Site<'_>, joint: BodyIndex) -> Option<ShockGeometry> {
        let axis = axis_in_parent(site, joint);
        if axis.y.abs() < 1.0 - 1e-9 {
            let name = site.model().body(joint).joint_name.clone();
            let message =
                format!("joint `{name}` does not turn about the lateral axis, but a linkage is a mechanism of the plane of symmetry");
            site.refuse("joint", "wrong_joint", message);
            return None;
        }
        let parent = site.design_pose(site.model().body(joint).parent);
        let pivot = parent.inverse().point(site.design_pose(joint).p);
        let point = |p: [Quantity<Length>; 2]| Planar::from(p.map(Quantity::si));
        let points = LinkagePoints {
            arm_pivot: Planar::new(pivot.x, pivot.z),
            rocker_pivot: point(self.rocker_pivot),
            rocker_to_rod: point(self.rocker_to_rod),
            rocker_to_shock: point(self.rocker_to_shock),
            rod_on_arm: point(self.rod_on_arm),
            shock_on_frame: point(self.shock_on_frame),
        };
        match Linkage::new(points) {
            Ok(linkage) => Some(ShockGeometry::Linkage { linkage, sense: axis.y.signum() }),
            Err(error) => {
                site.refuse("geometry.linkage", "impossible_linkage", error.to_string());
                None
            }
        }
    }
}

/// Axis of a joint in the body that carries it.
fn axis_in_parent(site: &Site<'_>, joint: BodyIndex) -> Vec3<f64> {
    let model = site.model();
    model.body(joint).X_PF.R * turning_axis(model, joint)
}

#[cfg(test)]
mod tests;
