//! What is asked of every kind of element, assembled from its own example, in motion: a crate with kinds of its own asks it of them too.

mod motion;

use crate::agreement::{Agreement, Tolerance, absolute, relative};
use crate::numbers::Numbers;
use mbody::assembly::{ElementKind, Kinds};
use motion::{Example, Motion, REGIMES, Regime, on_tree};
use problem::{Dae, Differentiable, Matrix, Outputs, Seeds};

/// Kinds of elements on their example trees.
#[derive(Debug)]
pub struct Conformity {
    kinds: Kinds,
    held: Vec<ElementKind>,
    examples: Vec<Example>,
}

impl Conformity {
    /// The examples of kinds in `held`, which are among `kinds`; `beside`: name of a kind and a further written form of it.
    ///
    /// # Panics
    /// Where an example does not assemble.
    pub fn of(kinds: Kinds, held: &[ElementKind], beside: &[(&str, &str)]) -> Self {
        let kind = |name: &str| held.iter().find(|kind| kind.name == name).unwrap_or_else(|| panic!("no kind is called {name}"));
        let written = held.iter().map(|kind| (kind, kind.example)).chain(beside.iter().map(|(name, written)| (kind(name), *written)));
        let examples = written.map(|(kind, written)| Example::of(&kinds, kind, written)).collect();
        Self { kinds, held: held.to_vec(), examples }
    }

    /// Every example in every regime.
    fn motions(&self, mut hold: impl FnMut(&str, Motion)) {
        let mut numbers = Numbers(31);
        for example in &self.examples {
            for regime in REGIMES {
                let mut motion = Motion::of(example);
                motion.go(regime, &mut numbers);
                hold(&format!("{} {regime:?}", example.kind.name), motion);
            }
        }
    }

    /// The schema accepts the example and refuses an unknown key at any depth of it; signals have names in snake case, units and sentences.
    ///
    /// # Panics
    /// Where it does not hold, which is how a test fails.
    pub fn the_schema_accepts_every_example_and_refuses_unknown_keys(&self) {
        for kind in &self.held {
            let (assembled, findings) = on_tree(&self.kinds, kind, &format!("{{ example: {{ {}: {} }} }}", kind.name, kind.example));
            assert!(assembled.is_some() && findings.iter().next().is_none(), "{}: {findings}", kind.name);
            for (place, _) in kind.example.match_indices('{') {
                let (before, after) = kind.example.split_at(place + 1);
                let wrong = format!("{before} unknown_key: 1,{after}");
                let (assembled, findings) = on_tree(&self.kinds, kind, &format!("{{ example: {{ {}: {wrong} }} }}", kind.name));
                assert!(assembled.is_none(), "{}: accepts {wrong}", kind.name);
                let told = |f: &mbody::description::finding::Finding| f.path.contains("unknown_key") || f.message.contains("unknown_key");
                assert!(findings.iter().any(told), "{}: {wrong}\n{findings}", kind.name);
            }
            let system = assembled.map(|a| a.system).expect("assembled");
            for signal in system.outputs().iter().chain(system.inputs().iter().map(|i| &i.signal)) {
                let snake = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "_.".contains(c);
                assert!(signal.name.chars().all(snake), "{}: `{}` is not in snake case", kind.name, signal.name);
                assert!(!signal.unit.is_empty() && !signal.about.is_empty(), "{}: `{}` lacks unit or sentence", kind.name, signal.name);
            }
        }
    }

    /// Derivatives of residual and outputs along every y, ẏ and u are those of extrapolated differences.
    ///
    /// # Panics
    /// Where it does not hold, which is how a test fails.
    pub fn derivatives_are_exact(&self) {
        let mut agreement = Agreement::on("elements: exact derivatives against central differences");
        self.motions(|name, mut motion| {
            let (seeds, scales) = every_direction(&motion);
            let ([r, z], exact) = motion.along(&seeds);
            let size = |numbers: &[f64]| numbers.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
            // a stiff spring sees the rounding of positions of about a meter
            let stiffness = size(exact[0].as_slice()).max(size(exact[1].as_slice()));
            let rounding_of_forces = f64::EPSILON * (64.0 * size(&r).max(size(&z)) + 8.0 * stiffness);
            let found = differences(&mut motion, &scales);
            for (part, (exact, found)) in ["row", "output"].into_iter().zip(exact.iter().zip(&found)) {
                for i in 0..exact.rows() {
                    for k in 0..scales.len() {
                        let rounding = rounding_of_forces / (STEP * scales[k]);
                        let tolerance = absolute(rounding).or_relative(1e-6).because("rounding of forces over the step");
                        agreement.near(&format!("{name}: {part} {i}, argument {k}"), found[(i, k)], exact[(i, k)], &tolerance);
                    }
                }
            }
        });
        agreement.assert();
    }

    /// P = −d(stored)/dt + supplied − dissipated.
    ///
    /// # Panics
    /// Where it does not hold, which is how a test fails.
    pub fn energy_is_accounted_for(&self) {
        let mut agreement = Agreement::on("elements: balance of power");
        self.motions(|name, mut motion| {
            let system = motion.plant.system().clone();
            let (full, _) = motion.evaluate();
            let mut alone = vec![0.0; full.len()];
            let at = problem::At { time: 0.0, y: &motion.y, yd: &motion.yd, u: &motion.u };
            assert!(
                motion.plant.residual(at, &mut alone).is_ok() && alone == full,
                "{name} exerts something, though it says that it only tells"
            );
            let delivered =
                motion.plant.evaluate_at(problem::At { time: 0.0, y: &motion.y, yd: &motion.yd, u: &motion.u }).delivered_power(&system);
            let n = motion.bare.unknowns().len();
            let at = problem::At { time: 0.0, y: &motion.y, yd: &motion.yd, u: &motion.u };
            let (total, account) = motion.plant.energy_rate_at(at);
            let (tree, _) = motion.bare.energy_rate_at(problem::At { y: &at.y[..n], yd: &at.yd[..n], u: &[], ..at });
            let stored = total - tree + by_moving_inputs(&mut motion);
            let balance = -stored + account.elements.supplied - account.elements.dissipated;
            let size =
                [delivered, total, tree, account.elements.supplied, account.elements.dissipated].map(f64::abs).into_iter().sum::<f64>();
            agreement.near(name, delivered, balance, &absolute(1e-13 * size).because("double precision of the largest term"));
        });
        agreement.assert();
    }

    /// Forces and outputs do not see x, y and yaw; positions on the road move along.
    ///
    /// # Panics
    /// Where it does not hold, which is how a test fails.
    pub fn nothing_depends_on_place_and_heading(&self) {
        let mut agreement = Agreement::on("elements: symmetry of the level road");
        let symmetry: Tolerance = relative(1e-10).because("double precision at forces of some kN");
        let close = |a: &[f64], b: &[f64]| {
            let size = b.iter().fold(1.0, |size: f64, x| size.max(x.abs()));
            a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-10 * size)
        };
        let (dx, dy, angle) = (3.7, -2.1, 0.8);
        self.motions(|name, mut motion| {
            let outputs: Vec<String> = motion.plant.outputs().iter().map(|o| o.name.clone()).collect();
            let inputs: Vec<String> = motion.plant.inputs().iter().map(|i| i.signal.name.clone()).collect();
            let (x, y, yaw) = (motion.unknown("x"), motion.unknown("y"), motion.unknown("yaw"));
            let (r, z) = motion.evaluate();
            let (x0, y0) = (motion.y[x], motion.y[y]);
            // the base turns about the origin of the road, then shifts
            let (s, c) = f64::sin_cos(angle);
            (motion.y[x], motion.y[y]) = (c * x0 - s * y0 + dx, s * x0 + c * y0 + dy);
            motion.y[yaw] += angle;
            motion.make_consistent();
            let mut found = motion.evaluate();
            if !close(&found.0, &r) {
                // inputs in axes of the world turn along
                motion.u = turned(&motion.u, &inputs, angle);
                motion.make_consistent();
                found = motion.evaluate();
            }
            agreement.all_near(&format!("{name}: rows"), &found.0, &r, &symmetry);
            let along = turned(&z, &outputs, angle);
            let rounding = 1e-11 * z.iter().fold(1.0, |size: f64, x| size.max(x.abs()));
            for (i, output) in outputs.iter().enumerate() {
                let shift = match output.rsplit_once('_') {
                    Some((_, "x")) => dx,
                    Some((_, "y")) => dy,
                    _ => 0.0,
                };
                // an output either stays, or is a position that moves along
                let stays = (found.1[i] - z[i]).abs() <= rounding;
                let expected = if stays { z[i] } else { along[i] + shift };
                let tolerance = absolute(rounding).because("double precision of the largest output");
                agreement.near(&format!("{name}: `{output}`"), found.1[i], expected, &tolerance);
            }
        });
        agreement.assert();
    }

    /// Evaluation on dual numbers gives the values of plain numbers, to the last bit.
    ///
    /// # Panics
    /// Where it does not hold, which is how a test fails.
    pub fn dual_numbers_carry_the_same_values(&self) {
        let mut agreement = Agreement::on("elements: values of dual numbers");
        let same = absolute(0.0).because("the same operations");
        self.motions(|name, mut motion| {
            let (r, z) = motion.evaluate();
            for directions in [8, 16, 24] {
                let seeds = Seeds::zeros(motion.y.len(), motion.u.len(), directions);
                let ([dual_r, dual_z], _) = motion.along(&seeds);
                agreement.all_near(&format!("{name}: rows on {directions}"), &dual_r, &r, &same);
                agreement.all_near(&format!("{name}: outputs on {directions}"), &dual_z, &z, &same);
            }
        });
        agreement.assert();
    }

    /// Evaluation of residual, outputs and derivatives allocates nothing; `count`: number of allocations while something runs.
    ///
    /// # Panics
    /// Where it does not hold, which is how a test fails.
    pub fn evaluation_allocates_nothing(&self, count: impl Fn(&mut dyn FnMut()) -> u64) {
        let mut numbers = Numbers(5);
        for example in &self.examples {
            let (kind, mut motion) = (example.kind, Motion::of(example));
            motion.go(Regime::Leaning, &mut numbers);
            let (seeds, scales) = every_direction(&motion);
            let (nr, nz) = (motion.plant.equations().len(), motion.plant.outputs().len());
            let (mut r, mut z) = (vec![0.0; nr], vec![0.0; nz]);
            let (mut dr, mut dz) = (Matrix::zeros(nr, scales.len()), Matrix::zeros(nz, scales.len()));
            let Motion { plant, y, yd, u, .. } = &mut motion;
            let at = problem::At { time: 0.0, y, yd, u };
            let counted = count(&mut || {
                plant.residual(at, &mut r).expect("finite");
                plant.evaluate(at, &mut r, &mut z).expect("finite");
                plant.along(at, &seeds, (&mut r, &mut z), &mut dr, &mut dz).expect("finite");
                let _ = plant.energy_rate_at(at);
            });
            assert_eq!(counted, 0, "{}: allocations", kind.name);
        }
    }
}

/// All directions of (y, ẏ, u), one column each, and the scale of each.
fn every_direction(motion: &Motion) -> (Seeds, Vec<f64>) {
    let (ny, nu) = (motion.y.len(), motion.u.len());
    let mut seeds = Seeds::zeros(ny, nu, 2 * ny + nu);
    for i in 0..ny {
        seeds.y[(i, i)] = 1.0;
        seeds.yd[(i, ny + i)] = 1.0;
    }
    for i in 0..nu {
        seeds.u[(i, 2 * ny + i)] = 1.0;
    }
    let nominal: Vec<f64> = motion.plant.unknowns().iter().map(|u| u.nominal).collect();
    let inputs = motion.plant.inputs().iter().map(|u| u.nominal);
    let scales = nominal.iter().chain(&nominal).copied().chain(inputs).collect();
    (seeds, scales)
}

/// Residual and outputs with one argument moved by some amount.
fn moved(motion: &mut Motion, argument: usize, by: f64) -> (Vec<f64>, Vec<f64>) {
    let (ny, arguments) = (motion.y.len(), [&mut motion.y, &mut motion.yd, &mut motion.u]);
    let [y, yd, u] = arguments;
    let x = match argument {
        i if i < ny => &mut y[i],
        i if i < 2 * ny => &mut yd[i - ny],
        i => &mut u[i - 2 * ny],
    };
    let kept = std::mem::replace(x, *x + by);
    let result = motion.evaluate();
    let [y, yd, u] = [&mut motion.y, &mut motion.yd, &mut motion.u];
    match argument {
        i if i < ny => y[i] = kept,
        i if i < 2 * ny => yd[i - ny] = kept,
        i => u[i - 2 * ny] = kept,
    }
    result
}

/// Step of the differences, in units of the scale of each argument.
const STEP: f64 = 1e-3;

/// Central differences of steps h and h/2, extrapolated to step 0.
fn differences(motion: &mut Motion, scales: &[f64]) -> [Matrix; 2] {
    let (nr, nz) = (motion.plant.equations().len(), motion.plant.outputs().len());
    let mut found = [Matrix::zeros(nr, scales.len()), Matrix::zeros(nz, scales.len())];
    for (k, scale) in scales.iter().enumerate() {
        let h = STEP * scale;
        let points = [h, -h, 0.5 * h, -0.5 * h].map(|by| moved(motion, k, by));
        let pick = |part: usize, i: usize| points.each_ref().map(|p| if part == 0 { p.0[i] } else { p.1[i] });
        for (part, matrix) in found.iter_mut().enumerate() {
            for i in 0..matrix.rows() {
                let [a, b, c, d] = pick(part, i);
                let (coarse, fine) = ((a - b) / (2.0 * h), (c - d) / h);
                matrix[(i, k)] = fine + (fine - coarse) / 3.0;
            }
        }
    }
    found
}

/// Rate of the stored energy by inputs that move: those that have a rate among the inputs, as the height of a road.
fn by_moving_inputs(motion: &mut Motion) -> f64 {
    let rates: Vec<Option<usize>> = motion.plant.inputs().iter().map(|i| i.rate).collect();
    let mut sum = 0.0;
    for (i, rate) in rates.into_iter().enumerate().filter_map(|(i, rate)| rate.map(|rate| (i, rate))) {
        // springs store the square of the height, and of slopes a smooth function: differences of the sixth order
        let (kept, step) = (motion.u[i], 1e-3);
        let mut stored = |by: f64| {
            motion.u[i] = kept + by;
            motion.plant.account_at(problem::At { time: 0.0, y: &motion.y, yd: &motion.yd, u: &motion.u }).elements.stored
        };
        let mut slope = |factor: f64| (stored(factor * step) - stored(-factor * step)) / (2.0 * factor * step);
        let slope = (64.0 * slope(1.0) - 20.0 * slope(2.0) + slope(4.0)) / 45.0;
        motion.u[i] = kept;
        sum += slope * motion.u[rate];
    }
    sum
}

/// Rotates the pairs `…_x`, `…_y` of a list of named values by an angle.
fn turned(values: &[f64], names: &[String], angle: f64) -> Vec<f64> {
    let (s, c) = angle.sin_cos();
    let mut turned = values.to_vec();
    for (i, name) in names.iter().enumerate() {
        let partner = name.strip_suffix("_x").and_then(|stem| names.iter().position(|n| *n == format!("{stem}_y")));
        if let Some(j) = partner {
            (turned[i], turned[j]) = (c * values[i] - s * values[j], s * values[i] + c * values[j]);
        }
    }
    turned
}
