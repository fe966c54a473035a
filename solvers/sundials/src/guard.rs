//! What happens between a C callback and the Rust code that it calls.

use problem::EvalError;
use std::any::Any;
use std::ffi::c_int;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

/// Return codes that every SUNDIALS callback understands.
const SUCCESS: c_int = 0;
/// A smaller step may help.
pub const RECOVERABLE: c_int = 1;
/// No step helps.
pub const FATAL: c_int = -1;

/// Keeps what went wrong inside a callback while C code is on the stack.
#[derive(Default)]
pub struct Guard {
    error: Option<EvalError>,
    panic: Option<Box<dyn Any + Send>>,
}

impl Guard {
    /// Runs the body of a callback and returns the code for SUNDIALS: 0, +1 (a smaller step may help) or −1.
    ///
    /// A panic must not unwind through C frames: it is kept, stops the solver, and goes on in [`Guard::release`].
    pub fn run(&mut self, body: impl FnOnce() -> Result<(), EvalError>) -> c_int {
        match catch_unwind(AssertUnwindSafe(body)) {
            Ok(Ok(())) => SUCCESS,
            Ok(Err(error)) => {
                self.error = Some(error);
                match error {
                    EvalError::Recoverable { .. } => RECOVERABLE,
                    EvalError::Fatal { .. } => FATAL,
                }
            }
            Err(panic) => {
                self.panic = Some(panic);
                FATAL
            }
        }
    }

    /// The last error of an evaluation; resumes a panic that a callback raised.
    pub fn release(self) -> Option<EvalError> {
        match self.panic {
            Some(panic) => resume_unwind(panic),
            None => self.error,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_become_the_codes_of_the_callback_contract() {
        let mut guard = Guard::default();
        assert_eq!(guard.run(|| Ok(())), 0);
        assert_eq!(guard.run(|| Err(EvalError::Recoverable { equation: 3 })), 1);
        assert_eq!(guard.run(|| Err(EvalError::Fatal { equation: 4 })), -1);
        assert_eq!(guard.release(), Some(EvalError::Fatal { equation: 4 }));
    }
}
