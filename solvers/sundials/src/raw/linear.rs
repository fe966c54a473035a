//! Linear solvers: LU of a dense matrix, and the generalized minimal residual method, which needs products alone and may be preconditioned.
//!
//! Source of the second: Y. Saad, M. H. Schultz, *GMRES: a generalized minimal residual algorithm for solving nonsymmetric linear systems*,
//! SIAM J. Sci. Stat. Comput. 7, 1986, 856–869.

use super::context::Context;
use super::index;
use super::vector::Vector;
use problem::LinearSolver;
use std::ffi::c_int;
use std::{ptr, slice};
use sundials_sys::{
    SUN_PREC_LEFT, SUN_PREC_NONE, SUN_PREC_RIGHT, SUNDenseMatrix, SUNDenseMatrix_Data, SUNDenseMatrix_LData, SUNLinSol_Dense,
    SUNLinSol_SPGMR, SUNLinSol_SPGMRSetMaxRestarts, SUNLinSolFree, SUNLinSolInitialize, SUNLinSolSetup, SUNLinSolSolve, SUNLinearSolver,
    SUNMatDestroy, SUNMatrix,
};

/// Largest dimension of a Krylov subspace. Where it is that of the problem, only rounding keeps the method from ending in it.
const SUBSPACE: usize = 100;
/// How often the method may begin anew from where it came to.
const RESTARTS: c_int = 10;

/// Whether GMRES works on P⁻¹ A or on A P⁻¹ instead of A.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preconditioned {
    /// It does not.
    No,
    /// P⁻¹ A: residuals are measured in units of the unknowns.
    Left,
    /// A P⁻¹: residuals stay those of the equations.
    Right,
}

/// Owner of one linear solver, and of the dense matrix that it factorizes where it is a direct one.
pub struct Linear {
    kind: LinearSolver,
    /// Null where there is none.
    matrix: SUNMatrix,
    solver: SUNLinearSolver,
    _context: Context,
}

impl Linear {
    /// For systems of the size of `template`.
    pub fn new(kind: LinearSolver, preconditioned: Preconditioned, context: &Context, template: &Vector) -> Self {
        let size = template.as_slice().len();
        // SAFETY: context and template are alive; the solver copies neither and is dropped before the context.
        unsafe {
            let (matrix, solver) = match kind {
                LinearSolver::Direct => {
                    let matrix = SUNDenseMatrix(index(size), index(size), context.raw());
                    assert!(!matrix.is_null(), "out of memory while creating a SUNDIALS matrix");
                    (matrix, SUNLinSol_Dense(template.raw(), matrix, context.raw()))
                }
                LinearSolver::Gmres => {
                    let side = match preconditioned {
                        Preconditioned::No => SUN_PREC_NONE,
                        Preconditioned::Left => SUN_PREC_LEFT,
                        Preconditioned::Right => SUN_PREC_RIGHT,
                    };
                    let subspace = c_int::try_from(size.min(SUBSPACE)).unwrap_or(c_int::MAX);
                    (ptr::null_mut(), SUNLinSol_SPGMR(template.raw(), side as c_int, subspace, context.raw()))
                }
            };
            assert!(!solver.is_null(), "out of memory while creating a SUNDIALS linear solver");
            if kind == LinearSolver::Gmres {
                SUNLinSol_SPGMRSetMaxRestarts(solver, RESTARTS);
            }
            Self { kind, matrix, solver, _context: context.clone() }
        }
    }

    /// Which one it is.
    pub fn kind(&self) -> LinearSolver {
        self.kind
    }

    /// The handle of the matrix for calls into the library; null where there is none.
    pub fn matrix(&self) -> SUNMatrix {
        self.matrix
    }

    /// The handle of the solver for calls into the library.
    pub fn solver(&self) -> SUNLinearSolver {
        self.solver
    }
}

impl Drop for Linear {
    fn drop(&mut self) {
        // SAFETY: created above and freed once, the solver before its matrix; the context is still alive.
        unsafe {
            SUNLinSolFree(self.solver);
            if !self.matrix.is_null() {
                SUNMatDestroy(self.matrix);
            }
        }
    }
}

/// A matrix, its LU factors and vectors to solve with.
pub struct Factors {
    dense: Linear,
    x: Vector,
    b: Vector,
}

// SAFETY: SUNDIALS ties nothing to a thread, and all clones of the context live in private fields of this one owner.
unsafe impl Send for Factors {}

impl Factors {
    /// For matrices of `size` rows, above zero.
    pub fn new(size: usize) -> Self {
        let context = Context::new();
        let (x, b) = (Vector::zeros(&context, size), Vector::zeros(&context, size));
        let dense = Linear::new(LinearSolver::Direct, Preconditioned::No, &context, &x);
        Self { dense, x, b }
    }

    /// Factorizes a matrix, column after column. False where it is singular.
    pub fn factorize(&mut self, matrix: &[f64]) -> bool {
        // SAFETY: matrix and solver are owned by self, and nobody else reads or writes the entries meanwhile.
        unsafe {
            matrix_entries_mut(self.dense.matrix()).copy_from_slice(matrix);
            SUNLinSolInitialize(self.dense.solver()) == 0 && SUNLinSolSetup(self.dense.solver(), self.dense.matrix()) == 0
        }
    }

    /// Replaces b by the solution of A x = b.
    pub fn solve(&mut self, b: &mut [f64]) {
        self.b.as_mut_slice().copy_from_slice(b);
        // SAFETY: all handles are owned by self; a direct solver reads no tolerance.
        unsafe { SUNLinSolSolve(self.dense.solver(), self.dense.matrix(), self.x.raw(), self.b.raw(), 0.0) };
        b.copy_from_slice(self.x.as_slice());
    }
}

/// The entries of a matrix that the library owns, column after column.
///
/// # Safety
/// `matrix` must be a dense matrix that nobody else reads or writes during `'a`.
pub unsafe fn matrix_entries_mut<'a>(matrix: SUNMatrix) -> &'a mut [f64] {
    // SAFETY: a dense matrix stores `LData` contiguous numbers; exclusive by the caller's promise.
    unsafe { slice::from_raw_parts_mut(SUNDenseMatrix_Data(matrix), usize::try_from(SUNDenseMatrix_LData(matrix)).unwrap_or(0)) }
}
