//! One IDA integrator of fixed size, with everything that it refers to.

use super::context::Context;
use super::integrator::{self, Request, Slot, Statistics, count, length};
use super::linear::{Linear, Preconditioned, matrix_entries_mut};
use super::vector::{Vector, entries, entries_mut};
use crate::guard::RECOVERABLE;
use problem::{EvalError, IntegrationEnding, LinearSolver};
use std::ffi::{c_int, c_long, c_void};
use std::slice;
use sundials_sys::{
    IDA_CONV_FAIL, IDA_ERR_FAIL, IDA_ILL_INPUT, IDA_LSETUP_FAIL, IDA_LSOLVE_FAIL, IDA_NORMAL, IDA_REP_RES_ERR, IDA_RES_FAIL,
    IDA_ROOT_RETURN, IDA_RTFUNC_FAIL, IDA_SUCCESS, IDA_TOO_MUCH_ACC, IDA_TOO_MUCH_WORK, IDA_TSTOP_RETURN, IDACreate, IDAFree,
    IDAGetCurrentStep, IDAGetCurrentTime, IDAGetDky, IDAGetLastLinFlag, IDAGetNumErrTestFails, IDAGetNumNonlinSolvIters,
    IDAGetNumStepSolveFails, IDAGetNumSteps, IDAGetRootInfo, IDAInit, IDALS_JACFUNC_RECVR, IDALS_JACFUNC_UNRECVR, IDAReInit, IDARootInit,
    IDASVtolerances, IDASetId, IDASetInitStep, IDASetJacFn, IDASetJacTimes, IDASetLinearSolver, IDASetMaxNumSteps, IDASetMaxStep,
    IDASetNoInactiveRootWarn, IDASetPreconditioner, IDASetStopTime, IDASetSuppressAlg, IDASetUserData, IDASolve, N_Vector,
    SUNLS_PSET_FAIL_REC, SUNMatrix,
};

/// What IDA keeps where a preconditioner could not be made.
const PREPARATION_FAILED: c_int = SUNLS_PSET_FAIL_REC as c_int;

/// What IDA calls back.
pub trait System {
    /// Writes F(t, y, ẏ).
    fn residual(&mut self, time: f64, y: &[f64], yd: &[f64], residual: &mut [f64]) -> Result<(), EvalError>;
    /// Writes ∂F/∂y + c ∂F/∂ẏ, column after column.
    fn jacobian(&mut self, time: f64, c: f64, y: &[f64], yd: &[f64], jacobian: &mut [f64]) -> Result<(), EvalError>;
    /// Writes the product of that with v.
    fn product(&mut self, at: (f64, f64), state: (&[f64], &[f64]), v: &[f64], product: &mut [f64]) -> Result<(), EvalError>;
    /// Makes the preconditioner for a point and those near it. False where its matrix is singular.
    fn prepare(&mut self, time: f64, c: f64, y: &[f64], yd: &[f64]) -> Result<bool, EvalError>;
    /// Writes P⁻¹ r.
    fn precondition(&mut self, r: &[f64], z: &mut [f64]);
    /// Writes the event functions.
    fn events(&mut self, time: f64, y: &[f64], yd: &[f64], values: &mut [f64]) -> Result<(), EvalError>;
}

/// Owner of one IDA integrator and of all objects that it refers to.
pub struct Memory {
    raw: *mut c_void,
    y: Vector,
    yd: Vector,
    tolerance: Vector,
    differential: Vector,
    found: Vec<c_int>,
    slot: Slot,
    linear: Linear,
    context: Context,
}

// SAFETY: SUNDIALS ties nothing to a thread. The clones of the context, which are not thread-safe among each other, all
// live in private fields of this one owner and move together.
unsafe impl Send for Memory {}

type Call<'a> = integrator::Call<'a, dyn System + 'a>;

impl Memory {
    /// An integrator for `size` unknowns, `size` above zero.
    pub fn new(size: usize, linear: LinearSolver) -> Self {
        assert!(size > 0, "a system of equations has at least one unknown");
        let context = Context::new();
        let zeros = || Vector::zeros(&context, size);
        let (y, yd, tolerance, differential) = (zeros(), zeros(), zeros(), zeros());
        let linear = Linear::new(linear, Preconditioned::Left, &context, &y);
        let slot = Slot::new();
        // SAFETY: context, vectors, matrix and linear solver are alive and are owned by the result.
        let raw = unsafe {
            let raw = IDACreate(context.raw());
            assert!(!raw.is_null(), "out of memory while creating an IDA integrator");
            accept(IDASetUserData(raw, slot.raw()), &context);
            accept(IDAInit(raw, Some(residual), 0.0, y.raw(), yd.raw()), &context);
            accept(IDASetLinearSolver(raw, linear.solver(), linear.matrix()), &context);
            let told = match linear.kind() {
                LinearSolver::Direct => IDASetJacFn(raw, Some(jacobian)),
                LinearSolver::Gmres => {
                    accept(IDASetPreconditioner(raw, Some(prepare), Some(precondition)), &context);
                    IDASetJacTimes(raw, None, Some(product))
                }
            };
            accept(told, &context);
            accept(IDASetNoInactiveRootWarn(raw), &context);
            raw
        };
        Self { raw, y, yd, tolerance, differential, found: Vec::new(), slot, linear, context }
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.y.as_slice().len()
    }

    /// What solves the linear equations of a step.
    pub fn linear(&self) -> LinearSolver {
        self.linear.kind()
    }

    /// Unknowns and their rates: those of the start, to be written before it; afterwards those of the time reached.
    pub fn state(&self) -> (&[f64], &[f64]) {
        (self.y.as_slice(), self.yd.as_slice())
    }

    /// As [`Memory::state`].
    pub fn state_mut(&mut self) -> (&mut [f64], &mut [f64]) {
        (self.y.as_mut_slice(), self.yd.as_mut_slice())
    }

    /// Absolute tolerances, to be written before a start.
    pub fn tolerance_mut(&mut self) -> &mut [f64] {
        self.tolerance.as_mut_slice()
    }

    /// One for each unknown whose rate appears in F, zero for the others; to be written before a start.
    pub fn differential_mut(&mut self) -> &mut [f64] {
        self.differential.as_mut_slice()
    }

    /// Begins an integration at the state that was written. False where IDA does not accept the tolerances.
    ///
    /// `suppress_algebraic` leaves algebraic unknowns out of the error test.
    pub fn start(&mut self, request: &Request, suppress_algebraic: bool) -> bool {
        let (max_steps, events) = request.counts();
        self.found.clear();
        self.found.resize(request.events, 0);
        // SAFETY: all handles are owned by self; IDA copies state, tolerances and kinds.
        unsafe {
            accept(IDAReInit(self.raw, request.time, self.y.raw(), self.yd.raw()), &self.context);
            accept(IDASetId(self.raw, self.differential.raw()), &self.context);
            accept(IDASetSuppressAlg(self.raw, suppress_algebraic.into()), &self.context);
            accept(IDASetStopTime(self.raw, request.stop_time), &self.context);
            accept(IDASetInitStep(self.raw, request.first_step), &self.context);
            accept(IDASetMaxStep(self.raw, request.max_step), &self.context);
            accept(IDASetMaxNumSteps(self.raw, max_steps), &self.context);
            // by way of none: for an unchanged number IDA would keep from the last run which functions were still at zero
            accept(IDARootInit(self.raw, 0, None), &self.context);
            accept(IDARootInit(self.raw, events, Some(event_functions)), &self.context);
            IDASVtolerances(self.raw, request.relative_tolerance, self.tolerance.raw()) == IDA_SUCCESS
        }
    }

    /// Integrates to `time` or to what ends the integration before, and returns the time reached. A panic of the system goes on here.
    pub fn advance(&mut self, system: &mut dyn System, time: f64) -> (f64, Result<(), IntegrationEnding>) {
        let mut call = Call::new(system, self.found.len(), self.raw);
        // where IDA refuses the call it reports no time
        let mut reached = self.time();
        // SAFETY: all handles are owned by self; the slot lends `call` as long as IDASolve runs.
        let code = self.slot.lend(&mut call, || unsafe { IDASolve(self.raw, time, &mut reached, self.y.raw(), self.yd.raw(), IDA_NORMAL) });
        let Call { stuck, guard, .. } = call;
        let error = guard.release();
        if stuck.for_ever() && !stuck.failed {
            return (reached, Err(IntegrationEnding::ErrorTest));
        }
        if code == IDA_RTFUNC_FAIL {
            reached = self.time();
            self.restore(reached);
        }
        (reached, self.meaning(code, error))
    }

    /// What IDA counted since the start.
    pub fn statistics(&self) -> Statistics {
        // SAFETY: `raw` is a living integrator.
        unsafe {
            Statistics {
                steps: count(self.raw, IDAGetNumSteps),
                rejected: count(self.raw, IDAGetNumErrTestFails),
                convergence_failures: count(self.raw, IDAGetNumStepSolveFails),
                iterations: count(self.raw, IDAGetNumNonlinSolvIters),
            }
        }
    }

    /// End of the last step.
    fn time(&self) -> f64 {
        // SAFETY: `raw` is a living integrator.
        unsafe { length(self.raw, IDAGetCurrentTime) }
    }

    /// Takes the state at the end of the last step, where IDA has not done so.
    fn restore(&mut self, time: f64) {
        if self.statistics().steps > 0 {
            // SAFETY: `raw` is a living integrator and the vectors have its size.
            unsafe {
                IDAGetDky(self.raw, time, 0, self.y.raw());
                IDAGetDky(self.raw, time, 1, self.yd.raw());
            }
        }
    }

    /// Meaning of a return code of `IDASolve`.
    fn meaning(&mut self, code: c_int, error: Option<EvalError>) -> Result<(), IntegrationEnding> {
        let evaluation = |otherwise| error.map_or(otherwise, IntegrationEnding::Evaluation);
        Err(match code {
            IDA_SUCCESS | IDA_TSTOP_RETURN => return Ok(()),
            IDA_ROOT_RETURN => self.event(),
            IDA_TOO_MUCH_WORK => IntegrationEnding::TooManySteps,
            IDA_ERR_FAIL => IntegrationEnding::ErrorTest,
            IDA_CONV_FAIL | IDA_LSETUP_FAIL | IDA_LSOLVE_FAIL if self.linear() == LinearSolver::Gmres => match self.linear_flag() {
                // its preconditioner has no LU factors, or could not be evaluated
                PREPARATION_FAILED => evaluation(IntegrationEnding::Singular),
                _ => evaluation(IntegrationEnding::Convergence),
            },
            IDA_CONV_FAIL | IDA_LSETUP_FAIL | IDA_LSOLVE_FAIL => match self.linear_flag() {
                IDALS_JACFUNC_RECVR | IDALS_JACFUNC_UNRECVR => evaluation(IntegrationEnding::Convergence),
                0 => IntegrationEnding::Convergence,
                _ => IntegrationEnding::Singular,
            },
            IDA_RES_FAIL | IDA_REP_RES_ERR | IDA_RTFUNC_FAIL => evaluation(IntegrationEnding::Convergence),
            IDA_ILL_INPUT | IDA_TOO_MUCH_ACC => IntegrationEnding::Refused,
            refusal => panic!("IDA refused with code {refusal}: {}", self.context.message()),
        })
    }

    /// The event function whose root was found, the first where there are several.
    fn event(&mut self) -> IntegrationEnding {
        // SAFETY: `raw` is a living integrator, and the array has one entry per event function.
        unsafe { IDAGetRootInfo(self.raw, self.found.as_mut_ptr()) };
        integrator::event(&self.found)
    }

    /// What the linear solver said last: zero, a failure of the Jacobian, or a column without a pivot.
    fn linear_flag(&self) -> c_int {
        let mut flag: c_long = 0;
        // SAFETY: `raw` is a living integrator.
        unsafe { IDAGetLastLinFlag(self.raw, &mut flag) };
        c_int::try_from(flag).unwrap_or(c_int::MAX)
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: created by IDACreate and freed once, before the objects that it refers to.
        unsafe { IDAFree(&mut self.raw) }
    }
}

/// Holds the set-up calls to their contract: they fail only for arguments that this module never passes, or without memory.
fn accept(code: c_int, context: &Context) {
    assert!(code == IDA_SUCCESS, "IDA refused its set-up with code {code}: {}", context.message());
}

extern "C" fn residual(time: f64, y: N_Vector, yd: N_Vector, residual: N_Vector, slot: *mut c_void) -> c_int {
    // SAFETY: `advance` lends the call through the slot; IDA passes three different serial vectors that it leaves alone meanwhile.
    let (call, y, yd, residual) = unsafe { (Slot::lent::<Call<'_>>(slot), entries(y), entries(yd), entries_mut(residual)) };
    // SAFETY: the integrator that calls.
    let step = unsafe { length(call.memory, IDAGetCurrentStep) };
    call.evaluate(time, step, |system| system.residual(time, y, yd, residual))
}

extern "C" fn jacobian(
    time: f64,
    c: f64,
    y: N_Vector,
    yd: N_Vector,
    _residual: N_Vector,
    matrix: SUNMatrix,
    slot: *mut c_void,
    _: N_Vector,
    _: N_Vector,
    _: N_Vector,
) -> c_int {
    // SAFETY: `advance` lends the call through the slot; IDA passes serial vectors and the dense matrix, and leaves them alone meanwhile.
    let (call, y, yd, matrix) = unsafe { (Slot::lent::<Call<'_>>(slot), entries(y), entries(yd), matrix_entries_mut(matrix)) };
    let system = &mut *call.system;
    call.guard.run(|| system.jacobian(time, c, y, yd, matrix))
}

extern "C" fn product(
    time: f64,
    y: N_Vector,
    yd: N_Vector,
    _residual: N_Vector,
    v: N_Vector,
    product: N_Vector,
    c: f64,
    slot: *mut c_void,
    _: N_Vector,
    _: N_Vector,
) -> c_int {
    // SAFETY: `advance` lends the call through the slot; IDA passes different serial vectors, and leaves them alone meanwhile.
    let (call, y, yd, v, product) = unsafe { (Slot::lent::<Call<'_>>(slot), entries(y), entries(yd), entries(v), entries_mut(product)) };
    let system = &mut *call.system;
    call.guard.run(|| system.product((time, c), (y, yd), v, product))
}

extern "C" fn prepare(time: f64, y: N_Vector, yd: N_Vector, _residual: N_Vector, c: f64, slot: *mut c_void) -> c_int {
    // SAFETY: `advance` lends the call through the slot; IDA passes serial vectors, and leaves them alone meanwhile.
    let (call, y, yd) = unsafe { (Slot::lent::<Call<'_>>(slot), entries(y), entries(yd)) };
    let system = &mut *call.system;
    let mut regular = false;
    let code = call.guard.run(|| system.prepare(time, c, y, yd).map(|found| regular = found));
    if code == 0 && !regular { RECOVERABLE } else { code }
}

extern "C" fn precondition(
    _time: f64,
    _y: N_Vector,
    _yd: N_Vector,
    _residual: N_Vector,
    r: N_Vector,
    z: N_Vector,
    _c: f64,
    _tolerance: f64,
    slot: *mut c_void,
) -> c_int {
    // SAFETY: `advance` lends the call through the slot; IDA passes two different serial vectors that it leaves alone meanwhile.
    let (call, r, z) = unsafe { (Slot::lent::<Call<'_>>(slot), entries(r), entries_mut(z)) };
    let system = &mut *call.system;
    call.guard.run(|| {
        system.precondition(r, z);
        Ok(())
    })
}

extern "C" fn event_functions(time: f64, y: N_Vector, yd: N_Vector, values: *mut f64, slot: *mut c_void) -> c_int {
    // SAFETY: `advance` lends the call through the slot; IDA passes two serial vectors and an array of as many entries as there are events.
    let (call, y, yd, values) = unsafe {
        let call = Slot::lent::<Call<'_>>(slot);
        let events = call.events;
        (call, entries(y), entries(yd), slice::from_raw_parts_mut(values, events))
    };
    let system = &mut *call.system;
    call.guard.run(|| system.events(time, y, yd, values))
}
