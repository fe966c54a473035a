//! A road that passes under two wheels as a vehicle moves along its path.
//!
//! ```text
//! rear:  place (x, y)            front:  place (x, y) + p (cos ψ, sin ψ)
//! over path:   z(s, n),   slopes z_s/(1 − κ n) along the path and z_n across        over world:   z(x, y),   slopes z_x, z_y
//! turned into the heading by χ = ψ − ψ_p(s), or ψ:   grade = z₁ cos χ + z₂ sin χ,    cross slope = z₂ cos χ − z₁ sin χ
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | x, y, ψ | m, rad | place of the base point, heading |
//! | s, n | m | arc length of a wheel's place on the path, a state of its own, and offset to the left of it: [`crate::maneuver::Path::progress`] |
//! | κ, ψ_p | 1/m, rad | curvature and heading of the path at s |
//! | p | m | wheelbase of the design pose |
//! | z | m | height of the road, the sum of all its kinds: [`super::Relief`] |
//!
//! Rates are exactly those of heights and slopes as both places move. The wheels stand on the tangent planes at their places ([`super::Footing`]); unevenness is felt by its height alone.
//!
//! Source: kinematics; differential geometry of a path. Range: offsets below the radius of the path; slopes up to 1 or so.

use super::Relief;
use super::footing::QUANTITIES;
use super::relief::Coordinates;
use crate::chain_rule::along_directions;
use crate::maneuver::Path;
use mbody::scalar::{Dual, Lanes, Real, SystemScalar};
use problem::{Answer, AnswerAlong, Controller, EvalError, Matrix, Signal, Unknown, UnknownKind};
use std::sync::Arc;

/// What is measured of the base, and the states: the directions of the derivatives.
const MEASURED: usize = 6;
const READ: usize = MEASURED + 2;
/// Inputs of both wheels.
const COMMANDS: usize = 2 * QUANTITIES.len();

/// The scalar of its derivatives: eight directions.
type Wide = Lanes<2>;

/// Names of what is read and commanded.
#[derive(Clone, Debug)]
pub struct Tracks {
    /// Position along x, along y and heading of the base, its forward and its lateral speed, its yaw rate.
    pub base: [String; MEASURED],
    /// Names of the roads under the front and under the rear wheel.
    pub roads: [String; 2],
    /// Distance of the wheels, m.
    pub wheelbase: f64,
}

/// A road under two wheels.
#[derive(Debug)]
pub struct Passing {
    path: Path,
    reliefs: Vec<Arc<dyn Relief>>,
    wheelbase: f64,
    measured: [String; MEASURED],
    commanded: Vec<String>,
    states: [Unknown; 2],
    jacobian: Matrix,
}

impl Passing {
    /// A road along a path that begins at the origin, made of one or more kinds.
    pub fn new(tracks: Tracks, path: Path, reliefs: Vec<Arc<dyn Relief>>) -> Self {
        let station = |name: &str, about: &'static str, start: f64| Unknown {
            signal: Signal::new(name, "m", about),
            kind: UnknownKind::State,
            cyclic: false,
            differential: true,
            nominal: 10.0,
            absolute_tolerance: 1e-5,
            design: 0.0,
            start: Some(start),
        };
        let Tracks { base: measured, roads, wheelbase } = tracks;
        let states = [
            station("road.front_station", "arc length on the path of the place of the front wheel", nearest(&path, wheelbase)),
            station("road.rear_station", "arc length on the path of the place of the rear wheel", 0.0),
        ];
        let commanded = roads.iter().flat_map(|road| QUANTITIES.map(|quantity| format!("{road}.{quantity}"))).collect();
        Self { path, reliefs, wheelbase, measured, commanded, states, jacobian: Matrix::zeros(COMMANDS + 2, READ) }
    }

    /// Inputs of the front and of the rear wheel, then the rates of the arc lengths; of base, then arc lengths.
    fn law<S: Real>(&self, at: &[S; READ]) -> [S; COMMANDS + 2] {
        let [x, y, heading, forward, lateral, yaw_rate, stations @ ..] = *at;
        let (sine, cosine) = heading.sin_cos();
        let mut answer = [S::zero(); COMMANDS + 2];
        for (k, (s, ahead)) in stations.into_iter().zip([self.wheelbase, 0.0]).enumerate() {
            let sideward = lateral + yaw_rate * ahead;
            let (px, py) = (x + cosine * ahead, y + sine * ahead);
            let rate = self.path.progress(s, [px, py, heading, forward, sideward]).rate;
            let moving = |value: S, rate: S| Dual { x: value, d: [rate] };
            let place = [moving(px, forward * cosine - sideward * sine), moving(py, forward * sine + sideward * cosine)];
            let [height, grade, across, friction] = self.under(place, moving(heading, yaw_rate), moving(s, rate));
            let commands = [height.x, height.d[0], grade.x, grade.d[0], across.x, across.d[0], friction.x];
            answer[k * commands.len()..][..commands.len()].copy_from_slice(&commands);
            answer[COMMANDS + k] = rate;
        }
        answer
    }

    /// Height, slopes ahead and to the left, and friction at a place.
    fn under<T: Real>(&self, [x, y]: [T; 2], heading: T, s: T) -> [T; 4] {
        let place = self.path.at(s);
        let (sine, cosine) = place.heading.sin_cos();
        let offset = cosine * (y - place.y) - sine * (x - place.x);
        let [mut height, mut grade, mut across, mut friction] = [T::zero(), T::zero(), T::zero(), T::one()];
        for relief in &self.reliefs {
            let (u, v, stretch, frame) = match relief.coordinates() {
                Coordinates::Path => (s, offset, -(place.curvature * offset) + 1.0, place.heading),
                Coordinates::World => (x, y, T::one(), T::zero()),
            };
            let (at_u, at_v) = (u.value(), v.value());
            let (du, dv) = (u - at_u, v - at_v);
            let [z, by_u, by_v] = relief.shape(at_u, at_v).near(du, dv);
            height += z;
            if relief.tilts() {
                let along = by_u / stretch;
                let (sine, cosine) = (heading - frame).sin_cos();
                grade += along * cosine + by_v * sine;
                across += by_v * cosine - along * sine;
            }
            let [mu, mu_u, mu_v] = relief.friction(at_u, at_v);
            friction *= du * mu_u + dv * mu_v + mu;
        }
        [height, grade, across, friction]
    }
}

/// Arc length nearest to a place ahead of the start.
fn nearest(path: &Path, ahead: f64) -> f64 {
    // the distance left shrinks by the share that the path turns over it
    (0..60).fold(ahead, |s, _| {
        let place = path.at(s);
        s + place.heading.cos() * (ahead - place.x) - place.heading.sin() * place.y
    })
}

/// What is measured, then the states.
fn joined(measured: &[f64], states: &[f64]) -> [f64; READ] {
    std::array::from_fn(|k| if k < MEASURED { measured[k] } else { states[k - MEASURED] })
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
        let law = self.law(&joined(measured, states));
        let (commands, rates) = law.split_at(COMMANDS);
        answer.commands.copy_from_slice(commands);
        answer.rates.copy_from_slice(rates);
        match rates.iter().position(|rate| !rate.is_finite()) {
            None => Ok(()),
            Some(equation) => Err(EvalError::Recoverable { equation }),
        }
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
        let seeded: [Wide; READ] = std::array::from_fn(|k| {
            let mut seeded = <Wide as Real>::from_f64(values[k]);
            seeded.set_derivative(k, 1.0);
            seeded
        });
        for (row, value) in self.law(&seeded).iter().enumerate() {
            for k in 0..READ {
                self.jacobian[(row, k)] = SystemScalar::derivative(value, k);
            }
        }
        along_directions(&self.jacobian, directions, along);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maneuver::Layout;
    use crate::road::relief::{KINDS, Shape};

    /// A hill of the world.
    #[derive(Debug)]
    struct World;

    impl Relief for World {
        fn shape(&self, x: f64, y: f64) -> Shape {
            // x² y/1000
            Shape {
                height: x * x * y * 1e-3,
                first: [2e-3 * x * y, 1e-3 * x * x],
                second: [2e-3 * y, 2e-3 * x, 0.0],
                third: [0.0, 2e-3, 0.0, 0.0],
            }
        }
        fn coordinates(&self) -> Coordinates {
            Coordinates::World
        }
    }

    struct NoFiles;

    impl mbody::description::Library for NoFiles {
        fn text(&self, _: &str) -> Option<std::borrow::Cow<'_, str>> {
            None
        }
    }

    /// Slopes, a bank, patches, waves and a hill of the world under a path that bends.
    fn passing() -> Passing {
        let mut layout = Layout::default();
        layout.straight(5.0);
        layout.bend(10.0, 0.0, 0.05);
        layout.bend(40.0, 0.05, 0.05);
        let kinds = ["slope", "bank", "friction", "sine"].map(|name| {
            let kind = KINDS.iter().find(|k| k.name == name).expect("a kind");
            (kind.make)(&serde_yaml::from_str(kind.example).expect("parameters"), &NoFiles).expect("a road").expect("not flat")
        });
        let reliefs = kinds.into_iter().chain([Arc::new(World) as Arc<dyn Relief>]).collect();
        let base = ["x", "y", "yaw", "vx", "vy", "r"].map(str::to_owned);
        Passing::new(Tracks { base, roads: ["front", "rear"].map(str::to_owned), wheelbase: 1.4 }, layout.path(), reliefs)
    }

    /// Base and stations near the path at an arc length, moving.
    fn somewhere(passing: &Passing, s: f64) -> [f64; READ] {
        let place = passing.path.at(s);
        [place.x + 0.1, place.y - 0.2, place.heading + 0.03, 12.0, 0.4, 0.5, s + 1.45, s + 0.05]
    }

    #[test]
    fn rates_are_those_of_a_vehicle_that_moves() {
        let passing = passing();
        for s in [12.3, 21.7, 30.45, 36.2] {
            let at = somewhere(&passing, s);
            let law = passing.law(&at);
            let after = |dt: f64| {
                let [x, y, heading, vx, vy, r, front, rear] = at;
                // along the arc of constant velocities, to second order
                let middle = heading + 0.5 * r * dt;
                let (sine, cosine) = middle.sin_cos();
                let place = [x + dt * (vx * cosine - vy * sine), y + dt * (vx * sine + vy * cosine), heading + r * dt];
                let stations = [front + dt * law[COMMANDS], rear + dt * law[COMMANDS + 1]];
                passing.law(&[place[0], place[1], place[2], vx, vy, r, stations[0], stations[1]])
            };
            let h = 1e-5;
            let (a, b) = (after(-h), after(h));
            for k in [0, 2, 4, 7, 9, 11] {
                let difference = (b[k] - a[k]) / (2.0 * h);
                assert!((law[k + 1] - difference).abs() < 1e-7, "{s}, {}: {} {difference}", passing.commanded[k], law[k + 1]);
            }
        }
    }

    #[test]
    fn derivatives_are_exact() {
        let passing = passing();
        for s in [12.3, 21.7, 30.45, 36.2] {
            let at = somewhere(&passing, s);
            let seeded: [Wide; READ] = std::array::from_fn(|k| {
                let mut seeded = <Wide as Real>::from_f64(at[k]);
                seeded.set_derivative(k, 1.0);
                seeded
            });
            let exact = passing.law(&seeded);
            for k in 0..READ {
                let moved = |by: f64| {
                    let mut there = at;
                    there[k] += by;
                    passing.law(&there)
                };
                let (a, b) = (moved(-1e-5), moved(1e-5));
                for (row, (a, b)) in a.iter().zip(b).enumerate() {
                    let (exact, difference) = (SystemScalar::derivative(&exact[row], k), (b - a) / 2e-5);
                    assert!((exact - difference).abs() < 1e-4 * exact.abs().max(1.0), "{s}, row {row} along {k}: {exact} {difference}");
                }
            }
        }
    }
}
