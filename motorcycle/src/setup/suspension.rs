//! Suspension of an axle: sag, wheel rate, motion ratios over travel.
//!
//! ```text
//! k = dF/ds     τᵢ = dxᵢ/ds     c = Σ fᵢ(τᵢ v) τᵢ / v     sag = s − s_h with F(s_h) = 0
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | s | m | travel of the wheel against the chassis along its middle plane, positive in bump; of [`super::stand`] |
//! | F, k | N, N/m | force under all wheels of the axle, and its slope: the wheel rate (reduced stiffness), weights and preload with their geometry included |
//! | xᵢ, τᵢ | m, - | compression of a spring, and its motion ratio (velocity ratio) |
//! | fᵢ, c | N, N s/m | force of a damper; reduced damping at a wheel speed v of 0.1 m/s |
//! | s_h | m | travel at which the wheel hangs: full extension |
//!
//! For one spring with the stiffness K and the force f: `k = K τ² + f dτ/ds`; a fork at rest inclined by ε has `τ = 1/cos ε`.
//!
//! Source: V. Cossalter, *Motorcycle Dynamics*, 2nd ed. 2006, chapter 5 (velocity ratio, reduced stiffness and damping). Range: see [`super::stand`].

use super::parts::{Parts, Wheel};
use super::stand::{Posture, Stand};
use crate::suspension::{SUSPENSION_STOP, SwingarmShock};
use mbody::dynamics::{Element, System};
use mbody::force::{JointEffortUnit, JointSpring, SpringDamper, SpringDamperLaw};
use mbody::model::BodyIndex;
use mbody::spatial::Vec3;
use problem::{AlgebraicMethod, Limit, Side};
use std::sync::Arc;

/// Step of the differences along the travel, m.
const DIFFERENCE: f64 = 2e-4;
/// Distance of the points of a curve, m.
const STEP: f64 = 2.5e-3;
/// Travel in either direction at which a curve ends where nothing else ends it, m.
const LONGEST: f64 = 0.25;
/// Multiple of the static load beyond which a curve ends.
const MOST_LOAD: f64 = 12.0;
/// Motion ratio below which a spring does not belong to an axle.
const IDLE: f64 = 1e-3;
/// Speed of the wheel at which dampers are judged, m/s.
const WHEEL_SPEED: f64 = 0.1;

/// A spring of an axle at one travel.
#[derive(Clone, Copy, Debug)]
pub struct SpringAt {
    /// Compression, m (rad), as the element counts it.
    pub compression: f64,
    /// Force, N (N m), positive when it pushes.
    pub force: f64,
    /// Compression by travel of the wheel.
    pub motion_ratio: f64,
}

/// A point of the curves of a suspension.
#[derive(Clone, Debug)]
pub struct TravelPoint {
    /// Travel from full extension, or from the lowest travel that was found, m, positive in bump.
    pub travel: f64,
    /// Force under all wheels of the axle, N.
    pub force: f64,
    /// Wheel rate, N/m.
    pub wheel_rate: f64,
    /// Springs, in the order of [`Suspension::springs`].
    pub springs: Vec<SpringAt>,
}

/// Suspension of an axle.
#[derive(Clone, Debug)]
pub struct Suspension {
    /// `front`, `rear` or `side`.
    pub axle: &'static str,
    /// Names of the springs, and whether they are torsion springs: their compression is an angle and their force a torque.
    pub springs: Vec<(String, bool)>,
    /// Sag, m: travel of the given pose from full extension; none where the way there was not found.
    pub sag: Option<f64>,
    /// The given pose; its travel counts as that of the curve.
    pub here: TravelPoint,
    /// Reduced damping in bump and rebound at a wheel speed of 0.1 m/s, N s/m.
    pub damping: [f64; 2],
    /// Travel from full extension to the stop of the bump, m; none where no stop is used up below twelve times the load.
    pub stop: Option<f64>,
    /// The curves, from full extension on.
    pub curve: Vec<TravelPoint>,
    /// Motion of the wheel center by travel: forward and up in the heading, and turn of bodies.
    pub(super) motion: Motion,
}

/// Two neighboring equilibria, of which differences are taken.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    low: Posture,
    high: Posture,
    step: f64,
}

impl Motion {
    /// Rate of the center of a wheel by travel.
    pub fn center(&self, wheel: &Wheel) -> Vec3<f64> {
        (wheel.center(&self.high.poses) - wheel.center(&self.low.poses)).scaled(1.0 / self.step)
    }

    /// Turn of a body by travel, rad/m: the axial part of `R_high R_lowᵀ`.
    pub fn turn(&self, body: BodyIndex) -> Vec3<f64> {
        let (high, low) = (&self.high.poses[body.get()].R, &self.low.poses[body.get()].R);
        let sum = (0..3).map(|k| low.columns[k].cross(high.columns[k])).fold(Vec3::zero(), |a, b| a + b);
        sum.scaled(0.5 / self.step)
    }
}

/// A spring along a line or about an axis, with its place among the signals.
struct Spring<'s> {
    name: &'s str,
    law: &'s SpringDamperLaw,
    turning: bool,
    /// Its force among the outputs.
    force: usize,
    compression: Place,
}

/// Where a compression is read.
enum Place {
    Unknown(usize),
    Output(usize),
}

impl<'s> Spring<'s> {
    /// The spring that an element is, where it is one.
    fn of(system: &System, element: &'s Element) -> Option<Self> {
        let (name, force) = (element.force.name(), element.outputs.start);
        // outputs of both: force, length, compression
        let along = |law: &'s SpringDamperLaw| Self { name, law, turning: false, force, compression: Place::Output(force + 2) };
        if let Some(shock) = element.force.law::<SwingarmShock>() {
            return Some(along(&shock.law));
        }
        if let Some(spring) = element.force.law::<SpringDamper>() {
            return Some(along(&spring.law));
        }
        let spring = element.force.law::<JointSpring>()?;
        let q = system.model().body(spring.joint).q.start;
        let place = system.model().layout().independent_q.iter().position(|&i| i == q)?;
        let turning = spring.effort == JointEffortUnit::Torque;
        Some(Self { name, law: &spring.law, turning, force, compression: Place::Unknown(place) })
    }

    fn compression(&self, at: &Posture) -> f64 {
        match self.compression {
            Place::Unknown(k) => at.y[k],
            Place::Output(k) => at.outputs[k],
        }
    }
}

/// Looks at an axle while its wheels travel.
struct Travel<'a> {
    stand: Stand<'a>,
    springs: Vec<Spring<'a>>,
    stops: Vec<(Limit, usize)>,
}

impl Travel<'_> {
    /// The equilibrium at a travel, with its neighbors; the travel counts from the given pose.
    fn point(&mut self, travel: f64, near: Option<&Posture>) -> Option<(Posture, TravelPoint, Motion)> {
        let middle = self.stand.at(travel, near)?;
        let low = self.stand.at(travel - DIFFERENCE, Some(&middle))?;
        let high = self.stand.at(travel + DIFFERENCE, Some(&middle))?;
        let step = 2.0 * DIFFERENCE;
        let springs = self.springs.iter().map(|s| SpringAt {
            compression: s.compression(&middle),
            force: middle.outputs[s.force],
            motion_ratio: (s.compression(&high) - s.compression(&low)) / step,
        });
        let wheel_rate = (high.force - low.force) / step;
        let point = TravelPoint { travel, force: middle.force, wheel_rate, springs: springs.collect() };
        Some((middle, point, Motion { low, high, step }))
    }

    /// Whether a stop of a bump or a rebound has built up.
    fn stopped(&self, at: &Posture, side: Side) -> bool {
        let value = |&index: &usize| if index < at.y.len() { at.y[index] } else { at.outputs[index - at.y.len()] };
        self.stops.iter().any(|(limit, index)| limit.side == side && limit.margin(value(index)) < 0.0)
    }

    /// Travel at which the wheel hangs, between a point above it and one below.
    fn hanging(&mut self, mut above: (f64, Posture), mut below: f64) -> Option<(f64, Posture)> {
        for _ in 0..60 {
            let middle = 0.5 * (above.0 + below);
            let found = self.stand.at(middle, Some(&above.1))?;
            match found.force > 0.0 {
                true => above = (middle, found),
                false => below = middle,
            }
            if above.0 - below < 1e-9 {
                break;
            }
        }
        Some(above)
    }

    /// Travel between two at which a stop of the bump is used up.
    fn stop(&mut self, mut free: f64, mut stopped: f64, near: &Posture) -> f64 {
        while stopped - free > 1e-7 {
            let middle = 0.5 * (free + stopped);
            match self.stand.at(middle, Some(near)) {
                Some(found) if !self.stopped(&found, Side::Above) => free = middle,
                _ => stopped = middle,
            }
        }
        stopped
    }

    /// Points from full extension until a stop of the bump is used up or the load is many times that of the given pose, and the travel of that stop.
    fn curve(&mut self, (lowest, extended): (f64, Posture), load: f64) -> (Vec<TravelPoint>, Option<f64>) {
        let (mut points, mut at, mut near) = (Vec::new(), lowest, extended);
        while let Some((posture, point, _)) = self.point(at, Some(&near)) {
            let loaded = point.force > MOST_LOAD * load.max(1.0);
            points.push(point);
            near = posture;
            if at > 0.0 && self.stopped(&near, Side::Above) {
                return (points, Some(self.stop(at - STEP, at, &near) - lowest));
            }
            if loaded || at - lowest > 2.0 * LONGEST {
                break;
            }
            at += STEP;
        }
        (points, None)
    }

    /// Full extension: downward from the given pose until the jack carries nothing, or the stop of the rebound is used up.
    /// Where the way ends before, the lowest travel that was found and `false`.
    fn extension(&mut self, here: &Posture) -> ((f64, Posture), bool) {
        let mut above = (0.0, here.clone());
        while above.0 > -LONGEST {
            let below = above.0 - STEP;
            match self.stand.at(below, Some(&above.1)) {
                Some(found) if found.force > 0.0 => above = (below, found),
                Some(_) => {
                    return match self.hanging(above.clone(), below) {
                        Some(found) => (found, true),
                        None => (above, false),
                    };
                }
                None => break,
            }
        }
        (above, false)
    }
}

/// The suspension of an axle; a reason where there is none.
pub(super) fn suspension<'a>(
    (system, parts): (&'a Arc<System>, &Parts),
    (axle, wheels): (&'static str, &[Wheel]),
    pose: &[f64],
    method: &'a mut dyn AlgebraicMethod,
) -> Result<Suspension, String> {
    let stand =
        Stand::new(system, parts, wheels, pose, method).ok_or_else(|| "no joint lets the wheel move against the chassis".to_owned())?;
    let springs: Vec<Spring<'_>> = system.elements().iter().filter_map(|e| Spring::of(system, e)).collect();
    let names = system.unknowns().iter().map(|u| &u.signal.name).chain(system.outputs().iter().map(|o| &o.name));
    let names: Vec<&String> = names.collect();
    let limits = problem::Limits::limits(&mbody::dynamics::TreePlant::new(system.clone())).to_vec();
    let stops = limits.into_iter().filter(|l| l.name == SUSPENSION_STOP);
    let stops = stops.filter_map(|l| names.iter().position(|n| **n == l.signal).map(|at| (l, at))).collect();
    let mut travel = Travel { stand, springs, stops };
    let lost = || "no equilibrium of the wheel on a jack was found".to_owned();
    let (posture, here, motion) = travel.point(0.0, None).ok_or_else(lost)?;
    // springs of other axles do not move
    let own: Vec<usize> = (0..travel.springs.len()).filter(|&k| here.springs[k].motion_ratio.abs() > IDLE).collect();
    if own.is_empty() && here.wheel_rate.abs() < 1.0 {
        return Err("nothing springs between wheel and chassis".to_owned());
    }
    let ((lowest, extended), hangs) = travel.extension(&posture);
    let (curve, stop) = travel.curve((lowest, extended), here.force);
    let from_extension = |mut point: TravelPoint| {
        point.travel -= lowest;
        point.springs = own.iter().map(|&k| point.springs[k]).collect();
        point
    };
    let damping = [WHEEL_SPEED, -WHEEL_SPEED].map(|v| {
        let of = |k: &usize| {
            let ratio = here.springs[*k].motion_ratio;
            travel.springs[*k].law.viscous(ratio * v) * ratio / v
        };
        own.iter().map(of).sum()
    });
    Ok(Suspension {
        axle,
        springs: own.iter().map(|&k| (travel.springs[k].name.to_owned(), travel.springs[k].turning)).collect(),
        sag: hangs.then_some(-lowest),
        here: from_extension(here),
        damping,
        stop,
        curve: curve.into_iter().map(from_extension).collect(),
        motion,
    })
}
