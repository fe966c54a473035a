//! Where results leave the ranges in which elements can be trusted.

use crate::output::Angles;
use mbody::dynamics::System;
use problem::Signal;

/// One line per range that was left; `column` gives the values of a signal, points that were not computed left out.
///
/// # Errors
/// Those of `column`.
pub fn left<V: IntoIterator<Item = f64>, E>(
    system: &System,
    signals: &[Signal],
    column: impl Fn(usize) -> Result<V, E>,
) -> Result<Vec<String>, E> {
    let mut told = Vec::new();
    for range in system.ranges() {
        let Some(at) = signals.iter().position(|s| s.name == range.signal) else { continue };
        let [low, high] = range.bounds;
        let beyond = |value: f64| (low - value).max(value - high);
        let (mut all, mut outside, mut farthest) = (0, 0, None::<f64>);
        for value in column(at)?.into_iter().filter(|v| v.is_finite()) {
            all += 1;
            if beyond(value) > 0.0 {
                outside += 1;
                farthest = Some(farthest.filter(|f| beyond(*f) >= beyond(value)).unwrap_or(value));
            }
        }
        let Some(farthest) = farthest else { continue };
        let shown = Angles::Degrees.show(&signals[at].unit);
        let number = |value: f64| short(value * shown.factor);
        let unit = if shown.unit == "-" { String::new() } else { format!(" {}", shown.unit) };
        let how_often = if all > 1 { format!(" at {outside} of {all} points, farthest at") } else { " at".to_owned() };
        told.push(format!(
            "`{}` is outside {}, {} to {}{unit},{how_often} {}{unit}",
            range.signal,
            range.about,
            number(low),
            number(high),
            number(farthest)
        ));
    }
    Ok(told)
}

/// A number with at most four digits behind the point.
pub fn short(value: f64) -> String {
    format!("{value:.4}").trim_end_matches('0').trim_end_matches('.').to_owned()
}
