//! Who is given, who is unknown.

use crate::{Expression, ExpressionError, Variable, Variables};
use problem::{Plant, UnknownKind};
use thiserror::Error;

/// What a variable is in a trim.
#[derive(Clone, Debug, PartialEq)]
pub enum Role {
    /// Given.
    Fixed(f64),
    /// To be found, with a first guess.
    Unknown(f64),
    /// A formula of other variables (no outputs).
    Tied(Expression),
}

/// Why a trim cannot be set up or has no unique solution.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TrimError {
    /// A name that is no signal.
    #[error("`{name}` is no signal of this model")]
    UnknownSignal {
        /// The name.
        name: String,
    },
    /// A formula cannot be read.
    #[error(transparent)]
    Expression(#[from] ExpressionError),
    /// An output cannot be freed or tied; it can only be given.
    #[error("`{name}` is computed from the motion; it can be given but not freed")]
    OutputRole {
        /// The output.
        name: String,
    },
    /// A formula of a tie uses an output or runs in a circle.
    #[error("`{name}` is tied to {cause}")]
    Tie {
        /// The tied variable.
        name: String,
        /// What is wrong with the tie.
        cause: String,
    },
    /// Too few or too many conditions.
    #[error(
        "{} unknowns but {} equations: {} {}",
        unknowns,
        equations,
        if unknowns > equations { "nothing determines" } else { "nothing is left open for" },
        involved.join(", ")
    )]
    Count {
        /// Number of unknowns.
        unknowns: usize,
        /// Number of equations that involve any unknown.
        equations: usize,
        /// Candidates: free signals where too few are given; given ones where too many are.
        involved: Vec<String>,
    },
    /// Unknowns that no equation determines.
    #[error("undetermined: no equation fixes {}; these move together: give one of them", together.join(", "))]
    Undetermined {
        /// The signals that move together, with their shares.
        together: Vec<String>,
    },
    /// An equation that no unknown can satisfy.
    #[error("contradictory: the {equation} is off by {off:.6} {unit} and no unknown can change it")]
    Contradictory {
        /// The equation.
        equation: String,
        /// By how much it is violated.
        off: f64,
        /// Its unit.
        unit: String,
    },
    /// Equations that depend on each other and contradict.
    #[error("contradictory: {} cannot hold together with what is given", together.join(", "))]
    Conflict {
        /// The equations that cannot hold together.
        together: Vec<String>,
    },
    /// The first evaluation failed.
    #[error("the {equation} is not finite at the first guess")]
    NotFinite {
        /// The equation.
        equation: String,
    },
}

/// A condition `left = value`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Condition {
    pub(super) left: Expression,
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) scale: f64,
    /// Index of the goal whose value is the right-hand side.
    pub(super) goal: usize,
}

/// What is given and what is unknown.
///
/// Starts with the roles of a steady motion: rates and non-cyclic velocities are zero, cyclic coordinates are zero, inputs
/// have their default values, and everything else is unknown.
#[derive(Clone, Debug)]
pub struct Trim {
    pub(super) variables: Variables,
    pub(super) unknowns: Vec<Role>,
    pub(super) rates: Vec<Role>,
    pub(super) inputs: Vec<Role>,
    pub(super) conditions: Vec<Condition>,
    /// Where each goal goes: a variable that is fixed, or a condition.
    pub(super) goals: Vec<(String, Option<Variable>)>,
    pub(super) values: Vec<f64>,
    cyclic_velocities: Vec<usize>,
}

impl Trim {
    /// The roles of a steady motion of a plant.
    pub fn steady(plant: &dyn Plant) -> Self {
        let unknowns = plant.unknowns();
        let role = |u: &problem::Unknown| match (u.kind, u.cyclic) {
            (UnknownKind::Position, true) | (UnknownKind::Velocity, false) => Role::Fixed(u.design),
            _ => Role::Unknown(u.design),
        };
        Self {
            variables: Variables::of(plant),
            unknowns: unknowns.iter().map(role).collect(),
            rates: vec![Role::Fixed(0.0); unknowns.len()],
            inputs: plant.inputs().iter().map(|i| Role::Fixed(i.default)).collect(),
            conditions: Vec::new(),
            goals: Vec::new(),
            values: Vec::new(),
            cyclic_velocities: (0..unknowns.len()).filter(|&i| unknowns[i].kind == UnknownKind::Velocity && unknowns[i].cyclic).collect(),
        }
    }

    /// The roles of rest: as [`Trim::steady`], with all cyclic velocities zero too.
    pub fn at_rest(plant: &dyn Plant) -> Self {
        let mut trim = Self::steady(plant);
        for &i in &trim.cyclic_velocities.clone() {
            trim.unknowns[i] = Role::Fixed(0.0);
        }
        trim
    }

    /// The names of the plant.
    pub fn variables(&self) -> &Variables {
        &self.variables
    }

    fn find(&self, name: &str) -> Result<Variable, TrimError> {
        self.variables.find(name).ok_or_else(|| TrimError::UnknownSignal { name: name.to_owned() })
    }

    fn role_mut(&mut self, variable: Variable) -> Option<&mut Role> {
        match variable {
            Variable::Unknown(i) => Some(&mut self.unknowns[i]),
            Variable::Rate(i) => Some(&mut self.rates[i]),
            Variable::Input(i) => Some(&mut self.inputs[i]),
            Variable::Output(_) => None,
        }
    }

    /// The role of a variable; `None` for an output.
    pub fn role(&self, name: &str) -> Option<&Role> {
        match self.variables.find(name)? {
            Variable::Unknown(i) => Some(&self.unknowns[i]),
            Variable::Rate(i) => Some(&self.rates[i]),
            Variable::Input(i) => Some(&self.inputs[i]),
            Variable::Output(_) => None,
        }
    }

    /// Gives a signal a value. An unknown, a rate or an input becomes fixed; an output becomes a condition. The value can be
    /// changed later by [`Trim::set_goal`]; returns the index of this goal.
    pub fn give(&mut self, name: &str, value: f64) -> Result<usize, TrimError> {
        let variable = self.find(name)?;
        if let Some(at) = self.goals.iter().position(|(n, _)| n == name) {
            self.set_goal(at, value);
            return Ok(at);
        }
        let goal = self.goals.len();
        match self.role_mut(variable) {
            Some(role) => {
                *role = Role::Fixed(value);
                self.goals.push((name.to_owned(), Some(variable)));
            }
            None => {
                let unit = self.variables.unit(variable);
                let left = Expression::Variable(variable);
                self.conditions.push(Condition { left, name: name.to_owned(), unit, scale: 1.0, goal });
                self.goals.push((name.to_owned(), None));
            }
        }
        self.values.push(value);
        Ok(goal)
    }

    /// Demands that a formula has a value; `scale` is its typical magnitude. Returns the index of this goal.
    pub fn demand(&mut self, formula: &str, value: f64, scale: f64) -> Result<usize, TrimError> {
        let left = Expression::parse(formula, &self.variables)?;
        let goal = self.goals.len();
        self.conditions.push(Condition { left, name: formula.to_owned(), unit: String::new(), scale, goal });
        self.goals.push((formula.to_owned(), None));
        self.values.push(value);
        Ok(goal)
    }

    /// Ties a variable to a formula of other variables.
    pub fn tie(&mut self, name: &str, formula: &str) -> Result<(), TrimError> {
        let tied = Expression::parse(formula, &self.variables)?;
        let variable = self.find(name)?;
        if let Some(&output) = tied.variables().iter().find(|v| matches!(v, Variable::Output(_))) {
            let cause = format!("the output `{}`; demand it as a condition instead", self.variables.name(output));
            return Err(TrimError::Tie { name: name.to_owned(), cause });
        }
        match self.role_mut(variable) {
            Some(role) => *role = Role::Tied(tied),
            None => return Err(TrimError::OutputRole { name: name.to_owned() }),
        }
        Ok(())
    }

    /// Makes a variable unknown, with a first guess.
    pub fn free(&mut self, name: &str, guess: f64) -> Result<(), TrimError> {
        let variable = self.find(name)?;
        // a goal that fixed it has no effect any more
        for goal in self.goals.iter_mut().filter(|(n, v)| n == name && *v == Some(variable)) {
            goal.1 = None;
        }
        match self.role_mut(variable) {
            Some(role) => *role = Role::Unknown(guess),
            None => return Err(TrimError::OutputRole { name: name.to_owned() }),
        }
        Ok(())
    }

    /// Changes the first guess of an unknown; ignored where the variable is not unknown.
    pub fn guess(&mut self, name: &str, value: f64) {
        if let Some(variable) = self.variables.find(name)
            && let Some(Role::Unknown(guess)) = self.role_mut(variable)
        {
            *guess = value;
        }
    }

    /// Quasi-steady acceleration: all cyclic velocities keep their ratios, `v̇ = (a/V) v`, where `V` is the signal `speed`
    /// and `a` its given rate. Shape, slips and curvature stay constant; the drift of the lean with V² is ignored.
    pub fn accelerate(&mut self, speed: &str, acceleration: f64) -> Result<usize, TrimError> {
        let lead = self.find(speed)?;
        let lead_rate = format!("rate({speed})");
        for i in self.cyclic_velocities.clone() {
            if lead == Variable::Unknown(i) {
                continue;
            }
            let name = self.variables.name(Variable::Unknown(i));
            self.tie(&format!("rate({name})"), &format!("{lead_rate} * {name} / {speed}"))?;
        }
        self.give(&lead_rate, acceleration)
    }

    /// Changes the value of a goal.
    pub fn set_goal(&mut self, goal: usize, value: f64) {
        self.values[goal] = value;
        if let (_, Some(variable)) = self.goals[goal]
            && let Some(Role::Fixed(fixed)) = self.role_mut(variable)
        {
            *fixed = value;
        }
    }

    /// Names and values of all goals.
    pub fn goals(&self) -> impl Iterator<Item = (&str, f64)> {
        self.goals.iter().map(|(name, _)| name.as_str()).zip(self.values.iter().copied())
    }
}
