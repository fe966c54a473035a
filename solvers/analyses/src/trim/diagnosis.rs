//! Why a trim has no solution, or more than one, in signal names.
//!
//! Causes come from the limits that the elements declare; a failure without any declared limit near it is told as such, with
//! the signals of the direction in which the equations fold.

use super::system::TrimProblem;
use crate::{Variable, Variables};
use nalgebra::DMatrix;
use problem::{Ending, Limit};

/// Indices of a largest set of independent rows, each the largest of those that are left.
pub(super) fn largest_rows(jacobian: &DMatrix<f64>) -> Vec<usize> {
    let mut rest: Vec<nalgebra::DVector<f64>> = jacobian.row_iter().map(|row| row.transpose()).collect();
    let mut chosen = Vec::new();
    while let Some(best) = (0..rest.len()).filter(|i| !chosen.contains(i)).max_by(|&a, &b| rest[a].norm().total_cmp(&rest[b].norm())) {
        let Some(direction) = rest[best].try_normalize(1e-6) else { break };
        chosen.push(best);
        for row in &mut rest {
            let along = row.dot(&direction);
            *row -= &direction * along;
        }
    }
    chosen
}

/// Part of a row that must be independent of those chosen for it to be taken before others.
const CLEARLY_INDEPENDENT: f64 = 1e-6;

/// Indices of a largest set of independent rows of a scaled Jacobian, and the rank; those of the rows in `first` that are independent are among them.
pub(super) fn rank_rows(jacobian: &DMatrix<f64>, first: &[bool]) -> (Vec<usize>, usize) {
    // Gram-Schmidt with row pivoting: rows of the same origin are kept in order where they are equally good
    let (m, n) = jacobian.shape();
    let mut rest: Vec<nalgebra::DVector<f64>> = (0..m).map(|i| jacobian.row(i).transpose()).collect();
    let mut norms: Vec<f64> = rest.iter().map(|r| r.norm()).collect();
    for (row, norm) in rest.iter_mut().zip(&mut norms) {
        if *norm > 0.0 {
            *row /= *norm;
            *norm = 1.0;
        }
    }
    let mut chosen = Vec::new();
    while chosen.len() < n {
        let largest = |of: &dyn Fn(usize) -> bool| {
            (0..m).filter(|&i| of(i) && !chosen.contains(&i)).max_by(|&a, &b| rest[a].norm().total_cmp(&rest[b].norm()))
        };
        let best = largest(&|i| first[i]).filter(|&b| rest[b].norm() > CLEARLY_INDEPENDENT).or_else(|| largest(&|_| true));
        let Some(best) = best.filter(|&b| rest[b].norm() > 1e-9) else { break };
        chosen.push(best);
        let direction = rest[best].normalize();
        for (i, row) in rest.iter_mut().enumerate() {
            if !chosen.contains(&i) {
                let along = row.dot(&direction);
                *row -= &direction * along;
            }
        }
    }
    let rank = chosen.len();
    chosen.sort_unstable();
    (chosen, rank)
}

/// Names of the signals with a share in the direction that changes the rows least, largest first.
pub(crate) fn moving_together(jacobian: &DMatrix<f64>, unknowns: &[Variable], scale: &[f64], variables: &Variables) -> Vec<String> {
    let n = unknowns.len();
    // the right singular vector of the smallest singular value; pad wide matrices so that it is computed
    let mut square = DMatrix::zeros(n.max(jacobian.nrows()), n);
    square.rows_mut(0, jacobian.nrows()).copy_from(jacobian);
    let svd = square.svd(false, true);
    let Some(v_t) = svd.v_t else { return Vec::new() };
    let smallest = (0..n).min_by(|&a, &b| svd.singular_values[a].total_cmp(&svd.singular_values[b])).unwrap_or(0);
    let vector = v_t.row(smallest);
    let mut shares: Vec<(usize, f64)> = (0..n).map(|j| (j, vector[j])).filter(|(_, s)| s.abs() > 0.05).collect();
    shares.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    let told = shares.iter().take(6);
    told.map(|&(j, s)| format!("`{}` ({:+.2} {})", variables.name(unknowns[j]), s * scale[j], variables.unit(unknowns[j]))).collect()
}

/// The declared limit that is violated most at the last evaluated point.
pub(super) fn violated(problem: &TrimProblem<'_>) -> Option<Ending> {
    // a limit that is met exactly (top speed at full throttle) is not violated by rounding
    worst(problem, -1e-6)
}

/// The declared limit with the least room at the last evaluated point, if there is less room than `margin`.
pub(super) fn worst(problem: &TrimProblem<'_>, margin: f64) -> Option<Ending> {
    let value = |l: &Limit| {
        let v = problem.variables.find(&l.signal)?;
        Some(match v {
            Variable::Unknown(i) => problem.y[i],
            Variable::Rate(i) => problem.yd[i],
            Variable::Input(i) => problem.u[i],
            Variable::Output(i) => problem.outputs[i],
        })
    };
    let limits = problem.plant().limits().iter().filter_map(|l| value(l).map(|x| (l, x, l.margin(x))));
    let (limit, value, room) = limits.filter(|(_, x, _)| x.is_finite()).min_by(|a, b| a.2.total_cmp(&b.2))?;
    (room < margin).then(|| Ending::Limit { name: limit.name.to_string(), signal: limit.signal.clone(), value, threshold: limit.threshold })
}

/// What to say where no declared limit explains the end of a path.
pub(super) fn fold(problem: &TrimProblem<'_>, reached: &[(String, f64)]) -> Ending {
    let jacobian = problem.scaled_jacobian();
    let finite = jacobian.iter().all(|e| e.is_finite());
    let scale = problem::AlgebraicProblem::unknown_scale(problem);
    let together = if finite { moving_together(&jacobian, &problem.unknowns, scale, &problem.variables) } else { Vec::new() };
    let at: Vec<String> = reached.iter().map(|(name, value)| format!("{name} = {value:.6}")).collect();
    let because = match together.is_empty() {
        true => format!("the path of steady states ends at {}", at.join(", ")),
        false => format!("the path of steady states ends at {}; there {} move together", at.join(", "), together.join(", ")),
    };
    Ending::NotConverged { because }
}
