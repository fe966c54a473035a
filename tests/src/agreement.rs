//! Comparisons with reasons: no number is "close enough" without a word why.

/// An allowed difference that still lacks its reason.
#[derive(Clone, Copy, Debug)]
pub struct Unexplained {
    absolute: f64,
    relative: f64,
}

/// How far two numbers may be apart, and why.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    absolute: f64,
    relative: f64,
    reason: &'static str,
}

/// An allowed difference in the unit of the numbers.
pub const fn absolute(difference: f64) -> Unexplained {
    Unexplained { absolute: difference, relative: 0.0 }
}

/// An allowed difference as a share of the expected number (of the largest entry, where vectors are compared).
pub const fn relative(share: f64) -> Unexplained {
    Unexplained { absolute: 0.0, relative: share }
}

impl Unexplained {
    /// The same with a share of the expected number on top.
    pub const fn or_relative(self, share: f64) -> Self {
        Self { absolute: self.absolute, relative: share }
    }

    /// The tolerance with its reason.
    pub const fn because(self, reason: &'static str) -> Tolerance {
        Tolerance { absolute: self.absolute, relative: self.relative, reason }
    }
}

impl Tolerance {
    fn allowed(&self, size: f64) -> f64 {
        self.absolute + self.relative * size.abs()
    }
}

/// The number that a source prints, and half a unit of its last digit.
///
/// # Panics
/// The text is not a plain decimal number.
pub fn printed(text: &str) -> (f64, f64) {
    let value: f64 = text.parse().unwrap_or_else(|_| panic!("`{text}` is not a number"));
    let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    (value, 0.5 * 10f64.powi(-i32::try_from(decimals).unwrap_or(0)))
}

/// All comparisons that belong to one claim. They are judged together at the end, so that a failure shows everything.
#[must_use = "call `assert` at the end"]
#[derive(Debug)]
pub struct Agreement {
    claim: String,
    comparisons: usize,
    worst: Option<(f64, String)>,
    misses: Vec<String>,
}

impl Agreement {
    /// Starts without comparisons.
    pub fn on(claim: impl Into<String>) -> Self {
        Self { claim: claim.into(), comparisons: 0, worst: None, misses: Vec::new() }
    }

    fn compare(&mut self, what: &str, (value, expected): (f64, f64), allowed: f64, reason: &str) {
        self.comparisons += 1;
        let difference = (value - expected).abs();
        let used = if difference == 0.0 { 0.0 } else { difference / allowed };
        let missed = difference.is_nan() || difference > allowed;
        let told = || format!("{what}: {value} is not {expected}; {difference:.3e} apart, allowed {allowed:.3e} ({reason})");
        if missed {
            self.misses.push(told());
        }
        if missed || self.worst.as_ref().is_none_or(|(worst, _)| used > *worst) {
            self.worst = Some((used, format!("{what}: off by {difference:.2e} of {allowed:.2e} allowed")));
        }
    }

    /// A number agrees with what a source prints: to half a unit of the last digit.
    pub fn printed(&mut self, what: &str, value: f64, text: &str) {
        let (expected, half_unit) = printed(text);
        // the printed number itself is held to double precision only
        self.compare(what, (value, expected), half_unit + 1e-15 * expected.abs(), "half a unit of the last printed digit");
    }

    /// A number agrees with another one.
    pub fn near(&mut self, what: &str, value: f64, expected: f64, tolerance: &Tolerance) {
        self.compare(what, (value, expected), tolerance.allowed(expected), tolerance.reason);
    }

    /// Vectors agree, entry by entry; the relative part of the tolerance refers to the largest expected entry.
    pub fn all_near(&mut self, what: &str, values: &[f64], expected: &[f64], tolerance: &Tolerance) {
        if values.len() != expected.len() {
            self.misses.push(format!("{what}: {} entries, expected {}", values.len(), expected.len()));
            return;
        }
        let size = expected.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        for (i, pair) in values.iter().copied().zip(expected.iter().copied()).enumerate() {
            self.compare(&format!("{what}[{i}]"), pair, tolerance.allowed(size), tolerance.reason);
        }
    }

    /// A sentence that must be true.
    pub fn holds(&mut self, what: &str, truth: bool) {
        self.comparisons += 1;
        if !truth {
            self.misses.push(format!("{what}: does not hold"));
        }
    }

    /// Judges all comparisons and tells the worst one (`cargo test -- --nocapture` shows it).
    ///
    /// # Panics
    /// A comparison missed, or there was none.
    pub fn assert(self) {
        let Self { claim, comparisons, worst, misses } = self;
        assert!(comparisons > 0, "{claim}: nothing was compared");
        if let Some((used, told)) = worst.filter(|_| misses.is_empty()) {
            println!("{claim}: {comparisons} comparisons, worst at {used:.1e} of its tolerance, {told}");
        }
        let shown = misses.iter().take(20).map(String::as_str).collect::<Vec<_>>().join("\n  ");
        assert!(misses.is_empty(), "{claim}: {} of {comparisons} comparisons missed\n  {shown}", misses.len());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_printed_number_is_good_to_half_of_its_last_digit() {
        assert_eq!(printed("-0.0055"), (-0.0055, 0.5e-4));
        assert_eq!(printed("42"), (42.0, 0.5));
        let mut good = Agreement::on("rounding");
        good.printed("down", 1.2349, "1.23");
        good.printed("up", 1.2251, "1.23");
        good.assert();
    }

    #[test]
    #[should_panic(expected = "2 of 3 comparisons missed")]
    fn misses_are_told_together() {
        let mut bad = Agreement::on("rounding");
        bad.printed("more than half", 1.2351, "1.23");
        bad.near("no number", f64::NAN, 1.0, &absolute(1.0).because("anything"));
        bad.near("near", 1.0, 1.1, &relative(0.2).because("a fifth"));
        bad.assert();
    }
}
