//! Linear models: small motions about a trim, with named states, inputs and outputs.
//!
//! `E δẋ = A δx + B δu`, `δz = C δx + D δu`.
//!
//! A plant `0 = F(y, ẏ, u)` is differentiated exactly at one point. What is left of y after the cyclic coordinates are dropped are
//! differential unknowns x and algebraic ones, a (element states without rate) and m (multipliers):
//!
//! ```text
//! F_ẋ δẋ + F_x δx + F_a δa + F_m δm + F_u δu = 0        rows of motion and of elements        (1)
//!            G δx                            = 0        rows of constraints                   (2)
//! ```
//!
//! 1. The element rows of the algebraic states determine δa (index 1): Schur complement of their block.
//! 2. Constraints are expected in the formulation of Gear, Gupta and Leimkuhler (index 2): `q̇ = N(q)(v + Jᵀμ)`, forces `Jᵀλ`, rows
//!    `Φ(q) = 0` and `J v = 0` (rolling included), as many as multipliers. Column-pivoted elimination of G chooses the dependent unknowns
//!    D; the others, I, are the states and keep their names. `δx = S δξ` with `S_I = 1`, `S_D = −G_D⁻¹ G_I` spans the kernel of G.
//! 3. The rows of motion that belong to D determine δm: Schur complement again. What stays are the rows `Wᵀ F` with `Wᵀ F_m = 0` and `W_I = 1`:
//!    for forces `Jᵀλ` W and S are the same on the velocities, and `E = Wᵀ F_ẋ S` holds the reduced mass matrix `Sᵀ M S`.
//! 4. `δẋ = S δξ̇ + Ṡ δξ`: G moves with the point where velocities change (braking). G is linear in v, so the entries of `Ġ` by the coordinates
//!    are those of G at the velocities v̇ instead of v, and `Ṡ_D = −G_D⁻¹ Ġ S`. In steady motion `Ṡ = 0`.
//!
//! Coordinates that no velocity moves, the norms of quaternions, are left out before (`normalized.rs`). Without constraints S and W are the identity. A point with accelerations is frozen: E and A are those of the instant. Their eigenvalues
//! belong to the velocities chosen by the plant and change with them, since the point is no equilibrium.
//!
//! Source: E. Hairer, G. Wanner, *Solving Ordinary Differential Equations II*, 2nd ed., Springer 1996, VII.1–VII.2 (Hessenberg forms,
//! GGL); R. A. Wehage, E. J. Haug, J. Mech. Design 104 (1982) 247–255 (coordinate partition); theory manual 6.5, 8.1, 8.5.

mod independent;
mod layout;
mod normalized;
mod tableau;

use independent::Split;
use layout::Layout;
use nalgebra::DMatrix;
use normalized::Following;
use problem::{At, EvalError, Input, Plant, Signal, UnknownKind};
use tableau::Tableau;
use thiserror::Error;

/// What entries below this, in units of their scales, are: rounding.
const ROUNDING: f64 = 1e-9;

/// How to linearize.
#[derive(Clone, Debug)]
pub struct Options {
    /// Largest scaled residual of a point that counts as a trim.
    pub residual_tolerance: f64,
    /// What to do with other points.
    pub off_trim: OffTrim,
    /// Unknowns that should be states where constraints leave a choice.
    pub independent: Vec<String>,
    /// What to do with inputs that move a constraint.
    pub bound_inputs: BoundInputs,
}

impl Default for Options {
    fn default() -> Self {
        Self { residual_tolerance: 1e-6, off_trim: OffTrim::Refuse, independent: Vec::new(), bound_inputs: BoundInputs::Refuse }
    }
}

/// What to do with a point where the equations do not hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OffTrim {
    /// An error that names the worst equation.
    Refuse,
    /// Linearize all the same.
    Proceed,
}

/// What to do with an input that moves a constraint (its second rate would have to be an input too).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoundInputs {
    /// An error that names input and constraint.
    Refuse,
    /// The model does without it, and says so.
    LeaveOut,
}

/// One state of a linear model.
#[derive(Clone, Debug)]
pub struct State {
    /// Name, unit, meaning.
    pub signal: Signal,
    /// Coordinate, velocity or element state.
    pub kind: UnknownKind,
    /// For a velocity: it is the rate of a cyclic coordinate.
    pub cyclic: bool,
    /// Typical magnitude.
    pub nominal: f64,
    /// Index among the unknowns of the plant.
    pub unknown: usize,
    /// For a coordinate: index of the state that is its rate; for a velocity: of the coordinate whose rate it is.
    pub partner: Option<usize>,
}

/// What a linear model does without.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// The input or output.
    pub signal: String,
    /// Why, in signal names.
    pub because: String,
}

/// How the cyclic coordinates follow: `δċ = K_c δc + K_x δx`, in axes fixed at the heading of the point.
#[derive(Clone, Debug)]
pub struct Cyclic {
    /// Indices among the unknowns of the plant.
    pub unknowns: Vec<usize>,
    /// `K_c`: a heading turns the direction of travel.
    pub by_cyclic: DMatrix<f64>,
    /// `K_x`.
    pub by_states: DMatrix<f64>,
}

/// `E δẋ = A δx + B δu`, `δz = C δx + D δu`; δẋ has been eliminated from the outputs.
///
/// An input whose rate is another input ([`Input::rate`]) and that rate are two columns of B and D: a frequency response uses
/// `B + jω B_rate`.
#[derive(Clone, Debug)]
pub struct LinearModel {
    /// States, in the order of the plant's unknowns.
    pub states: Vec<State>,
    /// Inputs; rates are indices among these.
    pub inputs: Vec<Input>,
    /// Outputs.
    pub outputs: Vec<Signal>,
    /// Left-hand side: one row per state, regular.
    pub E: DMatrix<f64>,
    /// Right-hand side.
    pub A: DMatrix<f64>,
    /// Rows by inputs.
    pub B: DMatrix<f64>,
    /// Outputs by states.
    pub C: DMatrix<f64>,
    /// Outputs by inputs.
    pub D: DMatrix<f64>,
    /// All unknowns of the plant by states, multipliers and dependent coordinates included; rows of cyclic coordinates are zero.
    pub unknowns: DMatrix<f64>,
    /// All unknowns of the plant by inputs: what inputs do to algebraic states and multipliers at once; other rows are zero.
    pub unknowns_by_inputs: DMatrix<f64>,
    /// Name, unit and meaning of all unknowns of the plant.
    pub unknown_signals: Vec<Signal>,
    /// The cyclic coordinates.
    pub cyclic: Cyclic,
    /// Inputs and outputs that the model does without.
    pub left_out: Vec<LeftOut>,
}

impl LinearModel {
    /// Index of a state.
    pub fn state(&self, name: &str) -> Option<usize> {
        self.states.iter().position(|s| s.signal.name == name)
    }

    /// Index of an input.
    pub fn input(&self, name: &str) -> Option<usize> {
        self.inputs.iter().position(|i| i.signal.name == name)
    }

    /// Index of an output.
    pub fn output(&self, name: &str) -> Option<usize> {
        self.outputs.iter().position(|s| s.name == name)
    }
}

/// Why a point cannot be linearized.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum LinearizeError {
    /// The plant cannot be evaluated there.
    #[error("the {equation} is not finite at this point")]
    NotFinite {
        /// The equation.
        equation: String,
    },
    /// The point is no trim.
    #[error("this point is no steady state: the {equation} is off by {off:.6e} {unit}")]
    OffTrim {
        /// The equation that is violated most.
        equation: String,
        /// By how much.
        off: f64,
        /// Its unit.
        unit: String,
    },
    /// An equation depends on a coordinate that is declared cyclic.
    #[error("`{signal}` is declared cyclic, but the {equation} depends on it")]
    NotCyclic {
        /// The coordinate.
        signal: String,
        /// The equation.
        equation: String,
    },
    /// Algebraic states that their element rows do not determine.
    #[error("no row of an element determines {}", together.join(", "))]
    Algebraic {
        /// The states, those with the largest share first.
        together: Vec<String>,
    },
    /// The constraints are not in the expected formulation.
    #[error("constraints are expected on coordinates and velocities, with as many multipliers: {because}")]
    Formulation {
        /// What was found.
        because: String,
    },
    /// Constraints that depend on each other.
    #[error("the {equation} adds nothing to the other constraints here")]
    Redundant {
        /// The constraint that is left over.
        equation: String,
    },
    /// Constraints that their forces cannot hold.
    #[error("no force of a constraint holds {}", together.join(", "))]
    Unheld {
        /// The multipliers, those with the largest share first.
        together: Vec<String>,
    },
    /// An input moves a constraint.
    #[error("the input `{input}` moves the {equation}: its second rate would have to be an input too")]
    BoundInput {
        /// The input.
        input: String,
        /// The constraint.
        equation: String,
    },
    /// States whose rates no equation determines.
    #[error("no inertia: no equation determines the rate of {}", together.join(", "))]
    NoInertia {
        /// The states, those with the largest share first.
        together: Vec<String>,
    },
    /// A preferred state that is none.
    #[error("`{name}` is no coordinate, velocity or state of this model")]
    UnknownState {
        /// The name.
        name: String,
    },
}

/// Linearizes a plant at a trim.
///
/// # Arguments
/// `at`: unknowns, rates and inputs of the trim. The rates of cyclic coordinates are ignored.
///
/// # Errors
/// The point is no trim, or the equations do not have the structure that the header of this module describes; in signal names.
///
/// # Cost
/// One call of `along` with a direction for every unknown, rate and input; dense elimination, O(n³).
pub fn linearize(plant: &mut dyn Plant, at: At<'_>, options: &Options) -> Result<LinearModel, LinearizeError> {
    let mut layout = Layout::of(plant)?;
    if let Some(name) =
        options.independent.iter().find(|name| !layout.differential.iter().any(|&i| plant.unknowns()[i].signal.name == **name))
    {
        return Err(LinearizeError::UnknownState { name: name.clone() });
    }
    let (mut tableau, residual) = Tableau::at(plant, at, &layout).map_err(|e| not_finite(plant, e))?;
    if options.off_trim == OffTrim::Refuse {
        check_trim(plant, &layout, &residual, options.residual_tolerance)?;
    }
    let following = normalized::leave_out(plant, &mut layout, &mut tableau);
    tableau.check_cyclic(plant, &layout)?;
    tableau.check_constraints(plant, &layout)?;
    let left_out_inputs = tableau.bound_inputs(plant, &layout);
    if let (BoundInputs::Refuse, Some((input, equation))) = (options.bound_inputs, left_out_inputs.first()) {
        return Err(LinearizeError::BoundInput {
            input: name_of_input(plant, *input),
            equation: plant.equations()[*equation].name.clone(),
        });
    }
    let algebraic = tableau.algebraic.clone();
    tableau
        .eliminate(&layout.algebraic_rows, algebraic)
        .map_err(|shares| LinearizeError::Algebraic { together: named(plant, &layout.algebraic, &shares) })?;
    let pairs = tableau.pairs(&layout, plant);
    let split = Split::choose(plant, at, &layout, &tableau, &pairs, &options.independent)?;
    let holding: Vec<usize> = split.dependent.iter().map(|&k| layout.rows[k]).collect();
    let multipliers = tableau.multipliers.clone();
    tableau
        .eliminate(&holding, multipliers)
        .map_err(|shares| LinearizeError::Unheld { together: named(plant, &layout.multipliers, &shares) })?;
    let states = states(plant, &layout, &split, &pairs);
    let mut model = assemble(plant, &layout, &tableau, &split, states, &left_out_inputs)?;
    for Following { unknown, shares } in following {
        let row = shares.iter().map(|&(k, share)| share * split.S.row(k)).fold(split.S.row(0) * 0.0, |sum, row| sum + row);
        model.unknowns.row_mut(unknown).copy_from(&row);
    }
    Ok(model)
}

/// Some of these unknowns, in back-ticks.
fn named(plant: &dyn Plant, unknowns: &[usize], which: &[usize]) -> Vec<String> {
    which.iter().map(|&k| format!("`{}`", plant.unknowns()[unknowns[k]].signal.name)).collect()
}

fn name_of_input(plant: &dyn Plant, input: usize) -> String {
    plant.inputs()[input].signal.name.clone()
}

fn not_finite(plant: &dyn Plant, error: EvalError) -> LinearizeError {
    let (EvalError::Recoverable { equation } | EvalError::Fatal { equation }) = error;
    let equation = plant.equations().get(equation).map_or_else(|| "residual".to_owned(), |e| e.name.clone());
    LinearizeError::NotFinite { equation }
}

/// All rows but those of the cyclic coordinates, which grow by themselves, must hold.
fn check_trim(plant: &dyn Plant, layout: &Layout, residual: &[f64], tolerance: f64) -> Result<(), LinearizeError> {
    let rows = (0..residual.len()).filter(|i| !layout.cyclic_rows.contains(i));
    let scaled = rows.map(|i| (i, (residual[i] / plant.equations()[i].nominal).abs()));
    match scaled.max_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((worst, off)) if off > tolerance => {
            let equation = &plant.equations()[worst];
            Err(LinearizeError::OffTrim { equation: equation.name.clone(), off: residual[worst], unit: equation.unit.to_string() })
        }
        _ => Ok(()),
    }
}

/// The independent unknowns with their partners.
fn states(plant: &dyn Plant, layout: &Layout, split: &Split, pairs: &[Option<usize>]) -> Vec<State> {
    let place = |k: usize| split.independent.iter().position(|&i| i == k);
    let partner = |k: usize| match pairs[k] {
        Some(rate) => place(rate),
        None => pairs.iter().position(|p| *p == Some(k)).and_then(place),
    };
    let state = |&k: &usize| {
        let unknown = &plant.unknowns()[layout.differential[k]];
        State {
            signal: unknown.signal.clone(),
            kind: unknown.kind,
            cyclic: unknown.cyclic,
            nominal: unknown.nominal,
            unknown: layout.differential[k],
            partner: partner(k),
        }
    };
    split.independent.iter().map(state).collect()
}

/// Substitutes δx = S δξ, δẋ = S δξ̇ + Ṡ δξ and eliminates δξ̇ from everything that is watched.
fn assemble(
    plant: &dyn Plant,
    layout: &Layout,
    tableau: &Tableau,
    split: &Split,
    states: Vec<State>,
    bound: &[(usize, usize)],
) -> Result<LinearModel, LinearizeError> {
    let rows: Vec<usize> = split.independent.iter().map(|&k| layout.rows[k]).collect();
    // an input whose rate is missing would be half an input
    let is_bound = |i: usize| bound.iter().find(|(input, _)| *input == i || plant.inputs()[i].rate == Some(*input));
    let kept_inputs: Vec<usize> = (0..plant.inputs().len()).filter(|&i| is_bound(i).is_none()).collect();
    let columns: Vec<usize> = kept_inputs.iter().map(|i| tableau.inputs.start + i).collect();
    // where nothing depends, S is the identity
    let on_states = |block: DMatrix<f64>| if split.dependent.is_empty() { block } else { block * &split.S };
    let by_rates = |rows: &[usize]| on_states(tableau.block(rows, &tableau.rates));
    let by_states = |rows: &[usize]| {
        let steady = on_states(tableau.block(rows, &tableau.states));
        if split.S_rate.iter().all(|e| *e == 0.0) { steady } else { steady + tableau.block(rows, &tableau.rates) * &split.S_rate }
    };
    let by_inputs = |rows: &[usize]| tableau.M.select_rows(rows).select_columns(&columns);
    let (E, A, B) = (by_rates(&rows), -by_states(&rows), -by_inputs(&rows));

    let (seeing, blind): (Vec<usize>, Vec<usize>) = (0..plant.outputs().len()).partition(|&k| tableau.output_sees_cyclic(k).is_some());
    let mut watched: Vec<usize> = blind.iter().map(|k| tableau.outputs.start + k).collect();
    watched.extend(tableau.inner.clone());
    let scale: Vec<f64> = states.iter().map(|s| s.nominal).collect();
    let mut right = DMatrix::zeros(E.nrows(), A.ncols() + B.ncols());
    right.columns_mut(0, A.ncols()).copy_from(&A);
    right.columns_mut(A.ncols(), B.ncols()).copy_from(&B);
    let rates = tableau::solve(&E, &right, &scale).map_err(|shares| LinearizeError::NoInertia {
        together: shares.iter().map(|&k| format!("`{}`", states[k].signal.name)).collect(),
    })?;
    let (mut C, mut D) = (by_states(&watched), by_inputs(&watched));
    // few signals depend on rates
    let of_rates = by_rates(&watched);
    let seeing_rates: Vec<usize> = (0..watched.len()).filter(|&k| of_rates.row(k).iter().any(|e| *e != 0.0)).collect();
    let through = of_rates.select_rows(&seeing_rates) * rates;
    for (row, &k) in seeing_rates.iter().enumerate() {
        let mut of_states = C.row_mut(k);
        of_states += through.row(row).columns(0, A.ncols());
        let mut of_inputs = D.row_mut(k);
        of_inputs += through.row(row).columns(A.ncols(), B.ncols());
    }

    let mut unknowns = DMatrix::zeros(plant.unknowns().len(), states.len());
    let mut unknowns_by_inputs = DMatrix::zeros(plant.unknowns().len(), kept_inputs.len());
    for (k, &i) in layout.differential.iter().enumerate() {
        unknowns.row_mut(i).copy_from(&split.S.row(k));
    }
    for (k, &i) in layout.algebraic.iter().chain(&layout.multipliers).enumerate() {
        unknowns.row_mut(i).copy_from(&C.row(blind.len() + k));
        unknowns_by_inputs.row_mut(i).copy_from(&D.row(blind.len() + k));
    }
    let cyclic = Cyclic {
        unknowns: layout.cyclic.clone(),
        by_cyclic: -tableau.block(&layout.cyclic_rows, &tableau.cyclic),
        by_states: -by_states(&layout.cyclic_rows),
    };
    let inputs = kept_inputs.iter().map(|&i| {
        let mut input = plant.inputs()[i].clone();
        input.rate = input.rate.and_then(|rate| kept_inputs.iter().position(|&k| k == rate));
        input
    });
    let left_out_inputs = (0..plant.inputs().len()).filter_map(|i| {
        let because = format!("it moves the {}", plant.equations()[is_bound(i)?.1].name);
        Some(LeftOut { signal: name_of_input(plant, i), because })
    });
    let left_out_outputs = seeing.iter().filter_map(|&k| {
        let cyclic = layout.cyclic[tableau.output_sees_cyclic(k)?];
        let because = format!("it depends on `{}`, which is no state", plant.unknowns()[cyclic].signal.name);
        Some(LeftOut { signal: plant.outputs()[k].name.clone(), because })
    });
    Ok(LinearModel {
        inputs: inputs.collect(),
        outputs: blind.iter().map(|&k| plant.outputs()[k].clone()).collect(),
        C: C.rows(0, blind.len()).into_owned(),
        D: D.rows(0, blind.len()).into_owned(),
        left_out: left_out_inputs.chain(left_out_outputs).collect(),
        states,
        E,
        A,
        B,
        unknowns,
        unknowns_by_inputs,
        unknown_signals: plant.unknowns().iter().map(|u| u.signal.clone()).collect(),
        cyclic,
    })
}
