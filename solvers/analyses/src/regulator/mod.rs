//! Linear-quadratic regulators with preview of a path, and their margins.
//!
//! A linear model `E δẋ = A δx + B δu` of something that moves along a path of curvature κ with the speed V is extended by its offset e and its
//! heading error ψ against the path:
//!
//! ```text
//! ė = δv_y cos β + V δψ,    ψ̇ = δr − κ² V e − κ sin β δv_y,    V² = v_x² + v_y²,  tan β = v_y / v_x
//! ```
//!
//! The best feedback is `u = −K x − K_e e − K_ψ ψ`. Where the curvature ahead is κ + Δκ(s), known in advance, it disturbs `ψ̇` by `−V Δκ`, and the best
//! input has a part that looks ahead:
//!
//! ```text
//! u += ∫₀ᵀ F(τ) Δκ(s + Vτ) dτ,    F(τ) = V R⁻¹Bᵀ exp(A_cᵀτ) P d
//! ```
//!
//! with A_c of the closed loop, P of the Riccati equation and d the row of ψ. Offset and heading error are those against the path where it is now, so
//! nothing here is limited to small changes of direction: a U-turn is a history of curvature. The kernel oscillates with the modes of A_c, the curvature does
//! not: the integral is a weighted sum at equally spaced times, exact for every quadratic Δκ ([`Preview`]).
//!
//! Source: R. S. Sharp, Proc. IMechE C 221 (2007) 337–346 (preview in discrete time); B. D. O. Anderson, J. B. Moore, *Optimal Control: Linear
//! Quadratic Methods*, Prentice Hall 1990, chapters 3 and 4 (tracking in continuous time). Held by `solvers/analyses/tests/regulator.rs`.

mod cascade;
mod margins;
mod preview;
mod riccati;

pub use cascade::{Cascade, CascadeDesign, cascade};
pub use margins::{Crossing, Margins};
pub use preview::Preview;
pub use riccati::{Riccati, RiccatiError, riccati};

use crate::LinearModel;
use nalgebra::{Complex, DMatrix};
use thiserror::Error;

/// What moves along which path.
#[derive(Clone, Debug)]
pub struct Course {
    /// The unknown of the plant that is the speed across the heading, positive to the left: its index.
    pub lateral_speed: usize,
    /// The unknown of the plant that is the rate of the heading.
    pub yaw_rate: usize,
    /// Speeds along and across the heading at the point of the model, m/s.
    pub speed: (f64, f64),
    /// Curvature of the path there, positive to the left, 1/m.
    pub curvature: f64,
}

/// What a regulator should reach.
#[derive(Clone, Debug)]
pub struct Design {
    /// The input that it uses.
    pub input: String,
    /// An effort of the input that counts as much as one of the deviations below.
    pub effort: f64,
    /// Deviations of states that count as much.
    pub deviations: Vec<(String, f64)>,
    /// An offset (m) and a heading error (rad) that count as much.
    pub path: (f64, f64),
    /// States that are left out: something else holds them.
    pub held: Vec<String>,
    /// How long it looks ahead, s, and in how many intervals.
    pub preview: (f64, usize),
    /// What lies between the input of the regulator and that of the model.
    pub actuator: Actuator,
}

/// A dead time and a lag between what is wanted and what acts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Actuator {
    /// Dead time T, s, as `(s² − b s + a)/(s² + b s + a)`, a = 12/T², b = 6/T (Padé, second order); none: at once.
    pub delay: Option<f64>,
    /// Natural frequency, rad/s, and damping ratio of a lag of second order.
    pub lag: Option<(f64, f64)>,
}

impl Actuator {
    /// Number of its states: two of the dead time, then two of the lag.
    pub fn states(&self) -> usize {
        2 * usize::from(self.delay.is_some()) + 2 * usize::from(self.lag.is_some())
    }

    /// Puts it before `ẋ = A x + B u` with one input: its states follow those of the model.
    fn before(&self, A: DMatrix<f64>, B: DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
        let (n, m) = (A.nrows(), self.states());
        let (mut all, mut input) = (DMatrix::zeros(n + m, n + m), DMatrix::zeros(n + m, 1));
        all.view_mut((0, 0), (n, n)).copy_from(&A);
        // what acts on the next stage: a share of the input and a row over the states
        let (mut direct, mut row) = (1.0, DMatrix::zeros(1, n + m));
        let mut k = n;
        if let Some(delay) = self.delay {
            let (a, b) = (12.0 / (delay * delay), 6.0 / delay);
            (all[(k, k + 1)], all[(k + 1, k)], all[(k + 1, k + 1)], input[k + 1]) = (1.0, -a, -b, 1.0);
            row[k + 1] = -2.0 * b;
            k += 2;
        }
        if let Some((frequency, damping)) = self.lag {
            let stiffness = frequency * frequency;
            let mut rate = &row * stiffness;
            rate[k] -= stiffness;
            rate[k + 1] -= 2.0 * damping * frequency;
            all[(k, k + 1)] = 1.0;
            all.row_mut(k + 1).copy_from(&rate.row(0));
            input[k + 1] = direct * stiffness;
            (direct, row) = (0.0, DMatrix::zeros(1, n + m));
            row[k] = 1.0;
        }
        let driven = &B * &row;
        let above = all.rows(0, n) + driven;
        all.rows_mut(0, n).copy_from(&above);
        let own = input.rows(0, n) + B * direct;
        input.rows_mut(0, n).copy_from(&own);
        (all, input)
    }
}

/// A regulator for one linear model.
#[derive(Clone, Debug)]
pub struct Regulator {
    /// States that it feeds back.
    pub states: Vec<String>,
    /// Gains of the states, in units of the input per unit of the state.
    pub gains: Vec<f64>,
    /// Gains of offset and heading error.
    pub path_gains: [f64; 2],
    /// Gains of the states of the actuator.
    pub actuator_gains: Vec<f64>,
    /// How it looks ahead.
    pub preview: Preview,
    /// Eigenvalues of the closed loop, states and path, 1/s.
    pub closed: Vec<Complex<f64>>,
    /// Margins of the loop, cut at the input.
    pub margins: Margins,
}

/// Why there is no regulator.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RegulatorError {
    /// A name that the model does not have.
    #[error("the linear model has no {what} `{name}`")]
    Unknown {
        /// State or input.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// The states have no inertia.
    #[error("no inertia: some states have no rate of their own")]
    Singular,
    /// A feedback of few states that does not do.
    #[error("a feedback of {} damps it too little", fed_back.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", "))]
    Unstable {
        /// What is fed back.
        fed_back: Vec<String>,
    },
    /// No stabilizing solution.
    #[error(transparent)]
    Riccati(#[from] RiccatiError),
}

/// Designs a regulator that follows a path.
///
/// # Errors
/// Unknown names, a model without inertia, or no stabilizing feedback.
///
/// # Cost
/// One Riccati equation; some 10⁶ operations per 20 states.
pub fn follow(model: &LinearModel, course: &Course, design: &Design) -> Result<Regulator, RegulatorError> {
    let (A, B, kept) = extended(model, course, design)?;
    let (n, m) = (kept.len(), design.actuator.states());
    let (A, B) = design.actuator.before(A, B);
    let mut Q = DMatrix::zeros(n + 2 + m, n + 2 + m);
    for (name, deviation) in &design.deviations {
        let k = kept.iter().position(|&k| model.states[k].signal.name == *name);
        let k = k.ok_or_else(|| RegulatorError::Unknown { what: "state", name: name.clone() })?;
        Q[(k, k)] = deviation.powi(-2);
    }
    (Q[(n, n)], Q[(n + 1, n + 1)]) = (design.path.0.powi(-2), design.path.1.powi(-2));
    let R = DMatrix::from_element(1, 1, design.effort.powi(-2));
    let nominal: Vec<f64> =
        kept.iter().map(|&k| model.states[k].nominal).chain([design.path.0, design.path.1]).chain(actuated(design)).collect();
    let solved = riccati((&A, &B), (&Q, &R), &nominal)?;
    let speed = course.speed.0.hypot(course.speed.1);
    let bent = solved.P.column(n + 1) * speed;
    let preview = Preview::of((&solved.closed, &(B.transpose() / R[(0, 0)])), &bent, design.preview);
    Ok(Regulator {
        states: kept.iter().map(|&k| model.states[k].signal.name.to_string()).collect(),
        gains: solved.K.iter().take(n).copied().collect(),
        path_gains: [solved.K[n], solved.K[n + 1]],
        actuator_gains: solved.K.iter().skip(n + 2).copied().collect(),
        preview,
        closed: solved.closed.complex_eigenvalues().iter().copied().collect(),
        margins: Margins::of(&A, &B, &solved.K),
    })
}

/// Typical magnitudes of the states of the actuator.
fn actuated(design: &Design) -> Vec<f64> {
    let delay = design.actuator.delay.map(|t| [design.effort * t * t / 12.0, design.effort * t]);
    let lag = design.actuator.lag.map(|(frequency, _)| [design.effort, design.effort * frequency]);
    delay.into_iter().chain(lag).flatten().collect()
}

/// `ẋ = A x + B u`, and the indices of the kept states.
type Extended = (DMatrix<f64>, DMatrix<f64>, Vec<usize>);

/// The kept states, then offset and heading error.
fn extended(model: &LinearModel, course: &Course, design: &Design) -> Result<Extended, RegulatorError> {
    let unknown = |what, name: &str| RegulatorError::Unknown { what, name: name.to_owned() };
    let input = model.input(&design.input).ok_or_else(|| unknown("input", &design.input))?;
    if let Some(name) = design.held.iter().find(|h| model.state(h).is_none()) {
        return Err(unknown("state", name));
    }
    let kept: Vec<usize> = (0..model.states.len()).filter(|&k| !design.held.iter().any(|h| *h == *model.states[k].signal.name)).collect();
    // a wheel that does not slip leaves the vehicle no lateral speed of its own: it follows from the states
    let by_kept = |unknown: usize, k: usize| model.unknowns[(unknown, kept[k])];
    // what holds a state also supplies the effort of its row: row and column go
    let part = |m: &DMatrix<f64>| DMatrix::from_fn(kept.len(), kept.len(), |i, j| m[(kept[i], kept[j])]);
    let lu = part(&model.E).lu();
    let solve = |m: &DMatrix<f64>| lu.solve(m).ok_or(RegulatorError::Singular);
    let own = solve(&part(&model.A))?;
    let by_input = solve(&DMatrix::from_fn(kept.len(), 1, |i, _| model.B[(kept[i], input)]))?;
    let n = kept.len();
    let (mut A, mut B) = (DMatrix::zeros(n + 2, n + 2), DMatrix::zeros(n + 2, 1));
    A.view_mut((0, 0), (n, n)).copy_from(&own);
    B.rows_mut(0, n).copy_from(&by_input);
    let (forward, lateral) = course.speed;
    let speed = forward.hypot(lateral);
    let (sine, cosine) = (lateral / speed, forward / speed);
    for k in 0..n {
        let (v, r) = (by_kept(course.lateral_speed, k), by_kept(course.yaw_rate, k));
        (A[(n, k)], A[(n + 1, k)]) = (cosine * v, r - course.curvature * sine * v);
    }
    (A[(n, n + 1)], A[(n + 1, n)]) = (speed, -course.curvature.powi(2) * speed);
    Ok((A, B, kept))
}
