//! What IDA and CVODE have in common: what they are asked for, what they count, what their callbacks find.

use super::stuck::Stuck;
use crate::guard::{FATAL, Guard};
use problem::{EvalError, IntegrationEnding};
use std::cell::Cell;
use std::ffi::{c_int, c_long, c_void};
use std::ptr;

/// What one integration is asked for, beside the vectors that were written before.
pub struct Request {
    /// Time of the start.
    pub time: f64,
    /// Time that no step passes.
    pub stop_time: f64,
    /// Relative tolerance.
    pub relative_tolerance: f64,
    /// First step; zero leaves it to the integrator.
    pub first_step: f64,
    /// Longest step.
    pub max_step: f64,
    /// Largest number of steps in one advance, above zero.
    pub max_steps: usize,
    /// Number of event functions.
    pub events: usize,
}

impl Request {
    /// Numbers of steps and events as SUNDIALS counts.
    pub fn counts(&self) -> (c_long, c_int) {
        let events = c_int::try_from(self.events).expect("SUNDIALS counts events with an int");
        (c_long::try_from(self.max_steps).unwrap_or(c_long::MAX), events)
    }
}

/// What an integrator counted since the start.
#[derive(Clone, Copy, Default)]
pub struct Statistics {
    /// Steps taken.
    pub steps: usize,
    /// Steps rejected by the error test.
    pub rejected: usize,
    /// Steps rejected because the nonlinear iteration failed.
    pub convergence_failures: usize,
    /// Nonlinear iterations.
    pub iterations: usize,
}

impl Statistics {
    /// Work of two runs one after the other.
    pub fn sum(self, other: Self) -> Self {
        Self {
            steps: self.steps + other.steps,
            rejected: self.rejected + other.rejected,
            convergence_failures: self.convergence_failures + other.convergence_failures,
            iterations: self.iterations + other.iterations,
        }
    }
}

/// Reads a counter by its getter.
///
/// # Safety
/// `memory` must be a living integrator of the package that `get` belongs to.
pub unsafe fn count(memory: *mut c_void, get: unsafe extern "C" fn(*mut c_void, *mut c_long) -> c_int) -> usize {
    let mut count: c_long = 0;
    // SAFETY: by the caller's promise.
    unsafe { get(memory, &mut count) };
    usize::try_from(count).unwrap_or(0)
}

/// Reads a time or a step by its getter.
///
/// # Safety
/// As for [`count`].
pub unsafe fn length(memory: *mut c_void, get: unsafe extern "C" fn(*mut c_void, *mut f64) -> c_int) -> f64 {
    let mut length = 0.0;
    // SAFETY: by the caller's promise.
    unsafe { get(memory, &mut length) };
    length
}

/// The event function whose root was found, the first where there are several, from the directions that SUNDIALS reports.
pub fn event(found: &[c_int]) -> IntegrationEnding {
    let event = found.iter().position(|&direction| direction != 0).unwrap_or(0);
    IntegrationEnding::Event { event, rising: found[event] > 0 }
}

/// Where the user data pointer of an integrator leads, and from there to what one call into the library needs.
///
/// IDA and CVODE copy the pointer when they begin an integration, KINSOL when it is given a linear solver, and hand the copy to functions of linear
/// solvers in all later calls, so
/// it must not change from one call to the next.
pub struct Slot(*mut Cell<*mut c_void>);

impl Slot {
    /// An empty one.
    pub fn new() -> Self {
        Self(Box::into_raw(Box::new(Cell::new(ptr::null_mut()))))
    }

    /// The user data pointer.
    pub fn raw(&self) -> *mut c_void {
        self.0.cast()
    }

    /// Leads to `call` while `body` runs.
    pub fn lend<T, R>(&self, call: &mut T, body: impl FnOnce() -> R) -> R {
        // SAFETY: allocated in `new`, freed in `drop`; a cell may be written through shared pointers.
        let cell = unsafe { &*self.0 };
        cell.set(ptr::from_mut(call).cast());
        let result = body();
        cell.set(ptr::null_mut());
        result
    }

    /// What is lent, from the user data pointer.
    ///
    /// # Safety
    /// `raw` must be that of a living slot which lends a `T` at this time, and nobody else may hold a reference to it.
    pub unsafe fn lent<'a, T>(raw: *mut c_void) -> &'a mut T {
        // SAFETY: by the caller's promise.
        unsafe { &mut *(*raw.cast::<Cell<*mut c_void>>()).get().cast::<T>() }
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        // SAFETY: made by `Box::into_raw` and freed once.
        drop(unsafe { Box::from_raw(self.0) });
    }
}

/// What the callbacks find in the slot while an integrator runs.
pub struct Call<'a, S: ?Sized> {
    /// The system.
    pub system: &'a mut S,
    /// Number of event functions.
    pub events: usize,
    /// What went wrong.
    pub guard: Guard,
    /// The integrator itself.
    pub memory: *mut c_void,
    /// Whether it still gets on.
    pub stuck: Stuck,
}

impl<'a, S: ?Sized> Call<'a, S> {
    /// For one call into the library.
    pub fn new(system: &'a mut S, events: usize, memory: *mut c_void) -> Self {
        Self { system, events, guard: Guard::default(), memory, stuck: Stuck::default() }
    }

    /// Runs an evaluation of the residual or of the rates unless steps lead nowhere.
    pub fn evaluate(&mut self, time: f64, step: f64, body: impl FnOnce(&mut S) -> Result<(), EvalError>) -> c_int {
        self.stuck.note(time, step);
        if self.stuck.for_ever() {
            return FATAL;
        }
        let system = &mut *self.system;
        let code = self.guard.run(|| body(system));
        self.stuck.failed |= code != 0;
        code
    }
}
