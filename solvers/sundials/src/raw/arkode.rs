//! One Runge–Kutta integrator of ARKODE of fixed size, explicit or diagonally implicit, with everything that it refers to.
//!
//! `sundials-sys` links ARKODE but generates no bindings for it, so the few functions used are declared here, after `arkode.h`,
//! `arkode_erkstep.h`, `arkode_arkstep.h` and `arkode_ls.h` of SUNDIALS 7.1.1.

use super::context::Context;
use super::integrator::{count, length};
use super::linear::{Linear, Preconditioned, matrix_entries_mut};
use super::vector::{Vector, entries, entries_mut};
use crate::guard::Guard;
use problem::{EvalError, IntegrationEnding, LinearSolver};
use std::ffi::{CStr, c_char, c_int, c_long, c_void};
use std::ptr;
use sundials_sys::{N_Vector, SUNContext, SUNLinearSolver, SUNMatrix};

const ARK_ONE_STEP: c_int = 2;
const ARK_INTERP_NONE: c_int = -1;
const ARK_SUCCESS: c_int = 0;
const ARK_TSTOP_RETURN: c_int = 1;
const ARK_TOO_MUCH_ACC: c_int = -2;
const ARK_ERR_FAILURE: c_int = -3;
const ARK_CONV_FAILURE: c_int = -4;
const ARK_LSETUP_FAIL: c_int = -6;
const ARK_LSOLVE_FAIL: c_int = -7;
const ARK_RHSFUNC_FAIL: c_int = -8;
const ARK_FIRST_RHSFUNC_ERR: c_int = -9;
const ARK_REPTD_RHSFUNC_ERR: c_int = -10;
const ARK_UNREC_RHSFUNC_ERR: c_int = -11;
const ARK_ILL_INPUT: c_int = -22;
const ARK_POSTPROCESS_STEP_FAIL: c_int = -37;

type Rates = extern "C" fn(f64, N_Vector, N_Vector, *mut c_void) -> c_int;
type Jacobian = extern "C" fn(f64, N_Vector, N_Vector, SUNMatrix, *mut c_void, N_Vector, N_Vector, N_Vector) -> c_int;
type Product = extern "C" fn(N_Vector, N_Vector, f64, N_Vector, N_Vector, *mut c_void, N_Vector) -> c_int;
/// Called before products at a new point.
type ProductSetup = extern "C" fn(f64, N_Vector, N_Vector, *mut c_void) -> c_int;
type Postprocess = extern "C" fn(f64, N_Vector, *mut c_void) -> c_int;

unsafe extern "C" {
    fn ERKStepCreate(rates: Rates, time: f64, y: N_Vector, context: SUNContext) -> *mut c_void;
    fn ERKStepReInit(memory: *mut c_void, rates: Rates, time: f64, y: N_Vector) -> c_int;
    fn ERKStepSetTableName(memory: *mut c_void, table: *const c_char) -> c_int;
    fn ARKStepCreate(explicit: Option<Rates>, implicit: Option<Rates>, time: f64, y: N_Vector, context: SUNContext) -> *mut c_void;
    fn ARKStepReInit(memory: *mut c_void, explicit: Option<Rates>, implicit: Option<Rates>, time: f64, y: N_Vector) -> c_int;
    fn ARKStepSetTableName(memory: *mut c_void, implicit: *const c_char, explicit: *const c_char) -> c_int;
    fn ARKodeSetLinearSolver(memory: *mut c_void, solver: SUNLinearSolver, matrix: SUNMatrix) -> c_int;
    fn ARKodeSetJacFn(memory: *mut c_void, jacobian: Option<Jacobian>) -> c_int;
    fn ARKodeSetJacTimes(memory: *mut c_void, setup: Option<ProductSetup>, product: Option<Product>) -> c_int;
    fn ARKodeReset(memory: *mut c_void, time: f64, y: N_Vector) -> c_int;
    fn ARKodeSVtolerances(memory: *mut c_void, relative: f64, absolute: N_Vector) -> c_int;
    fn ARKodeSetInterpolantType(memory: *mut c_void, kind: c_int) -> c_int;
    fn ARKodeSetMaxHnilWarns(memory: *mut c_void, count: c_int) -> c_int;
    fn ARKodeSetPostprocessStepFn(memory: *mut c_void, postprocess: Option<Postprocess>) -> c_int;
    fn ARKodeSetInitStep(memory: *mut c_void, step: f64) -> c_int;
    fn ARKodeSetMaxStep(memory: *mut c_void, step: f64) -> c_int;
    fn ARKodeSetStopTime(memory: *mut c_void, time: f64) -> c_int;
    fn ARKodeSetUserData(memory: *mut c_void, data: *mut c_void) -> c_int;
    fn ARKodeEvolve(memory: *mut c_void, time: f64, y: N_Vector, reached: *mut f64, task: c_int) -> c_int;
    fn ARKodeGetCurrentStep(memory: *mut c_void, step: *mut f64) -> c_int;
    fn ARKodeGetNumErrTestFails(memory: *mut c_void, count: *mut c_long) -> c_int;
    fn ARKodeGetNumNonlinSolvIters(memory: *mut c_void, count: *mut c_long) -> c_int;
    fn ARKodeGetNumStepSolveFails(memory: *mut c_void, count: *mut c_long) -> c_int;
    fn ARKodeFree(memory: *mut *mut c_void);
}

/// What ARKODE calls back.
pub trait System {
    /// Writes f(t, y).
    fn rates(&mut self, time: f64, y: &[f64], yd: &mut [f64]) -> Result<(), EvalError>;
    /// Writes ∂f/∂y, column after column.
    fn jacobian(&mut self, time: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), EvalError>;
    /// Writes the product of that with v.
    fn product(&mut self, time: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), EvalError>;
    /// Finishes a step that passed the error test; it may move y.
    fn accept(&mut self, time: f64, y: &mut [f64]) -> Result<(), EvalError>;
}

/// A pair of formulas, by the name that ARKODE knows it by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Table {
    /// An explicit pair.
    Explicit(&'static CStr),
    /// A diagonally implicit pair, its stages solved by Newton's method.
    Implicit(&'static CStr),
}

/// What became of one step.
pub enum Step {
    /// It was accepted and ends at this time; the state is that of its end.
    Taken(f64),
    /// It could not be evaluated, and a shorter one may be.
    Unevaluated(EvalError),
    /// No step is possible.
    Failed(IntegrationEnding),
}

/// Owner of one integrator and of all objects that it refers to.
pub struct Memory {
    raw: *mut c_void,
    table: Table,
    linear: Option<Linear>,
    y: Vector,
    tolerance: Vector,
    context: Context,
}

// SAFETY: SUNDIALS ties nothing to a thread. The clones of the context, which are not thread-safe among each other, all
// live in private fields of this one owner and move together.
unsafe impl Send for Memory {}

/// What the callbacks find behind the user data pointer while `ARKodeEvolve` runs.
struct Call<'a> {
    system: &'a mut dyn System,
    guard: Guard,
}

impl Memory {
    /// An integrator for `size` unknowns, `size` above zero.
    pub fn new(size: usize, table: Table, linear: LinearSolver) -> Self {
        assert!(size > 0, "a system of equations has at least one unknown");
        let context = Context::new();
        let y = Vector::zeros(&context, size);
        let tolerance = Vector::zeros(&context, size);
        // SAFETY: context, vectors, matrix and linear solver are alive and are owned by the result.
        let (raw, linear) = unsafe {
            let (raw, linear) = match table {
                Table::Explicit(name) => {
                    let raw = ERKStepCreate(rates, 0.0, y.raw(), context.raw());
                    assert!(!raw.is_null(), "out of memory while creating an ARKODE integrator");
                    accept(ERKStepSetTableName(raw, name.as_ptr()), &context);
                    (raw, None)
                }
                Table::Implicit(name) => {
                    let raw = ARKStepCreate(None, Some(rates), 0.0, y.raw(), context.raw());
                    assert!(!raw.is_null(), "out of memory while creating an ARKODE integrator");
                    accept(ARKStepSetTableName(raw, name.as_ptr(), c"ARKODE_ERK_NONE".as_ptr()), &context);
                    let linear = Linear::new(linear, Preconditioned::No, &context, &y);
                    accept(ARKodeSetLinearSolver(raw, linear.solver(), linear.matrix()), &context);
                    let told = match linear.kind() {
                        LinearSolver::Direct => ARKodeSetJacFn(raw, Some(jacobian)),
                        LinearSolver::Gmres => ARKodeSetJacTimes(raw, None, Some(product)),
                    };
                    accept(told, &context);
                    (raw, Some(linear))
                }
            };
            // nothing is interpolated: the polynomials have degree five at most
            accept(ARKodeSetInterpolantType(raw, ARK_INTERP_NONE), &context);
            accept(ARKodeSetPostprocessStepFn(raw, Some(accepted)), &context);
            // they would be printed
            accept(ARKodeSetMaxHnilWarns(raw, -1), &context);
            (raw, linear)
        };
        Self { raw, table, linear, y, tolerance, context }
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.y.as_slice().len()
    }

    /// What solves the linear equations of a step; `None` where there are none.
    pub fn linear(&self) -> Option<LinearSolver> {
        self.linear.as_ref().map(Linear::kind)
    }

    /// State at the end of the last step taken.
    pub fn state(&self) -> &[f64] {
        self.y.as_slice()
    }

    /// Absolute tolerances, to be written before a start.
    pub fn tolerance_mut(&mut self) -> &mut [f64] {
        self.tolerance.as_mut_slice()
    }

    /// Begins an integration; a first step of zero leaves it to ARKODE. False where it does not accept the tolerances.
    pub fn start(&mut self, time: f64, y: &[f64], relative_tolerance: f64, first_step: f64, max_step: f64) -> bool {
        self.y.as_mut_slice().copy_from_slice(y);
        // SAFETY: all handles are owned by self; ARKODE copies state and tolerances.
        unsafe {
            let begun = match self.table {
                Table::Explicit(_) => ERKStepReInit(self.raw, rates, time, self.y.raw()),
                Table::Implicit(_) => ARKStepReInit(self.raw, None, Some(rates), time, self.y.raw()),
            };
            accept(begun, &self.context);
            accept(ARKodeSetInitStep(self.raw, first_step), &self.context);
            accept(ARKodeSetMaxStep(self.raw, max_step), &self.context);
            ARKodeSVtolerances(self.raw, relative_tolerance, self.tolerance.raw()) == ARK_SUCCESS
        }
    }

    /// Goes on from another point, with a step of this length first. Counters and tolerances stay.
    pub fn resume(&mut self, time: f64, y: &[f64], step: f64) {
        self.y.as_mut_slice().copy_from_slice(y);
        // SAFETY: all handles are owned by self; ARKODE copies the state.
        unsafe {
            accept(ARKodeReset(self.raw, time, self.y.raw()), &self.context);
            accept(ARKodeSetInitStep(self.raw, step), &self.context);
        }
    }

    /// Takes one step that does not pass `time`. A panic of the system goes on here.
    pub fn step(&mut self, system: &mut dyn System, time: f64) -> Step {
        let mut call = Call { system, guard: Guard::default() };
        let mut reached = time;
        // SAFETY: all handles are owned by self; `call` outlives ARKodeEvolve and is forgotten by ARKODE right after it.
        let code = unsafe {
            accept(ARKodeSetUserData(self.raw, ptr::from_mut(&mut call).cast()), &self.context);
            accept(ARKodeSetStopTime(self.raw, time), &self.context);
            let code = ARKodeEvolve(self.raw, time, self.y.raw(), &mut reached, ARK_ONE_STEP);
            ARKodeSetUserData(self.raw, ptr::null_mut());
            code
        };
        let error = call.guard.release();
        match (code, error) {
            (ARK_SUCCESS | ARK_TSTOP_RETURN, _) => Step::Taken(reached),
            // ARKODE itself recovers from none of them
            (
                ARK_RHSFUNC_FAIL
                | ARK_FIRST_RHSFUNC_ERR
                | ARK_REPTD_RHSFUNC_ERR
                | ARK_UNREC_RHSFUNC_ERR
                | ARK_CONV_FAILURE
                | ARK_LSETUP_FAIL
                | ARK_LSOLVE_FAIL
                | ARK_POSTPROCESS_STEP_FAIL,
                Some(error),
            ) => match error {
                EvalError::Recoverable { .. } => Step::Unevaluated(error),
                EvalError::Fatal { .. } => Step::Failed(IntegrationEnding::Evaluation(error)),
            },
            (ARK_ERR_FAILURE, _) => Step::Failed(IntegrationEnding::ErrorTest),
            (ARK_CONV_FAILURE, None) => Step::Failed(IntegrationEnding::Convergence),
            (ARK_LSOLVE_FAIL, None) if self.linear() == Some(LinearSolver::Gmres) => Step::Failed(IntegrationEnding::Convergence),
            (ARK_LSETUP_FAIL | ARK_LSOLVE_FAIL, _) => Step::Failed(IntegrationEnding::Singular),
            (ARK_ILL_INPUT | ARK_TOO_MUCH_ACC, _) => Step::Failed(IntegrationEnding::Refused),
            (refusal, _) => panic!("ARKODE refused with code {refusal}: {}", self.context.message()),
        }
    }

    /// Length of the step that was tried last; zero before the first.
    pub fn current_step(&self) -> f64 {
        // SAFETY: `raw` is a living integrator.
        unsafe { length(self.raw, ARKodeGetCurrentStep) }
    }

    /// Steps rejected by the error test since the start.
    pub fn rejected(&self) -> usize {
        // SAFETY: `raw` is a living integrator.
        unsafe { count(self.raw, ARKodeGetNumErrTestFails) }
    }

    /// Iterations of Newton's method since the start, and steps rejected because it failed.
    pub fn iterations(&self) -> (usize, usize) {
        match self.table {
            Table::Explicit(_) => (0, 0),
            // SAFETY: `raw` is a living integrator.
            Table::Implicit(_) => unsafe { (count(self.raw, ARKodeGetNumNonlinSolvIters), count(self.raw, ARKodeGetNumStepSolveFails)) },
        }
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: created by ERKStepCreate or ARKStepCreate and freed once, before the objects that it refers to.
        unsafe { ARKodeFree(&mut self.raw) }
    }
}

/// Holds the set-up calls to their contract: they fail only for arguments that this module never passes, or without memory.
fn accept(code: c_int, context: &Context) {
    assert!(code == ARK_SUCCESS, "ARKODE refused its set-up with code {code}: {}", context.message());
}

extern "C" fn rates(time: f64, y: N_Vector, yd: N_Vector, call: *mut c_void) -> c_int {
    // SAFETY: ARKODE passes the pointer set in `step` and two different serial vectors that it leaves alone meanwhile.
    let (call, y, yd) = unsafe { (&mut *call.cast::<Call<'_>>(), entries(y), entries_mut(yd)) };
    let system = &mut *call.system;
    call.guard.run(|| system.rates(time, y, yd))
}

extern "C" fn jacobian(
    time: f64,
    y: N_Vector,
    _yd: N_Vector,
    matrix: SUNMatrix,
    call: *mut c_void,
    _: N_Vector,
    _: N_Vector,
    _: N_Vector,
) -> c_int {
    // SAFETY: ARKODE passes the pointer set in `step`, a serial vector and the dense matrix, and leaves them alone meanwhile.
    let (call, y, matrix) = unsafe { (&mut *call.cast::<Call<'_>>(), entries(y), matrix_entries_mut(matrix)) };
    let system = &mut *call.system;
    call.guard.run(|| system.jacobian(time, y, matrix))
}

extern "C" fn product(v: N_Vector, product: N_Vector, time: f64, y: N_Vector, _yd: N_Vector, call: *mut c_void, _: N_Vector) -> c_int {
    // SAFETY: ARKODE passes the pointer set in `step` and different serial vectors, and leaves them alone meanwhile.
    let (call, y, v, product) = unsafe { (&mut *call.cast::<Call<'_>>(), entries(y), entries(v), entries_mut(product)) };
    let system = &mut *call.system;
    call.guard.run(|| system.product(time, y, v, product))
}

extern "C" fn accepted(time: f64, y: N_Vector, call: *mut c_void) -> c_int {
    // SAFETY: ARKODE passes the pointer set in `step` and a serial vector that it leaves alone meanwhile.
    let (call, y) = unsafe { (&mut *call.cast::<Call<'_>>(), entries_mut(y)) };
    let system = &mut *call.system;
    call.guard.run(|| system.accept(time, y))
}
