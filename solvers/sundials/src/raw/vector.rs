//! Serial vectors.

use super::context::Context;
use super::index;
use std::slice;
use sundials_sys::{N_VDestroy, N_VGetArrayPointer, N_VGetLength, N_VNew_Serial, N_Vector};

/// Owner of one serial `N_Vector`.
pub struct Vector {
    raw: N_Vector,
    _context: Context,
}

impl Vector {
    /// A vector of zeros.
    pub fn zeros(context: &Context, size: usize) -> Self {
        // SAFETY: the context is alive and is kept alive by the clone in the result.
        let raw = unsafe { N_VNew_Serial(index(size), context.raw()) };
        assert!(!raw.is_null(), "out of memory while creating a SUNDIALS vector");
        let mut vector = Self { raw, _context: context.clone() };
        vector.as_mut_slice().fill(0.0);
        vector
    }

    /// The handle for calls into the library.
    pub fn raw(&self) -> N_Vector {
        self.raw
    }

    /// The entries.
    pub fn as_slice(&self) -> &[f64] {
        // SAFETY: a serial vector, owned, not written while borrowed.
        unsafe { entries(self.raw) }
    }

    /// The entries.
    pub fn as_mut_slice(&mut self) -> &mut [f64] {
        // SAFETY: a serial vector, owned, borrowed exclusively.
        unsafe { entries_mut(self.raw) }
    }
}

impl Drop for Vector {
    fn drop(&mut self) {
        // SAFETY: created by N_VNew_Serial and freed once; the context is still alive.
        unsafe { N_VDestroy(self.raw) }
    }
}

/// The entries of a vector that the library owns.
///
/// # Safety
/// `vector` must be a serial vector that nobody writes during `'a`.
pub unsafe fn entries<'a>(vector: N_Vector) -> &'a [f64] {
    // SAFETY: a serial vector stores `length` contiguous numbers (never a null pointer for a length above zero).
    unsafe { slice::from_raw_parts(N_VGetArrayPointer(vector), length(vector)) }
}

/// The entries of a vector that the library owns.
///
/// # Safety
/// `vector` must be a serial vector that nobody else reads or writes during `'a`.
pub unsafe fn entries_mut<'a>(vector: N_Vector) -> &'a mut [f64] {
    // SAFETY: as above, and exclusive by the caller's promise.
    unsafe { slice::from_raw_parts_mut(N_VGetArrayPointer(vector), length(vector)) }
}

/// Number of entries.
///
/// # Safety
/// `vector` must be a living vector.
unsafe fn length(vector: N_Vector) -> usize {
    // SAFETY: by the caller's promise.
    usize::try_from(unsafe { N_VGetLength(vector) }).unwrap_or(0)
}
