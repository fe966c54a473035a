//! Accelerations of a tree by the articulated-body algorithm.
//!
//! For systems without constraints, couplings and element states whose forces do not depend on accelerations: one pass over the elements,
//! then `v̇ = ABA(q, v, τ)` in O(n), without a matrix. Source: Featherstone (2008), table 7.1.

use super::super::{System, TreePlant};
use problem::contract::finite;
use problem::{At, EvalError};

/// Whether a system whose forces do not depend on accelerations is a tree of independent joints without further states.
pub(super) fn applies(system: &System) -> bool {
    system.constraints.is_empty() && system.model.layout.is_identity() && system.state_count == 0
}

/// Writes all rates.
pub(super) fn solve(plant: &mut TreePlant, at: At<'_>, rates: &mut [f64]) -> Result<(), EvalError> {
    plant.forward_at(at, rates);
    finite(rates)
}
