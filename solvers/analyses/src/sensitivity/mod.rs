//! Sensitivities: how eigenvalues and signals of a steady state move with a parameter.
//!
//! A steady state satisfies `f(x; p) = 0`, its linear model `A v = s E v`, `wᴴ A = s wᴴ E`, `wᴴ E v = 1`. With the parameter the state moves along
//! `x′ = −(∂f/∂x)⁻¹ ∂f/∂p`, and with both
//!
//! ```text
//! s′ = wᴴ (A′ − s E′) v          ′: the whole derivative d/dp = ∂/∂p + x′ ∂/∂x
//! ```
//!
//! Matrices and signals are exact at every point; their derivatives are central differences along the tangent, between `(x + h x′, p + h)` and
//! `(x − h x′, p − h)`, extrapolated to h = 0. The tangent leaves the path of steady states by O(h²) only, to the same side at both
//! ends, so what is found is the derivative along the path, and no iteration adds noise to the differences. The states of the linear model are those
//! of the base point throughout. A value that occurs several times, or has fewer vectors than its multiplicity, has no derivative.
//!
//! Source: P. Lancaster, Numer. Math. 6 (1964) 377–387 (derivative of eigenvalues); theory manual 8.3.

mod extrapolation;

pub use extrapolation::Estimate;

use crate::eigen::{DEFECTIVE, EigenError, Spectrum, eigen};
use crate::linearize::{BoundInputs, OffTrim, Options};
use crate::trim::{Rows, Trim, TrimError, TrimProblem};
use crate::{LinearModel, LinearizeError, Variable, linearize};
use extrapolation::extrapolate;
use nalgebra::{Complex, DMatrix, DVector, Dyn, LU};
use problem::{AlgebraicProblem, At, EvalError, Family, Matrix, Member, NoMember, ParameterId, Plant, Unknown, UnknownKind};
use thiserror::Error;

/// Differences per derivative: steps from h down to h/8 leave an error of h⁸; where something bends more sharply, smaller ones follow.
const LEVELS: (i32, i32) = (4, 9);

/// Largest step in units of the parameter's magnitude, a power of two.
const STEP: f64 = 1.0 / 128.0;

/// Relative error at which smaller steps end: rounding would not let them do much better.
const ACCURATE: f64 = 1e-9;

/// Largest change of an eigenvalue, relative to it, by cyclic coordinates that do not matter.
const SYMMETRIC: f64 = 1e-8;

/// Eigenvalues closer than this, relative to the magnitude of the larger one, are not told apart.
const ALONE: f64 = 1e-8;

/// Factors of a square matrix.
type Factors = LU<f64, Dyn, Dyn>;

/// Why a sensitivity cannot be found.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SensitivityError {
    /// The steady state cannot be stated.
    #[error(transparent)]
    Trim(#[from] TrimError),
    /// The values given are no steady state, or one that is not isolated.
    #[error("the steady state is not regular: {because}")]
    NotRegular {
        /// What was found.
        because: String,
    },
    /// There is no model with a slightly different parameter.
    #[error("with `{parameter}` at {value:.6} {unit}: {because}")]
    Member {
        /// The parameter.
        parameter: String,
        /// The value that was tried.
        value: f64,
        /// Its unit.
        unit: String,
        /// Why.
        because: String,
    },
    /// The steady state has no linear model.
    #[error(transparent)]
    Linearize(#[from] LinearizeError),
    /// The linear model has no eigenvalues.
    #[error(transparent)]
    Eigen(#[from] EigenError),
}

impl From<NoMember> for SensitivityError {
    fn from(none: NoMember) -> Self {
        Self::NotRegular { because: none.because }
    }
}

/// Derivatives of a steady state and its modes by one parameter.
#[derive(Clone, Debug)]
pub struct Derivatives {
    /// Of every eigenvalue, in the order of the spectrum; none where the eigenvalue is not alone.
    pub eigenvalues: Vec<Option<Estimate<Complex<f64>>>>,
    /// Of every unknown of the steady state.
    pub unknowns: Vec<Estimate<f64>>,
    /// Of every input.
    pub inputs: Vec<Estimate<f64>>,
    /// Of every output.
    pub outputs: Vec<Estimate<f64>>,
}

/// A steady state with its modes, ready to be differentiated by the parameters of its family.
pub struct Sensitivity<'f> {
    family: &'f dyn Family,
    trim: Trim,
    rows: Rows,
    /// Solution of the trim, polished to rounding.
    x: Vec<f64>,
    /// ∂f/∂x there.
    jacobian: Factors,
    /// The linear model.
    pub model: LinearModel,
    /// Its eigenvalues and vectors.
    pub spectrum: Spectrum,
    /// Whether each eigenvalue has a derivative.
    alone: Vec<bool>,
}

/// What is compared between the two ends of a step: entries of E and A, then unknowns, inputs, outputs.
struct End {
    E: DMatrix<f64>,
    A: DMatrix<f64>,
    signals: Vec<f64>,
}

impl<'f> Sensitivity<'f> {
    /// Takes a steady state of the family's own member.
    ///
    /// # Arguments
    /// `trim`: roles and goals whose solution it is. `at`: the solution, unknowns, rates and inputs. `states`: unknowns that should be states where
    /// constraints leave a choice.
    ///
    /// # Errors
    /// The values solve another trim, the trim is singular there, or there is no linear model.
    ///
    /// # Cost
    /// Some iterations of Newton's method, one linear model.
    pub fn at(family: &'f dyn Family, trim: &Trim, at: At<'_>, states: &[String]) -> Result<Self, SensitivityError> {
        let Member { mut steady, mut linear } = family.with(&[])?;
        let mut problem = TrimProblem::new(steady.as_mut(), trim)?;
        let mut x: Vec<f64> = problem.unknowns().iter().map(|v| value(*v, at)).collect();
        let jacobian = polish(&mut problem, &mut x)?;
        let rows = problem.rows();
        let (y, yd, u, _) = problem.point();
        let options = Options { independent: states.to_vec(), bound_inputs: BoundInputs::LeaveOut, ..Options::default() };
        let model = linear_model(linear.as_mut(), (y, yd, u), &options)?;
        let spectrum = eigen(&model)?;
        let alone = alone(&spectrum);
        Ok(Self { family, trim: trim.clone(), rows, x, jacobian, model, spectrum, alone })
    }

    /// Derivatives by one parameter.
    ///
    /// # Errors
    /// There is no model beside this one, or its modes change as cyclic coordinates grow.
    ///
    /// # Cost
    /// Nine assemblies, residuals and linear models; up to nineteen where the error asks for it.
    pub fn by(&self, parameter: ParameterId) -> Result<Derivatives, SensitivityError> {
        let about = &self.family.parameters()[parameter.0];
        // a power of two: the ends of the steps are p ± h to the last bit, or nearly so
        let largest = (about.nominal * STEP).log2().round().exp2();
        let mut slopes: Vec<Vec<Complex<f64>>> = Vec::new();
        self.check_symmetry(parameter, about.value + largest)?;
        let modes = self.spectrum.values.len();
        for level in 0..LEVELS.1 {
            if level >= LEVELS.0 && (0..modes).all(|k| !self.alone[k] || self.accurate(k, estimate(&slopes, k), about.nominal)) {
                break;
            }
            slopes.push(self.slopes(parameter, about.value, largest / 2f64.powi(level))?);
        }
        let count = slopes.first().map_or(0, Vec::len);
        let estimate = |k: usize| estimate(&slopes, k);
        let eigenvalues = (0..modes).map(|k| self.alone[k].then(|| estimate(k))).collect();
        let mut signals = (modes..count).map(|k| {
            let Estimate { value, error } = estimate(k);
            Estimate { value: value.re, error }
        });
        let (unknowns, inputs, _) = self.trim.variables().counts();
        Ok(Derivatives {
            eigenvalues,
            unknowns: signals.by_ref().take(unknowns).collect(),
            inputs: signals.by_ref().take(inputs).collect(),
            outputs: signals.collect(),
        })
    }

    /// Small motions must not begin to depend on a cyclic coordinate: a wheel with another moment about one of its diameters only has modes that
    /// change as it turns.
    fn check_symmetry(&self, parameter: ParameterId, value: f64) -> Result<(), SensitivityError> {
        let fault = |because: String| self.fault(parameter, value, because);
        let mut member = self.family.with(&[(parameter, value)]).map_err(|e| fault(e.because))?;
        let mut at = |shift: f64| self.end(&mut member, &self.x, shift).map_err(fault);
        let moved = self.eigenvalue_slopes(&at(1.0)?, &at(0.0)?, 1.0);
        let same = |(by, s): (&Complex<f64>, &Complex<f64>)| by.norm() <= SYMMETRIC * s.norm().max(1.0);
        let all = moved.iter().zip(&self.spectrum.values).zip(&self.alone).filter(|(_, alone)| **alone).all(|(pair, _)| same(pair));
        match all {
            true => Ok(()),
            false => Err(fault("small motions depend on where cyclic coordinates stand, as with a wheel that is not symmetric".to_owned())),
        }
    }

    fn fault(&self, parameter: ParameterId, value: f64, because: String) -> SensitivityError {
        let about = &self.family.parameters()[parameter.0];
        SensitivityError::Member { parameter: about.name.clone(), value, unit: about.unit.to_string(), because }
    }

    /// Whether a derivative is good enough, by itself or beside the eigenvalue over the parameter.
    fn accurate(&self, slot: usize, found: Estimate<Complex<f64>>, nominal: f64) -> bool {
        found.error <= ACCURATE * found.value.norm() || found.error * nominal <= 1e-3 * ACCURATE * self.spectrum.values[slot].norm()
    }

    /// Central differences over one step: of the eigenvalues, then of the signals.
    fn slopes(&self, parameter: ParameterId, value: f64, step: f64) -> Result<Vec<Complex<f64>>, SensitivityError> {
        let values = [value + step, value - step];
        let width = values[0] - values[1];
        let fault = |value: f64, because: String| self.fault(parameter, value, because);
        let member = |value: f64| self.family.with(&[(parameter, value)]).map_err(|e| fault(value, e.because));
        let mut members = [member(values[0])?, member(values[1])?];
        let mut residuals = [DVector::zeros(self.x.len()), DVector::zeros(self.x.len())];
        for (k, member) in members.iter_mut().enumerate() {
            let mut problem = TrimProblem::with_rows(member.steady.as_mut(), &self.trim, &self.rows)?;
            let evaluated = problem.residual(&self.x, residuals[k].as_mut_slice());
            evaluated.map_err(|e| fault(values[k], words(problem.plant(), e)))?;
        }
        let by_parameter = (&residuals[0] - &residuals[1]) / width;
        let singular = || SensitivityError::NotRegular { because: "its equations are singular".to_owned() };
        let tangent = -self.jacobian.solve(&by_parameter).ok_or_else(singular)?;
        let mut ends = Vec::with_capacity(2);
        for (k, member) in members.iter_mut().enumerate() {
            let x: Vec<f64> = self.x.iter().zip(tangent.iter()).map(|(x, t)| x + t * (values[k] - value)).collect();
            ends.push(self.end(member, &x, 0.0).map_err(|because| fault(values[k], because))?);
        }
        let mut slopes = self.eigenvalue_slopes(&ends[0], &ends[1], width);
        slopes.extend(ends[0].signals.iter().zip(&ends[1].signals).map(|(a, b)| Complex::new((a - b) / width, 0.0)));
        Ok(slopes)
    }

    /// Matrices and signals of a member at a point, cyclic coordinates shifted.
    fn end(&self, member: &mut Member, x: &[f64], shift: f64) -> Result<End, String> {
        let mut problem = TrimProblem::with_rows(member.steady.as_mut(), &self.trim, &self.rows).map_err(|e| e.to_string())?;
        let mut f = vec![0.0; x.len()];
        problem.residual(x, &mut f).map_err(|e| words(problem.plant(), e))?;
        let cyclic = |u: &Unknown| u.cyclic && u.kind == UnknownKind::Position;
        let shifted = problem.point().0.iter().zip(problem.plant().unknowns()).map(|(y, u)| if cyclic(u) { y + shift } else { *y });
        let shifted: Vec<f64> = shifted.collect();
        let (y, (_, yd, u, z)) = (&shifted[..], problem.point());
        let states: Vec<String> = self.model.states.iter().map(|s| s.signal.name.clone()).collect();
        let options =
            Options { independent: states.clone(), off_trim: OffTrim::Proceed, bound_inputs: BoundInputs::LeaveOut, ..Options::default() };
        let model = linear_model(member.linear.as_mut(), (y, yd, u), &options).map_err(|e| e.to_string())?;
        if !model.states.iter().map(|s| &s.signal.name).eq(&states) {
            return Err("the linear model has other states".to_owned());
        }
        let signals = y.iter().chain(u).chain(z).copied().collect();
        Ok(End { E: model.E, A: model.A, signals })
    }

    /// `wᴴ (ΔA − s ΔE) v / 2h` of every eigenvalue.
    fn eigenvalue_slopes(&self, up: &End, down: &End, width: f64) -> Vec<Complex<f64>> {
        let complex = |a: &DMatrix<f64>, b: &DMatrix<f64>| (a - b).map(|e| Complex::new(e / width, 0.0));
        let (A, E) = (complex(&up.A, &down.A) * &self.spectrum.right, complex(&up.E, &down.E) * &self.spectrum.right);
        let slope = |(k, s): (usize, &Complex<f64>)| {
            let w = self.spectrum.left.column(k);
            w.dotc(&A.column(k)) - w.dotc(&E.column(k)) * s
        };
        self.spectrum.values.iter().enumerate().map(slope).collect()
    }
}

/// One of the derivatives, from the differences of all levels.
fn estimate(slopes: &[Vec<Complex<f64>>], k: usize) -> Estimate<Complex<f64>> {
    extrapolate(&slopes.iter().map(|level| level[k]).collect::<Vec<_>>())
}

/// Value of an unknown, rate or input.
fn value(variable: Variable, at: At<'_>) -> f64 {
    match variable {
        Variable::Unknown(i) => at.y[i],
        Variable::Rate(i) => at.yd[i],
        Variable::Input(i) => at.u[i],
        Variable::Output(_) => f64::NAN,
    }
}

/// The equation that cannot be evaluated.
fn words(plant: &dyn Plant, error: EvalError) -> String {
    let (EvalError::Recoverable { equation } | EvalError::Fatal { equation }) = error;
    format!("the {} is not finite", plant.equations()[equation].name)
}

/// The linear model of a plant whose unknowns begin with those of a steady state.
fn linear_model(plant: &mut dyn Plant, (y, yd, u): (&[f64], &[f64], &[f64]), options: &Options) -> Result<LinearModel, LinearizeError> {
    let padded = |values: &[f64]| {
        let mut values = values.to_vec();
        values.resize(plant.unknowns().len(), 0.0);
        values
    };
    let (y, yd) = (padded(y), padded(yd));
    linearize(plant, At { time: 0.0, y: &y, yd: &yd, u }, options)
}

/// Newton's method from a known solution until rounding ends it; returns the factors of the last Jacobian.
fn polish(problem: &mut TrimProblem<'_>, x: &mut Vec<f64>) -> Result<Factors, SensitivityError> {
    let n = x.len();
    let not_regular = |because: &str| SensitivityError::NotRegular { because: because.to_owned() };
    let (mut f, mut J) = (vec![0.0; n], Matrix::zeros(n, n));
    let mut best: Option<(f64, Vec<f64>, Factors)> = None;
    for _ in 0..8 {
        problem.jacobian(x, &mut f, &mut J).map_err(|e| not_regular(&words(problem.plant(), e)))?;
        let off = f.iter().zip(problem.equation_scale()).map(|(f, s)| (f / s).abs()).fold(0.0, f64::max);
        let lu = DMatrix::from_column_slice(n, n, J.as_slice()).lu();
        let step = lu.solve(&DVector::from_column_slice(&f)).ok_or_else(|| not_regular("its equations are singular"))?;
        // rounding has the last word where a step does not halve the residual
        if best.as_ref().is_some_and(|(least, ..)| off > 0.5 * least) {
            break;
        }
        best = Some((off, x.clone(), lu));
        x.iter_mut().zip(step.iter()).for_each(|(x, step)| *x -= step);
    }
    let (off, solution, lu) = best.ok_or_else(|| not_regular("it has no equations"))?;
    if off > 1e-6 {
        return Err(not_regular(&format!("its equations are off by {off:.1e}")));
    }
    *x = solution;
    // values of this very point, not of the last trial
    problem.residual(x, &mut f).map_err(|e| not_regular(&words(problem.plant(), e)))?;
    Ok(lu)
}

/// Whether each eigenvalue has a neighborhood of its own, and as many vectors as it needs.
fn alone(spectrum: &Spectrum) -> Vec<bool> {
    let values = &spectrum.values;
    let apart = |k: usize| {
        let close = |j: &usize| (values[*j] - values[k]).norm() <= ALONE * values[*j].norm().max(values[k].norm());
        !(0..values.len()).filter(|&j| j != k).any(|j| close(&j))
    };
    (0..values.len()).map(|k| apart(k) && spectrum.sensitivity[k] < DEFECTIVE).collect()
}
