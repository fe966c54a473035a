//! Axes: title, scale, range, and the choice of ticks.

use super::text;

/// How a value becomes a place on an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps are equally far apart.
    #[default]
    Linear,
    /// Equal ratios are equally far apart; values that are not positive are left out.
    Logarithmic,
}

/// What is shown along a side of a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Name of the quantity, as in the title.
    pub label: String,
    /// Unit; empty or `-` for a pure number.
    pub unit: String,
    /// Linear or logarithmic.
    pub scale: Scale,
    /// First and last value shown; from the data where absent.
    pub range: Option<(f64, f64)>,
}

impl Axis {
    /// A linear axis whose range follows the data.
    pub fn new(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { label: label.into(), unit: unit.into(), scale: Scale::Linear, range: None }
    }

    /// The same axis with a logarithmic scale.
    pub fn logarithmic(self) -> Self {
        Self { scale: Scale::Logarithmic, ..self }
    }

    /// The same axis from `low` to `high`, whatever the data.
    pub fn between(self, low: f64, high: f64) -> Self {
        Self { range: Some((low, high)), ..self }
    }

    /// `Speed (m/s)`, with a power of ten where the tick labels leave it out: `Force (10³ N)`.
    pub(super) fn title(&self, exponent: i32) -> String {
        let unit = if self.unit == "-" { String::new() } else { text::unit(&self.unit) };
        let factor = if exponent == 0 { String::new() } else { format!("10{}", text::superscript(exponent)) };
        let inside = [factor, unit].into_iter().filter(|s| !s.is_empty()).collect::<Vec<_>>().join(" ");
        if inside.is_empty() { self.label.clone() } else { format!("{} ({inside})", self.label) }
    }

    /// Whether `value` has a place on this axis.
    pub(super) fn shows(&self, value: f64) -> bool {
        value.is_finite() && (self.scale == Scale::Linear || value > 0.0)
    }

    /// Range over `values`, widened by `margin` (share of the span on each side), never empty.
    pub(super) fn span(&self, values: impl Iterator<Item = f64>, margin: f64) -> (f64, f64) {
        if let Some((low, high)) = self.range
            && self.shows(low)
            && self.shows(high)
            && low < high
        {
            return (low, high);
        }
        let (low, high) = values.filter(|&v| self.shows(v)).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        match self.scale {
            Scale::Linear if low > high => (0.0, 1.0),
            // a span lost in rounding noise is no span
            Scale::Linear if high - low <= 1e-10 * high.abs().max(low.abs()) => {
                let half = if low == 0.0 { 1.0 } else { 0.1 * low.abs() };
                (low - half, high + half)
            }
            Scale::Linear => (low - margin * (high - low), high + margin * (high - low)),
            Scale::Logarithmic if low > high => (1.0, 10.0),
            Scale::Logarithmic if high / low < 1.000_001 => (low / 2.0, high * 2.0),
            Scale::Logarithmic => (low * (low / high).powf(margin), high * (high / low).powf(margin)),
        }
    }
}

/// Where an axis is marked, and how the marks are labeled.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ticks {
    /// Value and label of each major tick.
    pub(super) major: Vec<(f64, String)>,
    /// Values of minor ticks.
    pub(super) minor: Vec<f64>,
    /// Power of ten that the labels leave out and the title states.
    pub(super) exponent: i32,
}

impl Ticks {
    /// Ticks on `axis` between `low` and `high`, about `count` of them.
    pub(super) fn choose(axis: &Axis, (low, high): (f64, f64), count: usize) -> Self {
        match axis.scale {
            Scale::Logarithmic if high / low >= 8.0 => Self::decades(low, high, count),
            _ if axis.unit == "deg" && high - low > 60.0 => Self::linear(low, high, turn_step(high - low, count)),
            // on a logarithmic axis shorter than a decade a linear choice has more to offer
            _ => Self::linear(low, high, nice_step(high - low, count)),
        }
    }

    fn linear(low: f64, high: f64, (step, parts): (f64, u32)) -> Self {
        let values = multiples(low, high, step);
        let exponent = common_exponent(low.abs().max(high.abs()));
        let factor = 10f64.powi(exponent);
        let decimals = text::decimals(step / factor);
        let major = values.iter().map(|&v| (v, text::number(v / factor, decimals))).collect();
        Self { major, minor: multiples(low, high, step / f64::from(parts)), exponent }
    }

    fn decades(low: f64, high: f64, count: usize) -> Self {
        let (first, last) = ((low.log10() - 1e-9).ceil() as i32, (high.log10() + 1e-9).floor() as i32);
        let stride = (((last - first) as usize) / count.max(1) + 1) as i32;
        let label = |e: i32| match e {
            0..=3 => text::number(10f64.powi(e), 0),
            -2..0 => text::number(10f64.powi(e), (-e) as usize),
            _ => format!("10{}", text::superscript(e)),
        };
        let major = (first..=last).step_by(stride as usize).map(|e| (10f64.powi(e), label(e))).collect();
        let minor = match stride {
            1 => (first - 1..=last)
                .flat_map(|e| (2..10).map(move |k| f64::from(k) * 10f64.powi(e)))
                .filter(|&v| v >= low && v <= high)
                .collect(),
            _ => (first..=last).map(|e| 10f64.powi(e)).collect(),
        };
        Self { major, minor, exponent: 0 }
    }
}

/// Step of 1, 2 or 5 times a power of ten that cuts `span` most nearly into `count` parts (at most √2 times as many), and into how many
/// parts minor ticks cut it.
pub(super) fn nice_step(span: f64, count: usize) -> (f64, u32) {
    let raw = span / count.max(1) as f64;
    let power = 10f64.powf(raw.log10().floor());
    let (factor, parts) = match raw / power {
        // geometric means of neighboring steps
        r if r <= 2f64.sqrt() => (1.0, 5),
        r if r <= 10f64.sqrt() => (2.0, 4),
        r if r <= 50f64.sqrt() => (5.0, 5),
        _ => (10.0, 5),
    };
    (factor * power, parts)
}

/// The same for angles in degrees that are a good part of a turn.
fn turn_step(span: f64, count: usize) -> (f64, u32) {
    const STEPS: [(f64, u32); 6] = [(15.0, 3), (30.0, 3), (45.0, 3), (90.0, 3), (180.0, 4), (360.0, 4)];
    STEPS.into_iter().find(|(step, _)| span / step <= count as f64 + 0.5).unwrap_or_else(|| nice_step(span, count))
}

/// Multiples of `step` from `low` to `high`, both ends included within rounding.
pub(super) fn multiples(low: f64, high: f64, step: f64) -> Vec<f64> {
    let (first, last) = ((low / step - 1e-6).ceil(), (high / step + 1e-6).floor());
    // a step far below the rounding error of the ends would give no end of ticks
    if !(last - first).is_finite() || last - first > 1000.0 {
        return vec![low, high];
    }
    // dividing by a whole inverse keeps tenths exact: 3 · 0.1 is not 0.3, but 3 / 10 is
    let inverse = (1.0 / step).round();
    let whole = inverse >= 1.0 && (inverse * step - 1.0).abs() < 1e-9;
    let at = |k: f64| if whole { k / inverse } else { k * step };
    (0..=(last - first) as usize).map(|i| at(first + i as f64)).collect()
}

/// Power of ten, a multiple of three, that keeps labels of values up to `largest` short; zero while they are.
pub(super) fn common_exponent(largest: f64) -> i32 {
    if !largest.is_finite() || largest == 0.0 || (0.01..1e5).contains(&largest) {
        return 0;
    }
    3 * ((largest.log10() + 1e-9) / 3.0).floor() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64, count: usize) -> Vec<String> {
        Ticks::choose(&Axis::new("", ""), (low, high), count).major.into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_nice_numbers() {
        assert_eq!(labels(10.0, 60.0, 6), ["10", "20", "30", "40", "50", "60"]);
        assert_eq!(labels(-0.3, 0.3, 6), ["\u{2212}0.3", "\u{2212}0.2", "\u{2212}0.1", "0.0", "0.1", "0.2", "0.3"]);
        assert_eq!(labels(0.0, 1.0, 4), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
    }

    #[test]
    fn large_values_leave_a_power_of_ten_to_the_title() {
        let ticks = Ticks::choose(&Axis::new("", ""), (0.0, 4e6), 5);
        assert_eq!(ticks.exponent, 6);
        assert_eq!(ticks.major.last().map(|(_, l)| l.as_str()), Some("4"));
        assert_eq!(Axis::new("Stiffness", "N/m").title(6), "Stiffness (10⁶ N/m)");
        assert_eq!(Axis::new("Ratio", "-").title(0), "Ratio");
    }

    #[test]
    fn phases_are_marked_at_parts_of_a_turn() {
        let ticks = Ticks::choose(&Axis::new("Phase", "deg"), (-180.0, 0.0), 4);
        assert_eq!(ticks.major.iter().map(|(v, _)| *v).collect::<Vec<_>>(), [-180.0, -135.0, -90.0, -45.0, 0.0]);
    }

    #[test]
    fn decades_have_nine_intervals() {
        let ticks = Ticks::choose(&Axis::new("", "").logarithmic(), (0.1, 30.0), 6);
        assert_eq!(ticks.major.iter().map(|(_, l)| l.as_str()).collect::<Vec<_>>(), ["0.1", "1", "10"]);
        assert_eq!(ticks.minor.len(), 8 + 8 + 2);
    }

    #[test]
    fn ranges_are_never_empty() {
        let axis = Axis::new("a", "");
        for values in [vec![], vec![3.0], vec![0.0, 0.0], vec![f64::NAN], vec![1.0, 1.0 + 1e-14], vec![-1e300, 1e300]] {
            let (low, high) = axis.span(values.iter().copied(), 0.05);
            assert!(low < high, "{values:?}");
            assert!(!Ticks::choose(&axis, (low, high), 6).major.is_empty(), "{values:?}");
        }
    }
}
