//! Inputs over time.

use problem::Plant;

/// The inputs of a plant as functions of time.
///
/// An input that names its rate input (road height and height rate) is followed together with it: both are written here.
pub trait Inputs {
    /// Writes all inputs at `time` (s), in SI units; at a break those after it.
    fn at(&self, time: f64, u: &mut [f64]);

    /// Times at which inputs jump or have a corner, s, in any order: the integration starts anew there. Elsewhere inputs are smooth.
    fn breaks(&self) -> Vec<f64> {
        Vec::new()
    }
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
