//! Systems of equations with published starts and solutions, and what every method must do with them.
//!
//! Numbers in brackets are those of J. J. Moré, B. S. Garbow, K. E. Hillstrom, “Testing unconstrained optimization software”,
//! ACM Transactions on Mathematical Software 7 (1981) 17–41, which states functions, starts and solutions.

mod systems;

use problem::{AlgebraicEnding, AlgebraicMethod, AlgebraicOptions, AlgebraicOutcome, AlgebraicProblem, Bound, Effort, EvalError, Matrix};
pub use systems::*;

type Function = fn(&[f64], &mut [f64]) -> Result<(), EvalError>;
type Derivative = fn(&[f64], &mut Matrix);

/// A system given by plain functions, that counts how often it is asked.
#[derive(Clone)]
pub struct Classic {
    function: Function,
    derivative: Derivative,
    start: Vec<f64>,
    unknown_scale: Vec<f64>,
    equation_scale: Vec<f64>,
    bounds: Vec<Bound>,
    residuals: usize,
    jacobians: usize,
    products: usize,
}

impl Classic {
    fn new(start: &[f64], function: Function, derivative: Derivative) -> Self {
        let ones = vec![1.0; start.len()];
        let (unknown_scale, equation_scale) = (ones.clone(), ones);
        Self {
            function,
            derivative,
            start: start.to_vec(),
            unknown_scale,
            equation_scale,
            bounds: Vec::new(),
            residuals: 0,
            jacobians: 0,
            products: 0,
        }
    }

    fn scaled(mut self, unknowns: &[f64], equations: &[f64]) -> Self {
        self.unknown_scale = unknowns.to_vec();
        self.equation_scale = equations.to_vec();
        self
    }

    fn bounded(mut self, bounds: &[Bound]) -> Self {
        self.bounds = bounds.to_vec();
        self
    }

    /// The published start.
    pub fn start(&self) -> Vec<f64> {
        self.start.clone()
    }

    /// Solves from the start and checks that the report tells the truth about the point that is left.
    pub fn solve(mut self, method: &mut dyn AlgebraicMethod, options: &AlgebraicOptions) -> (AlgebraicOutcome, Vec<f64>) {
        let mut x = self.start();
        let outcome = method.solve(&mut self, &mut x, options);
        let Effort { residuals, jacobians, products, .. } = outcome.effort;
        assert_eq!((residuals, jacobians, products), (self.residuals, self.jacobians, self.products), "{outcome:?}");
        let mut f = vec![0.0; x.len()];
        if self.residual(&x, &mut f).is_ok() && f.iter().all(|f| f.is_finite()) {
            let residual = f.iter().zip(&self.equation_scale).map(|(f, scale)| f.abs() / scale).fold(0.0, f64::max);
            assert!((outcome.residual - residual).abs() <= 1e-12 * residual, "reported {}, found {residual}", outcome.residual);
        }
        assert!(!outcome.converged() || outcome.residual <= options.residual_tolerance, "{outcome:?}");
        (outcome, x)
    }
}

impl AlgebraicProblem for Classic {
    fn size(&self) -> usize {
        self.start.len()
    }
    fn unknown_scale(&self) -> &[f64] {
        &self.unknown_scale
    }
    fn equation_scale(&self) -> &[f64] {
        &self.equation_scale
    }
    fn bounds(&self) -> &[Bound] {
        &self.bounds
    }
    fn residual(&mut self, x: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.residuals += 1;
        (self.function)(x, f)
    }
    fn jacobian(&mut self, x: &[f64], f: &mut [f64], jacobian: &mut Matrix) -> Result<(), EvalError> {
        self.jacobians += 1;
        (self.function)(x, f)?;
        jacobian.fill(0.0);
        (self.derivative)(x, jacobian);
        Ok(())
    }
    fn product(&mut self, x: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), EvalError> {
        self.products += 1;
        let mut jacobian = Matrix::zeros(v.len(), v.len());
        (self.function)(x, product)?;
        (self.derivative)(x, &mut jacobian);
        jacobian.times(v, product);
        Ok(())
    }
}

fn close(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value} is not {expected} within {tolerance}");
}

fn solution_of(name: &str, system: Classic, method: &mut dyn AlgebraicMethod) -> Vec<f64> {
    let (outcome, x) = system.solve(method, &AlgebraicOptions::default());
    assert!(outcome.converged(), "{name}: {outcome:?} at {x:?}");
    x
}

/// How a system ends, and where.
pub fn ending_of(system: Classic, method: &mut dyn AlgebraicMethod) -> (AlgebraicEnding, Vec<f64>) {
    let (outcome, x) = system.solve(method, &AlgebraicOptions::default());
    (outcome.ending, x)
}

/// Published solutions are reached by one and the same solver, whatever sizes and bounds came before.
pub fn published_solutions_are_reached(method: &mut dyn AlgebraicMethod) {
    for _ in 0..2 {
        for x in solution_of("Rosenbrock (1)", rosenbrock(), method) {
            close(x, 1.0, 1e-8);
        }
        let x = solution_of("Powell badly scaled (3)", powell_badly_scaled(), method);
        // printed with four digits
        close(x[0], 1.098e-5, 0.5e-8);
        close(x[1], 9.106, 0.5e-3);
        for (x, solution) in solution_of("helical valley (7)", helical_valley(), method).iter().zip([1.0, 0.0, 0.0]) {
            close(*x, solution, 1e-8);
        }
        // f grows with the square of x here, so a residual of 1e-9 holds x to about its square root
        for x in solution_of("Powell singular (13)", powell_singular(), method) {
            close(x, 0.0, 1e-4);
        }
        solution_of("Broyden tridiagonal (30)", broyden_tridiagonal(), method);
        let x = solution_of("Brown almost-linear (27)", brown_almost_linear(), method);
        // the two real roots of 10 α¹⁰ − 11 α⁹ + 1 are close to each other, so the polynomial is flat between them
        close(10.0 * x[0].powi(10) - 11.0 * x[0].powi(9) + 1.0, 0.0, 1e-7);
        close(x[9], x[0].powi(-9), 1e-6);
    }
}

/// A full step into a region without value is shortened.
pub fn undefined_regions_are_left(method: &mut dyn AlgebraicMethod) {
    close(solution_of("logarithm", logarithm(), method)[0], std::f64::consts::E, 1e-8);
}

/// Scales make units disappear: the same iterations as with units of one, to the same point.
pub fn units_do_not_matter(method: &mut dyn AlgebraicMethod) {
    let options = AlgebraicOptions::default();
    let (plain, _) = rosenbrock().solve(method, &options);
    let (scaled, x) = rosenbrock_in_other_units().solve(method, &options);
    assert!(scaled.converged());
    assert_eq!((plain.effort.iterations, plain.effort.residuals), (scaled.effort.iterations, scaled.effort.residuals));
    close(x[0], 1e-6, 1e-14);
    close(x[1], 1e9, 10.0);
}

/// Bounds keep the iteration on their side, also right after a problem without bounds and before one.
pub fn bounds_are_respected(method: &mut dyn AlgebraicMethod) {
    close(solution_of("cubic", cubic(), method)[0], -3.0, 1e-8);
    close(solution_of("bounded cubic", cubic().bounded(&[Bound::NonNegative]), method)[0], 1.0, 1e-8);
    close(solution_of("cubic again", cubic(), method)[0], -3.0, 1e-8);
    let (ending, x) = ending_of(root_behind_the_bound(), method);
    assert!(matches!(ending, AlgebraicEnding::NoDecrease | AlgebraicEnding::Stalled), "{ending:?} at {x:?}");
    assert!(x[0] >= 0.0);
    assert_eq!(ending_of(start_outside_the_bound(), method), (AlgebraicEnding::NoDecrease, vec![-2.0]));
}

/// What cannot be solved ends with its reason.
pub fn failures_are_named(method: &mut dyn AlgebraicMethod) {
    assert_eq!(ending_of(parallel_lines(), method).0, AlgebraicEnding::Singular);
    let start = ending_of(undefined_at_the_start(), method);
    assert_eq!(start, (AlgebraicEnding::Evaluation(EvalError::Recoverable { equation: 1 }), vec![1.0, -1.0]));
    let broken = ending_of(broken_away_from_the_start(), method);
    assert_eq!(broken, (AlgebraicEnding::Evaluation(EvalError::Fatal { equation: 0 }), vec![0.0]));
    let hurried = AlgebraicOptions { max_iterations: 2, ..AlgebraicOptions::default() };
    let (outcome, _) = powell_badly_scaled().solve(method, &hurried);
    assert_eq!((outcome.ending, outcome.effort.iterations), (AlgebraicEnding::MaxIterations, 2));
}

/// A local minimum of ‖f‖ is not taken for a solution.
pub fn local_minima_are_no_solutions(method: &mut dyn AlgebraicMethod) {
    for system in [freudenstein_roth(), no_real_root()] {
        let (ending, x) = ending_of(system, method);
        assert!(!matches!(ending, AlgebraicEnding::Converged | AlgebraicEnding::Evaluation(_)), "{ending:?} at {x:?}");
    }
}

/// The Jacobians above are those of the functions above, by central differences.
pub fn derivatives_fit_their_functions() {
    let systems = [rosenbrock(), freudenstein_roth(), powell_badly_scaled(), helical_valley(), powell_singular()];
    let more = [brown_almost_linear(), broyden_tridiagonal(), logarithm(), cubic(), rosenbrock_in_other_units()];
    for mut system in systems.into_iter().chain(more) {
        let size = system.size();
        let mut jacobian = Matrix::zeros(size, size);
        let (mut above, mut below) = (vec![0.0; size], vec![0.0; size]);
        // beside the start: some of these have a kink or a singular Jacobian exactly there
        let x: Vec<f64> = system.start().iter().zip(system.unknown_scale.clone()).map(|(x, scale)| x + 0.1 * scale).collect();
        system.jacobian(&x, &mut above, &mut jacobian).unwrap();
        for j in 0..size {
            let difference = 1e-6 * system.unknown_scale[j];
            let beside = |sign: f64| x.iter().enumerate().map(|(i, x)| if i == j { x + sign * difference } else { *x }).collect::<Vec<_>>();
            system.residual(&beside(1.0), &mut above).unwrap();
            system.residual(&beside(-1.0), &mut below).unwrap();
            for i in 0..size {
                let (slope, unit) = ((above[i] - below[i]) / (2.0 * difference), system.equation_scale[i] / system.unknown_scale[j]);
                // central differences with this step: truncation and rounding both below 1e-7 of values up to 1e4
                close(jacobian[(i, j)] / unit, slope / unit, 1e-5 * (1.0 + (slope / unit).abs()));
            }
        }
    }
}
