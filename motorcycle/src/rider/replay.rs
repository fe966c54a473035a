//! Who repeats a recorded ride: the torques of then, and a weak feedback of what differs from then.
//!
//! `u = u_r(t) + g K (z_r(t) − z)`, with z the deviation of states and of the place: offset `e = (y − y_r) cos ψ_r − (x − x_r) sin ψ_r` and heading `ψ − ψ_r`.
//!
//! Symbols: u commanded torques, N m; u_r, z_r what was recorded, over time; K gains of a regulator about straight running; g their share, 0 to 1: as little as holds the vehicle upright.
//! Only the steering torque is fed back; drive and brakes are those of the record.
//!
//! Source: theory manual 10.7 (replay). Range: the same vehicle, or one so similar that the record is nearly its motion; before and after the record its ends hold.

use crate::chain_rule::along_directions;
use mbody::scalar::Pchip;
use problem::{Answer, AnswerAlong, Controller, EvalError, Matrix, Signal, Unknown};

/// What was recorded and how it is held.
#[derive(Clone, Debug)]
pub struct Record {
    /// Names of position along x, along y and heading, then of what is fed back.
    pub measured: Vec<String>,
    /// The same over time.
    pub then: Vec<Pchip>,
    /// Names of the inputs, the steering torque first.
    pub commanded: Vec<String>,
    /// The same over time.
    pub torques: Vec<Pchip>,
    /// Gains of what is fed back behind the heading, in units of the steering torque.
    pub gains: Vec<f64>,
    /// Gains of offset and heading.
    pub path_gains: [f64; 2],
}

/// A recorded ride that is repeated.
#[derive(Debug)]
pub struct Replay {
    record: Record,
    outputs: [Signal; 1],
    jacobian: Matrix,
}

/// The value at a time; that of the nearest end outside.
fn held(curve: &Pchip, time: f64) -> f64 {
    let (first, last) = curve.range();
    curve.value(time.clamp(first, last))
}

impl Replay {
    /// A recorded ride; `None` where names, curves and gains are not of equal number.
    pub fn new(record: Record) -> Option<Self> {
        let (n, m) = (record.measured.len(), record.commanded.len());
        let fits = record.then.len() == n && record.torques.len() == m && n == record.gains.len() + 3 && m > 0;
        let outputs =
            [Signal::new("rider.path_error", "m", "offset of the base point from where it was in the record, positive to the left")];
        fits.then(|| Self { record, outputs, jacobian: Matrix::zeros(m + 1, n) })
    }
}

impl Controller for Replay {
    fn measured(&self) -> &[String] {
        &self.record.measured
    }
    fn commanded(&self) -> &[String] {
        &self.record.commanded
    }
    fn states(&self) -> &[Unknown] {
        &[]
    }
    fn outputs(&self) -> &[Signal] {
        &self.outputs
    }
    fn answer(&mut self, time: f64, measured: &[f64], _: &[f64], answer: Answer<'_>) -> Result<(), EvalError> {
        let Record { then, torques, gains, path_gains, .. } = &self.record;
        let [dx, dy, turned] = [0, 1, 2].map(|k| measured[k] - held(&then[k], time));
        let (sine, cosine) = held(&then[2], time).sin_cos();
        let offset = dy * cosine - dx * sine;
        for (command, torque) in answer.commands.iter_mut().zip(torques) {
            *command = held(torque, time);
        }
        answer.commands[0] -= path_gains[0] * offset + path_gains[1] * turned;
        for ((z, curve), gain) in measured.iter().zip(then).skip(3).zip(gains) {
            answer.commands[0] -= gain * (z - held(curve, time));
        }
        answer.outputs[0] = offset;
        Ok(())
    }
    fn answer_along(
        &mut self,
        time: f64,
        (measured, states): (&[f64], &[f64]),
        directions: (&Matrix, &Matrix),
        answer: Answer<'_>,
        along: AnswerAlong<'_>,
    ) -> Result<(), EvalError> {
        let (sine, cosine) = held(&self.record.then[2], time).sin_cos();
        let output = self.record.commanded.len();
        let [by_offset, by_heading] = self.record.path_gains;
        for (k, slope) in [-sine, cosine].into_iter().enumerate() {
            self.jacobian[(0, k)] = -by_offset * slope;
            self.jacobian[(output, k)] = slope;
        }
        self.jacobian[(0, 2)] = -by_heading;
        for (k, gain) in self.record.gains.iter().enumerate() {
            self.jacobian[(0, k + 3)] = -gain;
        }
        along_directions(&self.jacobian, directions, along);
        self.answer(time, measured, states, answer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_the_commands() {
        let curve = |a: f64, b: f64| Pchip::new(&[0.0, 1.0], &[a, b]).expect("a curve");
        let names = |list: &[&str]| list.iter().map(|n| (*n).to_owned()).collect();
        let mut replay = Replay::new(Record {
            measured: names(&["x", "y", "yaw", "roll"]),
            then: vec![curve(0.0, 10.0), curve(0.0, 1.0), curve(0.0, 0.3), curve(0.1, 0.2)],
            commanded: names(&["steer", "drive"]),
            torques: vec![curve(1.0, 3.0), curve(50.0, 60.0)],
            gains: vec![-20.0],
            path_gains: [4.0, 30.0],
        })
        .expect("a record");
        let mut at = |z: &[f64; 4]| {
            let (mut commands, mut outputs) = ([0.0; 2], [0.0]);
            replay.answer(0.6, z, &[], Answer { commands: &mut commands, rates: &mut [], outputs: &mut outputs }).expect("an answer");
            [commands[0], commands[1], outputs[0]]
        };
        let then: [f64; 4] = std::array::from_fn(|k| [6.0, 0.6, 0.18, 0.16][k]);
        let exact = at(&then);
        assert!((exact[0] - 2.2).abs() < 1e-12 && (exact[1] - 56.0).abs() < 1e-12 && exact[2].abs() < 1e-12, "{exact:?}");
        let differences: Vec<[f64; 3]> = (0..4)
            .map(|k| {
                let moved = |by: f64| std::array::from_fn(|i| then[i] + if i == k { by } else { 0.0 });
                let (up, down) = (at(&moved(1e-6)), at(&moved(-1e-6)));
                std::array::from_fn(|i| (up[i] - down[i]) / 2e-6)
            })
            .collect();
        let (mut seeds, mut dc, mut dz) = (Matrix::zeros(4, 4), Matrix::zeros(2, 4), Matrix::zeros(1, 4));
        (0..4).for_each(|k| seeds[(k, k)] = 1.0);
        let (mut commands, mut outputs) = ([0.0; 2], [0.0]);
        let answer = Answer { commands: &mut commands, rates: &mut [], outputs: &mut outputs };
        let along = AnswerAlong { commands: &mut dc, rates: &mut Matrix::zeros(0, 4), outputs: &mut dz };
        replay.answer_along(0.6, (&then, &[]), (&seeds, &Matrix::zeros(0, 4)), answer, along).expect("derivatives");
        for (k, difference) in differences.iter().enumerate() {
            for (exact, near) in [dc[(0, k)], dc[(1, k)], dz[(0, k)]].iter().zip(difference) {
                assert!((exact - near).abs() < 1e-7, "{k}: {exact} {near}");
            }
        }
    }
}
