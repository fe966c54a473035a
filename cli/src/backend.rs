//! Solver backends by name: one row each.

use problem::{AlgebraicMethod, DaeMethod, OdeMethod};

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
    /// Whether it asks for matrices, which may be exact or difference quotients.
    pub matrices: bool,
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

/// The integrators; the first is the default.
pub const INTEGRATION: &[IntegrationBackend] = &[
    IntegrationBackend {
        name: "ida",
        about: "SUNDIALS IDA: BDF of variable order, implicit form",
        make: Integrator::Implicit(|| Box::new(sundials::Ida::default())),
        matrices: true,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "erk",
        about: "SUNDIALS ARKODE: explicit Runge–Kutta of order 8, explicit form with projection",
        make: Integrator::Explicit(|| Box::new(sundials::RungeKutta::explicit())),
        matrices: false,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "dirk",
        about: "SUNDIALS ARKODE: diagonally implicit Runge–Kutta of order 5, explicit form with projection",
        make: Integrator::Explicit(|| Box::new(sundials::RungeKutta::implicit())),
        matrices: true,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "cvode",
        about: "SUNDIALS CVODE: BDF of variable order, explicit form with projection",
        make: Integrator::Explicit(|| Box::new(sundials::Cvode::bdf())),
        matrices: true,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "cvode_adams",
        about: "SUNDIALS CVODE: Adams formulas of variable order, explicit form",
        make: Integrator::Explicit(|| Box::new(sundials::Cvode::adams())),
        matrices: false,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "generalized_alpha",
        about: "generalized-α of this project, order 2, a fifth of the fastest oscillations damped away per step, implicit form",
        make: Integrator::Implicit(|| Box::new(native::GeneralizedAlpha::new(0.8))),
        matrices: true,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "dopri5",
        about: "Dormand and Prince's pair of orders 5 and 4 of this project, explicit form with projection",
        make: Integrator::Explicit(|| Box::<native::DormandPrince>::default()),
        matrices: false,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "ros2",
        about: "linearly implicit method of order 2 of this project with steps of one length (`--step`), for simulators",
        make: Integrator::Explicit(|| Box::new(native::Rosenbrock::second_order())),
        matrices: true,
        steps: Steps::Fixed,
    },
    IntegrationBackend {
        name: "linear_euler",
        about: "linearly implicit Euler method of this project with steps of one length (`--step`), for simulators",
        make: Integrator::Explicit(|| Box::new(native::Rosenbrock::euler())),
        matrices: true,
        steps: Steps::Fixed,
    },
    IntegrationBackend {
        name: "diffsol_bdf",
        about: "diffsol: BDF of variable order in Rust, explicit form",
        make: Integrator::Explicit(|| Box::new(native::Diffsol::bdf())),
        matrices: true,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "diffsol_esdirk34",
        about: "diffsol: diagonally implicit Runge–Kutta of order 4, explicit form",
        make: Integrator::Explicit(|| Box::new(native::Diffsol::esdirk34())),
        matrices: true,
        steps: Steps::Variable,
    },
    IntegrationBackend {
        name: "diffsol_tsit45",
        about: "diffsol: explicit Runge–Kutta pair of Tsitouras of order 5, explicit form",
        make: Integrator::Explicit(|| Box::new(native::Diffsol::tsit45())),
        matrices: false,
        steps: Steps::Variable,
    },
];

/// The integrator with this name.
pub fn integration(name: &str) -> Option<&'static IntegrationBackend> {
    INTEGRATION.iter().find(|b| b.name == name)
}
