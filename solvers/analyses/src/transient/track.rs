//! Signals over time from pieces and tables, and inputs made of them.

use super::inputs::Inputs;
use problem::Plant;

/// A signal over time with its rate.
pub trait Track {
    /// Value at a time, s; at a break that after it.
    fn value(&self, time: f64) -> f64;
    /// Rate at a time, per second; at a break that after it.
    fn rate(&self, time: f64) -> f64;
    /// Times at which value or rate jumps, s.
    fn breaks(&self) -> Vec<f64>;
}

/// Zero, then another value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// When, s.
    pub time: f64,
    /// By how much.
    pub height: f64,
}

impl Track for Step {
    fn value(&self, time: f64) -> f64 {
        if time < self.time { 0.0 } else { self.height }
    }
    fn rate(&self, _time: f64) -> f64 {
        0.0
    }
    fn breaks(&self) -> Vec<f64> {
        vec![self.time]
    }
}

/// Zero, then a straight line to another value, which stays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ramp {
    /// Where the line begins, s.
    pub begin: f64,
    /// Where it ends, s; later than its beginning.
    pub end: f64,
    /// By how much.
    pub height: f64,
}

impl Track for Ramp {
    fn value(&self, time: f64) -> f64 {
        self.height * ((time - self.begin) / (self.end - self.begin)).clamp(0.0, 1.0)
    }
    fn rate(&self, time: f64) -> f64 {
        if self.begin <= time && time < self.end { self.height / (self.end - self.begin) } else { 0.0 }
    }
    fn breaks(&self) -> Vec<f64> {
        vec![self.begin, self.end]
    }
}

/// A straight line through zero at the start, without end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drifting {
    /// Change per second.
    pub rate: f64,
}

impl Track for Drifting {
    fn value(&self, time: f64) -> f64 {
        self.rate * time
    }
    fn rate(&self, _time: f64) -> f64 {
        self.rate
    }
    fn breaks(&self) -> Vec<f64> {
        Vec::new()
    }
}

/// One bell `h/2 (1 − cos 2πs)` over its duration, with a continuous rate: a bump, a gust, a steering impulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulse {
    /// Where it begins, s.
    pub begin: f64,
    /// How long it lasts, s.
    pub duration: f64,
    /// Largest value.
    pub height: f64,
}

impl Pulse {
    /// Share of the duration that has passed, as an angle of a full turn.
    fn angle(&self, time: f64) -> f64 {
        std::f64::consts::TAU * ((time - self.begin) / self.duration).clamp(0.0, 1.0)
    }
}

impl Track for Pulse {
    fn value(&self, time: f64) -> f64 {
        0.5 * self.height * (1.0 - self.angle(time).cos())
    }
    fn rate(&self, time: f64) -> f64 {
        std::f64::consts::PI * self.height / self.duration * self.angle(time).sin()
    }
    fn breaks(&self) -> Vec<f64> {
        vec![self.begin, self.begin + self.duration]
    }
}

/// A table of values with a continuous rate between them that never overshoots; two rows of one time are a jump. Before the first row and after
/// the last their values hold.
///
/// Cubic Hermite polynomials with the slopes of F. N. Fritsch, J. Butland, *A method for constructing local monotone piecewise cubic
/// interpolants*, SIAM J. Sci. Stat. Comput. 5, 1984, 300–304: a weighted harmonic mean of the neighboring secants, zero at an extremum.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    times: Vec<f64>,
    values: Vec<f64>,
    slopes: Vec<f64>,
}

impl Table {
    /// A table of at least one row, with finite times that do not decrease; `None` for another one.
    pub fn new(times: Vec<f64>, values: Vec<f64>) -> Option<Self> {
        let ordered = times.windows(2).all(|w| w[0] <= w[1]) && times.iter().chain(&values).all(|x| x.is_finite());
        if times.is_empty() || times.len() != values.len() || !ordered {
            return None;
        }
        let mut slopes = vec![0.0; times.len()];
        let mut first = 0;
        while first < times.len() {
            // one stretch without a jump
            let last = (first + 1..times.len()).find(|&k| times[k] == times[k - 1]).unwrap_or(times.len());
            slope(&times[first..last], &values[first..last], &mut slopes[first..last]);
            first = last;
        }
        Some(Self { times, values, slopes })
    }

    /// The interval around a time: its index and the share of it that has passed.
    fn interval(&self, time: f64) -> Option<(usize, f64)> {
        let after = self.times.partition_point(|&t| t <= time);
        (after > 0 && after < self.times.len())
            .then(|| (after - 1, (time - self.times[after - 1]) / (self.times[after] - self.times[after - 1])))
    }
}

impl Track for Table {
    fn value(&self, time: f64) -> f64 {
        let Some((k, s)) = self.interval(time) else {
            return if time < self.times[0] { self.values[0] } else { self.values[self.values.len() - 1] };
        };
        let h = self.times[k + 1] - self.times[k];
        let rise = self.values[k + 1] - self.values[k];
        let (a, b) = (self.slopes[k] * h - rise, rise - self.slopes[k + 1] * h);
        self.values[k] + s * rise + s * (1.0 - s) * ((1.0 - s) * a + s * b)
    }
    fn rate(&self, time: f64) -> f64 {
        let Some((k, s)) = self.interval(time) else { return 0.0 };
        let h = self.times[k + 1] - self.times[k];
        let rise = self.values[k + 1] - self.values[k];
        let (a, b) = (self.slopes[k] * h - rise, rise - self.slopes[k + 1] * h);
        (rise + (1.0 - 2.0 * s) * ((1.0 - s) * a + s * b) + s * (1.0 - s) * (b - a)) / h
    }
    fn breaks(&self) -> Vec<f64> {
        let jumps = self.times.windows(2).filter(|w| w[0] == w[1]).map(|w| w[0]);
        jumps.chain([self.times[0], self.times[self.times.len() - 1]]).collect()
    }
}

/// Slopes in the rows of a stretch with increasing times.
fn slope(times: &[f64], values: &[f64], slopes: &mut [f64]) {
    let last = times.len() - 1;
    let secant = |k: usize| (values[k + 1] - values[k]) / (times[k + 1] - times[k]);
    if last == 0 {
        return;
    }
    for k in 1..last {
        let (before, after) = (secant(k - 1), secant(k));
        let (h0, h1) = (times[k] - times[k - 1], times[k + 1] - times[k]);
        let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
        slopes[k] = if before * after > 0.0 { (w0 + w1) / (w0 / before + w1 / after) } else { 0.0 };
    }
    // straight ends
    (slopes[0], slopes[last]) = (secant(0), secant(last - 1));
}

/// A track that acts on an input.
struct Acts {
    input: usize,
    /// The input that is its rate, where nothing else acts on that one.
    rate: Option<usize>,
    track: Box<dyn Track>,
}

/// Inputs with constant parts, to which tracks are added.
#[derive(Default)]
pub struct Driven {
    base: Vec<f64>,
    tracks: Vec<Acts>,
}

impl Driven {
    /// Constant inputs.
    pub fn new(base: Vec<f64>) -> Self {
        Self { base, tracks: Vec::new() }
    }

    /// The constant parts.
    pub fn base_mut(&mut self) -> &mut [f64] {
        &mut self.base
    }

    /// Adds a track to an input. The input that is its rate follows, unless a track of its own acts on that one.
    pub fn add(&mut self, plant: &dyn Plant, input: usize, track: Box<dyn Track>) {
        for other in self.tracks.iter_mut().filter(|other| other.rate == Some(input)) {
            other.rate = None;
        }
        let own = |&rate: &usize| !self.tracks.iter().any(|other| other.input == rate);
        let rate = plant.inputs()[input].rate.filter(own);
        self.tracks.push(Acts { input, rate, track });
    }
}

impl Inputs for Driven {
    fn at(&self, time: f64, u: &mut [f64]) {
        u.copy_from_slice(&self.base);
        for acts in &self.tracks {
            u[acts.input] += acts.track.value(time);
            if let Some(rate) = acts.rate {
                u[rate] += acts.track.rate(time);
            }
        }
    }

    fn breaks(&self) -> Vec<f64> {
        self.tracks.iter().flat_map(|acts| acts.track.breaks()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rates are those of the values.
    fn is_smooth(track: &dyn Track, times: &[f64]) {
        for &t in times {
            let slope = (track.value(t + 1e-6) - track.value(t - 1e-6)) / 2e-6;
            assert!((slope - track.rate(t)).abs() < 1e-6 * slope.abs().max(1.0), "{t}: {slope} {}", track.rate(t));
        }
    }

    #[test]
    fn pieces_have_their_rates_and_breaks() {
        let (ramp, pulse) = (Ramp { begin: 1.0, end: 3.0, height: 4.0 }, Pulse { begin: 1.0, duration: 0.5, height: 2.0 });
        is_smooth(&ramp, &[0.5, 1.5, 2.5, 3.5]);
        is_smooth(&pulse, &[0.5, 1.01, 1.2, 1.25, 1.4, 1.6]);
        assert_eq!((ramp.value(2.0), ramp.value(9.0), pulse.value(1.25), pulse.value(1.0)), (2.0, 4.0, 2.0, 0.0));
        let step = Step { time: 1.0, height: 3.0 };
        assert_eq!((step.value(1f64.next_down()), step.value(1.0), step.breaks()), (0.0, 3.0, vec![1.0]));
    }

    #[test]
    fn a_table_passes_its_rows_and_stays_between_them() {
        let table = Table::new(vec![0.0, 1.0, 2.0, 4.0, 4.0, 5.0], vec![0.0, 1.0, 1.0, 3.0, -1.0, 0.0]).expect("a table");
        is_smooth(&table, &[-1.0, 0.3, 1.0, 1.5, 2.0, 3.3, 4.7, 6.0]);
        for (t, v) in [(0.0, 0.0), (1.0, 1.0), (2.0, 1.0), (4.0, -1.0), (5.0, 0.0), (-1.0, 0.0), (9.0, 0.0)] {
            assert_eq!(table.value(t), v, "{t}");
        }
        assert!((table.value(4f64.next_down()) - 3.0).abs() < 1e-12);
        let between = |k: usize, a: f64, b: f64| (a..=b).contains(&table.value(0.04 * k as f64));
        assert!(
            (0..=25).all(|k| between(k, 0.0, 1.0)) && (26..=50).all(|k| between(k, 1.0, 1.0)) && (51..100).all(|k| between(k, 1.0, 3.0))
        );
        assert_eq!(table.breaks(), [4.0, 0.0, 5.0]);
        assert!(Table::new(vec![0.0, -1.0], vec![0.0; 2]).is_none() && Table::new(vec![], vec![]).is_none());
        // a straight line is met exactly
        let line = Table::new(vec![0.0, 0.3, 1.0], vec![1.0, 1.6, 3.0]).expect("a table");
        assert!((line.value(0.7) - 2.4).abs() < 1e-15 && (line.rate(0.1) - 2.0).abs() < 1e-12);
    }
}
