//! Curves through points: the twice differentiable cubic spline and the monotone cubic.
//!
//! In each interval of width `h`, with `u = (x − xᵢ)/h`, `w = 1 − u` and second derivatives `mᵢ` at the knots,
//!
//! ```text
//! s(x) = w yᵢ + u yᵢ₊₁ + h²/6 [ (w³ − w) mᵢ + (u³ − u) mᵢ₊₁ ]
//! ```
//!
//! Both curves go on as straight lines outside their knots.
//!
//! Source: C. de Boor, *A Practical Guide to Splines*, Springer 1978, chapter IV; F. N. Fritsch, R. E. Carlson, SIAM J.
//! Numer. Anal. 17 (1980) 238–246, with the slopes of F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300–304.

use super::Real;

/// Why points do not make a curve.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CurveError {
    /// Too few points for this kind of curve.
    #[error("the curve has {found} points but needs at least {needed}")]
    TooFewPoints {
        /// Points given.
        found: usize,
        /// Points needed.
        needed: usize,
    },
    /// Abscissas and ordinates do not pair up.
    #[error("the curve has {abscissas} abscissas but {ordinates} ordinates")]
    Unpaired {
        /// Number of abscissas.
        abscissas: usize,
        /// Number of ordinates.
        ordinates: usize,
    },
    /// An abscissa does not exceed the one before it.
    #[error("point {point} of the curve is at {at}, which is not beyond the point before it")]
    NotIncreasing {
        /// Index of the point, from 0.
        point: usize,
        /// Its abscissa.
        at: f64,
    },
    /// A coordinate is infinite or not a number.
    #[error("point {point} of the curve is not finite")]
    NotFinite {
        /// Index of the point, from 0.
        point: usize,
    },
}

/// What a cubic spline does at its first and last knot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ends {
    /// No curvature: the straight continuation is twice differentiable.
    Natural,
    /// Given slopes.
    Clamped {
        /// Slope at the first knot.
        first: f64,
        /// Slope at the last knot.
        last: f64,
    },
    /// The first two and the last two intervals share one cubic: fourth-order accurate up to the ends; four points or more.
    NotAKnot,
}

/// Value, slope and second derivative of a curve at one place.
#[derive(Clone, Copy, Debug)]
pub struct CurvePoint<S> {
    /// Value.
    pub value: S,
    /// First derivative.
    pub slope: S,
    /// Second derivative.
    pub curvature: S,
}

/// How a spline weighs (yᵢ, yᵢ₊₁, mᵢ, mᵢ₊₁) of one interval, and the derivatives of these weights.
pub(crate) struct Weights<S> {
    pub(crate) interval: usize,
    pub(crate) value: [S; 4],
    pub(crate) slope: [S; 4],
}

/// A curve with two continuous derivatives through given points.
#[derive(Clone, Debug, PartialEq)]
pub struct CubicSpline {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Second derivatives at the knots.
    m: Vec<f64>,
    /// Integrals from the first knot to each knot.
    sums: Vec<f64>,
}

impl CubicSpline {
    /// The spline through the points (xᵢ, yᵢ).
    ///
    /// # Errors
    /// Fewer than two points (four for [`Ends::NotAKnot`]), unpaired, not finite, or abscissas that do not increase.
    pub fn new(x: &[f64], y: &[f64], ends: Ends) -> Result<Self, CurveError> {
        let needed = if ends == Ends::NotAKnot { 4 } else { 2 };
        check_points(x, y, needed)?;
        let m = second_derivatives(x, y, ends);
        let mut sums = vec![0.0; x.len()];
        for i in 1..x.len() {
            let h = x[i] - x[i - 1];
            sums[i] = sums[i - 1] + 0.5 * h * (y[i - 1] + y[i]) - h.powi(3) / 24.0 * (m[i - 1] + m[i]);
        }
        Ok(Self { x: x.to_vec(), y: y.to_vec(), m, sums })
    }

    /// First and last abscissa.
    pub fn range(&self) -> (f64, f64) {
        (self.x[0], self.x[self.x.len() - 1])
    }

    /// Abscissas of the knots.
    pub fn knots(&self) -> &[f64] {
        &self.x
    }

    /// Value at x.
    #[inline]
    pub fn value<S: Real>(&self, x: S) -> S {
        self.at(x).value
    }

    /// Integral from the first knot to x, the straight continuations included.
    pub fn integral<S: Real>(&self, x: S) -> S {
        let i = interval(&self.x, x.value());
        let h = self.x[i + 1] - self.x[i];
        let u = (x - self.x[i]) / h;
        for (beyond, end) in [(u.value() < 0.0, i), (u.value() > 1.0, i + 1)] {
            if beyond {
                let knot = self.at(self.x[end]);
                let d = x - self.x[end];
                return d * d * (0.5 * knot.slope) + d * knot.value + self.sums[end];
            }
        }
        let w = -u + 1.0;
        let (uu, ww) = (u * u, w * w);
        let lines = (-ww + 1.0) * (0.5 * self.y[i]) + uu * (0.5 * self.y[i + 1]);
        let bend = (ww * (-ww * 0.25 + 0.5) - 0.25) * self.m[i] + uu * (uu * 0.25 - 0.5) * self.m[i + 1];
        (lines + bend * (h * h / 6.0)) * h + self.sums[i]
    }

    /// Value, slope and second derivative at x.
    pub fn at<S: Real>(&self, x: S) -> CurvePoint<S> {
        let w = weights(&self.x, x);
        let (i, j) = (w.interval, w.interval + 1);
        let known = [self.y[i], self.y[j], self.m[i], self.m[j]];
        let (first, last) = self.range();
        let curvature = if x.value() < first || x.value() > last {
            S::zero()
        } else {
            let u = (x - self.x[i]) / (self.x[j] - self.x[i]);
            u * (self.m[j] - self.m[i]) + self.m[i]
        };
        CurvePoint { value: weigh(&w.value, &known), slope: weigh(&w.slope, &known), curvature }
    }
}

#[inline(always)]
fn weigh<S: Real>(weights: &[S; 4], known: &[f64; 4]) -> S {
    weights[0] * known[0] + weights[1] * known[1] + weights[2] * known[2] + weights[3] * known[3]
}

/// Index of the interval that holds x; the first or the last one outside.
fn interval(knots: &[f64], x: f64) -> usize {
    knots.partition_point(|k| *k <= x).clamp(1, knots.len() - 1) - 1
}

/// Weights of the spline at x, with the straight continuation outside the knots.
pub(crate) fn weights<S: Real>(knots: &[f64], x: S) -> Weights<S> {
    let i = interval(knots, x.value());
    let h = knots[i + 1] - knots[i];
    let u = (x - knots[i]) / h;
    let outside = if u.value() < 0.0 {
        Some(0.0)
    } else if u.value() > 1.0 {
        Some(1.0)
    } else {
        None
    };
    let Some(end) = outside else {
        let (value, slope) = cubic_weights(u, h);
        return Weights { interval: i, value, slope };
    };
    // value and slope at the end, then straight on
    let (value, slope) = cubic_weights(end, h);
    let beyond = (u - end) * h;
    Weights { interval: i, value: std::array::from_fn(|k| beyond * slope[k] + value[k]), slope: slope.map(S::from_f64) }
}

fn cubic_weights<S: Real>(u: S, h: f64) -> ([S; 4], [S; 4]) {
    let w = -u + 1.0;
    let (uu, ww) = (u * u, w * w);
    let value = [w, u, (ww - 1.0) * w * (h * h / 6.0), (uu - 1.0) * u * (h * h / 6.0)];
    let slope = [S::from_f64(-1.0 / h), S::from_f64(1.0 / h), (ww * -3.0 + 1.0) * (h / 6.0), (uu * 3.0 - 1.0) * (h / 6.0)];
    (value, slope)
}

pub(crate) fn check_points(x: &[f64], y: &[f64], needed: usize) -> Result<(), CurveError> {
    if x.len() != y.len() {
        return Err(CurveError::Unpaired { abscissas: x.len(), ordinates: y.len() });
    }
    if x.len() < needed {
        return Err(CurveError::TooFewPoints { found: x.len(), needed });
    }
    if let Some(point) = (0..x.len()).find(|&i| !(x[i].is_finite() && y[i].is_finite())) {
        return Err(CurveError::NotFinite { point });
    }
    match (1..x.len()).find(|&i| x[i] <= x[i - 1]) {
        Some(point) => Err(CurveError::NotIncreasing { point, at: x[point] }),
        None => Ok(()),
    }
}

/// Second derivatives at the knots: the tridiagonal system that makes the slopes continuous.
///
/// The points must have passed [`check_points`].
pub(crate) fn second_derivatives(x: &[f64], y: &[f64], ends: Ends) -> Vec<f64> {
    let n = x.len();
    let h: Vec<f64> = x.windows(2).map(|k| k[1] - k[0]).collect();
    let chord: Vec<f64> = (0..n - 1).map(|i| (y[i + 1] - y[i]) / h[i]).collect();
    // rows: lower m[i-1] + diagonal m[i] + upper m[i+1] = right
    let (mut lower, mut diagonal, mut upper, mut right) = (vec![0.0; n], vec![1.0; n], vec![0.0; n], vec![0.0; n]);
    for i in 1..n - 1 {
        lower[i] = h[i - 1];
        diagonal[i] = 2.0 * (h[i - 1] + h[i]);
        upper[i] = h[i];
        right[i] = 6.0 * (chord[i] - chord[i - 1]);
    }
    match ends {
        Ends::Natural => {}
        Ends::Clamped { first, last } => {
            (diagonal[0], upper[0], right[0]) = (2.0 * h[0], h[0], 6.0 * (chord[0] - first));
            (lower[n - 1], diagonal[n - 1], right[n - 1]) = (h[n - 2], 2.0 * h[n - 2], 6.0 * (last - chord[n - 2]));
        }
        Ends::NotAKnot => {
            // m[0] = m[1] − (m[2] − m[1]) h₀/h₁ put into row 1, and the same from the other end
            let (a, b) = (h[0] / h[1], h[n - 2] / h[n - 3]);
            diagonal[1] += h[0] * (1.0 + a);
            upper[1] -= h[0] * a;
            diagonal[n - 2] += h[n - 2] * (1.0 + b);
            lower[n - 2] -= h[n - 2] * b;
            lower[1] = 0.0;
            upper[n - 2] = 0.0;
        }
    }
    let mut m = solve_tridiagonal(&lower, diagonal, &upper, right);
    if ends == Ends::NotAKnot {
        m[0] = m[1] - (m[2] - m[1]) * h[0] / h[1];
        m[n - 1] = m[n - 2] + (m[n - 2] - m[n - 3]) * h[n - 2] / h[n - 3];
    }
    m
}

/// Elimination without pivoting: the rows of a spline are diagonally dominant.
fn solve_tridiagonal(lower: &[f64], mut diagonal: Vec<f64>, upper: &[f64], mut right: Vec<f64>) -> Vec<f64> {
    let n = diagonal.len();
    for i in 1..n {
        let factor = lower[i] / diagonal[i - 1];
        diagonal[i] -= factor * upper[i - 1];
        right[i] -= factor * right[i - 1];
    }
    right[n - 1] /= diagonal[n - 1];
    for i in (0..n - 1).rev() {
        right[i] = (right[i] - upper[i] * right[i + 1]) / diagonal[i];
    }
    right
}

/// A curve with one continuous derivative that rises and falls only where its points do (PCHIP).
#[derive(Clone, Debug, PartialEq)]
pub struct Pchip {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Slopes at the knots.
    slope: Vec<f64>,
}

impl Pchip {
    /// The monotone cubic through the points (xᵢ, yᵢ).
    ///
    /// # Errors
    /// Fewer than two points, unpaired, not finite, or abscissas that do not increase.
    pub fn new(x: &[f64], y: &[f64]) -> Result<Self, CurveError> {
        check_points(x, y, 2)?;
        Ok(Self { x: x.to_vec(), y: y.to_vec(), slope: monotone_slopes(x, y) })
    }

    /// First and last abscissa.
    pub fn range(&self) -> (f64, f64) {
        (self.x[0], self.x[self.x.len() - 1])
    }

    /// Abscissas of the knots.
    pub fn knots(&self) -> &[f64] {
        &self.x
    }

    /// Value at x.
    pub fn value<S: Real>(&self, x: S) -> S {
        let i = interval(&self.x, x.value());
        let h = self.x[i + 1] - self.x[i];
        let u = (x - self.x[i]) / h;
        if u.value() < 0.0 {
            return (x - self.x[i]) * self.slope[i] + self.y[i];
        }
        if u.value() > 1.0 {
            return (x - self.x[i + 1]) * self.slope[i + 1] + self.y[i + 1];
        }
        // cubic Hermite form in powers of u
        let rise = self.y[i + 1] - self.y[i];
        let (s0, s1) = (self.slope[i] * h, self.slope[i + 1] * h);
        let (c2, c3) = (3.0 * rise - 2.0 * s0 - s1, s0 + s1 - 2.0 * rise);
        ((u * c3 + c2) * u + s0) * u + self.y[i]
    }
}

/// Weighted harmonic means of the chords inside, three-point formulas limited to monotone at the ends.
fn monotone_slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    let h: Vec<f64> = x.windows(2).map(|k| k[1] - k[0]).collect();
    let chord: Vec<f64> = (0..n - 1).map(|i| (y[i + 1] - y[i]) / h[i]).collect();
    if n == 2 {
        return vec![chord[0]; 2];
    }
    let mut slope = vec![0.0; n];
    for i in 1..n - 1 {
        if chord[i - 1] * chord[i] > 0.0 {
            let (a, b) = (2.0 * h[i] + h[i - 1], h[i] + 2.0 * h[i - 1]);
            slope[i] = (a + b) / (a / chord[i - 1] + b / chord[i]);
        }
    }
    slope[0] = end_slope(h[0], h[1], chord[0], chord[1]);
    slope[n - 1] = end_slope(h[n - 2], h[n - 3], chord[n - 2], chord[n - 3]);
    slope
}

/// Slope at an end from the nearest and the next interval.
fn end_slope(h: f64, h_next: f64, chord: f64, chord_next: f64) -> f64 {
    let slope = ((2.0 * h + h_next) * chord - h * chord_next) / (h + h_next);
    if slope * chord <= 0.0 {
        0.0
    } else if chord * chord_next < 0.0 && slope.abs() > 3.0 * chord.abs() {
        3.0 * chord
    } else {
        slope
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Jet;

    #[test]
    fn the_integral_of_a_spline_has_the_spline_as_its_slope() {
        let x = [-1.0, -0.2, 0.5, 1.5, 3.0];
        let y = [0.3, -1.0, 2.0, 2.5, -4.0];
        let s = CubicSpline::new(&x, &y, Ends::Natural).unwrap();
        assert_eq!(s.integral(x[0]), 0.0);
        for at in [-2.0, -1.0, -0.5, 0.0, 0.499, 0.501, 2.0, 2.999, 3.0, 4.0] {
            let j = s.integral(Jet::new(at, 1.0, 0.0));
            assert!((j.d - s.value(at)).abs() < 1e-13, "at {at}");
        }
        for knot in x {
            assert!((s.integral(knot - 1e-9) - s.integral(knot + 1e-9)).abs() < 1e-7);
        }
    }

    fn cubic(x: f64) -> f64 {
        ((0.3 * x - 1.1) * x + 0.7) * x - 2.0
    }

    const X: [f64; 6] = [-1.0, -0.2, 0.5, 0.9, 2.0, 2.3];

    #[test]
    fn a_cubic_is_its_own_spline() {
        let y = X.map(cubic);
        let slope = |x: f64| (0.9 * x - 2.2) * x + 0.7;
        for ends in [Ends::NotAKnot, Ends::Clamped { first: slope(-1.0), last: slope(2.3) }] {
            let spline = CubicSpline::new(&X, &y, ends).unwrap();
            for k in 0..=33 {
                let x = -0.999 + 0.0999 * f64::from(k);
                let p = spline.at(x);
                assert!((p.value - cubic(x)).abs() < 1e-13, "{ends:?} value at {x}");
                assert!((p.slope - slope(x)).abs() < 1e-12, "{ends:?} slope at {x}");
                assert!((p.curvature - (1.8 * x - 2.2)).abs() < 1e-11, "{ends:?} curvature at {x}");
            }
        }
    }

    #[test]
    fn slope_and_curvature_are_the_derivatives_of_the_value() {
        let spline = CubicSpline::new(&X, &[0.0, 1.0, -0.5, 0.3, 2.0, 1.0], Ends::Natural).unwrap();
        for x in [-1.5, -0.7, 0.0, 0.6, 1.4, 2.2, 3.0] {
            let (jet, point) = (spline.value(Jet::new(x, 1.0, 0.0)), spline.at(x));
            assert!((jet.d - point.slope).abs() < 1e-12 && (jet.dd - point.curvature).abs() < 1e-11, "at {x}");
        }
    }

    #[test]
    fn two_derivatives_are_continuous_across_knots_and_natural_ends() {
        let spline = CubicSpline::new(&X, &[0.0, 1.0, -0.5, 0.3, 2.0, 1.0], Ends::Natural).unwrap();
        for x in X {
            let (a, b) = (spline.at(x - 1e-9), spline.at(x + 1e-9));
            assert!((a.value - b.value).abs() < 1e-7 && (a.slope - b.slope).abs() < 1e-6, "at {x}");
            assert!((a.curvature - b.curvature).abs() < 1e-6, "at {x}");
        }
    }

    #[test]
    fn the_monotone_cubic_passes_through_its_points_and_never_overshoots() {
        let y = [0.0, 0.0, 1.0, 1.0, 1.5, 4.0];
        let curve = Pchip::new(&X, &y).unwrap();
        for (x, y) in X.iter().zip(y) {
            assert!((curve.value(*x) - y).abs() < 1e-14);
        }
        let mut last = curve.value(-1.0);
        for k in 1..=330 {
            let j = curve.value(Jet::new(-1.0 + 0.01 * f64::from(k), 1.0, 0.0));
            assert!(j.x >= last - 1e-14 && j.d >= -1e-13);
            last = j.x;
        }
    }

    #[test]
    fn the_monotone_cubic_is_straight_outside_and_smooth_across_its_ends() {
        let curve = Pchip::new(&X, &[0.0, 0.2, 1.0, 1.1, 1.5, 4.0]).unwrap();
        for x in X {
            let (a, b) = (curve.value(Jet::new(x - 1e-10, 1.0, 0.0)), curve.value(Jet::new(x + 1e-10, 1.0, 0.0)));
            assert!((a.d - b.d).abs() < 1e-7, "at {x}");
        }
        assert_eq!(curve.value(Jet::new(5.0, 1.0, 0.0)).dd, 0.0);
    }

    #[test]
    fn wrong_points_are_named() {
        assert_eq!(Pchip::new(&[0.0], &[1.0]), Err(CurveError::TooFewPoints { found: 1, needed: 2 }));
        assert_eq!(Pchip::new(&[0.0, 0.0], &[1.0, 2.0]), Err(CurveError::NotIncreasing { point: 1, at: 0.0 }));
        assert_eq!(CubicSpline::new(&[0.0, 1.0], &[1.0], Ends::Natural), Err(CurveError::Unpaired { abscissas: 2, ordinates: 1 }));
        assert_eq!(CubicSpline::new(&[0.0, 1.0], &[1.0, f64::NAN], Ends::Natural), Err(CurveError::NotFinite { point: 1 }));
    }
}
