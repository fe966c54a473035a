//! What a command prints.
