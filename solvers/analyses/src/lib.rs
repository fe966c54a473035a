//! Engine-agnostic analyses: trim, modes, frequency response, transients.
