//! One CVODE integrator of fixed size, with everything that it refers to.

use super::context::Context;
use super::integrator::{self, Request, Slot, Statistics, count, length};
use super::linear::{Linear, Preconditioned, matrix_entries_mut};
use super::vector::{Vector, entries, entries_mut};
use problem::{EvalError, IntegrationEnding, LinearSolver};
use std::ffi::{c_int, c_void};
use std::slice;
use sundials_sys::{
    CV_ADAMS, CV_BDF, CV_CONV_FAILURE, CV_ERR_FAILURE, CV_FIRST_RHSFUNC_ERR, CV_ILL_INPUT, CV_LSETUP_FAIL, CV_LSOLVE_FAIL, CV_NORMAL,
    CV_PROJFUNC_FAIL, CV_REPTD_PROJFUNC_ERR, CV_REPTD_RHSFUNC_ERR, CV_RHSFUNC_FAIL, CV_ROOT_RETURN, CV_RTFUNC_FAIL, CV_SUCCESS,
    CV_TOO_CLOSE, CV_TOO_MUCH_ACC, CV_TOO_MUCH_WORK, CV_TSTOP_RETURN, CV_UNREC_RHSFUNC_ERR, CVode, CVodeCreate, CVodeFree,
    CVodeGetCurrentStep, CVodeGetCurrentTime, CVodeGetDky, CVodeGetNumErrTestFails, CVodeGetNumNonlinSolvIters, CVodeGetNumStepSolveFails,
    CVodeGetNumSteps, CVodeGetRootInfo, CVodeInit, CVodeReInit, CVodeRootInit, CVodeSVtolerances, CVodeSetInitStep, CVodeSetJacFn,
    CVodeSetJacTimes, CVodeSetLinearSolver, CVodeSetMaxHnilWarns, CVodeSetMaxNumSteps, CVodeSetMaxStep, CVodeSetNoInactiveRootWarn,
    CVodeSetNonlinearSolver, CVodeSetProjErrEst, CVodeSetProjFn, CVodeSetStopTime, CVodeSetUserData, N_Vector, SUNMatrix,
    SUNNonlinSol_FixedPoint, SUNNonlinSolFree, SUNNonlinearSolver,
};

/// What CVODE calls back.
pub trait System {
    /// Writes f(t, y).
    fn rates(&mut self, time: f64, y: &[f64], yd: &mut [f64]) -> Result<(), EvalError>;
    /// Writes ∂f/∂y, column after column.
    fn jacobian(&mut self, time: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), EvalError>;
    /// Writes the product of that with v.
    fn product(&mut self, time: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), EvalError>;
    /// Writes what leads from y to the nearest point of the manifold.
    fn correction(&mut self, time: f64, y: &[f64], correction: &mut [f64]) -> Result<(), EvalError>;
    /// Writes the event functions.
    fn events(&mut self, time: f64, y: &[f64], values: &mut [f64]) -> Result<(), EvalError>;
}

/// The family of formulas, with the iteration that goes with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Adams–Moulton, orders 1 to 12, solved by functional iteration.
    Adams,
    /// Backward differentiation, orders 1 to 5, solved by Newton's method.
    Bdf,
}

/// Owner of one CVODE integrator and of all objects that it refers to.
pub struct Memory {
    raw: *mut c_void,
    y: Vector,
    tolerance: Vector,
    found: Vec<c_int>,
    slot: Slot,
    solver: Solver,
    context: Context,
}

/// What solves the equations of a step.
enum Solver {
    Newton(Linear),
    Functional(SUNNonlinearSolver),
}

impl Drop for Solver {
    fn drop(&mut self) {
        if let Self::Functional(solver) = self {
            // SAFETY: created by SUNNonlinSol_FixedPoint and freed once, after the integrator.
            unsafe { SUNNonlinSolFree(*solver) };
        }
    }
}

// SAFETY: SUNDIALS ties nothing to a thread. The clones of the context, which are not thread-safe among each other, all
// live in private fields of this one owner and move together.
unsafe impl Send for Memory {}

type Call<'a> = integrator::Call<'a, dyn System + 'a>;

impl Memory {
    /// An integrator for `size` unknowns, `size` above zero.
    pub fn new(size: usize, family: Family, linear: LinearSolver) -> Self {
        assert!(size > 0, "a system of equations has at least one unknown");
        let context = Context::new();
        let y = Vector::zeros(&context, size);
        let tolerance = Vector::zeros(&context, size);
        let slot = Slot::new();
        // SAFETY: context, vectors and solvers are alive and are owned by the result.
        let (raw, solver) = unsafe {
            let raw = CVodeCreate(if family == Family::Bdf { CV_BDF } else { CV_ADAMS }, context.raw());
            assert!(!raw.is_null(), "out of memory while creating a CVODE integrator");
            accept(CVodeSetUserData(raw, slot.raw()), &context);
            accept(CVodeInit(raw, Some(rates), 0.0, y.raw()), &context);
            let solver = match family {
                Family::Bdf => {
                    let linear = Linear::new(linear, Preconditioned::No, &context, &y);
                    accept(CVodeSetLinearSolver(raw, linear.solver(), linear.matrix()), &context);
                    let told = match linear.kind() {
                        LinearSolver::Direct => CVodeSetJacFn(raw, Some(jacobian)),
                        LinearSolver::Gmres => CVodeSetJacTimes(raw, None, Some(product)),
                    };
                    accept(told, &context);
                    accept(CVodeSetProjFn(raw, Some(correction)), &context);
                    // the estimate of the error stays as it is
                    accept(CVodeSetProjErrEst(raw, 0), &context);
                    Solver::Newton(linear)
                }
                Family::Adams => {
                    let functional = SUNNonlinSol_FixedPoint(y.raw(), 0, context.raw());
                    assert!(!functional.is_null(), "out of memory while creating a SUNDIALS solver");
                    accept(CVodeSetNonlinearSolver(raw, functional), &context);
                    Solver::Functional(functional)
                }
            };
            accept(CVodeSetNoInactiveRootWarn(raw), &context);
            // they would be printed
            accept(CVodeSetMaxHnilWarns(raw, -1), &context);
            (raw, solver)
        };
        Self { raw, y, tolerance, found: Vec::new(), slot, solver, context }
    }

    /// What solves the linear equations of a step; `None` where there are none.
    pub fn linear(&self) -> Option<LinearSolver> {
        match &self.solver {
            Solver::Newton(linear) => Some(linear.kind()),
            Solver::Functional(_) => None,
        }
    }

    /// State at the time reached.
    pub fn state(&self) -> &[f64] {
        self.y.as_slice()
    }

    /// Absolute tolerances, to be written before a start.
    pub fn tolerance_mut(&mut self) -> &mut [f64] {
        self.tolerance.as_mut_slice()
    }

    /// Begins an integration. False where CVODE does not accept the tolerances.
    pub fn start(&mut self, y: &[f64], request: &Request) -> bool {
        let (max_steps, events) = request.counts();
        self.found.clear();
        self.found.resize(request.events, 0);
        self.y.as_mut_slice().copy_from_slice(y);
        // SAFETY: all handles are owned by self; CVODE copies state and tolerances.
        unsafe {
            accept(CVodeReInit(self.raw, request.time, self.y.raw()), &self.context);
            accept(CVodeSetStopTime(self.raw, request.stop_time), &self.context);
            accept(CVodeSetInitStep(self.raw, request.first_step), &self.context);
            accept(CVodeSetMaxStep(self.raw, request.max_step), &self.context);
            accept(CVodeSetMaxNumSteps(self.raw, max_steps), &self.context);
            // by way of none: for an unchanged number CVODE would keep from the last run which functions were still at zero
            accept(CVodeRootInit(self.raw, 0, None), &self.context);
            accept(CVodeRootInit(self.raw, events, Some(event_functions)), &self.context);
            CVodeSVtolerances(self.raw, request.relative_tolerance, self.tolerance.raw()) == CV_SUCCESS
        }
    }

    /// Integrates to `time` or to what ends the integration before, and returns the time reached. A panic of the system goes on here.
    pub fn advance(&mut self, system: &mut dyn System, time: f64) -> (f64, Result<(), IntegrationEnding>) {
        let mut call = Call::new(system, self.found.len(), self.raw);
        // where CVODE refuses the call it reports no time
        let mut reached = self.time();
        // SAFETY: all handles are owned by self; the slot lends `call` as long as CVode runs.
        let code = self.slot.lend(&mut call, || unsafe { CVode(self.raw, time, self.y.raw(), &mut reached, CV_NORMAL) });
        let Call { stuck, guard, .. } = call;
        let error = guard.release();
        if stuck.for_ever() && !stuck.failed {
            return (reached, Err(IntegrationEnding::ErrorTest));
        }
        if code == CV_RTFUNC_FAIL && self.statistics().steps > 0 {
            reached = self.time();
            // SAFETY: `raw` is a living integrator and the vector has its size.
            unsafe { CVodeGetDky(self.raw, reached, 0, self.y.raw()) };
        }
        (reached, self.meaning(code, error))
    }

    /// What CVODE counted since the start.
    pub fn statistics(&self) -> Statistics {
        // SAFETY: `raw` is a living integrator.
        unsafe {
            Statistics {
                steps: count(self.raw, CVodeGetNumSteps),
                rejected: count(self.raw, CVodeGetNumErrTestFails),
                convergence_failures: count(self.raw, CVodeGetNumStepSolveFails),
                iterations: count(self.raw, CVodeGetNumNonlinSolvIters),
            }
        }
    }

    /// End of the last step.
    fn time(&self) -> f64 {
        // SAFETY: `raw` is a living integrator.
        unsafe { length(self.raw, CVodeGetCurrentTime) }
    }

    /// Meaning of a return code of `CVode`.
    fn meaning(&mut self, code: c_int, error: Option<EvalError>) -> Result<(), IntegrationEnding> {
        let evaluation = |otherwise| error.map_or(otherwise, IntegrationEnding::Evaluation);
        Err(match code {
            CV_SUCCESS | CV_TSTOP_RETURN => return Ok(()),
            CV_ROOT_RETURN => self.event(),
            CV_TOO_MUCH_WORK => IntegrationEnding::TooManySteps,
            CV_ERR_FAILURE => IntegrationEnding::ErrorTest,
            CV_CONV_FAILURE | CV_LSETUP_FAIL => evaluation(IntegrationEnding::Convergence),
            CV_LSOLVE_FAIL if self.linear() == Some(LinearSolver::Gmres) => evaluation(IntegrationEnding::Convergence),
            CV_LSOLVE_FAIL => IntegrationEnding::Singular,
            CV_RHSFUNC_FAIL
            | CV_FIRST_RHSFUNC_ERR
            | CV_REPTD_RHSFUNC_ERR
            | CV_UNREC_RHSFUNC_ERR
            | CV_RTFUNC_FAIL
            | CV_PROJFUNC_FAIL
            | CV_REPTD_PROJFUNC_ERR => evaluation(IntegrationEnding::Convergence),
            CV_ILL_INPUT | CV_TOO_MUCH_ACC | CV_TOO_CLOSE => IntegrationEnding::Refused,
            refusal => panic!("CVODE refused with code {refusal}: {}", self.context.message()),
        })
    }

    /// The event function whose root was found, the first where there are several.
    fn event(&mut self) -> IntegrationEnding {
        // SAFETY: `raw` is a living integrator, and the array has one entry per event function.
        unsafe { CVodeGetRootInfo(self.raw, self.found.as_mut_ptr()) };
        integrator::event(&self.found)
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: created by CVodeCreate and freed once, before the objects that it refers to.
        unsafe { CVodeFree(&mut self.raw) }
    }
}

/// Holds the set-up calls to their contract: they fail only for arguments that this module never passes, or without memory.
fn accept(code: c_int, context: &Context) {
    assert!(code == CV_SUCCESS, "CVODE refused its set-up with code {code}: {}", context.message());
}

extern "C" fn rates(time: f64, y: N_Vector, yd: N_Vector, slot: *mut c_void) -> c_int {
    // SAFETY: `advance` lends the call through the slot; CVODE passes two different serial vectors that it leaves alone meanwhile.
    let (call, y, yd) = unsafe { (Slot::lent::<Call<'_>>(slot), entries(y), entries_mut(yd)) };
    // SAFETY: the integrator that calls.
    let step = unsafe { length(call.memory, CVodeGetCurrentStep) };
    call.evaluate(time, step, |system| system.rates(time, y, yd))
}

extern "C" fn jacobian(
    time: f64,
    y: N_Vector,
    _yd: N_Vector,
    matrix: SUNMatrix,
    slot: *mut c_void,
    _: N_Vector,
    _: N_Vector,
    _: N_Vector,
) -> c_int {
    // SAFETY: `advance` lends the call through the slot; CVODE passes a serial vector and the dense matrix, and leaves them alone meanwhile.
    let (call, y, matrix) = unsafe { (Slot::lent::<Call<'_>>(slot), entries(y), matrix_entries_mut(matrix)) };
    let system = &mut *call.system;
    call.guard.run(|| system.jacobian(time, y, matrix))
}

extern "C" fn product(v: N_Vector, product: N_Vector, time: f64, y: N_Vector, _yd: N_Vector, slot: *mut c_void, _: N_Vector) -> c_int {
    // SAFETY: `advance` lends the call through the slot; CVODE passes different serial vectors, and leaves them alone meanwhile.
    let (call, y, v, product) = unsafe { (Slot::lent::<Call<'_>>(slot), entries(y), entries(v), entries_mut(product)) };
    let system = &mut *call.system;
    call.guard.run(|| system.product(time, y, v, product))
}

extern "C" fn correction(time: f64, y: N_Vector, correction: N_Vector, _tolerance: f64, _error: N_Vector, slot: *mut c_void) -> c_int {
    // SAFETY: `advance` lends the call through the slot; CVODE passes two different serial vectors that it leaves alone meanwhile.
    let (call, y, correction) = unsafe { (Slot::lent::<Call<'_>>(slot), entries(y), entries_mut(correction)) };
    let system = &mut *call.system;
    call.guard.run(|| system.correction(time, y, correction))
}

extern "C" fn event_functions(time: f64, y: N_Vector, values: *mut f64, slot: *mut c_void) -> c_int {
    // SAFETY: `advance` lends the call through the slot; CVODE passes a serial vector and an array of as many entries as there are events.
    let (call, y, values) = unsafe {
        let call = Slot::lent::<Call<'_>>(slot);
        let events = call.events;
        (call, entries(y), slice::from_raw_parts_mut(values, events))
    };
    let system = &mut *call.system;
    call.guard.run(|| system.events(time, y, values))
}
