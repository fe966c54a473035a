//! A step between two points with rates: a cubic polynomial for each unknown.
//!
//! y(t₀ + s h) = (1 + 2 s)(1 − s)² y₀ + s² (3 − 2 s) y₁ + h s (1 − s)² ẏ₀ − h s² (1 − s) ẏ₁ (Hermite), error of order h⁴.
//! Unknowns without rates lie on straight lines.

/// The last step.
#[derive(Debug, Default)]
pub(crate) struct Segment {
    span: (f64, f64),
    begin: (Vec<f64>, Vec<f64>),
    end: (Vec<f64>, Vec<f64>),
    /// Which unknowns have no rates; empty where all have.
    straight: Vec<bool>,
}

impl Segment {
    pub(crate) fn new(size: usize) -> Self {
        let zeros = || (vec![0.0; size], vec![0.0; size]);
        Self { span: (0.0, 0.0), begin: zeros(), end: zeros(), straight: Vec::new() }
    }

    /// Unknowns whose rates mean nothing.
    pub(crate) fn without_rates(&mut self, straight: impl Iterator<Item = bool>) {
        self.straight.clear();
        self.straight.extend(straight);
    }

    /// Begins at a point; its rates are written by [`Segment::rates_at_end`].
    pub(crate) fn start(&mut self, time: f64, y: &[f64]) {
        self.span = (time, time);
        self.end.0.copy_from_slice(y);
    }

    pub(crate) fn rates_at_end(&mut self) -> &mut [f64] {
        &mut self.end.1
    }

    pub(crate) fn span(&self) -> (f64, f64) {
        self.span
    }

    /// Point and rates at the begin of the step.
    pub(crate) fn begin(&self) -> (&[f64], &[f64]) {
        (&self.begin.0, &self.begin.1)
    }

    /// Point and rates at its end.
    pub(crate) fn end(&self) -> (&[f64], &[f64]) {
        (&self.end.0, &self.end.1)
    }

    /// The next step, from the end of this one.
    pub(crate) fn push(&mut self, time: f64, y: &[f64], yd: &[f64]) {
        std::mem::swap(&mut self.begin, &mut self.end);
        self.span = (self.span.1, time);
        self.end.0.copy_from_slice(y);
        self.end.1.copy_from_slice(yd);
    }

    /// Writes a point within the step. True where it is the end itself, rates included; else the rates are those of the polynomial.
    pub(crate) fn read(&self, time: f64, y: &mut [f64], yd: &mut [f64]) -> bool {
        if time == self.span.1 {
            y.copy_from_slice(&self.end.0);
            yd.copy_from_slice(&self.end.1);
            return true;
        }
        let h = self.span.1 - self.span.0;
        let s = (time - self.span.0) / h;
        let r = 1.0 - s;
        for i in 0..y.len() {
            let (y0, y1, d0, d1) = (self.begin.0[i], self.end.0[i], self.begin.1[i], self.end.1[i]);
            if self.straight.get(i) == Some(&true) {
                (y[i], yd[i]) = (y0 + s * (y1 - y0), 0.0);
                continue;
            }
            y[i] = y0 + s * s * (3.0 - 2.0 * s) * (y1 - y0) + h * s * r * (r * d0 - s * d1);
            yd[i] = 6.0 * s * r * (y1 - y0) / h + r * (1.0 - 3.0 * s) * d0 + s * (3.0 * s - 2.0) * d1;
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_are_read_exactly() {
        let (f, fd) = (|t: f64| t * t * t - 2.0 * t, |t: f64| 3.0 * t * t - 2.0);
        let mut segment = Segment::new(1);
        segment.start(0.5, &[f(0.5)]);
        segment.rates_at_end()[0] = fd(0.5);
        segment.push(2.0, &[f(2.0)], &[fd(2.0)]);
        for t in [0.5, 0.7, 1.9] {
            let (mut y, mut yd) = ([0.0], [0.0]);
            assert!(!segment.read(t, &mut y, &mut yd));
            assert!((y[0] - f(t)).abs() < 1e-14 && (yd[0] - fd(t)).abs() < 1e-13);
        }
        assert_eq!(segment.span(), (0.5, 2.0));
    }
}
