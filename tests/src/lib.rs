//! Verification, validation and diagnostics of the whole.
