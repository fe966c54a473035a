//! The square algebraic system of a trim, with its exact Jacobian.
//!
//! `x → (y, ẏ, u)` through roles and ties; rows: equations of motion, element rows, conditions. One sweep of the plant with
//! the directions `∂(y, ẏ, u)/∂x` gives the Jacobian. Rows that no unknown touches are left out and checked at the end.

use super::diagnosis::{largest_rows, moving_together, rank_rows};
use super::roles::{Condition, Role, Trim, TrimError};
use crate::{Expression, Variable, Variables};
use problem::{AlgebraicProblem, At, EquationKind, EvalError, Matrix, Plant, Seeds};

/// One row of the trim system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Row {
    /// Row of the plant.
    Equation(usize),
    /// Condition of the trim.
    Condition(usize),
}

/// Which rows a trim solves, and which it leaves out.
#[derive(Clone, Debug)]
pub struct Rows {
    solved: Vec<Row>,
    implied: Vec<Row>,
}

/// The trim of one plant as an algebraic problem.
pub struct TrimProblem<'p> {
    pub(super) plant: &'p mut dyn Plant,
    pub(super) variables: Variables,
    pub(super) unknowns: Vec<Variable>,
    pub(super) rows: Vec<Row>,
    /// Rows left out because no unknown touches them or because others imply them; they must hold all the same.
    pub(super) implied: Vec<Row>,
    ties: Vec<(Variable, Expression)>,
    pub(super) conditions: Vec<Condition>,
    goals: Vec<(String, Option<Variable>)>,
    pub(super) values: Vec<f64>,
    guess: Vec<f64>,
    unknown_scale: Vec<f64>,
    equation_scale: Vec<f64>,
    pub(super) y: Vec<f64>,
    pub(super) yd: Vec<f64>,
    pub(super) u: Vec<f64>,
    pub(super) residual: Vec<f64>,
    pub(super) outputs: Vec<f64>,
    seeds: Seeds,
    d_residual: Matrix,
    d_outputs: Matrix,
    /// One direction and the derivatives along it.
    along: (Seeds, Matrix, Matrix),
}

/// Value of a variable.
fn value(v: Variable, y: &[f64], yd: &[f64], u: &[f64], z: &[f64]) -> f64 {
    match v {
        Variable::Unknown(i) => y[i],
        Variable::Rate(i) => yd[i],
        Variable::Input(i) => u[i],
        Variable::Output(i) => z[i],
    }
}

/// Sets a variable that is not an output.
fn set(v: Variable, x: f64, y: &mut [f64], yd: &mut [f64], u: &mut [f64]) {
    match v {
        Variable::Unknown(i) => y[i] = x,
        Variable::Rate(i) => yd[i] = x,
        Variable::Input(i) => u[i] = x,
        Variable::Output(_) => {}
    }
}

/// The entry of the seeds that belongs to a variable and a column.
fn seed(seeds: &mut Seeds, v: Variable, column: usize) -> Option<&mut f64> {
    match v {
        Variable::Unknown(i) => Some(&mut seeds.y[(i, column)]),
        Variable::Rate(i) => Some(&mut seeds.yd[(i, column)]),
        Variable::Input(i) => Some(&mut seeds.u[(i, column)]),
        Variable::Output(_) => None,
    }
}

impl<'p> TrimProblem<'p> {
    /// Sets the system up: counts, structure, rank.
    ///
    /// # Errors
    /// Ties that run in circles, too few or too many conditions, undetermined unknowns (in signal names).
    pub fn new(plant: &'p mut dyn Plant, trim: &Trim) -> Result<Self, TrimError> {
        let mut problem = Self::without_rows(plant, trim)?;
        problem.choose_rows()?;
        Ok(problem)
    }

    /// The same trim of another plant with the same signals: the rows that were chosen before, nothing checked again.
    ///
    /// # Errors
    /// Ties that run in circles.
    pub fn with_rows(plant: &'p mut dyn Plant, trim: &Trim, rows: &Rows) -> Result<Self, TrimError> {
        let mut problem = Self::without_rows(plant, trim)?;
        (problem.rows, problem.implied) = (rows.solved.clone(), rows.implied.clone());
        problem.equation_scale = problem.rows.iter().map(|&r| problem.row_scale(r)).collect();
        Ok(problem)
    }

    /// The rows that were chosen, for [`TrimProblem::with_rows`].
    pub fn rows(&self) -> Rows {
        Rows { solved: self.rows.clone(), implied: self.implied.clone() }
    }

    /// Everything but the choice of the rows.
    fn without_rows(plant: &'p mut dyn Plant, trim: &Trim) -> Result<Self, TrimError> {
        let (ny, nu, nf, nz) = (plant.unknowns().len(), plant.inputs().len(), plant.equations().len(), plant.outputs().len());
        let mut unknowns = Vec::new();
        let mut guess = Vec::new();
        let mut unknown_scale = Vec::new();
        let mut ties = Vec::new();
        let (mut y, mut yd, mut u) = (vec![0.0; ny], vec![0.0; ny], vec![0.0; nu]);
        let roles = (trim.unknowns.iter().enumerate().map(|(i, r)| (Variable::Unknown(i), r)))
            .chain(trim.rates.iter().enumerate().map(|(i, r)| (Variable::Rate(i), r)))
            .chain(trim.inputs.iter().enumerate().map(|(i, r)| (Variable::Input(i), r)));
        for (v, role) in roles {
            match role {
                Role::Fixed(x) => set(v, *x, &mut y, &mut yd, &mut u),
                Role::Tied(formula) => ties.push((v, formula.clone())),
                Role::Unknown(x) => {
                    unknowns.push(v);
                    guess.push(*x);
                    unknown_scale.push(match v {
                        Variable::Unknown(i) | Variable::Rate(i) => plant.unknowns()[i].nominal,
                        Variable::Input(i) => plant.inputs()[i].nominal,
                        Variable::Output(_) => 1.0,
                    });
                }
            }
        }
        let n = unknowns.len();
        let mut problem = Self {
            variables: trim.variables.clone(),
            ties: order_ties(ties, &trim.variables)?,
            conditions: trim.conditions.clone(),
            goals: trim.goals.clone(),
            values: trim.values.clone(),
            rows: Vec::new(),
            implied: Vec::new(),
            equation_scale: Vec::new(),
            residual: vec![0.0; nf],
            outputs: vec![0.0; nz],
            seeds: Seeds::zeros(ny, nu, n),
            d_residual: Matrix::zeros(nf, n),
            d_outputs: Matrix::zeros(nz, n),
            along: (Seeds::zeros(ny, nu, 1), Matrix::zeros(nf, 1), Matrix::zeros(nz, 1)),
            plant,
            unknowns,
            guess,
            unknown_scale,
            y,
            yd,
            u,
        };
        for (column, &v) in problem.unknowns.iter().enumerate() {
            if let Some(entry) = seed(&mut problem.seeds, v, column) {
                *entry = 1.0;
            }
        }
        Ok(problem)
    }

    /// Chooses as many independent rows as there are unknowns.
    fn choose_rows(&mut self) -> Result<(), TrimError> {
        let cyclic = |i: usize| self.plant.equations()[i].kind == EquationKind::Kinematic && self.plant.unknowns()[i].cyclic;
        let mut candidates: Vec<Row> = (0..self.plant.equations().len()).filter(|&i| !cyclic(i)).map(Row::Equation).collect();
        candidates.extend((0..self.conditions.len()).map(Row::Condition));
        // two points off the symmetric ones: structure must not hide in a special pose
        let mut touched = vec![false; candidates.len()];
        let mut generic = None;
        for round in 0..2 {
            let x = self.generic_point(round);
            let Ok(()) = self.derivatives(&x) else { continue };
            self.rows = candidates.clone();
            let scaled = self.scaled_jacobian();
            // what rounding leaves of the largest entries is no structure
            let rounding = 1e-13 * scaled.amax().max(1.0);
            for (row, touched) in touched.iter_mut().enumerate() {
                *touched |= scaled.row(row).iter().any(|e| e.abs() > rounding);
            }
            generic = Some(scaled);
        }
        let Some(scaled) = generic else {
            let equation = match self.derivatives(&self.guess.clone()) {
                Err(EvalError::Recoverable { equation } | EvalError::Fatal { equation }) => self.plant.equations()[equation].name.clone(),
                Ok(()) => "residual near the first guess".to_owned(),
            };
            return Err(TrimError::NotFinite { equation });
        };
        // four rows hold the norm of a quaternion: the one that does it best at the first guess speaks for them
        let guess = self.guess.clone();
        if self.derivatives(&guess).is_ok() {
            let kinematic =
                |i: &usize| matches!(candidates[*i], Row::Equation(e) if self.plant.equations()[e].kind == EquationKind::Kinematic);
            let rows: Vec<usize> = (0..candidates.len()).filter(kinematic).collect();
            self.rows = rows.iter().map(|&i| candidates[i]).collect();
            let kept = largest_rows(&self.scaled_jacobian());
            rows.iter().enumerate().filter(|(k, _)| !kept.contains(k)).for_each(|(_, &i)| touched[i] = false);
        }
        let live: Vec<usize> = (0..candidates.len()).filter(|&i| touched[i]).collect();
        self.implied = (0..candidates.len()).filter(|&i| !touched[i]).map(|i| candidates[i]).collect();
        let jacobian = scaled.select_rows(&live);
        // loops close exactly: where something follows from the rest, it is a balance of forces
        let closes = |&i: &usize| matches!(candidates[i], Row::Equation(e) if self.plant.equations()[e].kind == EquationKind::Constraint);
        let first: Vec<bool> = live.iter().map(closes).collect();
        let (independent, rank) = rank_rows(&jacobian, &first);
        if rank < self.unknowns.len() {
            let together = moving_together(&jacobian, &self.unknowns, &self.unknown_scale, &self.variables);
            return Err(match live.len() < self.unknowns.len() {
                true => TrimError::Count { unknowns: self.unknowns.len(), equations: live.len(), involved: together },
                false => TrimError::Undetermined { together },
            });
        }
        self.rows = independent.iter().map(|&i| candidates[live[i]]).collect();
        self.implied.extend((0..live.len()).filter(|i| !independent.contains(i)).map(|i| candidates[live[i]]));
        self.equation_scale = self.rows.iter().map(|&r| self.row_scale(r)).collect();
        Ok(())
    }

    /// The first guess moved by a fraction of each scale, different for each unknown and round.
    fn generic_point(&self, round: usize) -> Vec<f64> {
        let spread = |i: usize| ((i + 1) as f64 * 0.618_034 + round as f64 * 0.414_214).fract() - 0.5;
        self.guess.iter().zip(&self.unknown_scale).enumerate().map(|(i, (g, s))| g + 0.02 * s * spread(i)).collect()
    }

    fn row_scale(&self, row: Row) -> f64 {
        match row {
            Row::Equation(i) => self.plant.equations()[i].nominal,
            Row::Condition(k) => self.conditions[k].scale,
        }
    }

    pub(super) fn row_name(&self, row: Row) -> (String, String) {
        match row {
            Row::Equation(i) => (self.plant.equations()[i].name.clone(), self.plant.equations()[i].unit.to_string()),
            Row::Condition(k) => (format!("demanded `{}`", self.conditions[k].name), self.conditions[k].unit.clone()),
        }
    }

    pub(super) fn row_value(&self, row: Row) -> f64 {
        match row {
            Row::Equation(i) => self.residual[i],
            Row::Condition(k) => {
                let of = |v| value(v, &self.y, &self.yd, &self.u, &self.outputs);
                self.conditions[k].left.value(&of) - self.values[self.conditions[k].goal]
            }
        }
    }

    /// Jacobian of `self.rows` in units of the scales.
    pub(super) fn scaled_jacobian(&self) -> nalgebra::DMatrix<f64> {
        let mut J = Matrix::zeros(self.rows.len(), self.unknowns.len());
        self.collect_jacobian(&mut J);
        nalgebra::DMatrix::from_fn(self.rows.len(), self.unknowns.len(), |i, j| {
            J[(i, j)] * self.unknown_scale[j] / self.row_scale(self.rows[i])
        })
    }

    /// Names and values of the goals.
    pub fn goals(&self) -> Vec<(String, f64)> {
        self.goals.iter().map(|(n, _)| n.clone()).zip(self.values.iter().copied()).collect()
    }

    /// Sets the values of all goals.
    pub fn set_goals(&mut self, values: &[f64]) {
        self.values.copy_from_slice(values);
        for ((_, target), &x) in self.goals.iter().zip(values) {
            if let Some(v) = target {
                set(*v, x, &mut self.y, &mut self.yd, &mut self.u);
            }
        }
    }

    /// The first guess.
    pub fn guess(&self) -> &[f64] {
        &self.guess
    }

    /// The unknowns, in the order of x.
    pub fn unknowns(&self) -> &[Variable] {
        &self.unknowns
    }

    /// The names of the plant.
    pub fn variables(&self) -> &Variables {
        &self.variables
    }

    /// The plant.
    pub fn plant(&self) -> &dyn Plant {
        self.plant
    }

    /// The point of the last evaluation: y, ẏ, u, z.
    pub fn point(&self) -> (&[f64], &[f64], &[f64], &[f64]) {
        (&self.y, &self.yd, &self.u, &self.outputs)
    }

    /// Writes x into (y, ẏ, u), ties included.
    fn load(&mut self, x: &[f64]) {
        for (&v, &value) in self.unknowns.iter().zip(x) {
            set(v, value, &mut self.y, &mut self.yd, &mut self.u);
        }
        for (v, formula) in &self.ties {
            let tied = formula.value(&|w| value(w, &self.y, &self.yd, &self.u, &[]));
            set(*v, tied, &mut self.y, &mut self.yd, &mut self.u);
        }
    }

    /// Writes the directions of the tied variables.
    fn load_seeds(&mut self) {
        let Self { ties, seeds, y, yd, u, unknowns, .. } = self;
        for (v, formula) in ties.iter() {
            for column in 0..unknowns.len() {
                let mut sum = 0.0;
                formula.gradient(&|w| value(w, y, yd, u, &[]), 1.0, &mut |w, weight| {
                    sum += weight * seed(seeds, w, column).map_or(0.0, |e| *e);
                });
                if let Some(entry) = seed(seeds, *v, column) {
                    *entry = sum;
                }
            }
        }
    }

    /// Evaluates plant and derivatives at x.
    fn derivatives(&mut self, x: &[f64]) -> Result<(), EvalError> {
        self.load(x);
        self.load_seeds();
        let at = At { time: 0.0, y: &self.y, yd: &self.yd, u: &self.u };
        let values = (&mut self.residual[..], &mut self.outputs[..]);
        self.plant.along(at, &self.seeds, values, &mut self.d_residual, &mut self.d_outputs)
    }

    /// Copies the derivatives of `self.rows`.
    fn collect_jacobian(&self, J: &mut Matrix) {
        for (r, &row) in self.rows.iter().enumerate() {
            for j in 0..self.unknowns.len() {
                J[(r, j)] = self.row_along(row, j, (&self.seeds, &self.d_residual, &self.d_outputs));
            }
        }
    }

    /// Derivative of a row along one direction.
    fn row_along(&self, row: Row, j: usize, (seeds, d_residual, d_outputs): (&Seeds, &Matrix, &Matrix)) -> f64 {
        match row {
            Row::Equation(i) => d_residual[(i, j)],
            Row::Condition(k) => {
                let of = |v| value(v, &self.y, &self.yd, &self.u, &self.outputs);
                let mut sum = 0.0;
                self.conditions[k].left.gradient(&of, 1.0, &mut |v, weight| {
                    sum += weight
                        * match v {
                            Variable::Unknown(i) => seeds.y[(i, j)],
                            Variable::Rate(i) => seeds.yd[(i, j)],
                            Variable::Input(i) => seeds.u[(i, j)],
                            Variable::Output(i) => d_outputs[(i, j)],
                        };
                });
                sum
            }
        }
    }

    /// Rows that were left out must hold at a solution: the first that does not, as an error.
    pub(super) fn check_implied(&self) -> Result<(), TrimError> {
        for &row in &self.implied {
            let off = self.row_value(row);
            if off.abs() > 1e-6 * self.row_scale(row) {
                let (equation, unit) = self.row_name(row);
                return Err(TrimError::Contradictory { equation, off, unit });
            }
        }
        Ok(())
    }
}

/// Orders ties so that each follows those it uses.
fn order_ties(mut waiting: Vec<(Variable, Expression)>, variables: &Variables) -> Result<Vec<(Variable, Expression)>, TrimError> {
    let mut ordered = Vec::new();
    while !waiting.is_empty() {
        let free = |t: &(Variable, Expression)| !t.1.variables().iter().any(|v| waiting.iter().any(|w| w.0 == *v));
        match waiting.iter().position(free) {
            Some(at) => ordered.push(waiting.remove(at)),
            None => {
                let name = variables.name(waiting[0].0);
                return Err(TrimError::Tie { name, cause: "itself, directly or through other ties".to_owned() });
            }
        }
    }
    Ok(ordered)
}

impl AlgebraicProblem for TrimProblem<'_> {
    fn size(&self) -> usize {
        self.unknowns.len()
    }
    fn unknown_scale(&self) -> &[f64] {
        &self.unknown_scale
    }
    fn equation_scale(&self) -> &[f64] {
        &self.equation_scale
    }
    fn residual(&mut self, x: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.load(x);
        let at = At { time: 0.0, y: &self.y, yd: &self.yd, u: &self.u };
        self.plant.evaluate(at, &mut self.residual, &mut self.outputs)?;
        for (f, &row) in f.iter_mut().zip(&self.rows) {
            *f = self.row_value(row);
        }
        Ok(())
    }
    fn jacobian(&mut self, x: &[f64], f: &mut [f64], jacobian: &mut Matrix) -> Result<(), EvalError> {
        self.derivatives(x)?;
        for (f, &row) in f.iter_mut().zip(&self.rows) {
            *f = self.row_value(row);
        }
        self.collect_jacobian(jacobian);
        Ok(())
    }
    fn product(&mut self, x: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), EvalError> {
        self.load(x);
        self.load_seeds();
        let (mut one, mut d_residual, mut d_outputs) = std::mem::take(&mut self.along);
        self.seeds.y.times(v, one.y.as_mut_slice());
        self.seeds.yd.times(v, one.yd.as_mut_slice());
        self.seeds.u.times(v, one.u.as_mut_slice());
        let at = At { time: 0.0, y: &self.y, yd: &self.yd, u: &self.u };
        let evaluated = self.plant.along(at, &one, (&mut self.residual, &mut self.outputs), &mut d_residual, &mut d_outputs);
        for (entry, &row) in product.iter_mut().zip(&self.rows) {
            *entry = self.row_along(row, 0, (&one, &d_residual, &d_outputs));
        }
        self.along = (one, d_residual, d_outputs);
        evaluated
    }
}
