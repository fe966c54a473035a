//! Dense matrices and the LU solver that belongs to them.

use super::context::Context;
use super::index;
use super::vector::Vector;
use std::slice;
use sundials_sys::{
    SUNDenseMatrix, SUNDenseMatrix_Data, SUNDenseMatrix_LData, SUNLinSol_Dense, SUNLinSolFree, SUNLinSolInitialize, SUNLinSolSetup,
    SUNLinSolSolve, SUNLinearSolver, SUNMatDestroy, SUNMatrix,
};

/// Owner of one square dense `SUNMatrix` and of its LU solver.
pub struct DenseSolver {
    matrix: SUNMatrix,
    solver: SUNLinearSolver,
    _context: Context,
}

impl DenseSolver {
    /// Matrix and LU solver for systems of the size of `template`.
    pub fn new(context: &Context, template: &Vector) -> Self {
        let size = index(template.as_slice().len());
        // SAFETY: context and template are alive; the solver copies neither and is dropped before the context.
        unsafe {
            let matrix = SUNDenseMatrix(size, size, context.raw());
            assert!(!matrix.is_null(), "out of memory while creating a SUNDIALS matrix");
            let solver = SUNLinSol_Dense(template.raw(), matrix, context.raw());
            assert!(!solver.is_null(), "out of memory while creating a SUNDIALS linear solver");
            Self { matrix, solver, _context: context.clone() }
        }
    }

    /// The handle of the matrix for calls into the library.
    pub fn matrix(&self) -> SUNMatrix {
        self.matrix
    }

    /// The handle of the solver for calls into the library.
    pub fn solver(&self) -> SUNLinearSolver {
        self.solver
    }
}

impl Drop for DenseSolver {
    fn drop(&mut self) {
        // SAFETY: created above and freed once, the solver before its matrix; the context is still alive.
        unsafe {
            SUNLinSolFree(self.solver);
            SUNMatDestroy(self.matrix);
        }
    }
}

/// A matrix, its LU factors and vectors to solve with.
pub struct Factors {
    dense: DenseSolver,
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
        let dense = DenseSolver::new(&context, &x);
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
