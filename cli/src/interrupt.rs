//! Ctrl-C: the first asks for the end and keeps what was computed, the second ends the program at once.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the user has asked for the end.
#[derive(Debug)]
pub struct Interrupt(AtomicBool);

impl Interrupt {
    /// Whether it was asked for.
    pub fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Exit status of a program that Ctrl-C has ended, as shells have it.
const INTERRUPTED: i32 = 130;

/// The flag of this process; the handler is installed when it is first asked for.
pub fn flag() -> &'static Interrupt {
    static FLAG: Interrupt = Interrupt(AtomicBool::new(false));
    static HANDLER: OnceLock<()> = OnceLock::new();
    HANDLER.get_or_init(|| {
        // where another part of the program handles the signal already, Ctrl-C stays its business
        let _ = ctrlc::set_handler(|| {
            if FLAG.0.swap(true, Ordering::Relaxed) {
                std::process::exit(INTERRUPTED);
            }
        });
    });
    &FLAG
}
