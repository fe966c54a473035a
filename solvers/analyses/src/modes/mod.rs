//! Modes of small motions: frequency, damping, who takes part, shape; their names and their way along a sweep.
//!
//! `s = σ + jω`, natural frequency `|s| / 2π`, damped frequency `ω / 2π`, damping ratio `−σ / |s|`. Participation of a state:
//! `p_k = |w̄_k (E v)_k|` over the sum of all, with right and left vectors v, w and `wᴴ E v = 1`; a coordinate and its rate are one signal.
//! The shape of all unknowns follows from v; cyclic coordinates by integration, `(s − K_c) δc = K_x v`, in axes fixed at the heading of the point.
//!
//! - [`naming`] gives modes the names of rules;
//! - [`tracking`] follows them along a sweep;
//! - [`critical`] finds where one of them changes its sign.
//!
//! Source: I. J. Pérez-Arriaga, G. C. Verghese, F. C. Schweppe, IEEE Trans. Power App. Syst. 101 (1982) 3117–3125 (participation);
//! theory manual 8.3, 8.4.

mod assignment;
pub mod critical;
pub mod naming;
pub mod tracking;

use crate::eigen::{DEFECTIVE, EigenError, Spectrum, eigen};
use crate::linearize::LinearModel;
use nalgebra::{Complex, DVector};
use std::f64::consts::TAU;

/// One mode: a real eigenvalue, or a pair of conjugate ones.
#[derive(Clone, Debug)]
pub struct Mode {
    /// Eigenvalue with ω ≥ 0, 1/s.
    pub value: Complex<f64>,
    /// Its place in the spectrum; the conjugate one follows it.
    pub slot: usize,
    /// Participation of each of [`Modes::signals`]; the sum is 1.
    pub participation: Vec<f64>,
    /// Deviation of every unknown of the plant, cyclic coordinates included, SI; the largest state, in nominal values, is 1.
    pub shape: Vec<Complex<f64>>,
}

impl Mode {
    /// Whether it oscillates.
    pub fn oscillates(&self) -> bool {
        self.value.im > 0.0
    }

    /// `|s| / 2π`, Hz.
    pub fn natural_frequency(&self) -> f64 {
        self.value.norm() / TAU
    }

    /// `ω / 2π`, Hz.
    pub fn damped_frequency(&self) -> f64 {
        self.value.im / TAU
    }

    /// `−σ / |s|`; zero for a zero eigenvalue.
    pub fn damping_ratio(&self) -> f64 {
        if self.value.norm() > 0.0 { -self.value.re / self.value.norm() } else { 0.0 }
    }
}

/// All modes at one point.
#[derive(Clone, Debug)]
pub struct Modes {
    /// What takes part: coordinates (each with its rate), velocities of cyclic coordinates, element states.
    pub signals: Vec<String>,
    /// The modes, in the order of the spectrum.
    pub list: Vec<Mode>,
    /// Eigenvalues and vectors.
    pub spectrum: Spectrum,
    /// Names of the states.
    pub states: Vec<String>,
    /// Right vectors in nominal states and of unit length, one per eigenvalue.
    scaled: Vec<DVector<Complex<f64>>>,
}

impl Modes {
    /// The modes of a linear model.
    ///
    /// # Errors
    /// See [`eigen`].
    pub fn of(model: &LinearModel) -> Result<Self, EigenError> {
        let spectrum = eigen(model)?;
        let n = model.states.len();
        let in_nominal = |k: usize| DVector::from_fn(n, |i, _| spectrum.right[(i, k)] / model.states[i].nominal);
        let scaled: Vec<DVector<Complex<f64>>> = (0..n).map(|k| in_nominal(k).normalize()).collect();
        let (signals, member) = signals(model);
        let leads = (0..n).filter(|&k| spectrum.values[k].im >= 0.0);
        let list = leads.map(|slot| Mode {
            value: spectrum.values[slot],
            slot,
            participation: participation(model, &spectrum, &scaled[slot], slot, (signals.len(), &member)),
            shape: shape(model, &spectrum, slot),
        });
        let states = model.states.iter().map(|s| s.signal.name.clone()).collect();
        Ok(Self { list: list.collect(), signals, states, scaled, spectrum })
    }
}

/// The signals that take part, and for each state which of them it belongs to.
fn signals(model: &LinearModel) -> (Vec<String>, Vec<usize>) {
    let mut signals = Vec::new();
    let mut member = vec![0; model.states.len()];
    for (k, state) in model.states.iter().enumerate() {
        // coordinates come before their rates
        match state.partner.filter(|&partner| partner < k) {
            Some(coordinate) => member[k] = member[coordinate],
            None => {
                member[k] = signals.len();
                signals.push(state.signal.name.clone());
            }
        }
    }
    (signals, member)
}

/// Shares of the signals; those of a defective eigenvalue are squares of its right vector.
fn participation(
    model: &LinearModel,
    spectrum: &Spectrum,
    scaled: &DVector<Complex<f64>>,
    slot: usize,
    (count, member): (usize, &[usize]),
) -> Vec<f64> {
    let Ev = model.E.map(|e| Complex::new(e, 0.0)) * spectrum.right.column(slot);
    let defective = spectrum.sensitivity[slot] > DEFECTIVE;
    let mut shares = vec![0.0; count];
    for (k, &signal) in member.iter().enumerate() {
        shares[signal] += if defective { scaled[k].norm_sqr() } else { (spectrum.left[(k, slot)].conj() * Ev[k]).norm() };
    }
    let sum: f64 = shares.iter().sum();
    shares.iter_mut().for_each(|share| *share /= sum);
    shares
}

/// Deviations of all unknowns of the plant.
fn shape(model: &LinearModel, spectrum: &Spectrum, slot: usize) -> Vec<Complex<f64>> {
    let s = spectrum.values[slot];
    let v = spectrum.right.column(slot);
    let in_nominal = |k: usize| v[k] / model.states[k].nominal;
    // the first of equal ones, so that rounding does not choose
    let first = (0..v.len()).fold(None, |best: Option<usize>, k| match best {
        Some(b) if in_nominal(b).norm() * (1.0 + 1e-9) >= in_nominal(k).norm() => best,
        _ => Some(k),
    });
    let v = first.map_or_else(|| v.into_owned(), |k| v / in_nominal(k));
    let complex = |m: &nalgebra::DMatrix<f64>| m.map(|e| Complex::new(e, 0.0));
    let mut shape: Vec<Complex<f64>> = (complex(&model.unknowns) * &v).iter().copied().collect();
    let n = model.cyclic.unknowns.len();
    if n == 0 {
        return shape;
    }
    let rates = complex(&model.cyclic.by_states) * &v;
    let integrator = nalgebra::DMatrix::from_fn(n, n, |i, j| {
        let own = if i == j { s } else { Complex::new(0.0, 0.0) };
        own - Complex::new(model.cyclic.by_cyclic[(i, j)], 0.0)
    });
    // a mode at zero frequency drifts away: it has no shape there
    let cyclic = Some(integrator)
        .filter(|i| !i.is_empty())
        .and_then(|i| i.lu().solve(&rates))
        .filter(|c| c.iter().all(|e| e.re.is_finite() && e.im.is_finite()));
    for (k, &unknown) in model.cyclic.unknowns.iter().enumerate() {
        shape[unknown] = cyclic.as_ref().map_or(Complex::new(0.0, 0.0), |c| c[k]);
    }
    shape
}
