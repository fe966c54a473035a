//! Heights about one place of a road, and curves over stations that change by smooth steps.
//!
//! ```text
//! y(x) = yᵢ + (yᵢ₊₁ − yᵢ) W(q)     W = 10 q³ − 15 q⁴ + 6 q⁵     q = (x − xᵢ)/(xᵢ₊₁ − xᵢ)
//! ```
//!
//! Level at every point, with two continuous derivatives; constant before the first and behind the last point. Source: elementary; the least polynomial whose first two derivatives vanish at both ends.

use super::Onset;
use mbody::scalar::Real;
use mbody::scalar::spline::{CurveError, CurvePoint};

/// Height of a road at one place and its derivatives up to the third, by the coordinates of its kind.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shape {
    /// Height, m.
    pub height: f64,
    /// By the first and by the second coordinate.
    pub first: [f64; 2],
    /// Twice by the first, by both, twice by the second, 1/m.
    pub second: [f64; 3],
    /// Thrice by the first, …, thrice by the second, 1/m².
    pub third: [f64; 4],
}

impl Shape {
    /// A road that is the same from edge to edge.
    pub fn along(z: CurvePoint<f64>) -> Self {
        Self { height: z.value, first: [z.slope, 0.0], second: [z.curvature, 0.0, 0.0], third: [0.0; 4] }
    }

    /// Height and both slopes close by, of second order in the distance: exact where only derivatives tell the places apart.
    #[inline]
    pub fn near<T: Real>(&self, du: T, dv: T) -> [T; 3] {
        let quadratic = |[a, b, c]: [f64; 3]| du * du * (0.5 * a) + du * dv * b + dv * dv * (0.5 * c);
        let linear = |constant: f64, [a, b]: [f64; 2]| du * a + dv * b + constant;
        let ([uu, uv, vv], [uuu, uuv, uvv, vvv]) = (self.second, self.third);
        [
            linear(self.height, self.first) + quadratic(self.second),
            linear(self.first[0], [uu, uv]) + quadratic([uuu, uuv, uvv]),
            linear(self.first[1], [uv, vv]) + quadratic([uuv, uvv, vvv]),
        ]
    }
}

/// A curve over stations, level at its points.
#[derive(Clone, Debug)]
pub(super) struct Steps {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Integrals from the first point to each.
    sums: Vec<f64>,
}

/// The curve at one place: its integral from the first point, itself, three derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepPoint {
    pub integral: f64,
    pub value: f64,
    pub slope: f64,
    pub curvature: f64,
    pub third: f64,
}

impl Steps {
    /// The curve through points (xᵢ, yᵢ), two or more.
    ///
    /// # Errors
    /// Too few points, or abscissas that do not increase.
    pub fn new(x: Vec<f64>, y: Vec<f64>) -> Result<Self, CurveError> {
        if x.len() < 2 {
            return Err(CurveError::TooFewPoints { found: x.len(), needed: 2 });
        }
        if let Some(k) = x.windows(2).position(|w| w[1] <= w[0]) {
            return Err(CurveError::NotIncreasing { point: k + 1, at: x[k + 1] });
        }
        let mut sums = vec![0.0; x.len()];
        for k in 1..x.len() {
            sums[k] = sums[k - 1] + 0.5 * (x[k] - x[k - 1]) * (y[k] + y[k - 1]);
        }
        Ok(Self { x, y, sums })
    }

    pub fn at(&self, x: f64) -> StepPoint {
        let constant = |k: usize| {
            let value = self.y[k];
            StepPoint { integral: self.sums[k] + value * (x - self.x[k]), value, slope: 0.0, curvature: 0.0, third: 0.0 }
        };
        let last = self.x.len() - 1;
        if x <= self.x[0] {
            return constant(0);
        }
        if x >= self.x[last] {
            return constant(last);
        }
        let i = self.x.partition_point(|k| *k <= x) - 1;
        let (h, change) = (self.x[i + 1] - self.x[i], self.y[i + 1] - self.y[i]);
        let step = Onset { begin: self.x[i], length: h };
        let [integral, value, slope, curvature, third] = step.share(x);
        StepPoint {
            integral: self.sums[i] + self.y[i] * (x - self.x[i]) + change * integral,
            value: self.y[i] + change * value,
            slope: change * slope,
            curvature: change * curvature,
            third: change * third,
        }
    }

    /// Length of the shortest change, m.
    pub fn shortest(&self) -> f64 {
        let changes = self.x.windows(2).zip(self.y.windows(2)).filter(|(_, y)| y[0] != y[1]);
        changes.map(|(x, _)| x[1] - x[0]).fold(f64::INFINITY, f64::min)
    }

    pub fn values(&self) -> &[f64] {
        &self.y
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_meet_their_points_and_their_derivatives_are_those_of_the_values() {
        let steps = Steps::new(vec![1.0, 3.0, 4.0, 8.0], vec![0.5, -0.2, -0.2, 1.0]).unwrap();
        for (x, y) in [(-5.0, 0.5), (1.0, 0.5), (3.0, -0.2), (3.5, -0.2), (8.0, 1.0), (20.0, 1.0)] {
            assert!((steps.at(x).value - y).abs() < 1e-15);
        }
        let h = 1e-5;
        for x in [-1.0, 1.3, 2.9, 3.0, 4.7, 6.1, 8.0, 9.0] {
            let (a, at, b) = (steps.at(x - h), steps.at(x), steps.at(x + h));
            assert!(((b.integral - a.integral) / (2.0 * h) - at.value).abs() < 1e-9, "at {x}");
            assert!(((b.value - a.value) / (2.0 * h) - at.slope).abs() < 1e-8, "at {x}");
            assert!(((b.slope - a.slope) / (2.0 * h) - at.curvature).abs() < 1e-4, "at {x}");
        }
        assert!(steps.shortest() == 2.0);
        assert!(Steps::new(vec![0.0, 0.0], vec![1.0, 1.0]).is_err() && Steps::new(vec![0.0], vec![1.0]).is_err());
    }
}
