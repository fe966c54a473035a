//! Frequency responses of a linear model: what a signal answers to an input that oscillates.
//!
//! ```text
//! H(jω) = C (jωE − A)⁻¹ B(jω) + D(jω)        B(jω) = B_u + jω B_u̇,   D(jω) = D_u + jω D_u̇                  (1)
//! H     = Σ_k H_k exp(−jω τ_k)                one cause that reaches several inputs, each after a delay τ_k    (2)
//! ```
//!
//! | symbol | unit | |
//! |---|---|---|
//! | E, A, B, C, D | SI | the linear model; columns u̇ are those of the rate that an input names ([`problem::Input::rate`]) |
//! | ω | rad/s | angular frequency |
//! | H | output / input | output over input, both as amplitudes of `exp(jωt)` |
//!
//! With `x = T Q ξ` (T: nominal values and balancing, Q orthogonal) `(jω − M) ξ = Qᵀ T⁻¹ E⁻¹ B` has an upper Hessenberg matrix
//! `M = Qᵀ T⁻¹ E⁻¹ A T Q`. It is made once; every frequency then costs O(n²) and needs no eigenvectors, so that nearly defective modes do no harm.
//!
//! A response is a forced motion. Where the steady state is unstable, it is the motion that whoever stabilizes it has to sustain, not one
//! to which the system settles by itself. At the frequency of an undamped mode it is not finite.
//!
//! Source: A. J. Laub, IEEE Trans. Autom. Control 26 (1981) 407–408; theory manual 9.1.

use crate::LinearModel;
use crate::eigen::{balance, similar};
use crate::hessenberg::Hessenberg;
use crate::variable::rate_unit;
use nalgebra::{Complex, DMatrix};
use problem::Signal;
use thiserror::Error;

/// What oscillates: an input, or one cause that reaches several inputs after delays.
#[derive(Clone, Debug, PartialEq)]
pub struct Excitation {
    /// Name in the results.
    pub name: String,
    /// Names of the inputs, each with its delay, s.
    pub reaches: Vec<(String, f64)>,
}

impl Excitation {
    /// One input by itself.
    pub fn input(name: impl Into<String>) -> Self {
        let name = name.into();
        Self { reaches: vec![(name.clone(), 0.0)], name }
    }

    /// One cause that reaches several inputs, each after a delay (s).
    pub fn delayed(name: impl Into<String>, reaches: impl IntoIterator<Item = (String, f64)>) -> Self {
        Self { name: name.into(), reaches: reaches.into_iter().collect() }
    }
}

/// Why a frequency response cannot be had.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum FrequencyResponseError {
    /// A name that is no input.
    #[error("there is no input `{name}`")]
    UnknownInput {
        /// The name.
        name: String,
    },
    /// A name that is neither an unknown nor an output.
    #[error("there is no unknown or output `{name}`")]
    UnknownOutput {
        /// The name.
        name: String,
    },
    /// The linear model does without this signal.
    #[error("the linear model does without `{signal}`: {because}")]
    LeftOut {
        /// The signal.
        signal: String,
        /// Why, in signal names.
        because: String,
    },
    /// E is singular.
    #[error("no inertia: some states have no rate of their own")]
    Singular,
    /// An entry is not finite.
    #[error("the matrices have entries that are not finite")]
    NotFinite,
}

/// One input of an excitation.
#[derive(Clone, Copy, Debug)]
struct Part {
    /// Column of `b`, `b_rate`, `d`, `d_rate`.
    column: usize,
    /// s.
    delay: f64,
    /// The rate of an input is asked for: the amplitude of the input is that of the rate over jω.
    integrated: bool,
}

/// A row of C and D.
#[derive(Clone, Copy, Debug)]
struct Watched {
    /// Row of `c`, `d`, `d_rate`.
    row: usize,
    /// `rate(signal)`: jω times the signal.
    rate: bool,
}

/// Responses of some signals to some excitations, ready to be evaluated at any frequency.
#[derive(Clone, Debug)]
pub struct FrequencyResponse {
    /// The excitations as signals.
    pub inputs: Vec<Signal>,
    /// The signals that answer.
    pub outputs: Vec<Signal>,
    excitations: Vec<Vec<Part>>,
    watched: Vec<Watched>,
    /// States by columns of inputs, and by the columns of their rates.
    b: [DMatrix<f64>; 2],
    /// One contiguous row of the states for every watched signal.
    c: Vec<f64>,
    /// Watched signals by columns of inputs, and of their rates.
    d: [DMatrix<f64>; 2],
    work: Hessenberg,
}

impl FrequencyResponse {
    /// Responses of `outputs` to `excitations`.
    ///
    /// # Arguments
    /// `outputs`: names of outputs and unknowns of the plant, cyclic coordinates included; `rate(name)` is the rate of any of them. An input that names
    /// its rate input oscillates together with it; asked for by the name of that rate, the response is referred to the rate.
    ///
    /// # Errors
    /// Unknown names, signals that the model does without, singular E.
    ///
    /// # Cost
    /// O(n³), once.
    pub fn of(model: &LinearModel, excitations: &[Excitation], outputs: &[String]) -> Result<Self, FrequencyResponseError> {
        let mut columns = Vec::new();
        let parts = |excitation: &Excitation, columns: &mut Vec<usize>| -> Result<Vec<Part>, FrequencyResponseError> {
            let part = |(name, delay): &(String, f64)| {
                let named = find_input(model, name)?;
                let owner = model.inputs.iter().position(|i| i.rate == Some(named));
                columns.push(owner.unwrap_or(named));
                Ok(Part { column: columns.len() - 1, delay: *delay, integrated: owner.is_some() })
            };
            excitation.reaches.iter().map(part).collect()
        };
        let excited = excitations.iter().map(|e| parts(e, &mut columns)).collect::<Result<Vec<_>, _>>()?;
        let rows = outputs.iter().map(|name| Row::find(model, name)).collect::<Result<Vec<_>, _>>()?;
        let whole = Whole::of(model, rows.iter().any(|r| matches!(r.place, Place::Cyclic(_))));

        let reduced = whole.reduced()?;
        let of_rates = |m: &DMatrix<f64>| {
            let column =
                |&k: &usize| model.inputs[k].rate.map_or_else(|| DMatrix::zeros(m.nrows(), 1), |rate| m.columns(rate, 1).into_owned());
            let columns: Vec<DMatrix<f64>> = columns.iter().map(column).collect();
            DMatrix::from_fn(m.nrows(), columns.len(), |i, k| columns[k][i])
        };
        let C = rows.iter().map(|r| whole.watch(model, r.place).0 * &reduced.out_of);
        let D = DMatrix::from_fn(rows.len(), model.inputs.len(), |i, k| whole.watch(model, rows[i].place).1[k]);
        Ok(Self {
            inputs: excitations.iter().map(|e| signal_of(model, e)).collect(),
            outputs: rows.iter().map(|r| r.signal(model)).collect(),
            excitations: excited,
            watched: rows.iter().enumerate().map(|(row, r)| Watched { row, rate: r.rate }).collect(),
            b: [reduced.B.select_columns(&columns), of_rates(&reduced.B)],
            c: C.flat_map(|row| row.iter().copied().collect::<Vec<f64>>()).collect(),
            d: [D.select_columns(&columns), of_rates(&D)],
            work: Hessenberg::new(&reduced.M, excitations.len()),
        })
    }

    /// Responses at one angular frequency (rad/s), all outputs of the first excitation first.
    ///
    /// # Cost
    /// O(n²) for the matrix and for every excitation; allocates nothing.
    ///
    /// # Panics
    /// `responses` has another length than excitations times outputs.
    pub fn at(&mut self, omega: f64, responses: &mut [Complex<f64>]) {
        assert_eq!(responses.len(), self.inputs.len() * self.outputs.len(), "one place for every response");
        self.load(omega);
        self.work.solve(omega);
        let (n, m) = (self.work.states(), self.excitations.len());
        let s = Complex::new(0.0, omega);
        for (k, parts) in self.excitations.iter().enumerate() {
            for (i, watched) in self.watched.iter().enumerate() {
                let row = &self.c[watched.row * n..(watched.row + 1) * n];
                let part = |half: &[f64]| row.iter().zip(half[k..].iter().step_by(m.max(1))).map(|(c, x)| c * x).sum::<f64>();
                let mut response = Complex::new(part(&self.work.right[0]), part(&self.work.right[1]));
                for p in parts {
                    let [d, by_rate] = [0, 1].map(|r| self.d[r][(watched.row, p.column)]);
                    response += (d + s * by_rate) * p.amplitude(omega);
                }
                responses[k * self.outputs.len() + i] = if watched.rate { s * response } else { response };
            }
        }
    }

    /// The right-hand sides.
    fn load(&mut self, omega: f64) {
        let (n, m) = (self.work.states(), self.excitations.len());
        for (k, parts) in self.excitations.iter().enumerate() {
            for i in 0..n {
                (self.work.right[0][i * m + k], self.work.right[1][i * m + k]) = (0.0, 0.0);
            }
            for part in parts {
                let amplitude = part.amplitude(omega);
                let [b, by_rate] = [0, 1].map(|r| self.b[r].column(part.column));
                for i in 0..n {
                    let entry = amplitude * Complex::new(b[i], omega * by_rate[i]);
                    self.work.right[0][i * m + k] += entry.re;
                    self.work.right[1][i * m + k] += entry.im;
                }
            }
        }
    }
}

impl Part {
    /// Amplitude of the input where the excitation has amplitude 1.
    fn amplitude(&self, omega: f64) -> Complex<f64> {
        let late = if self.delay == 0.0 { Complex::new(1.0, 0.0) } else { Complex::from_polar(1.0, -omega * self.delay) };
        if self.integrated { late / Complex::new(0.0, omega) } else { late }
    }
}

fn find_input(model: &LinearModel, name: &str) -> Result<usize, FrequencyResponseError> {
    let unknown = || left_out(model, name).unwrap_or_else(|| FrequencyResponseError::UnknownInput { name: name.to_owned() });
    model.input(name).ok_or_else(unknown)
}

fn left_out(model: &LinearModel, name: &str) -> Option<FrequencyResponseError> {
    let left_out = model.left_out.iter().find(|l| l.signal == name)?;
    Some(FrequencyResponseError::LeftOut { signal: name.to_owned(), because: left_out.because.clone() })
}

/// The excitation as a signal: that of its input, or the name of the cause with the unit of the first input.
fn signal_of(model: &LinearModel, excitation: &Excitation) -> Signal {
    let first = excitation.reaches.first().and_then(|(name, _)| model.input(name)).map(|k| &model.inputs[k].signal);
    match (first, excitation.reaches.as_slice()) {
        (Some(signal), [(name, _)]) if *name == excitation.name => signal.clone(),
        (Some(signal), _) => {
            let reached = excitation.reaches.iter().map(|(name, delay)| format!("`{name}` after {delay:.4} s"));
            let about = format!("reaches {}", reached.collect::<Vec<_>>().join(" and "));
            Signal::new(excitation.name.clone(), signal.unit.clone(), about)
        }
        (None, _) => Signal::new(excitation.name.clone(), "-", "reaches nothing"),
    }
}

/// Where a watched signal stands in the linear model.
#[derive(Clone, Copy, Debug)]
enum Place {
    Output(usize),
    Unknown(usize),
    /// Index among the cyclic coordinates.
    Cyclic(usize),
}

#[derive(Clone, Copy, Debug)]
struct Row {
    place: Place,
    rate: bool,
}

impl Row {
    fn find(model: &LinearModel, name: &str) -> Result<Self, FrequencyResponseError> {
        let inner = name.strip_prefix("rate(").and_then(|rest| rest.strip_suffix(')'));
        let (name, rate) = (inner.unwrap_or(name).trim(), inner.is_some());
        let unknown = model.unknown_signals.iter().position(|s| s.name == name);
        let place = match (model.output(name), unknown) {
            (Some(output), _) => Place::Output(output),
            (None, Some(unknown)) => match model.cyclic.unknowns.iter().position(|&c| c == unknown) {
                Some(cyclic) => Place::Cyclic(cyclic),
                None => Place::Unknown(unknown),
            },
            (None, None) => {
                return Err(left_out(model, name).unwrap_or_else(|| FrequencyResponseError::UnknownOutput { name: name.to_owned() }));
            }
        };
        Ok(Self { place, rate })
    }

    fn signal(&self, model: &LinearModel) -> Signal {
        let signal = match self.place {
            Place::Output(k) => &model.outputs[k],
            Place::Unknown(k) => &model.unknown_signals[k],
            Place::Cyclic(k) => &model.unknown_signals[model.cyclic.unknowns[k]],
        };
        match self.rate {
            true => Signal::new(format!("rate({})", signal.name), rate_unit(&signal.unit), format!("rate of: {}", signal.about)),
            false => signal.clone(),
        }
    }
}

/// The linear model, with the cyclic coordinates as further states where they are watched: `δċ = K_c δc + K_x δx`.
struct Whole {
    E: DMatrix<f64>,
    A: DMatrix<f64>,
    B: DMatrix<f64>,
    nominal: Vec<f64>,
}

/// `ξ̇ = M ξ + B u` with an upper Hessenberg matrix, `x = out_of ξ`.
struct Reduced {
    M: DMatrix<f64>,
    B: DMatrix<f64>,
    out_of: DMatrix<f64>,
}

impl Whole {
    fn of(model: &LinearModel, with_cyclic: bool) -> Self {
        let n = model.states.len();
        let all = if with_cyclic { n + model.cyclic.unknowns.len() } else { n };
        let block = |m: &DMatrix<f64>, corner: f64| {
            let mut whole = DMatrix::from_diagonal_element(all, all, corner);
            whole.view_mut((0, 0), (n, n)).copy_from(m);
            whole
        };
        let (E, mut A, mut B) = (block(&model.E, 1.0), block(&model.A, 0.0), DMatrix::zeros(all, model.inputs.len()));
        if with_cyclic {
            A.view_mut((n, 0), (all - n, n)).copy_from(&model.cyclic.by_states);
            A.view_mut((n, n), (all - n, all - n)).copy_from(&model.cyclic.by_cyclic);
        }
        B.view_mut((0, 0), (n, model.inputs.len())).copy_from(&model.B);
        let nominal = model.states.iter().map(|s| s.nominal).chain((n..all).map(|_| 1.0)).collect();
        Self { E, A, B, nominal }
    }

    /// Row of C and of D.
    fn watch(&self, model: &LinearModel, place: Place) -> (nalgebra::RowDVector<f64>, nalgebra::RowDVector<f64>) {
        let mut C = nalgebra::RowDVector::zeros(self.A.nrows());
        let mut D = nalgebra::RowDVector::zeros(model.inputs.len());
        let n = model.states.len();
        match place {
            Place::Output(k) => {
                C.columns_mut(0, n).copy_from(&model.C.row(k));
                D.copy_from(&model.D.row(k));
            }
            Place::Unknown(k) => {
                C.columns_mut(0, n).copy_from(&model.unknowns.row(k));
                D.copy_from(&model.unknowns_by_inputs.row(k));
            }
            Place::Cyclic(k) => C[n + k] = 1.0,
        }
        (C, D)
    }

    fn reduced(&self) -> Result<Reduced, FrequencyResponseError> {
        let n = self.A.nrows();
        if self.E.iter().chain(self.A.iter()).chain(self.B.iter()).any(|e| !e.is_finite()) {
            return Err(FrequencyResponseError::NotFinite);
        }
        let lu = self.E.clone().lu();
        let solve = |right: &DMatrix<f64>| lu.solve(right).ok_or(FrequencyResponseError::Singular);
        let (mut M, mut B) = (solve(&self.A)?, solve(&self.B)?);
        let mut T = self.nominal.clone();
        similar(&mut M, &T);
        for (t, b) in T.iter_mut().zip(balance(&mut M)) {
            *t *= b;
        }
        for (mut row, t) in B.row_iter_mut().zip(&T) {
            row /= *t;
        }
        if n < 2 {
            return Ok(Reduced { M, B, out_of: DMatrix::from_diagonal(&T.into()) });
        }
        let (Q, M) = M.hessenberg().unpack();
        let out_of = DMatrix::from_fn(n, n, |i, k| T[i] * Q[(i, k)]);
        Ok(Reduced { M, B: Q.tr_mul(&B), out_of })
    }
}
