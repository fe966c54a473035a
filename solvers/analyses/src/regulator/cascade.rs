//! Cascades: a path asks for an acceleration across it, an inner loop brings a few states where that acceleration is steady.
//!
//! Inner loop: one leading state φ and a few others y are fed back, and the integral of φ, which leaves no error behind:
//!
//! ```text
//! u = −K (y − y₀ a_f) − K_i ∫(φ − φ₀ a_f) dt + u₀ a_f,     ä_f + 2 z w ȧ_f + w² a_f = w² a_ref
//! ```
//!
//! with the steady state y₀, u₀ per acceleration, and the rate of φ against `φ₀ ȧ_f`. K is the static feedback nearest to the regulator L of all states: of all `K C` it has the least mean square of
//! `(L − K C) x` in the motion that white noise of the input excites in the best loop, `K = L Σ Cᵀ (C Σ Cᵀ)⁻¹`, `A_c Σ + Σ A_cᵀ + B Bᵀ = 0`.
//!
//! Outer loop: `a_ref = Σ wᵢ V² κ(s + V tᵢ) − k² e − 2 ζ k V ψ`. The weights are those with which `Σ wᵢ exp(jω tᵢ) G(jω)` is nearest to one, G from a_ref to the acceleration across the path, and exactly
//! one at rest. k is the largest of a list for which every slow mode of the whole is damped well.
//!
//! | symbol | unit | |
//! |---|---|---|
//! | e, ψ, κ, V | m, rad, 1/m, m/s | offset, heading error and curvature of the path, speed |
//! | a_ref, a_f | m/s² | acceleration across the path that is asked for; the same behind its filter |
//! | k, ζ | rad/s, – | bandwidth and damping of the outer loop |
//!
//! Whole means: all states, actuator, filter, integral, path. A cascade is handed out only where all of its eigenvalues decay.
//!
//! Source: theory manual 10.3, 10.5; feedback of few states by projection: R. L. Kosut, *Suboptimal control of linear time-invariant systems subject to control structure constraints*,
//! IEEE Trans. Autom. Control 15 (1970) 557–563. Held by `solvers/analyses/tests/cascade.rs`.

use super::riccati::lyapunov;
use super::{Course, Design, Margins, Preview, Regulator, RegulatorError, actuated, extended, riccati};
use crate::LinearModel;
use nalgebra::{Complex, DMatrix, DVector, RowDVector};
use std::f64::consts::TAU;

/// Bandwidths of the outer loop that are tried, rad/s, and its damping ratio.
const BANDWIDTHS: [f64; 9] = [1.0, 0.85, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1];
const DAMPING: f64 = 0.8;
/// Least damping ratio of modes slower than the filter.
const LEAST_DAMPING: f64 = 0.3;
/// Frequencies at which the way ahead is matched, Hz: range, number, and where they begin to count less.
const MATCHED: (f64, f64, usize) = (0.02, 1.5, 60);
const MATTERS: f64 = 0.8;
/// Share of the sum of squares of the weights beside the mean square of the mismatch.
const SMOOTH: f64 = 1e-3;

/// What a cascade should reach.
#[derive(Clone, Debug)]
pub struct CascadeDesign {
    /// Input and its effort, states that are held by something else, how far it looks ahead, what lies before the input. The first deviation is that of the leading state; path deviations do not matter.
    pub design: Design,
    /// Integral of the leading state that counts as much as its deviation.
    pub integral: f64,
    /// Rate of the leading state, then what else is fed back.
    pub beside: Vec<String>,
    /// Natural frequency, rad/s, and damping ratio of the filter of the reference.
    pub filter: (f64, f64),
}

/// A cascade for one linear model.
#[derive(Clone, Debug)]
pub struct Cascade {
    /// The inner feedback: the leading state, then the others. Path gains are those of a_ref (1/s², m/s² per rad), weights of the way ahead are shares of `V² κ`.
    pub regulator: Regulator,
    /// Gain of the integral of the leading state.
    pub integral_gain: f64,
    /// Change of the leading state per acceleration across the path.
    pub lead: f64,
    /// Bandwidth of the outer loop, rad/s.
    pub bandwidth: f64,
}

/// The inner loop with its reference: states, actuator, integral, a_f, ȧ_f.
struct Inner {
    A: DMatrix<f64>,
    B: DMatrix<f64>,
    /// The input is `−row x`.
    row: RowDVector<f64>,
    /// Rates of offset and heading error.
    path: [RowDVector<f64>; 2],
    /// Steady lateral motion per acceleration: angle of slip, rad.
    slip: f64,
    speed: f64,
    filter: (f64, f64),
}

/// Designs a cascade that follows a path.
///
/// # Errors
/// Unknown names, a model without inertia, no stabilizing feedback of these states.
///
/// # Cost
/// One Riccati and one Lyapunov equation, some hundred linear systems of the size of the model.
pub fn cascade(model: &LinearModel, course: &Course, wanted: &CascadeDesign) -> Result<Cascade, RegulatorError> {
    let design = &wanted.design;
    let (all, input, kept) = extended(model, course, design)?;
    let (n, m) = (kept.len(), design.actuator.states());
    let place = |name: &str| {
        let found = kept.iter().position(|&k| *model.states[k].signal.name == *name);
        found.ok_or_else(|| RegulatorError::Unknown { what: "state", name: name.to_owned() })
    };
    let (leading, deviation) = design.deviations.first().cloned().unwrap_or_default();
    let names: Vec<String> = std::iter::once(leading).chain(wanted.beside.iter().cloned()).collect();
    let fed: Vec<usize> = names.iter().map(|name| place(name)).collect::<Result<_, _>>()?;
    // the path is not part of the inner loop
    let (A, B) = design.actuator.before(all.view((0, 0), (n, n)).into_owned(), input.rows(0, n).into_owned());
    let size = n + m;
    let (mut with_integral, mut by_input) = (DMatrix::zeros(size + 1, size + 1), DMatrix::zeros(size + 1, 1));
    with_integral.view_mut((0, 0), (size, size)).copy_from(&A);
    with_integral[(size, fed[0])] = 1.0;
    by_input.rows_mut(0, size).copy_from(&B);
    let mut Q = DMatrix::zeros(size + 1, size + 1);
    (Q[(fed[0], fed[0])], Q[(size, size)]) = (deviation.powi(-2), wanted.integral.powi(-2));
    let R = DMatrix::from_element(1, 1, design.effort.powi(-2));
    let nominal: Vec<f64> = kept.iter().map(|&k| model.states[k].nominal).chain(actuated(design)).chain([wanted.integral]).collect();
    let best = riccati((&with_integral, &by_input), (&Q, &R), &nominal)?;
    let gains = nearest((&best.closed, &by_input, &best.K), &fed, size).ok_or(RegulatorError::Singular)?;
    let steady = steady((&A, &B), (&all, course, n)).ok_or(RegulatorError::Singular)?;
    let inner = Inner::new((&with_integral, &by_input), (&gains, &fed), (&steady, &all, n), (course, wanted.filter));
    let weights = inner.ahead(design.preview).ok_or(RegulatorError::Singular)?;
    let (bandwidth, whole) = (BANDWIDTHS.iter().map(|&k| (k, inner.whole(k))))
        .find(|(_, (A, B, K))| is_damped(&(A - B * K), wanted.filter.0))
        .ok_or_else(|| RegulatorError::Unstable { fed_back: names.clone() })?;
    let (A, B, K) = whole;
    let closed = (&A - &B * &K).complex_eigenvalues().iter().copied().collect();
    let largest = weights.iter().fold(0.0, |m: f64, w| m.max(w.abs()));
    let preview =
        Preview { interval: design.preview.0 / design.preview.1 as f64, tail: weights.last().map_or(0.0, |w| w.abs() / largest), weights };
    let speed = course.speed.0.hypot(course.speed.1);
    let regulator = Regulator {
        states: names,
        gains: gains[..fed.len()].to_vec(),
        path_gains: [bandwidth * bandwidth, 2.0 * DAMPING * bandwidth * speed],
        actuator_gains: vec![0.0; m],
        preview,
        closed,
        margins: Margins::of(&A, &B, &K),
    };
    Ok(Cascade { regulator, integral_gain: gains[fed.len()], lead: steady[fed[0]], bandwidth })
}

/// The static feedback of the states `fed` and of the integral (the last state) that is nearest to a regulator.
fn nearest((closed, B, K): (&DMatrix<f64>, &DMatrix<f64>, &DMatrix<f64>), fed: &[usize], integral: usize) -> Option<Vec<f64>> {
    let excited = lyapunov(&closed.transpose(), &(B * B.transpose()))?;
    let rows: Vec<usize> = fed.iter().copied().chain([integral]).collect();
    let seen = DMatrix::from_fn(rows.len(), rows.len(), |i, j| excited[(rows[i], rows[j])]);
    // in units in which all that is seen is of size one
    let scale: Vec<f64> = (0..rows.len()).map(|i| seen[(i, i)].sqrt()).collect();
    let scaled = DMatrix::from_fn(rows.len(), rows.len(), |i, j| seen[(i, j)] / (scale[i] * scale[j]));
    let with = K * &excited;
    let right = DVector::from_fn(rows.len(), |i, _| with[rows[i]] / scale[i]);
    let solved = scaled.lu().solve(&right)?;
    Some(solved.iter().zip(&scale).map(|(k, s)| k / s).collect())
}

/// Steady states and input per acceleration across the path: the input stands last.
fn steady((A, B): (&DMatrix<f64>, &DMatrix<f64>), (all, course, n): (&DMatrix<f64>, &Course, usize)) -> Option<DVector<f64>> {
    let (size, speed) = (A.nrows(), course.speed.0.hypot(course.speed.1));
    let mut bordered = DMatrix::zeros(size + 1, size + 1);
    bordered.view_mut((0, 0), (size, size)).copy_from(A);
    bordered.view_mut((0, size), (size, 1)).copy_from(B);
    for k in 0..n {
        bordered[(size, k)] = speed * all[(n + 1, k)];
    }
    let mut one = DVector::zeros(size + 1);
    one[size] = 1.0;
    bordered.lu().solve(&one)
}

impl Inner {
    fn new(
        (with_integral, by_input): (&DMatrix<f64>, &DMatrix<f64>),
        (gains, fed): (&[f64], &[usize]),
        (steady, all, n): (&DVector<f64>, &DMatrix<f64>, usize),
        (course, filter): (&Course, (f64, f64)),
    ) -> Self {
        let size = with_integral.nrows();
        let (reference, rate) = (size, size + 1);
        let (mut A, mut B) = (DMatrix::zeros(size + 2, size + 2), DMatrix::zeros(size + 2, 1));
        A.view_mut((0, 0), (size, size)).copy_from(with_integral);
        B.rows_mut(0, size).copy_from(by_input);
        A[(size - 1, reference)] = -steady[fed[0]];
        A[(reference, rate)] = 1.0;
        (A[(rate, reference)], A[(rate, rate)]) = (-filter.0 * filter.0, -2.0 * filter.1 * filter.0);
        let mut row = RowDVector::zeros(size + 2);
        row[reference] = -steady[steady.len() - 1];
        for (j, (&k, gain)) in fed.iter().zip(gains).enumerate() {
            row[k] += gain;
            // the second is the rate of the first
            match j {
                1 => row[rate] -= gain * steady[fed[0]],
                _ => row[reference] -= gain * steady[k],
            }
        }
        row[size - 1] = gains[fed.len()];
        let of_path = |i: usize| RowDVector::from_fn(size + 2, |_, k| if k < n { all[(n + i, k)] } else { 0.0 });
        let path = [of_path(0), of_path(1)];
        let speed = course.speed.0.hypot(course.speed.1);
        let drift: f64 = (0..n).map(|k| all[(n, k)] * steady[k]).sum();
        Self { A, B, row, path, slip: drift / speed, speed, filter }
    }

    /// Weights of the way ahead.
    fn ahead(&self, (horizon, intervals): (f64, usize)) -> Option<Vec<f64>> {
        let (size, count) = (self.A.nrows(), intervals + 1);
        let closed = &self.A - &self.B * &self.row;
        let (low, high, samples) = MATCHED;
        let (mut normal, mut right) = (DMatrix::zeros(count + 1, count + 1), DVector::zeros(count + 1));
        for k in 0..samples {
            let frequency = low + (high - low) * k as f64 / (samples - 1) as f64;
            let jw = Complex::new(0.0, TAU * frequency);
            let system = DMatrix::from_fn(size, size, |i, j| (if i == j { jw } else { 0.0.into() }) - closed[(i, j)]);
            let mut asked = DVector::from_element(size, Complex::new(0.0, 0.0));
            asked[size - 1] = (self.filter.0 * self.filter.0).into();
            let moved = system.lu().solve(&asked)?;
            let along = |row: &RowDVector<f64>| row.iter().zip(moved.iter()).map(|(a, x)| x * *a).sum::<Complex<f64>>();
            let response = jw * along(&self.path[0]) + along(&self.path[1]) * self.speed;
            let counts = (1.0 + (frequency / MATTERS).powi(4)).powi(-2);
            let sample = |i: usize| (jw * (horizon * i as f64 / intervals as f64)).exp() * response;
            for i in 0..count {
                for j in 0..count {
                    normal[(i, j)] += counts * (sample(i).conj() * sample(j)).re;
                }
                right[i] += counts * sample(i).re;
            }
        }
        for i in 0..count {
            normal[(i, i)] += SMOOTH * samples as f64;
            (normal[(i, count)], normal[(count, i)]) = (1.0, 1.0);
        }
        right[count] = 1.0;
        Some(normal.lu().solve(&right)?.iter().take(count).copied().collect())
    }

    /// The whole with an outer loop of bandwidth k, offset and heading error last, and the row that is fed back.
    fn whole(&self, k: f64) -> (DMatrix<f64>, DMatrix<f64>, DMatrix<f64>) {
        let size = self.A.nrows();
        let (mut A, mut B, mut K) = (DMatrix::zeros(size + 2, size + 2), DMatrix::zeros(size + 2, 1), DMatrix::zeros(1, size + 2));
        A.view_mut((0, 0), (size, size)).copy_from(&self.A);
        B.rows_mut(0, size).copy_from(&self.B);
        K.view_mut((0, 0), (1, size)).copy_from(&self.row);
        for (i, row) in self.path.iter().enumerate() {
            A.view_mut((size + i, 0), (1, size)).copy_from(row);
        }
        A[(size, size + 1)] = self.speed;
        let stiffness = self.filter.0 * self.filter.0;
        let turned = stiffness * 2.0 * DAMPING * k * self.speed;
        A[(size - 1, size)] = -stiffness * k * k;
        A[(size - 1, size + 1)] = -turned;
        A[(size - 1, size - 2)] -= turned * self.slip;
        (A, B, K)
    }
}

/// Whether everything decays, and what is slower than `fast` (rad/s) without much swinging.
fn is_damped(closed: &DMatrix<f64>, fast: f64) -> bool {
    let fine = |s: &Complex<f64>| s.re < 0.0 && (s.im == 0.0 || s.norm() > fast || -s.re > LEAST_DAMPING * s.norm());
    closed.complex_eigenvalues().iter().all(fine)
}
