//! Inputs over time.

use problem::Plant;

/// The inputs of a plant as functions of time.
///
/// An input that names its rate input (road height and height rate) is followed together with it: both are written here. Functions
/// should be smooth between two sampling times; a jump belongs on a sampling time.
pub trait Inputs {
    /// Writes all inputs at `time` (s), in SI units.
    fn at(&self, time: f64, u: &mut [f64]);
}

/// Inputs that do not change.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant(pub Vec<f64>);

impl Constant {
    /// Every input at its default.
    pub fn defaults(plant: &dyn Plant) -> Self {
        Self(plant.inputs().iter().map(|i| i.default).collect())
    }
}

impl Inputs for Constant {
    fn at(&self, _time: f64, u: &mut [f64]) {
        u.copy_from_slice(&self.0);
    }
}

impl<F: Fn(f64, &mut [f64])> Inputs for F {
    fn at(&self, time: f64, u: &mut [f64]) {
        self(time, u);
    }
}
