//! The speed that a maneuver asks for.

use mbody::scalar::{Dual, Pchip, Real};

/// Target speed, over time or along the path.
#[derive(Clone, Debug)]
pub enum Speed {
    /// One speed, m/s.
    Constant(f64),
    /// Over time, s; constant before the first and after the last point.
    OverTime(Pchip),
    /// Over arc length, m; constant before the first and after the last point.
    AlongPath(Pchip),
}

/// Value and slope of a curve that ends level on both sides.
fn level<S: Real>(curve: &Pchip, x: S) -> (S, S) {
    let (first, last) = curve.range();
    if x.value() <= first || x.value() >= last {
        return (S::from_f64(curve.value(x.value().clamp(first, last))), S::zero());
    }
    let at = curve.value(Dual::<S, 1> { x, d: [S::one()] });
    (at.x, at.d[0])
}

impl Speed {
    /// Target, m/s, and its rate, m/s², at a time (s), an arc length (m) and its rate (m/s).
    pub fn at<S: Real>(&self, time: f64, s: S, along: S) -> (S, S) {
        match self {
            Self::Constant(speed) => (S::from_f64(*speed), S::zero()),
            Self::OverTime(curve) => {
                let (target, rate) = level(curve, time);
                (S::from_f64(target), S::from_f64(rate))
            }
            Self::AlongPath(curve) => {
                let (target, slope) = level(curve, s);
                (target, slope * along)
            }
        }
    }

    /// Points of time, s, where it is given over time.
    pub fn knots(&self) -> Vec<f64> {
        match self {
            Self::OverTime(curve) => curve.knots().to_vec(),
            _ => Vec::new(),
        }
    }

    /// Target at the start, m/s.
    pub fn first(&self) -> f64 {
        self.at(0.0, 0.0, 0.0).0
    }

    /// Smallest and largest target, m/s.
    pub fn range(&self) -> (f64, f64) {
        match self {
            Self::Constant(speed) => (*speed, *speed),
            Self::OverTime(curve) | Self::AlongPath(curve) => {
                let (first, last) = curve.range();
                let values = (0..=200).map(|k| curve.value(first + (last - first) * f64::from(k) / 200.0));
                values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
            }
        }
    }

    /// Largest lateral acceleration that a path demands at these speeds, m/s².
    pub fn greatest_lateral(&self, path: &super::Path) -> f64 {
        let count = 400;
        let at = |k: i32| path.length() * f64::from(k) / f64::from(count);
        match self {
            Self::AlongPath(_) => (0..=count).map(|k| self.at(0.0, at(k), 0.0).0.powi(2) * path.curvature(at(k)).abs()).fold(0.0, f64::max),
            _ => self.range().1.powi(2) * path.sharpest(0.0, path.length()),
        }
    }
}
