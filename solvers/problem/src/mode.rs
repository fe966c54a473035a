//! What a mode of small motions is called: rules that those who know a trade hand to the analyses.

/// Whether a rule speaks of oscillations or of real eigenvalues.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nature {
    /// A pair of conjugate eigenvalues.
    Oscillation,
    /// A real eigenvalue.
    Real,
    /// Either.
    Any,
}

/// How many modes at one point may have the name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Occurs {
    /// One at most.
    Once,
    /// As many as look like it.
    Often,
}

/// How to recognize a mode by the signals that take part in it, its frequency and its damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeRule {
    /// Name of the mode: `weave`.
    pub name: &'static str,
    /// One sentence: what moves.
    pub about: &'static str,
    /// Patterns of signal names (`*` stands for anything) with the weight of their participation, 1 for the leading ones.
    pub takes_part: &'static [(&'static str, f64)],
    /// Usual natural frequency `|s| / 2π`, of real eigenvalues too, Hz.
    pub frequency: (f64, f64),
    /// Usual damping ratio; one of a real eigenvalue is ±1.
    pub damping: (f64, f64),
    /// Oscillation or real eigenvalue.
    pub nature: Nature,
    /// How many modes may have the name.
    pub occurs: Occurs,
}
