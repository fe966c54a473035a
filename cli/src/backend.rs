//! Solver backends by name: one row each.

use problem::{AlgebraicMethod, DaeMethod, LinearSolver, OdeMethod};

/// A backend for algebraic systems.
#[derive(Clone, Copy)]
pub struct AlgebraicBackend {
    /// Name after `--backend`.
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// Makes one; each task has its own.
    pub make: fn() -> Box<dyn AlgebraicMethod>,
}

/// The backends; the first is the default.
pub const ALGEBRAIC: &[AlgebraicBackend] = &[
    AlgebraicBackend {
        name: "kinsol",
        about: "SUNDIALS KINSOL: Newton with line search",
        make: || Box::new(sundials::Kinsol::new(sundials::Strategy::LineSearch)),
    },
    AlgebraicBackend {
        name: "newton",
        about: "damped Newton of this project, without calls to C",
        make: || Box::new(native::Newton::new()),
    },
    AlgebraicBackend {
        name: "newton_simplified",
        about: "the same with matrices that are kept while they lead on fast",
        make: || Box::new(native::Newton::simplified()),
    },
    AlgebraicBackend {
        name: "kinsol_newton",
        about: "SUNDIALS KINSOL: full Newton steps",
        make: || Box::new(sundials::Kinsol::new(sundials::Strategy::FullStep)),
    },
    AlgebraicBackend {
        name: "kinsol_gmres",
        about: "SUNDIALS KINSOL: Newton–Krylov with line search, products with the exact derivative, matrices renewed every ten iterations as preconditioners",
        make: || Box::new(sundials::Kinsol::new(sundials::Strategy::Krylov)),
    },
    AlgebraicBackend {
        name: "kinsol_picard",
        about: "SUNDIALS KINSOL: Picard iteration with Anderson acceleration, matrices renewed every ten iterations",
        make: || Box::new(sundials::Kinsol::new(sundials::Strategy::Picard)),
    },
    AlgebraicBackend {
        name: "kinsol_fixed_point",
        about: "SUNDIALS KINSOL: fixed-point iteration with the matrix of the start and Anderson acceleration",
        make: || Box::new(sundials::Kinsol::new(sundials::Strategy::FixedPoint)),
    },
];

/// The backend with this name.
pub fn algebraic(name: &str) -> Option<&'static AlgebraicBackend> {
    ALGEBRAIC.iter().find(|b| b.name == name)
}

/// Makes an integrator of either problem form; each task has its own.
#[derive(Clone, Copy)]
pub enum Integrator {
    /// Takes the implicit form, in a formulation of the constraints.
    Implicit(fn() -> Box<dyn DaeMethod>),
    /// Takes the explicit form, projected after each step.
    Explicit(fn() -> Box<dyn OdeMethod>),
}

/// A backend for integration in time.
#[derive(Clone, Copy)]
pub struct IntegrationBackend {
    /// Name after `--backend`.
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// Makes one.
    pub make: Integrator,
    /// What may solve the linear equations of its steps, the first where nobody says otherwise; none where it has no such equations. Their
    /// matrices or products may be exact or difference quotients.
    pub linear_solvers: &'static [LinearSolver],
    /// Who decides how long steps are.
    pub steps: Steps,
}

/// Who decides how long the steps of a method are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Steps {
    /// The tolerance.
    Variable,
    /// The user: all are alike.
    Fixed,
}

/// For methods without linear equations.
const NONE: &[LinearSolver] = &[];
/// For methods that factorize matrices.
const DIRECT: &[LinearSolver] = &[LinearSolver::Direct];
/// For methods that can do without.
const EITHER: &[LinearSolver] = &[LinearSolver::Direct, LinearSolver::Gmres];

/// The integrators; the first is the default.
pub const INTEGRATION: &[IntegrationBackend] = &[
    IntegrationBackend {
        name: "ida",
        about: "SUNDIALS IDA: BDF of variable order, implicit form",
        make: Integrator::Implicit(|| Box::new(sundials::Ida::default())),
        linear_solvers: EITHER,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "erk",
        about: "SUNDIALS ARKODE: explicit Runge–Kutta of order 8, explicit form with projection",
        make: Integrator::Explicit(|| Box::new(sundials::RungeKutta::explicit())),
        linear_solvers: NONE,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "dirk",
        about: "SUNDIALS ARKODE: diagonally implicit Runge–Kutta of order 5, explicit form with projection",
        make: Integrator::Explicit(|| Box::new(sundials::RungeKutta::implicit())),
        linear_solvers: EITHER,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "cvode",
        about: "SUNDIALS CVODE: BDF of variable order, explicit form with projection",
        make: Integrator::Explicit(|| Box::new(sundials::Cvode::bdf())),
        linear_solvers: EITHER,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "cvode_adams",
        about: "SUNDIALS CVODE: Adams formulas of variable order, explicit form",
        make: Integrator::Explicit(|| Box::new(sundials::Cvode::adams())),
        linear_solvers: NONE,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "generalized_alpha",
        about: "generalized-α of this project, order 2, a fifth of the fastest oscillations damped away per step, implicit form",
        make: Integrator::Implicit(|| Box::new(native::GeneralizedAlpha::new(0.8))),
        linear_solvers: DIRECT,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "dopri5",
        about: "Dormand and Prince's pair of orders 5 and 4 of this project, explicit form with projection",
        make: Integrator::Explicit(|| Box::<native::DormandPrince>::default()),
        linear_solvers: NONE,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "ros2",
        about: "linearly implicit method of order 2 of this project with steps of one length (`--step`), for simulators",
        make: Integrator::Explicit(|| Box::new(native::Rosenbrock::second_order())),
        linear_solvers: DIRECT,
        steps: Steps::Fixed,
    },
    IntegrationBackend {
        name: "linear_euler",
        about: "linearly implicit Euler method of this project with steps of one length (`--step`), for simulators",
        make: Integrator::Explicit(|| Box::new(native::Rosenbrock::euler())),
        linear_solvers: DIRECT,
        steps: Steps::Fixed,
    },
    IntegrationBackend {
        name: "diffsol_bdf",
        about: "diffsol: BDF of variable order in Rust, explicit form",
        make: Integrator::Explicit(|| Box::new(native::Diffsol::bdf())),
        linear_solvers: DIRECT,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "diffsol_esdirk34",
        about: "diffsol: diagonally implicit Runge–Kutta of order 4, explicit form",
        make: Integrator::Explicit(|| Box::new(native::Diffsol::esdirk34())),
        linear_solvers: DIRECT,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "diffsol_tsit45",
        about: "diffsol: explicit Runge–Kutta pair of Tsitouras of order 5, explicit form",
        make: Integrator::Explicit(|| Box::new(native::Diffsol::tsit45())),
        linear_solvers: NONE,
        steps: Steps::Variable,
    },
];

/// The integrator with this name.
pub fn integration(name: &str) -> Option<&'static IntegrationBackend> {
    INTEGRATION.iter().find(|b| b.name == name)
}
