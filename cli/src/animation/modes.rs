//! The page of modes: small motions about steady states.
//!
//! ```text
//! X(t) = F(t) P(t) [exp(δw) R₀, p₀ + δv] Rot(a, Ω t + δθ)        δ = Re(A δ̂ e^{st})
//! δψ̂ = δr̂/s      s ξ̂ = δV̂x − Vy δψ̂ + r η̂      s η̂ = δV̂y + Vx δψ̂ − r ξ̂      δθ̂ = δΩ̂/s
//! ```
//!
//! F steady motion of the moving frame (speeds Vx, Vy, m/s, yaw rate r, rad/s); P deviation of the path in that frame: ξ forward, η left,
//! m, ψ heading, rad; δw, δv small rotation, rad, and displacement, m, of each body in the moving frame; Ω, θ spin of a wheel about its axis a;
//! A amplitude. The first line is exact for rigid bodies; loops close to first order in A.
//! Source: rigid kinematics in a turning frame, theory manual 8.3 (cyclic coordinates by integration).

use super::scene::{self, Scene};
use super::shape::vector;
use super::{assemble, base64};
use crate::Failure;
use crate::output::modes::{NamedMode, PointModes};
use crate::output::{Angles, Beside, Point, Report};
use mbody::description::finding::Finding;
use mbody::spatial::{Pose, Vec3};
use mbody::stage::Workspace;
use nalgebra::Complex;
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// Step of the differences of poses; their error is its square.
const STEP: f64 = 1e-5;
/// Most points of a page.
const MOST: usize = 500;
/// Below this a mode is no motion that could be integrated, 1/s.
const NEUTRAL: f64 = 1e-6;
/// Shares of the largest deviation below which a signal is not drawn.
const FAINT: f64 = 1e-3;

/// The part of the coordinates that no equation depends on.
struct Cyclic {
    /// Unknowns of x, y and heading of the moving frame, and of its speeds.
    path: Option<([usize; 3], [usize; 3])>,
    /// Body, unknown of its angle and of its spin.
    spins: Vec<(usize, usize, usize)>,
}

impl Cyclic {
    fn of(scene: &Scene) -> Self {
        let (model, unknowns) = (scene.system.model(), scene.system.unknowns());
        let layout = model.layout();
        let place = |list: &[usize], tree: usize| list.iter().position(|&k| k == tree);
        let coordinate = |tree: usize| place(&layout.independent_q, tree);
        let velocity = |tree: usize| place(&layout.independent_v, tree).map(|k| layout.nq() + k);
        let of_path = |first_q: usize, first_v: usize| {
            let q = [coordinate(first_q)?, coordinate(first_q + 1)?, coordinate(first_q + 2)?];
            let v = [velocity(first_v)?, velocity(first_v + 1)?, velocity(first_v + 2)?];
            (q.iter().all(|&k| unknowns[k].cyclic) && unknowns[q[2]].signal.unit == "rad").then_some((q, v))
        };
        let path = scene.follows.map(|b| model.body(b)).and_then(|body| of_path(body.q.start, body.v.start));
        let spins = model.moving().filter(|&b| model.body(b).joint.rotation_axis().is_some()).filter_map(|b| {
            let (angle, spin) = (coordinate(model.body(b).q.start)?, velocity(model.body(b).v.start)?);
            unknowns[angle].cyclic.then_some((b.get(), angle, spin))
        });
        Self { path, spins: spins.collect() }
    }

    fn has(&self, unknown: usize) -> bool {
        self.path.is_some_and(|(q, _)| q.contains(&unknown)) || self.spins.iter().any(|s| s.1 == unknown)
    }
}

/// The page of all modes at all points that have some.
///
/// # Errors
/// There are none, or too many.
pub fn page(scene: &Scene, report: &Report, angles: Angles) -> Result<String, Failure> {
    let found: Vec<(&Point, &PointModes)> = match &report.beside {
        Beside::Modes(modes) => report.points.iter().zip(&modes.points).filter_map(|(p, m)| Some((p, m.as_ref().ok()?))).collect(),
        _ => Vec::new(),
    };
    if found.is_empty() {
        return Err(Finding::error("no_steady_state", "there are no modes to animate").into());
    }
    if found.len() > MOST {
        let finding =
            Finding::error("too_many_points", format!("an animation of {} points would be too large; at most {MOST}", found.len()));
        return Err(finding.with_hint("sweep in larger steps, for example `--speed 10..60:5`").into());
    }
    let cyclic = Cyclic::of(scene);
    let mut w = Workspace::new(scene.system.model());
    let mut frames = Vec::new();
    let mut points = Vec::new();
    for (point, modes) in found {
        let mut steady = Steady { scene, cyclic: &cyclic, values: &point.values, w: &mut w };
        let poses = steady.poses(None);
        let columns = steady.columns();
        let velocity = cyclic.path.map_or([0.0; 3], |(_, v)| v.map(|k| point.values[k]));
        let spins: Vec<Value> = cyclic
            .spins
            .iter()
            .map(|&(body, _, spin)| json!({ "body": body, "axis": axis(scene, body), "rate": point.values[spin] }))
            .collect();
        let label: Vec<String> = (report.given.iter().zip(&point.given))
            .map(|(g, v)| {
                let shown = angles.show(&g.unit);
                format!("{} {} {}", g.name.replace('_', " "), (v * shown.factor * 1e6).round() / 1e6, shown.unit).trim_end().to_owned()
            })
            .collect();
        points.push(json!({
            "label": if label.is_empty() { "static pose".to_owned() } else { label.join(", ") },
            "velocity": velocity,
            "spins": spins,
            "poses": base64::numbers(scene::numbers(&poses)),
            "modes": modes.modes.iter().map(|m| steady.mode(m, &columns, velocity, angles)).collect::<Vec<_>>(),
        }));
        frames.push(poses);
    }
    let title = format!("Modes of {}", report.model);
    let about = "largest rotation of a body = amplitude; ISO axes: x forward, y left, z up";
    let data = json!({ "kind": "modes", "title": title, "about": about, "scene": scene.json(&frames), "points": points });
    Ok(assemble(&title, &data))
}

fn axis(scene: &Scene, body: usize) -> [f64; 3] {
    scene.system.model().bodies()[body].joint.rotation_axis().map_or([0.0; 3], vector)
}

/// One steady state.
struct Steady<'a> {
    scene: &'a Scene,
    cyclic: &'a Cyclic,
    /// All signals; the unknowns come first.
    values: &'a [f64],
    w: &'a mut Workspace<f64>,
}

/// Small rotation and displacement of a body.
type Small = (Vec3<f64>, Vec3<f64>);

impl Steady<'_> {
    /// Poses with the moving frame in the world's and the wheels unturned, one coordinate displaced.
    fn poses(&mut self, displaced: Option<(usize, f64)>) -> Vec<Pose<f64>> {
        let (cyclic, values) = (self.cyclic, self.values);
        let q = (0..self.scene.system.model().layout().nq()).map(|k| {
            let moved = displaced.filter(|d| d.0 == k).map_or(0.0, |d| d.1);
            moved + if cyclic.has(k) { 0.0 } else { values[k] }
        });
        self.scene.poses(self.w, q)
    }

    /// Motion of every body by each coordinate that is not cyclic, by central differences.
    fn columns(&mut self) -> Vec<(usize, Vec<Small>)> {
        let nq = self.scene.system.model().layout().nq();
        let cyclic = self.cyclic;
        let columns = (0..nq).filter(|&k| !cyclic.has(k)).map(|k| {
            let (ahead, behind) = (self.poses(Some((k, STEP))), self.poses(Some((k, -STEP))));
            let moved = ahead.iter().zip(&behind).map(|(a, b)| {
                let turn = a.R * b.R.inverse();
                let [x, y, z] = turn.columns;
                let skew = Vec3::new(y.z - z.y, z.x - x.z, x.y - y.x);
                (skew * (0.25 / STEP), (a.p - b.p) * (0.5 / STEP))
            });
            (k, moved.collect())
        });
        columns.collect()
    }

    /// One mode as the viewer reads it, scaled so that the largest rotation is 1 rad.
    fn mode(&self, mode: &NamedMode, columns: &[(usize, Vec<Small>)], velocity: [f64; 3], angles: Angles) -> Value {
        let bodies = self.scene.system.model().bodies().len();
        let zero = Complex::new(0.0, 0.0);
        let mut small = vec![[zero; 6]; bodies];
        for (k, moved) in columns {
            for (sum, (turn, shift)) in small.iter_mut().zip(moved) {
                let parts = [turn.x, turn.y, turn.z, shift.x, shift.y, shift.z];
                sum.iter_mut().zip(parts).for_each(|(s, part)| *s += mode.shape[*k] * part);
            }
        }
        let path = self.cyclic.path.map_or([zero; 3], |(_, v)| path(mode.value, velocity, v.map(|k| mode.shape[k])));
        let integrated = |z: Complex<f64>| if mode.value.norm() > NEUTRAL { z / mode.value } else { zero };
        let spins: Vec<Complex<f64>> = self.cyclic.spins.iter().map(|s| integrated(mode.shape[s.2])).collect();
        let size = |z: &[Complex<f64>]| z.iter().map(|z| z.norm_sqr()).sum::<f64>().sqrt();
        let shape = small.iter().map(|s| size(&s[..3]).max(size(&s[3..]))).fold(0.0, f64::max);
        let travel = path.iter().chain(&spins).map(|z| z.norm()).fold(0.0, f64::max);
        let scale = match (shape > 1e-9, travel > 1e-9) {
            (true, _) => 1.0 / shape,
            (false, true) => 1.0 / travel,
            _ => 0.0,
        };
        let pairs = |list: &[Complex<f64>]| list.iter().map(|z| [z.re * scale, z.im * scale]).collect::<Vec<_>>();
        let twists = small.iter().skip(1).flat_map(|s| s.iter().map(|z| z.re).chain(s.iter().map(|z| z.im)).collect::<Vec<_>>());
        json!({
            "name": mode.name,
            "re": mode.value.re,
            "im": mode.value.im,
            "hz": mode.value.im / TAU,
            "damping": mode.damping_ratio,
            "twists": base64::numbers(twists.map(|x| x * scale)),
            "path": pairs(&path),
            "spins": pairs(&spins),
            "phasors": self.phasors(mode, &path, scale, angles),
        })
    }

    /// Coordinates that take part, angles and lengths apart, the largest first.
    fn phasors(&self, mode: &NamedMode, path: &[Complex<f64>; 3], scale: f64, angles: Angles) -> Vec<Value> {
        let system = &self.scene.system;
        let named = system.unknowns().iter().enumerate().take(system.model().layout().nq());
        let deviations = named.filter_map(|(k, u)| match self.cyclic.path.and_then(|(q, _)| q.iter().position(|&p| p == k)) {
            Some(place) => Some((u, path[place])),
            None if self.cyclic.has(k) => None,
            None => Some((u, mode.shape[k])),
        });
        let deviations: Vec<_> = deviations.filter(|(_, z)| z.norm().is_finite()).collect();
        let mut chosen = Vec::new();
        for unit in ["rad", "m"] {
            let mut of_unit: Vec<_> = deviations.iter().filter(|(u, _)| u.signal.unit == unit).collect();
            of_unit.sort_by(|a, b| b.1.norm().total_cmp(&a.1.norm()));
            let largest = of_unit.first().map_or(0.0, |(_, z)| z.norm());
            let shown = if unit == "m" { ("mm", 1e3) } else { (angles.show(unit).unit, angles.show(unit).factor) };
            chosen.extend(of_unit.iter().take(6).filter(|(_, z)| z.norm() > FAINT * largest).map(|(u, z)| {
                let z = z * (scale * shown.1);
                json!({ "name": u.signal.name, "unit": shown.0, "re": z.re, "im": z.im })
            }));
        }
        chosen
    }
}

/// Deviation of the moving frame, forward, left and heading, from those of its speeds: see the head of the file.
fn path(s: Complex<f64>, [vx, vy, r]: [f64; 3], [forward, left, turn]: [Complex<f64>; 3]) -> [Complex<f64>; 3] {
    let determinant = s * s + r * r;
    if s.norm() < NEUTRAL || determinant.norm() < NEUTRAL * NEUTRAL {
        return [Complex::new(0.0, 0.0); 3];
    }
    let heading = turn / s;
    let (a, b) = (forward - heading * vy, left + heading * vx);
    [(s * a + b * r) / determinant, (s * b - a * r) / determinant, heading]
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEADY: [f64; 3] = [20.0, -0.5, 0.4];

    /// Place and heading of the deviated frame: the steady circle, then the deviation in its frame.
    fn composed(t: f64, deviation: [f64; 3]) -> [f64; 3] {
        let [vx, vy, r] = STEADY;
        let (sin, cos) = (r * t).sin_cos();
        let (x, y) = ((vx * sin - vy * (1.0 - cos)) / r, (vx * (1.0 - cos) + vy * sin) / r);
        let [forward, left, heading] = deviation;
        [x + cos * forward - sin * left, y + sin * forward + cos * left, r * t + heading]
    }

    /// Disturbed speeds, integrated without linearization, lead along the path that the mode is shown on.
    #[test]
    fn the_path_of_a_mode_in_a_turn_is_that_of_its_speeds() {
        let s = Complex::new(-0.3, 5.0);
        let shape = [Complex::new(0.3, -0.2), Complex::new(-0.5, 0.1), Complex::new(0.2, 0.4)];
        let deviation = path(s, STEADY, shape);
        let small = 1e-5;
        let at = |z: Complex<f64>, t: f64| small * (z * (s * t).exp()).re;
        let rates = |t: f64, psi: f64| {
            let [vx, vy, r] = [0, 1, 2].map(|k| STEADY[k] + at(shape[k], t));
            [vx * psi.cos() - vy * psi.sin(), vx * psi.sin() + vy * psi.cos(), r]
        };
        let mut q = composed(0.0, deviation.map(|z| at(z, 0.0)));
        let (steps, end) = (2000, 2.0);
        let h = end / f64::from(steps);
        for k in 0..steps {
            let t = h * f64::from(k);
            let moved = |by: [f64; 3], h: f64| q[2] + h * by[2];
            let a = rates(t, q[2]);
            let b = rates(t + h / 2.0, moved(a, h / 2.0));
            let c = rates(t + h / 2.0, moved(b, h / 2.0));
            let d = rates(t + h, moved(c, h));
            for i in 0..3 {
                q[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
            }
        }
        let expected = composed(end, deviation.map(|z| at(z, end)));
        for i in 0..3 {
            // second order in the deviation, 1e-10 times 40 m
            assert!((q[i] - expected[i]).abs() < 1e-8, "{i}: {} {}", q[i], expected[i]);
        }
    }
}
