//! Textbook methods with steps of one length, to test the service without any solver package.

use problem::{
    DaeMethod, DaeProblem, EvalError, Flow, IntegrationEnding, IntegrationOptions, IntegrationOutcome, Matrix, OdeMethod, OdeProblem, Sink,
};

fn outcome(time: f64) -> IntegrationOutcome {
    IntegrationOutcome {
        ending: IntegrationEnding::Finished,
        time,
        steps: 0,
        rejected: 0,
        convergence_failures: 0,
        residuals: 0,
        jacobians: 0,
        products: 0,
        iterations: 0,
    }
}

/// Number and length of the steps of at most `longest` from one time to another.
fn steps(from: f64, to: f64, longest: f64) -> (usize, f64) {
    let count = ((to - from) / longest - 1e-9).ceil().max(1.0);
    (count as usize, (to - from) / count)
}

/// The classical method of Runge and Kutta, of fourth order.
pub struct RungeKutta {
    /// Longest step, s.
    pub step: f64,
}

impl RungeKutta {
    fn step(problem: &mut dyn OdeProblem, t: f64, h: f64, y: &mut [f64], [k, stage, sum]: &mut [Vec<f64>; 3]) -> Result<(), EvalError> {
        sum.copy_from_slice(y);
        stage.copy_from_slice(y);
        for (at, weight) in [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
            if at > 0.0 {
                stage.iter_mut().zip(&*y).zip(&*k).for_each(|((s, y), k)| *s = y + at * h * k);
            }
            problem.rates(t + at * h, stage, k)?;
            sum.iter_mut().zip(&*k).for_each(|(s, k)| *s += h / 6.0 * weight * k);
        }
        problem.project(t + h, sum)?;
        y.copy_from_slice(sum);
        Ok(())
    }
}

impl OdeMethod for RungeKutta {
    fn name(&self) -> &'static str {
        "runge_kutta"
    }
    fn integrate(
        &mut self,
        problem: &mut dyn OdeProblem,
        times: &[f64],
        y: &mut [f64],
        options: &IntegrationOptions,
        sink: Sink<'_>,
    ) -> IntegrationOutcome {
        let mut out = outcome(times[0]);
        let mut work = [(); 3].map(|()| vec![0.0; y.len()]);
        let mut yd = vec![0.0; y.len()];
        for (k, &time) in times.iter().enumerate() {
            let from = out.time;
            let (count, h) = if k == 0 { (0, 0.0) } else { steps(from, time, self.step) };
            for i in 0..count {
                if i == options.max_steps {
                    return IntegrationOutcome { ending: IntegrationEnding::TooManySteps, ..out };
                }
                if let Err(e) = Self::step(problem, out.time, h, y, &mut work) {
                    return IntegrationOutcome { ending: IntegrationEnding::Evaluation(e), ..out };
                }
                (out.steps, out.residuals, out.time) = (out.steps + 1, out.residuals + 4, from + (i + 1) as f64 * h);
            }
            out.time = time;
            if let Err(e) = problem.rates(time, y, &mut yd) {
                return IntegrationOutcome { ending: IntegrationEnding::Evaluation(e), ..out };
            }
            if sink(time, y, &yd) == Flow::Stop {
                return IntegrationOutcome { ending: IntegrationEnding::Stopped, ..out };
            }
        }
        out
    }
}

/// Implicit Euler: ẏ = (y − y₀)/h, of first order.
pub struct ImplicitEuler {
    /// Longest step, s.
    pub step: f64,
}

/// Work arrays of a step.
struct Work {
    matrix: Matrix,
    f: Vec<f64>,
    y: Vec<f64>,
    yd: Vec<f64>,
}

impl ImplicitEuler {
    fn step(problem: &mut dyn DaeProblem, t: f64, h: f64, start: &[f64], w: &mut Work) -> Result<usize, IntegrationEnding> {
        w.y.copy_from_slice(start);
        for iteration in 1..=12 {
            for (yd, (y, y0)) in w.yd.iter_mut().zip(w.y.iter().zip(start)) {
                *yd = (y - y0) / h;
            }
            problem.residual(t + h, &w.y, &w.yd, &mut w.f).map_err(IntegrationEnding::Evaluation)?;
            problem.jacobian(t + h, 1.0 / h, &w.y, &w.yd, &mut w.matrix).map_err(IntegrationEnding::Evaluation)?;
            if !eliminate(&mut w.matrix, &mut w.f) {
                return Err(IntegrationEnding::Singular);
            }
            w.y.iter_mut().zip(&w.f).for_each(|(y, d)| *y -= d);
            if w.f.iter().all(|d| d.abs() < 1e-11) {
                for (yd, (y, y0)) in w.yd.iter_mut().zip(w.y.iter().zip(start)) {
                    *yd = (y - y0) / h;
                }
                return Ok(iteration);
            }
        }
        Err(IntegrationEnding::Convergence)
    }
}

/// Gaussian elimination with row pivoting, in place; false where the matrix is singular.
fn eliminate(a: &mut Matrix, b: &mut [f64]) -> bool {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[(i, k)].abs().total_cmp(&a[(j, k)].abs())).unwrap_or(k);
        if a[(pivot, k)].abs() < 1e-10 {
            return false;
        }
        for j in 0..n {
            (a[(k, j)], a[(pivot, j)]) = (a[(pivot, j)], a[(k, j)]);
        }
        b.swap(k, pivot);
        for i in k + 1..n {
            let factor = a[(i, k)] / a[(k, k)];
            for j in k..n {
                a[(i, j)] -= factor * a[(k, j)];
            }
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        let sum: f64 = (k + 1..n).map(|j| a[(k, j)] * b[j]).sum();
        b[k] = (b[k] - sum) / a[(k, k)];
    }
    true
}

impl DaeMethod for ImplicitEuler {
    fn name(&self) -> &'static str {
        "implicit_euler"
    }
    fn integrate(
        &mut self,
        problem: &mut dyn DaeProblem,
        times: &[f64],
        (y, yd): (&mut [f64], &mut [f64]),
        _options: &IntegrationOptions,
        sink: Sink<'_>,
    ) -> IntegrationOutcome {
        let n = y.len();
        let mut work = Work { matrix: Matrix::zeros(n, n), f: vec![0.0; n], y: vec![0.0; n], yd: vec![0.0; n] };
        let mut out = outcome(times[0]);
        for (k, &time) in times.iter().enumerate() {
            let from = out.time;
            let (count, h) = if k == 0 { (0, 0.0) } else { steps(from, time, self.step) };
            for i in 0..count {
                match Self::step(problem, out.time, h, y, &mut work) {
                    Ok(iterations) => out.iterations += iterations,
                    Err(ending) => return IntegrationOutcome { ending, ..out },
                }
                y.copy_from_slice(&work.y);
                yd.copy_from_slice(&work.yd);
                (out.steps, out.time) = (out.steps + 1, from + (i + 1) as f64 * h);
            }
            out.time = time;
            if sink(time, y, yd) == Flow::Stop {
                return IntegrationOutcome { ending: IntegrationEnding::Stopped, ..out };
            }
        }
        (out.residuals, out.jacobians) = (out.iterations, out.iterations);
        out
    }
}
