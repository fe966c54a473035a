//! Steps that lead nowhere.

/// Watches for steps so short that rounding swallows them. A few are no harm, at a start for instance, but SUNDIALS goes on for ever.
#[derive(Default)]
pub struct Stuck {
    /// The time that does not advance.
    time: f64,
    /// Evaluations there.
    count: usize,
    /// Whether any evaluation failed since.
    pub failed: bool,
}

impl Stuck {
    /// Evaluations without progress that end an integration.
    const LIMIT: usize = 100;

    /// Takes note of one more evaluation.
    pub fn note(&mut self, time: f64, step: f64) {
        if time - step != time {
            return;
        }
        if time != self.time {
            *self = Self { time, count: 0, failed: false };
        }
        self.count += 1;
    }

    /// Whether nothing will come of it.
    pub fn for_ever(&self) -> bool {
        self.count > Self::LIMIT
    }
}
