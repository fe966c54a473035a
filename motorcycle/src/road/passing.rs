//! A road that passes under two wheels as a vehicle moves along its path.
//!
//! ```text
//! rear:  z(s),       ż = z'(s) ṡ            front:  z(s + p),   ż = z'(s + p) ṡ
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | s | m | arc length of the base point on the path, a state: [`crate::maneuver::Path::progress`] |
//! | p | m | wheelbase of the design pose |
//! | z, z' | m, – | height and slope of the road: [`super::Relief`] |
//!
//! Rates are exactly those of the heights. The contact points move a little against the base point as suspension and steering do, and a road is felt at a point, as if it stayed level
//! under each wheel: its height is exact to first order in these motions and in the slope.
//!
//! Source: kinematics. Range: slopes up to a tenth or so; a road that has the same height from edge to edge.

use super::Relief;
use crate::chain_rule::along_directions;
use crate::maneuver::Path;
use mbody::scalar::{Lanes, Real, SystemScalar};
use problem::{Answer, AnswerAlong, Controller, EvalError, Matrix, Signal, Unknown, UnknownKind};
use std::sync::Arc;

/// The scalar of its derivatives: base and arc length are six directions.
type Wide = Lanes<2>;

/// Names of what is read and commanded.
#[derive(Clone, Debug)]
pub struct Tracks {
    /// Position along x, along y and heading of the base, its forward and its lateral speed.
    pub base: [String; 5],
    /// Inputs: height and rate of the height under the front wheel, then under the rear wheel.
    pub heights: [String; 4],
    /// Distance of the wheels, m.
    pub wheelbase: f64,
}

/// A road under two wheels.
#[derive(Debug)]
pub struct Passing {
    path: Path,
    relief: Arc<dyn Relief>,
    wheelbase: f64,
    measured: [String; 5],
    commanded: [String; 4],
    states: [Unknown; 1],
    jacobian: Matrix,
}

impl Passing {
    /// A road along a path.
    pub fn new(tracks: Tracks, path: Path, relief: Arc<dyn Relief>) -> Self {
        let station = Unknown {
            signal: Signal::new("road.station", "m", "arc length on the path of the rear contact point"),
            kind: UnknownKind::State,
            cyclic: false,
            differential: true,
            nominal: 10.0,
            absolute_tolerance: 1e-5,
            design: 0.0,
            start: Some(0.0),
        };
        let Tracks { base: measured, heights: commanded, wheelbase } = tracks;
        Self { path, relief, wheelbase, measured, commanded, states: [station], jacobian: Matrix::zeros(5, 6) }
    }

    /// Heights and their rates, front and rear, then the rate of the arc length; of base, then arc length.
    fn law<S: Real>(&self, at: &[S; 6]) -> [S; 5] {
        let [x, y, heading, forward, lateral, s] = *at;
        let rate = self.path.progress(s, [x, y, heading, forward, lateral]).rate;
        let under = |s: S| {
            let z = self.relief.at(s.value());
            let moved = s - s.value();
            (moved * z.slope + z.value, (moved * z.curvature + z.slope) * rate)
        };
        let ((front, front_rate), (rear, rear_rate)) = (under(s + self.wheelbase), under(s));
        [front, front_rate, rear, rear_rate, rate]
    }
}

/// What is measured, then the state.
fn joined(measured: &[f64], states: &[f64]) -> [f64; 6] {
    std::array::from_fn(|k| if k < 5 { measured[k] } else { states[0] })
}

impl Controller for Passing {
    fn measured(&self) -> &[String] {
        &self.measured
    }
    fn commanded(&self) -> &[String] {
        &self.commanded
    }
    fn states(&self) -> &[Unknown] {
        &self.states
    }
    fn outputs(&self) -> &[Signal] {
        &[]
    }
    fn answer(&mut self, _: f64, measured: &[f64], states: &[f64], answer: Answer<'_>) -> Result<(), EvalError> {
        let [commands @ .., rate] = self.law(&joined(measured, states));
        answer.commands.copy_from_slice(&commands);
        answer.rates[0] = rate;
        if rate.is_finite() { Ok(()) } else { Err(EvalError::Recoverable { equation: 0 }) }
    }
    fn answer_along(
        &mut self,
        time: f64,
        (measured, states): (&[f64], &[f64]),
        directions: (&Matrix, &Matrix),
        answer: Answer<'_>,
        along: AnswerAlong<'_>,
    ) -> Result<(), EvalError> {
        self.answer(time, measured, states, answer)?;
        let values = joined(measured, states);
        let seeded: [Wide; 6] = std::array::from_fn(|k| {
            let mut seeded = <Wide as Real>::from_f64(values[k]);
            seeded.set_derivative(k, 1.0);
            seeded
        });
        for (row, value) in self.law(&seeded).iter().enumerate() {
            for k in 0..6 {
                self.jacobian[(row, k)] = SystemScalar::derivative(value, k);
            }
        }
        along_directions(&self.jacobian, directions, along);
        Ok(())
    }
}
