//! Which unknowns of a constrained plant are independent, and how the others follow.
//!
//! Elimination with complete pivoting of G, in units of the nominal values: rows on coordinates choose dependent coordinates, rows on velocities
//! dependent velocities. Among pivots that are good enough the choice keeps coordinates and their rates together, then
//! the rates of cyclic coordinates (spins, speed) go first: a wheel that rolls follows, a lean stays.
//!
//! Source: R. A. Wehage, E. J. Haug, J. Mech. Design 104 (1982) 247–255.

use super::layout::Layout;
use super::tableau::{Tableau, solve};
use super::{LinearizeError, not_finite};
use nalgebra::DMatrix;
use problem::{At, Matrix, Plant, Seeds, UnknownKind};

/// A pivot of a better class is taken while it is at least this share of the best one.
const GOOD_ENOUGH: f64 = 1e-3;

/// A row whose pivots are all below this, after equilibration, is redundant.
const REDUNDANT: f64 = 1e-9;

/// Independent and dependent differential unknowns: `δx = S δξ`, `δẋ = S δξ̇ + Ṡ δξ`.
#[derive(Clone, Debug)]
pub(super) struct Split {
    /// The states, in order.
    pub(super) independent: Vec<usize>,
    /// The others.
    pub(super) dependent: Vec<usize>,
    /// Kernel of G; the identity on the states.
    pub(super) S: DMatrix<f64>,
    /// Its rate along the motion.
    pub(super) S_rate: DMatrix<f64>,
}

impl Split {
    /// Chooses the states; `pairs` has the rate of every coordinate, `preferred` names unknowns that should be states.
    pub(super) fn choose(
        plant: &mut dyn Plant,
        at: At<'_>,
        layout: &Layout,
        tableau: &Tableau,
        pairs: &[Option<usize>],
        preferred: &[String],
    ) -> Result<Self, LinearizeError> {
        let n = layout.differential.len();
        let constraints = layout.constraints();
        if constraints.is_empty() {
            return Ok(Self {
                independent: (0..n).collect(),
                dependent: Vec::new(),
                S: DMatrix::identity(n, n),
                S_rate: DMatrix::zeros(n, n),
            });
        }
        let dependent = dependent(plant, layout, tableau, pairs, preferred)?;
        let independent: Vec<usize> = (0..n).filter(|k| !dependent.contains(k)).collect();
        let G = tableau.block(&constraints, &tableau.states);
        let G_D = G.select_columns(&dependent);
        let scale: Vec<f64> = dependent.iter().map(|&k| tableau.state_scale(k)).collect();
        let follow = |right: &DMatrix<f64>| {
            let redundant = |shares: Vec<usize>| plant.unknowns()[layout.differential[dependent[shares[0]]]].signal.name.clone();
            solve(&G_D, right, &scale)
                .map_err(|shares| LinearizeError::Redundant { equation: format!("constraint that moves `{}`", redundant(shares)) })
        };
        let mut S = DMatrix::zeros(n, independent.len());
        let mut S_rate = DMatrix::zeros(n, independent.len());
        for (column, &k) in independent.iter().enumerate() {
            S[(k, column)] = 1.0;
        }
        set_rows(&mut S, &dependent, &follow(&G.select_columns(&independent))?);
        if let Some(drift) = drift(plant, at, layout)? {
            let follow =
                |right: &DMatrix<f64>| solve(&G_D, right, &scale).unwrap_or_else(|_| DMatrix::zeros(dependent.len(), right.ncols()));
            set_rows(&mut S_rate, &dependent, &follow(&(drift * &S)));
        }
        Ok(Self { independent, dependent, S, S_rate })
    }
}

/// Sets rows to the negative of a solution.
fn set_rows(S: &mut DMatrix<f64>, rows: &[usize], solution: &DMatrix<f64>) {
    for (k, &row) in rows.iter().enumerate() {
        S.row_mut(row).copy_from(&-solution.row(k));
    }
}

/// Ġ along the motion; none where no velocity changes or nothing is constrained.
///
/// Rows on velocities are linear in v, so their entries by the coordinates change as they would be at the velocities v̇.
/// Rows on coordinates, and the entries by velocities, change with the shape only, which is constant.
fn drift(plant: &mut dyn Plant, at: At<'_>, layout: &Layout) -> Result<Option<DMatrix<f64>>, LinearizeError> {
    let velocities: Vec<usize> = (0..plant.unknowns().len()).filter(|&i| plant.unknowns()[i].kind == UnknownKind::Velocity).collect();
    if velocities.iter().all(|&i| at.yd[i] == 0.0) {
        return Ok(None);
    }
    let n = layout.differential.len();
    let mut seeds = Seeds::zeros(plant.unknowns().len(), plant.inputs().len(), n);
    for (column, &i) in layout.differential.iter().enumerate().filter(|(_, i)| plant.unknowns()[**i].kind == UnknownKind::Position) {
        seeds.y[(i, column)] = 1.0;
    }
    let (nf, nz) = (plant.equations().len(), plant.outputs().len());
    let (mut f, mut z, mut dz) = (vec![0.0; nf], vec![0.0; nz], Matrix::zeros(nz, n));
    let mut by_coordinates = |velocity: &dyn Fn(usize) -> f64| {
        let mut y = at.y.to_vec();
        velocities.iter().for_each(|&i| y[i] = velocity(i));
        let mut df = Matrix::zeros(nf, n);
        let found = plant.along(At { y: &y, ..at }, &seeds, (&mut f, &mut z), &mut df, &mut dz);
        found.map_err(|e| not_finite(plant, e))?;
        Ok(DMatrix::from_column_slice(nf, n, df.as_slice()))
    };
    let change = by_coordinates(&|i| at.yd[i])? - by_coordinates(&|_| 0.0)?;
    let mut drift = change.select_rows(&layout.constraints());
    drift.rows_mut(0, layout.position_constraints.len()).fill(0.0);
    Ok(Some(drift))
}

/// The dependent unknowns, in the order of the constraints' elimination.
fn dependent(
    plant: &dyn Plant,
    layout: &Layout,
    tableau: &Tableau,
    pairs: &[Option<usize>],
    preferred: &[String],
) -> Result<Vec<usize>, LinearizeError> {
    let n = layout.differential.len();
    let unknown = |k: usize| &plant.unknowns()[layout.differential[k]];
    let is_preferred: Vec<bool> = (0..n).map(|k| preferred.contains(&unknown(k).signal.name)).collect();
    let scaled = |rows: &[usize]| DMatrix::from_fn(rows.len(), n, |i, k| tableau.scaled(rows[i], tableau.states.start + k));
    let redundant = |rows: &[usize], row: usize| LinearizeError::Redundant { equation: plant.equations()[rows[row]].name.clone() };

    let class = |k: usize| (unknown(k).kind == UnknownKind::Position).then(|| usize::from(is_preferred[k]));
    let rows = &layout.position_constraints;
    let coordinates = pivots(scaled(rows), 2, &class).map_err(|row| redundant(rows, row))?;

    // rates of dependent coordinates first, rates of states last
    let follows = |k: usize| coordinates.iter().any(|&q| pairs[q] == Some(k));
    let class = |k: usize| match (unknown(k).kind, is_preferred[k]) {
        (UnknownKind::Velocity, true) => Some(3),
        (UnknownKind::Velocity, false) if follows(k) => Some(0),
        (UnknownKind::Velocity, false) if !pairs.contains(&Some(k)) => Some(1),
        (UnknownKind::Velocity, false) => Some(2),
        _ => None,
    };
    let rows = &layout.velocity_constraints;
    let velocities = pivots(scaled(rows), 4, &class).map_err(|row| redundant(rows, row))?;
    Ok(coordinates.into_iter().chain(velocities).collect())
}

/// One column per row of a matrix, by elimination with complete pivoting; `class` says how gladly a column is taken (0 first).
///
/// # Errors
/// A row that depends on the others.
fn pivots(mut G: DMatrix<f64>, classes: usize, class: &dyn Fn(usize) -> Option<usize>) -> Result<Vec<usize>, usize> {
    for mut row in G.row_iter_mut() {
        let largest = row.amax();
        row /= if largest > 0.0 { largest } else { 1.0 };
    }
    let mut rows: Vec<usize> = (0..G.nrows()).collect();
    let mut chosen: Vec<usize> = Vec::new();
    while let Some(&left) = rows.first() {
        let best = |wanted: &dyn Fn(usize) -> bool| {
            let columns = (0..G.ncols()).filter(|k| !chosen.contains(k) && wanted(*k));
            let entries = columns.flat_map(|k| rows.iter().map(move |&i| (i, k)));
            // the first of equal ones, so that the choice does not depend on rounding of symmetric systems
            entries.fold(None, |best: Option<(usize, usize)>, (i, k)| match best {
                Some(b) if G[b].abs() * (1.0 + 1e-9) >= G[(i, k)].abs() => best,
                _ => Some((i, k)),
            })
        };
        let overall = best(&|k| class(k).is_some()).filter(|&p| G[p].abs() > REDUNDANT).ok_or(left)?;
        let of_class = (0..classes).filter_map(|c| best(&|k| class(k) == Some(c)));
        let (row, column) = of_class.into_iter().find(|&p| G[p].abs() >= GOOD_ENOUGH * G[overall].abs()).unwrap_or(overall);
        rows.retain(|&i| i != row);
        let pivot = G.row(row) / G[(row, column)];
        for &i in &rows {
            let factor = G[(i, column)];
            let reduced = G.row(i) - &pivot * factor;
            G.row_mut(i).copy_from(&reduced);
        }
        chosen.push(column);
    }
    Ok(chosen)
}
