//! The systems. Numbers in brackets: Moré, Garbow, Hillstrom (1981), see the module above.

use super::Classic;
use problem::{Bound, EvalError, Matrix};
use std::f64::consts::TAU;

/// Writes the entries row after row.
fn rows<const N: usize>(jacobian: &mut Matrix, rows: [[f64; N]; N]) {
    for (i, row) in rows.iter().enumerate() {
        for (j, &entry) in row.iter().enumerate() {
            jacobian[(i, j)] = entry;
        }
    }
}

/// (1): solution (1, 1).
pub fn rosenbrock() -> Classic {
    Classic::new(
        &[-1.2, 1.0],
        |x, f| {
            f.copy_from_slice(&[10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]]);
            Ok(())
        },
        |x, jacobian| rows(jacobian, [[-20.0 * x[0], 10.0], [-1.0, 0.0]]),
    )
}

/// (1) with the first unknown in millionths, the second in thousands of millions, and equations to match.
pub fn rosenbrock_in_other_units() -> Classic {
    Classic::new(
        &[-1.2e-6, 1e9],
        |x, f| {
            let (a, b) = (x[0] * 1e6, x[1] * 1e-9);
            f.copy_from_slice(&[1e7 * 10.0 * (b - a * a), 1e-5 * (1.0 - a)]);
            Ok(())
        },
        |x, jacobian| rows(jacobian, [[-1e7 * 20.0 * x[0] * 1e12, 1e7 * 10.0 * 1e-9], [-1e-5 * 1e6, 0.0]]),
    )
    .scaled(&[1e-6, 1e9], &[1e7, 1e-5])
}

/// (2): solution (5, 4); from this start descent methods end at a local minimum with ‖f‖² = 48.9842….
pub fn freudenstein_roth() -> Classic {
    Classic::new(
        &[0.5, -2.0],
        |x, f| {
            let (a, b) = (x[0], x[1]);
            f.copy_from_slice(&[-13.0 + a + ((5.0 - b) * b - 2.0) * b, -29.0 + a + ((b + 1.0) * b - 14.0) * b]);
            Ok(())
        },
        |x, jacobian| rows(jacobian, [[1.0, 10.0 * x[1] - 3.0 * x[1] * x[1] - 2.0], [1.0, 3.0 * x[1] * x[1] + 2.0 * x[1] - 14.0]]),
    )
}

/// (3): solution (1.098…e-5, 9.106…).
pub fn powell_badly_scaled() -> Classic {
    Classic::new(
        &[0.0, 1.0],
        |x, f| {
            f.copy_from_slice(&[1e4 * x[0] * x[1] - 1.0, (-x[0]).exp() + (-x[1]).exp() - 1.0001]);
            Ok(())
        },
        |x, jacobian| rows(jacobian, [[1e4 * x[1], 1e4 * x[0]], [-(-x[0]).exp(), -(-x[1]).exp()]]),
    )
}

/// (7): solution (1, 0, 0).
pub fn helical_valley() -> Classic {
    Classic::new(
        &[-1.0, 0.0, 0.0],
        |x, f| {
            let turn = (x[1] / x[0]).atan() / TAU + if x[0] < 0.0 { 0.5 } else { 0.0 };
            f.copy_from_slice(&[10.0 * (x[2] - 10.0 * turn), 10.0 * (x[0].hypot(x[1]) - 1.0), x[2]]);
            Ok(())
        },
        |x, jacobian| {
            let (radius, square) = (x[0].hypot(x[1]), x[0] * x[0] + x[1] * x[1]);
            let (turn_a, turn_b) = (-x[1] / square / TAU, x[0] / square / TAU);
            rows(jacobian, [[-100.0 * turn_a, -100.0 * turn_b, 10.0], [10.0 * x[0] / radius, 10.0 * x[1] / radius, 0.0], [0.0, 0.0, 1.0]]);
        },
    )
}

/// (13): solution 0, where the Jacobian is singular.
pub fn powell_singular() -> Classic {
    Classic::new(
        &[3.0, -1.0, 0.0, 1.0],
        |x, f| {
            let (p, q) = (x[1] - 2.0 * x[2], x[0] - x[3]);
            f.copy_from_slice(&[x[0] + 10.0 * x[1], 5f64.sqrt() * (x[2] - x[3]), p * p, 10f64.sqrt() * q * q]);
            Ok(())
        },
        |x, jacobian| {
            let (p, q) = (2.0 * (x[1] - 2.0 * x[2]), 10f64.sqrt() * 2.0 * (x[0] - x[3]));
            let root = 5f64.sqrt();
            rows(jacobian, [[1.0, 10.0, 0.0, 0.0], [0.0, 0.0, root, -root], [0.0, p, -2.0 * p, 0.0], [q, 0.0, 0.0, -q]]);
        },
    )
}

/// (27) with ten unknowns: solutions (α, …, α, α⁻⁹) with 10 α¹⁰ − 11 α⁹ + 1 = 0.
pub fn brown_almost_linear() -> Classic {
    Classic::new(
        &[0.5; 10],
        |x, f| {
            let sum: f64 = x.iter().sum();
            for (f, x) in f.iter_mut().zip(x) {
                *f = x + sum - 11.0;
            }
            f[9] = x.iter().product::<f64>() - 1.0;
            Ok(())
        },
        |x, jacobian| {
            for j in 0..10 {
                for i in 0..9 {
                    jacobian[(i, j)] = if i == j { 2.0 } else { 1.0 };
                }
                jacobian[(9, j)] = x.iter().enumerate().filter(|(k, _)| *k != j).map(|(_, x)| x).product();
            }
        },
    )
}

/// (30) with twenty unknowns; the start is −1 everywhere.
pub fn broyden_tridiagonal() -> Classic {
    Classic::new(
        &[-1.0; 20],
        |x, f| {
            let at = |i: usize| x.get(i).copied().unwrap_or(0.0);
            for (i, f) in f.iter_mut().enumerate() {
                *f = (3.0 - 2.0 * x[i]) * x[i] - at(i.wrapping_sub(1)) - 2.0 * at(i + 1) + 1.0;
            }
            Ok(())
        },
        |x, jacobian| {
            for i in 0..x.len() {
                jacobian[(i, i)] = 3.0 - 4.0 * x[i];
                if i > 0 {
                    jacobian[(i, i - 1)] = -1.0;
                }
                if i + 1 < x.len() {
                    jacobian[(i, i + 1)] = -2.0;
                }
            }
        },
    )
}

/// ln x = 1, not a number below zero, where the first full step from 10 lands; solution e.
pub fn logarithm() -> Classic {
    Classic::new(
        &[10.0],
        |x, f| {
            f[0] = x[0].ln() - 1.0;
            Ok(())
        },
        |x, jacobian| rows(jacobian, [[1.0 / x[0]]]),
    )
}

/// (x − 1)(x + 3)(x − 2) = 0; the first full step from 1.5 lands on −3.
pub fn cubic() -> Classic {
    Classic::new(
        &[1.5],
        |x, f| {
            f[0] = (x[0] - 1.0) * (x[0] + 3.0) * (x[0] - 2.0);
            Ok(())
        },
        |x, jacobian| rows(jacobian, [[3.0 * x[0] * x[0] - 7.0]]),
    )
}

/// x + 1 = 0 with x ≥ 0.
pub fn root_behind_the_bound() -> Classic {
    line(&[1.0]).bounded(&[Bound::NonNegative])
}

/// x + 1 = 0 with x > 0, from a start at −2.
pub fn start_outside_the_bound() -> Classic {
    line(&[-2.0]).bounded(&[Bound::Positive])
}

fn line(start: &[f64]) -> Classic {
    Classic::new(
        start,
        |x, f| {
            f[0] = x[0] + 1.0;
            Ok(())
        },
        |_, jacobian| rows(jacobian, [[1.0]]),
    )
}

/// x² + 1 = 0: no real solution, |f| is smallest at 0.
pub fn no_real_root() -> Classic {
    Classic::new(
        &[3.0],
        |x, f| {
            f[0] = x[0] * x[0] + 1.0;
            Ok(())
        },
        |x, jacobian| rows(jacobian, [[2.0 * x[0]]]),
    )
}

/// Two parallel lines.
pub fn parallel_lines() -> Classic {
    Classic::new(
        &[0.0, 0.0],
        |x, f| {
            f.copy_from_slice(&[x[0] + x[1] - 1.0, x[0] + x[1] - 2.0]);
            Ok(())
        },
        |_, jacobian| rows(jacobian, [[1.0, 1.0], [1.0, 1.0]]),
    )
}

/// Not a number at the start, in the second equation.
pub fn undefined_at_the_start() -> Classic {
    Classic::new(
        &[1.0, -1.0],
        |x, f| {
            f.copy_from_slice(&[x[0], x[1].sqrt()]);
            Ok(())
        },
        |x, jacobian| rows(jacobian, [[1.0, 0.0], [0.0, 0.5 / x[1].sqrt()]]),
    )
}

/// x = 1 whose evaluation breaks down for good once x has moved from 0.
pub fn broken_away_from_the_start() -> Classic {
    Classic::new(
        &[0.0],
        |x, f| {
            f[0] = x[0] - 1.0;
            if x[0] == 0.0 { Ok(()) } else { Err(EvalError::Fatal { equation: 0 }) }
        },
        |_, jacobian| rows(jacobian, [[1.0]]),
    )
}

/// x = 1 whose evaluation panics once x has moved from 0.
pub fn panics_away_from_the_start() -> Classic {
    Classic::new(
        &[0.0],
        |x, f| {
            f[0] = x[0] - 1.0;
            assert!(x[0] == 0.0, "the law has no value here");
            Ok(())
        },
        |_, jacobian| rows(jacobian, [[1.0]]),
    )
}
