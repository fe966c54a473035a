//! The C bindings, and safe owners of what they allocate.
//!
//! Every object holds its [`Context`](context::Context) alive. Objects that share a context must stay on one thread;
//! only a bundle that owns all of them (such as [`kinsol::Memory`]) may move to another.
#![allow(unsafe_code)]

pub mod arkode;
mod context;
pub mod cvode;
pub mod ida;
pub mod integrator;
pub mod kinsol;
pub mod linear;
mod stuck;
mod vector;

use std::ffi::{CStr, c_char, c_int};

/// Version of the SUNDIALS that is linked, for example `7.1.1`.
pub fn version() -> String {
    let mut text: [c_char; 64] = [0; 64];
    // SAFETY: the buffer is as long as stated; SUNDIALS writes a terminated string or fails without writing.
    unsafe {
        sundials_sys::SUNDIALSGetVersion(text.as_mut_ptr(), text.len() as c_int);
        CStr::from_ptr(text.as_ptr()).to_string_lossy().into_owned()
    }
}

/// A size as SUNDIALS counts.
fn index(size: usize) -> sundials_sys::sunindextype {
    sundials_sys::sunindextype::try_from(size).expect("a problem size fits the index type of SUNDIALS")
}
