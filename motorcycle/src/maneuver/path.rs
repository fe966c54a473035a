//! A path on the road: a curve by arc length.
//!
//! `ψ' = κ(s)`, `x' = cos ψ`, `y' = sin ψ`; s arc length, m; κ curvature, positive to the left, 1/m; ψ heading, rad. Heading and position are
//! integrals of what was laid (the position by Gauss–Legendre, four points an interval), all of them twice differentiable splines over arc length; corners of the
//! curvature are rounded over a knot. Before its start a path is straight, beyond its end it keeps its curvature for [`BEYOND`].
//!
//! Source: elementary differential geometry. Range: intervals of [`STEP`]; curvature radii well above it.

use mbody::scalar::spline::{CubicSpline, Ends};
use mbody::scalar::{Dual, Real};

/// Distance between two knots, m.
const STEP: f64 = 0.05;

/// What a path goes on for beyond its end, m: what is seen ahead from there.
pub const BEYOND: f64 = 200.0;

/// What a path has before its start, m.
const BEFORE: f64 = 20.0;

/// Rate at which an arc length follows who is ahead of it, 1/s.
const CATCH_UP: f64 = 5.0;

/// A curve by arc length.
#[derive(Clone, Debug)]
pub struct Path {
    curvature: CubicSpline,
    heading: CubicSpline,
    x: CubicSpline,
    y: CubicSpline,
    length: f64,
}

/// A place on a path.
#[derive(Clone, Copy, Debug)]
pub struct Place<S> {
    /// Position, m.
    pub x: S,
    /// Position, m.
    pub y: S,
    /// Heading, rad.
    pub heading: S,
    /// Curvature, 1/m.
    pub curvature: S,
}

/// Where somebody is against a path.
#[derive(Clone, Copy, Debug)]
pub struct Progress<S> {
    /// The place on the path.
    pub place: Place<S>,
    /// Distance to the left of it, m.
    pub offset: S,
    /// Heading against that of the path, rad.
    pub heading_error: S,
    /// Speed of the nearest place along the path, m/s.
    pub along: S,
    /// Rate of the arc length, m/s: that speed, and what brings the arc length to the nearest place.
    pub rate: S,
}

impl Path {
    /// Progress along the path of who is at x, y (m), heads for an angle (rad) and moves forward and to the left (m/s).
    ///
    /// The arc length s is a state of whoever asks: `ṡ = (V_x cos ψ_e − V_y sin ψ_e)/(1 − κ e) + k_s e_t`, with the offset e, the heading error `ψ_e = ψ − ψ_p(s)` and
    /// the distance e_t by which he is ahead of s along the path. There is no search, and it can be differentiated. Source: theory manual 10.1.
    #[inline]
    pub fn progress<S: Real>(&self, s: S, [x, y, heading, forward, lateral]: [S; 5]) -> Progress<S> {
        let place = self.at(s);
        let (sine, cosine) = place.heading.sin_cos();
        let (dx, dy) = (x - place.x, y - place.y);
        let (ahead, offset) = (cosine * dx + sine * dy, cosine * dy - sine * dx);
        let heading_error = heading - place.heading;
        let (se, ce) = heading_error.sin_cos();
        let along = (forward * ce - lateral * se) / (-(place.curvature * offset) + 1.0);
        Progress { place, offset, heading_error, along, rate: along + ahead * CATCH_UP }
    }

    /// Arc length of what was laid, m.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Curvature, 1/m, at an arc length, m.
    #[inline]
    pub fn curvature<S: Real>(&self, s: S) -> S {
        self.curvature.value(s)
    }

    /// Position, heading and curvature at an arc length, m.
    #[inline]
    pub fn at<S: Real>(&self, s: S) -> Place<S> {
        Place { x: self.x.value(s), y: self.y.value(s), heading: self.heading.value(s), curvature: self.curvature.value(s) }
    }

    /// Largest curvature between two arc lengths, 1/m, without sign.
    pub fn sharpest(&self, from: f64, to: f64) -> f64 {
        let count = ((to - from) / STEP).ceil().max(1.0) as usize;
        (0..=count).map(|k| self.curvature(from + (to - from) * k as f64 / count as f64).abs()).fold(0.0, f64::max)
    }
}

/// Lays a path piece by piece: what follows begins where the last piece ended, in its direction.
#[derive(Debug, Default)]
pub struct Layout {
    /// Length and curvature of each piece, by its own arc length.
    pieces: Vec<(f64, Piece)>,
}

#[derive(Debug)]
enum Piece {
    /// Curvature that changes evenly between two values.
    Even(f64, f64),
    /// Curvature between samples.
    Sampled(CubicSpline),
}

impl Layout {
    /// Straight on, m.
    pub fn straight(&mut self, length: f64) {
        self.bend(length, 0.0, 0.0);
    }

    /// Curvature that changes evenly from one value to another (1/m) over a length: an arc where they are equal, a clothoid elsewhere.
    pub fn bend(&mut self, length: f64, from: f64, to: f64) {
        if length > 0.0 {
            self.pieces.push((length, Piece::Even(from, to)));
        }
    }

    /// A curve `y(x)` in the frame of the end of the last piece, x from 0 to `length`, with no slope at both ends. `y` is generic over its scalar by way
    /// of second-order numbers: it is handed x as a value with two derivatives.
    pub fn offset(&mut self, length: f64, y: impl Fn(Twice) -> Twice) {
        let count = ((length / (0.25 * STEP)).ceil() as usize).max(8);
        let h = length / count as f64;
        // slope and second derivative at x
        let shape = |x: f64| {
            let at = y(twice(x));
            (at.d[0].x, at.d[0].d[0])
        };
        let speed = |x: f64| (1.0 + shape(x).0.powi(2)).sqrt();
        let (mut s, mut arcs, mut curvatures) = (0.0, Vec::with_capacity(count + 1), Vec::with_capacity(count + 1));
        for k in 0..=count {
            let x = h * k as f64;
            if k > 0 {
                // Simpson's rule
                s += h / 6.0 * (speed(x - h) + 4.0 * speed(x - 0.5 * h) + speed(x));
            }
            let (slope, bend) = shape(x);
            arcs.push(s);
            curvatures.push(bend / (1.0 + slope * slope).powf(1.5));
        }
        if let Ok(curve) = CubicSpline::new(&arcs, &curvatures, Ends::Natural) {
            self.pieces.push((s, Piece::Sampled(curve)));
        }
    }

    /// Curvature (1/m) over arc length (m) from 0 to the last knot.
    pub fn curve(&mut self, curvature: CubicSpline) {
        self.pieces.push((curvature.range().1, Piece::Sampled(curvature)));
    }

    /// Curvature at the end of what was laid, 1/m.
    pub fn last_curvature(&self) -> f64 {
        match self.pieces.last() {
            Some((_, Piece::Even(_, to))) => *to,
            Some((length, Piece::Sampled(curve))) => curve.value(*length),
            None => 0.0,
        }
    }

    /// Length of what was laid, m.
    pub fn length(&self) -> f64 {
        self.pieces.iter().map(|(l, _)| l).sum()
    }

    fn curvature(&self, s: f64) -> f64 {
        let mut from = 0.0;
        if s < 0.0 {
            return 0.0;
        }
        for (length, piece) in &self.pieces {
            if s <= from + length {
                let at = s - from;
                return match piece {
                    Piece::Even(a, b) => a + (b - a) * at / length,
                    Piece::Sampled(curve) => curve.value(at),
                };
            }
            from += length;
        }
        self.last_curvature()
    }

    /// Heading at an arc length: what the pieces turn by, exactly.
    fn heading(&self, s: f64) -> f64 {
        let (mut from, mut heading) = (0.0, 0.0);
        for (length, piece) in &self.pieces {
            let at = (s - from).clamp(0.0, *length);
            heading += match piece {
                Piece::Even(a, b) => at * (a + 0.5 * (b - a) * at / length),
                Piece::Sampled(curve) => curve.integral(at),
            };
            from += length;
        }
        heading + self.last_curvature() * (s - from).max(0.0)
    }

    /// The path, from the origin along x.
    pub fn path(&self) -> Path {
        let length = self.length();
        let count = ((BEFORE + length + BEYOND) / STEP).ceil() as usize;
        let s: Vec<f64> = (0..=count).map(|k| k as f64 * STEP - BEFORE).collect();
        let values: Vec<f64> = s.iter().map(|&s| self.curvature(s)).collect();
        // knots increase and are finite, and there are more than two: these splines exist
        let spline = |y: &[f64], ends| CubicSpline::new(&s, y, ends).unwrap_or_else(|_| unreachable!());
        let curvature = spline(&values, Ends::Clamped { first: 0.0, last: 0.0 });
        let (mut x, mut y) = (vec![0.0; s.len()], vec![0.0; s.len()]);
        for k in 1..s.len() {
            let (dx, dy) = GAUSS.iter().fold((0.0, 0.0), |(dx, dy), (at, weight)| {
                let (sine, cosine) = self.heading(s[k - 1] + STEP * at).sin_cos();
                (dx + weight * STEP * cosine, dy + weight * STEP * sine)
            });
            (x[k], y[k]) = (x[k - 1] + dx, y[k - 1] + dy);
        }
        let heading: Vec<f64> = s.iter().map(|&s| self.heading(s)).collect();
        let clamped = |y: &[f64], slope: &dyn Fn(usize) -> f64| spline(y, Ends::Clamped { first: slope(0), last: slope(count) });
        let x_curve = clamped(&x, &|k| heading[k].cos());
        let y_curve = clamped(&y, &|k| heading[k].sin());
        let (x0, y0) = (x_curve.value(0.0), y_curve.value(0.0));
        let shifted = |v: &[f64], by: f64| v.iter().map(|v| v - by).collect::<Vec<_>>();
        Path {
            x: clamped(&shifted(&x, x0), &|k| heading[k].cos()),
            y: clamped(&shifted(&y, y0), &|k| heading[k].sin()),
            heading: clamped(&heading, &|k| values[k]),
            curvature,
            length,
        }
    }
}

/// Nodes on [0, 1] and weights of the Gauss–Legendre rule with four points.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// A number with its first and second derivative by one variable.
pub type Twice = Dual<Dual<f64, 1>, 1>;

/// x as the variable.
fn twice(x: f64) -> Twice {
    let mut at = Twice::from_f64(x);
    at.x.d[0] = 1.0;
    at.d[0].x = 1.0;
    at
}
