//! Dense matrices and the LU solver that belongs to them.

use super::context::Context;
use super::index;
use super::vector::Vector;
use std::slice;
use sundials_sys::{
    SUNDenseMatrix, SUNDenseMatrix_Data, SUNDenseMatrix_LData, SUNLinSol_Dense, SUNLinSolFree, SUNLinearSolver, SUNMatDestroy, SUNMatrix,
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

/// The entries of a matrix that the library owns, column after column.
///
/// # Safety
/// `matrix` must be a dense matrix that nobody else reads or writes during `'a`.
pub unsafe fn matrix_entries_mut<'a>(matrix: SUNMatrix) -> &'a mut [f64] {
    // SAFETY: a dense matrix stores `LData` contiguous numbers; exclusive by the caller's promise.
    unsafe { slice::from_raw_parts_mut(SUNDenseMatrix_Data(matrix), usize::try_from(SUNDenseMatrix_LData(matrix)).unwrap_or(0)) }
}
