//! Solver backends by name: one row each.

use problem::AlgebraicMethod;

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
];

/// The backend with this name.
pub fn algebraic(name: &str) -> Option<&'static AlgebraicBackend> {
    ALGEBRAIC.iter().find(|b| b.name == name)
}
