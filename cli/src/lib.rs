//! Command line for motorcycle handling and stability.
