//! The road where a wheel stands: a plane that inputs tell, and its friction.
//!
//! ```text
//! z(ξ, η) = h + g ξ + c η              k = (−g x − c y + z)/√(1 + g² + c²)
//! own rise at (ξ, η)    w = ḣ − g u − c v + (ġ − r c) ξ + (ċ + r g) η
//! ```
//!
//! | symbol | unit | input | |
//! |---|---|---|---|
//! | h, ḣ | m, m/s | `<road>.height`, `height_rate` | height of the road at the place Q of the wheel, and its rate as Q moves |
//! | g, ġ | –, 1/s | `<road>.grade`, `grade_rate` | slope ahead, along the heading of the base; positive uphill |
//! | c, ċ | –, 1/s | `<road>.cross_slope`, `cross_slope_rate` | slope across, positive where the road rises to the left |
//! | μ | – | `<road>.friction` | friction over that of the road on which the tire was measured: [`crate::tire::similarity`] |
//! | ξ, η | m | | distance from Q, ahead and to the left of the heading of the base, in the horizontal plane |
//! | u, v, r | m/s, rad/s | | horizontal velocity of Q in these directions, yaw rate of the base |
//! | w | m/s | | vertical speed of the plane at a point that is fixed in the world: zero where the road stands still |
//!
//! Q lies below the center of the wheel in the design pose and is carried along by the base, over the road, whatever heave, roll and pitch are. What is constant here is constant in the yawed frame
//! of the base: a steady turn on a cone, a straight way uphill and a helix are equilibria (ADR 20). The plane is that of the road at Q, so a road that bends over the distance of Q from the point of contact
//! (0.3 m at the most) is met as its tangent.
//!
//! Source: kinematics; the plane under a wheel after H. B. Pacejka, *Tire and Vehicle Dynamics*, section 4.2.1 (transition to an effective road plane).
//! Range: slopes up to 1 or so; roads whose radii are far above those of wheels.

use mbody::assembly::Site;
use mbody::contact::TangentPlane;
use mbody::force::{Evaluated, InputDeclared};
use mbody::model::{BodyIndex, Model};
use mbody::scalar::SystemScalar;
use mbody::spatial::Vec3;

/// Names of the inputs behind that of the road, in the order in which elements declare them.
pub const QUANTITIES: [&str; 7] = ["height", "height_rate", "grade", "grade_rate", "cross_slope", "cross_slope_rate", "friction"];

/// Least friction that is reckoned with: slips are divided by it.
pub const LEAST_FRICTION: f64 = 0.01;

/// Where a wheel stands, and under which name the road comes in.
#[derive(Clone, Debug, PartialEq)]
pub struct Footing {
    /// Name of the road.
    pub road: String,
    /// The body that moves over the road: its left tells the heading.
    pub base: BodyIndex,
    /// Place Q from the origin of that body, ahead and to the left, m.
    pub place: [f64; 2],
}

/// The plane under a wheel.
#[derive(Clone, Copy, Debug)]
pub struct Under<S> {
    /// The plane.
    pub plane: TangentPlane<S>,
    /// Vertical speed of the road itself at the point of the plane, m/s.
    pub rise: S,
    /// Change of that speed over the plane, 1/s; none on level ground.
    pub turn: Option<Vec3<S>>,
    /// Friction; none where it is 1.
    pub friction: Option<S>,
}

/// Whether a quantity is a number and does not vary along any direction.
#[inline]
fn is_just<S: SystemScalar>(x: S, value: f64) -> bool {
    x.value() == value && (0..S::DIRECTIONS).all(|k| x.derivative(k) == 0.0)
}

impl<S: SystemScalar> Under<S> {
    /// Level ground of a height that rises, m and m/s.
    #[inline]
    pub fn level(height: S, rise: S) -> Self {
        let point = Vec3::new(S::zero(), S::zero(), height);
        let normal = Vec3::from_f64(Vec3 { x: 0.0, y: 0.0, z: 1.0 });
        Self { plane: TangentPlane { point, normal }, rise, turn: None, friction: None }
    }

    /// Relative rate `k̇_z/k_z` at which distances from the plane shrink while it steepens, 1/s.
    #[inline]
    pub fn steepening(&self) -> S {
        self.turn.map_or_else(S::zero, |turn| turn.dot(self.plane.normal) * self.plane.normal.z)
    }

    /// Vertical speed of the road itself at a point, m/s.
    #[inline]
    pub fn rise_at(&self, point: Vec3<S>) -> S {
        self.turn.map_or(self.rise, |turn| self.rise + turn.dot(point - self.plane.point))
    }
}

impl Footing {
    /// The footing of a wheel on a road of this name, at the origin of the body that carries everything.
    pub fn new(model: &Model, wheel: BodyIndex, road: impl Into<String>) -> Self {
        let mut base = wheel;
        while model.body(base).parent != BodyIndex::WORLD {
            base = model.body(base).parent;
        }
        Self { road: road.into(), base, place: [0.0, 0.0] }
    }

    /// The same below the origin of a wheel in the design pose.
    pub fn below(self, site: &Site<'_>, wheel: BodyIndex) -> Self {
        let from = site.design_pose(wheel).p - site.design_pose(self.base).p;
        Self { place: [from.x, from.y], ..self }
    }

    /// The inputs, in the order of [`QUANTITIES`].
    pub fn inputs(&self) -> Vec<InputDeclared> {
        const ROWS: [(&str, &str, f64, f64); 7] = [
            ("m", "height of the road, upward", 0.01, 0.0),
            ("m/s", "rate of the height of the road", 0.1, 0.0),
            ("-", "slope of the road along the heading, positive uphill", 0.1, 0.0),
            ("1/s", "rate of the slope along the heading", 0.1, 0.0),
            ("-", "slope of the road across the heading, positive where it rises to the left", 0.1, 0.0),
            ("1/s", "rate of the slope across the heading", 0.1, 0.0),
            ("-", "friction of the road over that on which the tire was measured", 1.0, 1.0),
        ];
        let name = |k: usize| format!("{}.{}", self.road, QUANTITIES[k]);
        let of = |(k, (unit, about, nominal, default)): (usize, (&'static str, &'static str, f64, f64))| InputDeclared {
            name: name(k),
            unit,
            about,
            nominal,
            rate: (k % 2 == 0 && k < 6).then(|| name(k + 1)),
            default,
        };
        ROWS.into_iter().enumerate().map(of).collect()
    }

    /// The road at one instant; `first` is the place of the height among the inputs of the element.
    #[inline]
    pub fn under<S: SystemScalar>(&self, at: &Evaluated<'_, S>, first: usize) -> Under<S> {
        let (height, height_rate, friction) = (at.input(first), at.input(first + 1), at.input(first + 6));
        let slopes: [S; 4] = std::array::from_fn(|k| at.input(first + 2 + k));
        let mut under = match slopes.iter().all(|slope| is_just(*slope, 0.0)) {
            true => Under::level(height, height_rate),
            false => self.tilted(at, (height, height_rate), slopes),
        };
        if !is_just(friction, 1.0) {
            let below = friction.value() < LEAST_FRICTION;
            under.friction = Some(if below { S::from_f64(LEAST_FRICTION) } else { friction });
        }
        under
    }

    fn tilted<S: SystemScalar>(&self, at: &Evaluated<'_, S>, (height, height_rate): (S, S), [g, gd, c, cd]: [S; 4]) -> Under<S> {
        let X = at.X_WB(self.base);
        let left = X.R.columns[1];
        let level = left.x * left.x + left.y * left.y;
        let per = level.sqrt().recip();
        let x = Vec3::new(left.y * per, -(left.x * per), S::zero());
        let y = Vec3::new(left.x * per, left.y * per, S::zero());
        let turning = at.w_WB(self.base).cross(left);
        let r = (left.x * turning.y - left.y * turning.x) / level;
        let (velocity, [px, py]) = (at.v_WQ(self.base, X.p), self.place);
        let (u, v) = (velocity.dot(x) - r * py, velocity.dot(y) + r * px);
        let place = X.p + x * px + y * py;
        let up = (g * g + c * c + 1.0).sqrt().recip();
        Under {
            plane: TangentPlane {
                point: Vec3::new(place.x, place.y, height),
                normal: (Vec3::new(S::zero(), S::zero(), S::one()) - x.scaled(g) - y.scaled(c)).scaled(up),
            },
            rise: height_rate - g * u - c * v,
            turn: Some(x.scaled(gd - r * c) + y.scaled(cd + r * g)),
            friction: None,
        }
    }
}
