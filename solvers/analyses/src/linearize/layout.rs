//! Which unknowns and rows of a plant play which part in a linear model.

use super::LinearizeError;
use problem::{EquationKind, Plant, UnknownKind};

/// Indices of unknowns and of rows, part by part. Rows stand in the order of the unknowns that they belong to.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    /// Differential unknowns without the cyclic coordinates.
    pub(super) differential: Vec<usize>,
    /// The row of each of them: its rate, its equation of motion, its element row.
    pub(super) rows: Vec<usize>,
    /// Cyclic coordinates.
    pub(super) cyclic: Vec<usize>,
    /// Their rows.
    pub(super) cyclic_rows: Vec<usize>,
    /// Element states without rate.
    pub(super) algebraic: Vec<usize>,
    /// Their rows.
    pub(super) algebraic_rows: Vec<usize>,
    /// Multipliers.
    pub(super) multipliers: Vec<usize>,
    /// Constraints on coordinates.
    pub(super) position_constraints: Vec<usize>,
    /// Constraints on velocities.
    pub(super) velocity_constraints: Vec<usize>,
}

impl Layout {
    /// Sorts unknowns and rows of a plant.
    ///
    /// # Errors
    /// Constraints on accelerations, or another number of multipliers than of constraints.
    pub(super) fn of(plant: &dyn Plant) -> Result<Self, LinearizeError> {
        let unknowns = |kind: UnknownKind| -> Vec<usize> {
            plant.unknowns().iter().enumerate().filter(|(_, u)| u.kind == kind).map(|(i, _)| i).collect()
        };
        let rows = |kind: EquationKind| -> Vec<usize> {
            plant.equations().iter().enumerate().filter(|(_, e)| e.kind == kind).map(|(i, _)| i).collect()
        };
        if let Some(&row) = rows(EquationKind::AccelerationConstraint).first() {
            let because = format!("the {} is one on accelerations", plant.equations()[row].name);
            return Err(LinearizeError::Formulation { because });
        }
        // rows of elements come in the order of the states, wherever these stand; what is left of the algebraic unknowns are multipliers
        let mut inner = [unknowns(UnknownKind::State), unknowns(UnknownKind::Algebraic)].concat();
        let element_rows = rows(EquationKind::Element);
        let multipliers = inner.split_off(element_rows.len().min(inner.len()));
        let mut layout = Self {
            differential: Vec::new(),
            rows: Vec::new(),
            cyclic: Vec::new(),
            cyclic_rows: Vec::new(),
            algebraic: Vec::new(),
            algebraic_rows: Vec::new(),
            multipliers,
            position_constraints: rows(EquationKind::Constraint),
            velocity_constraints: rows(EquationKind::VelocityConstraint),
        };
        let constraints = layout.position_constraints.len() + layout.velocity_constraints.len();
        if layout.multipliers.len() != constraints {
            let because = format!("there are {} multipliers and {constraints} rows of constraints", layout.multipliers.len());
            return Err(LinearizeError::Formulation { because });
        }
        let parts = [
            (unknowns(UnknownKind::Position), rows(EquationKind::Kinematic)),
            (unknowns(UnknownKind::Velocity), rows(EquationKind::Dynamic)),
            (inner, element_rows),
        ];
        for (unknown, row) in parts.into_iter().flat_map(|(unknowns, rows)| unknowns.into_iter().zip(rows)) {
            let u = &plant.unknowns()[unknown];
            let (to, to_rows) = match (u.kind == UnknownKind::Position && u.cyclic, u.differential) {
                (true, _) => (&mut layout.cyclic, &mut layout.cyclic_rows),
                (false, true) => (&mut layout.differential, &mut layout.rows),
                (false, false) => (&mut layout.algebraic, &mut layout.algebraic_rows),
            };
            to.push(unknown);
            to_rows.push(row);
        }
        Ok(layout)
    }

    /// All constraints, those on coordinates first.
    pub(super) fn constraints(&self) -> Vec<usize> {
        self.position_constraints.iter().chain(&self.velocity_constraints).copied().collect()
    }
}
