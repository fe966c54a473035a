//! One KINSOL solver of fixed size, with everything that it refers to.

use super::context::Context;
use super::integrator::Slot;
use super::linear::{Linear, Preconditioned, matrix_entries_mut};
use super::vector::{Vector, entries, entries_mut};
use crate::guard::{FATAL, Guard, RECOVERABLE};
use problem::{EvalError, LinearSolver};
use std::ffi::{c_int, c_long, c_void};
use sundials_sys::{
    KIN_FIRST_SYSFUNC_ERR, KIN_FP, KIN_INITIAL_GUESS_OK, KIN_LINESEARCH, KIN_LINESEARCH_BCFAIL, KIN_LINESEARCH_NONCONV,
    KIN_LINSOLV_NO_RECOVERY, KIN_LSETUP_FAIL, KIN_LSOLVE_FAIL, KIN_MAXITER_REACHED, KIN_MXNEWT_5X_EXCEEDED, KIN_NONE, KIN_PICARD,
    KIN_REPTD_SYSFUNC_ERR, KIN_STEP_LT_STPTOL, KIN_SUCCESS, KIN_SYSFUNC_FAIL, KINCreate, KINFree, KINGetLastLinFlag,
    KINGetNumNonlinSolvIters, KINInit, KINLS_JACFUNC_ERR, KINSetConstraints, KINSetFuncNormTol, KINSetJacFn, KINSetJacTimesVecFn,
    KINSetLinearSolver, KINSetMAA, KINSetMaxBetaFails, KINSetMaxNewtonStep, KINSetMaxSetupCalls, KINSetNoResMon, KINSetNumMaxIters,
    KINSetPreconditioner, KINSetScaledStepTol, KINSetUserData, KINSol, N_Vector, SUNMatrix,
};

/// What KINSOL calls back.
pub trait System {
    /// Writes f(x).
    fn residual(&mut self, x: &[f64], f: &mut [f64]) -> Result<(), EvalError>;
    /// Writes x − J₀⁻¹ f(x) for the fixed-point iteration.
    fn fixed_point(&mut self, x: &[f64], g: &mut [f64]) -> Result<(), EvalError>;
    /// Writes ∂f/∂x, column after column.
    fn jacobian(&mut self, x: &[f64], jacobian: &mut [f64]) -> Result<(), EvalError>;
    /// Writes the product of that with v.
    fn product(&mut self, x: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), EvalError>;
    /// Makes the preconditioner for a point and those near it. False where its matrix is singular.
    fn prepare(&mut self, x: &[f64]) -> Result<bool, EvalError>;
    /// Replaces r by P⁻¹ r.
    fn precondition(&mut self, r: &mut [f64]);
}

/// How KINSOL makes progress from far away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Strategy {
    /// Newton steps shortened until the scaled residual decreases enough.
    #[default]
    LineSearch,
    /// Full Newton steps, shortened only at bounds and where the residual cannot be evaluated.
    FullStep,
    /// The first, its steps by the generalized minimal residual method: as closely as the distance from the solution asks for, preconditioned by
    /// the factors of a J that is renewed every ten iterations.
    Krylov,
    /// Picard iteration `x − J⁻¹ f(x)` with Anderson acceleration; J is renewed every ten iterations.
    Picard,
    /// Fixed-point iteration `x − J₀⁻¹ f(x)` with Anderson acceleration, J₀ that of the start.
    FixedPoint,
}

/// Differences that Anderson acceleration keeps.
const ANDERSON: c_long = 5;

/// What one solve is asked for; every figure in scaled quantities and above zero.
pub struct Request {
    /// Largest scaled residual that counts as solved.
    pub residual_tolerance: f64,
    /// Step below which KINSOL gives up.
    pub step_tolerance: f64,
    /// Largest number of iterations.
    pub max_iterations: usize,
    /// Longest step.
    pub max_step: f64,
}

/// Why KINSOL came back, its return codes sorted by what they mean for the caller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The scaled residual is below the tolerance.
    Solved,
    /// The step became too small, or five steps in a row had the largest length allowed.
    Stalled,
    /// Too many iterations.
    MaxIterations,
    /// The Jacobian has no usable LU factors.
    Singular,
    /// The line search found no acceptable point, or a bound left no room.
    NoDecrease,
    /// The residual or the Jacobian failed.
    Evaluation,
}

/// What one solve reports.
pub struct Report {
    /// Why KINSOL came back.
    pub stop: Stop,
    /// Iterations begun.
    pub iterations: usize,
    /// The last error that a callback returned, even if KINSOL recovered from it.
    pub error: Option<EvalError>,
}

/// Owner of one KINSOL solver and of all objects that it refers to.
pub struct Memory {
    raw: *mut c_void,
    x: Vector,
    unknown_weight: Vector,
    equation_weight: Vector,
    constraints: Vector,
    strategy: Strategy,
    _linear: Linear,
    slot: Slot,
    context: Context,
}

// SAFETY: SUNDIALS ties nothing to a thread. The clones of the context, which are not thread-safe among each other, all
// live in private fields of this one owner and move together.
unsafe impl Send for Memory {}

/// What the callbacks find behind the user data pointer while `KINSol` runs.
struct Call<'a> {
    system: &'a mut dyn System,
    /// Whether the iteration takes a recoverable error for none.
    accelerated: bool,
    guard: Guard,
}

impl Memory {
    /// A solver for `size` unknowns, `size` above zero.
    pub fn new(size: usize, strategy: Strategy) -> Self {
        assert!(size > 0, "a system of equations has at least one unknown");
        let context = Context::new();
        let x = Vector::zeros(&context, size);
        let kind = if strategy == Strategy::Krylov { LinearSolver::Gmres } else { LinearSolver::Direct };
        // KINSOL knows no other side
        let linear = Linear::new(kind, Preconditioned::Right, &context, &x);
        let slot = Slot::new();
        // SAFETY: context, vector, matrix and linear solver are alive and are owned by the result.
        let raw = unsafe {
            let raw = KINCreate(context.raw());
            assert!(!raw.is_null(), "out of memory while creating a KINSOL solver");
            accept(KINSetUserData(raw, slot.raw()), &context);
            // memory for accelerated iterations is allocated with the rest
            if matches!(strategy, Strategy::Picard | Strategy::FixedPoint) {
                accept(KINSetMAA(raw, ANDERSON), &context);
            }
            let function = if strategy == Strategy::FixedPoint { fixed_point } else { residual };
            accept(KINInit(raw, Some(function), x.raw()), &context);
            if strategy != Strategy::FixedPoint {
                accept(KINSetLinearSolver(raw, linear.solver(), linear.matrix()), &context);
                let told = match kind {
                    LinearSolver::Direct => KINSetJacFn(raw, Some(jacobian)),
                    LinearSolver::Gmres => {
                        accept(KINSetPreconditioner(raw, Some(prepare), Some(precondition)), &context);
                        KINSetJacTimesVecFn(raw, Some(product))
                    }
                };
                accept(told, &context);
            }
            if matches!(strategy, Strategy::LineSearch | Strategy::FullStep) {
                // a fresh Jacobian in every iteration; then nobody need watch whether an old one still serves
                accept(KINSetMaxSetupCalls(raw, 1), &context);
                accept(KINSetNoResMon(raw, 1), &context);
            }
            raw
        };
        let zeros = || Vector::zeros(&context, size);
        Self { raw, x, unknown_weight: zeros(), equation_weight: zeros(), constraints: zeros(), strategy, _linear: linear, slot, context }
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.x.as_slice().len()
    }

    /// The start of the iteration, to be written before a solve.
    pub fn start_mut(&mut self) -> &mut [f64] {
        self.x.as_mut_slice()
    }

    /// Reciprocals of the typical magnitudes of the unknowns, to be written before a solve.
    pub fn unknown_weight_mut(&mut self) -> &mut [f64] {
        self.unknown_weight.as_mut_slice()
    }

    /// Reciprocals of the typical magnitudes of the equations, to be written before a solve.
    pub fn equation_weight_mut(&mut self) -> &mut [f64] {
        self.equation_weight.as_mut_slice()
    }

    /// Codes of the bounds, to be written before a solve: 0 free, ±1 weak, ±2 strict.
    pub fn constraints_mut(&mut self) -> &mut [f64] {
        self.constraints.as_mut_slice()
    }

    /// Runs KINSOL from the start that was written. A panic of the system goes on here.
    pub fn solve(&mut self, system: &mut dyn System, request: &Request) -> Report {
        let max_iterations = c_long::try_from(request.max_iterations).unwrap_or(c_long::MAX);
        let strategy = match self.strategy {
            Strategy::LineSearch | Strategy::Krylov => KIN_LINESEARCH,
            Strategy::FullStep => KIN_NONE,
            Strategy::Picard => KIN_PICARD,
            Strategy::FixedPoint => KIN_FP,
        };
        let accelerated = matches!(self.strategy, Strategy::Picard | Strategy::FixedPoint);
        let mut call = Call { system, accelerated, guard: Guard::default() };
        // the distance of two iterates is what the fixed-point iteration is judged by
        let weight = if self.strategy == Strategy::FixedPoint { &self.unknown_weight } else { &self.equation_weight };
        // SAFETY: all handles are owned by self; the slot lends `call` as long as KINSol runs.
        let (code, iterations) = unsafe {
            accept(KINSetFuncNormTol(self.raw, request.residual_tolerance), &self.context);
            accept(KINSetScaledStepTol(self.raw, request.step_tolerance), &self.context);
            accept(KINSetNumMaxIters(self.raw, max_iterations), &self.context);
            accept(KINSetMaxBetaFails(self.raw, max_iterations), &self.context);
            accept(KINSetMaxNewtonStep(self.raw, request.max_step), &self.context);
            // bounds belong to Newton's method;
            // never a null pointer instead of zeros: 7.1.1 would keep using the vector that it has freed
            if !accelerated {
                accept(KINSetConstraints(self.raw, self.constraints.raw()), &self.context);
            }
            let code = self.slot.lend(&mut call, || KINSol(self.raw, self.x.raw(), strategy, self.unknown_weight.raw(), weight.raw()));
            let mut iterations: c_long = 0;
            KINGetNumNonlinSolvIters(self.raw, &mut iterations);
            (code, iterations)
        };
        let error = call.guard.release();
        Report { stop: self.stop(code), iterations: usize::try_from(iterations).unwrap_or(0), error }
    }

    /// Meaning of a return code of `KINSol`.
    fn stop(&self, code: c_int) -> Stop {
        match code {
            KIN_SUCCESS | KIN_INITIAL_GUESS_OK => Stop::Solved,
            KIN_STEP_LT_STPTOL | KIN_MXNEWT_5X_EXCEEDED => Stop::Stalled,
            KIN_MAXITER_REACHED => Stop::MaxIterations,
            KIN_LINESEARCH_NONCONV | KIN_LINESEARCH_BCFAIL => Stop::NoDecrease,
            KIN_SYSFUNC_FAIL | KIN_FIRST_SYSFUNC_ERR | KIN_REPTD_SYSFUNC_ERR => Stop::Evaluation,
            // a preconditioner without factors and one that could not be evaluated have one code
            KIN_LSETUP_FAIL if self.jacobian_failed() || self.strategy == Strategy::Krylov => Stop::Evaluation,
            KIN_LSETUP_FAIL | KIN_LSOLVE_FAIL | KIN_LINSOLV_NO_RECOVERY => Stop::Singular,
            refusal => panic!("KINSOL refused with code {refusal}: {}", self.context.message()),
        }
    }

    /// Whether the last set-up of the linear solver failed in our Jacobian rather than in its LU factorization.
    fn jacobian_failed(&self) -> bool {
        let mut flag: c_long = 0;
        // SAFETY: `raw` is a living solver.
        unsafe { KINGetLastLinFlag(self.raw, &mut flag) };
        flag == c_long::from(KINLS_JACFUNC_ERR)
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: created by KINCreate and freed once, before the objects that it refers to.
        unsafe { KINFree(&mut self.raw) }
    }
}

/// Holds the set-up calls to their contract: they fail only for arguments that this module never passes, or without memory.
fn accept(code: c_int, context: &Context) {
    assert!(code == KIN_SUCCESS, "KINSOL refused its set-up with code {code}: {}", context.message());
}

extern "C" fn residual(x: N_Vector, f: N_Vector, slot: *mut c_void) -> c_int {
    // SAFETY: `solve` lends the call through the slot; KINSOL passes two different serial vectors that it leaves alone meanwhile.
    let (call, x, f) = unsafe { (Slot::lent::<Call<'_>>(slot), entries(x), entries_mut(f)) };
    let system = &mut *call.system;
    let code = call.guard.run(|| system.residual(x, f));
    if call.accelerated && code != 0 { FATAL } else { code }
}

extern "C" fn fixed_point(x: N_Vector, g: N_Vector, slot: *mut c_void) -> c_int {
    // SAFETY: `solve` lends the call through the slot; KINSOL passes two different serial vectors that it leaves alone meanwhile.
    let (call, x, g) = unsafe { (Slot::lent::<Call<'_>>(slot), entries(x), entries_mut(g)) };
    let system = &mut *call.system;
    let code = call.guard.run(|| system.fixed_point(x, g));
    if code == 0 { code } else { FATAL }
}

extern "C" fn jacobian(x: N_Vector, _f: N_Vector, matrix: SUNMatrix, slot: *mut c_void, _: N_Vector, _: N_Vector) -> c_int {
    // SAFETY: `solve` lends the call through the slot; KINSOL passes a serial vector and the dense matrix, and leaves both alone meanwhile.
    let (call, x, matrix) = unsafe { (Slot::lent::<Call<'_>>(slot), entries(x), matrix_entries_mut(matrix)) };
    let system = &mut *call.system;
    call.guard.run(|| system.jacobian(x, matrix))
}

extern "C" fn product(v: N_Vector, product: N_Vector, x: N_Vector, _new: *mut c_int, slot: *mut c_void) -> c_int {
    // SAFETY: `solve` lends the call through the slot; KINSOL passes different serial vectors, and leaves them alone meanwhile.
    let (call, x, v, product) = unsafe { (Slot::lent::<Call<'_>>(slot), entries(x), entries(v), entries_mut(product)) };
    let system = &mut *call.system;
    call.guard.run(|| system.product(x, v, product))
}

extern "C" fn prepare(x: N_Vector, _x_scale: N_Vector, _f: N_Vector, _f_scale: N_Vector, slot: *mut c_void) -> c_int {
    // SAFETY: `solve` lends the call through the slot; KINSOL passes a serial vector that it leaves alone meanwhile.
    let (call, x) = unsafe { (Slot::lent::<Call<'_>>(slot), entries(x)) };
    let system = &mut *call.system;
    let mut regular = false;
    let code = call.guard.run(|| system.prepare(x).map(|found| regular = found));
    if code == 0 && !regular { RECOVERABLE } else { code }
}

extern "C" fn precondition(_x: N_Vector, _x_scale: N_Vector, _f: N_Vector, _f_scale: N_Vector, r: N_Vector, slot: *mut c_void) -> c_int {
    // SAFETY: `solve` lends the call through the slot; KINSOL passes a serial vector that it leaves alone meanwhile.
    let (call, r) = unsafe { (Slot::lent::<Call<'_>>(slot), entries_mut(r)) };
    let system = &mut *call.system;
    call.guard.run(|| {
        system.precondition(r);
        Ok(())
    })
}
