//! Names of modes at one point, by rules.
//!
//! The score of a mode by a rule is the weighted participation of the rule's signals times one factor each for frequency and damping: 1 inside
//! the usual band, a Gaussian of the distance outside. Names that occur once are assigned together, so that the sum of all
//! scores is largest. A mode that no rule fits has the name of the signal that takes part most.

use super::assignment::cheapest;
use super::{Mode, Modes};
use nalgebra::DMatrix;
use problem::{ModeRule, Nature, Occurs};

/// Scores below this are no recognition.
pub(super) const FAINT: f64 = 0.15;

/// Widths of the Gaussians outside the bands: ratio of frequencies (logarithm), difference of damping ratios.
const WIDTHS: (f64, f64) = (0.35, 0.1);

/// The name of a mode and how sure it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Name {
    /// The name.
    pub name: String,
    /// 0 to 1: squared score over that of the next best rule and itself; along a sweep not more than the resemblance from point to point.
    pub confidence: f64,
}

/// Whether a name fits a pattern, in which `*` stands for anything.
pub fn fits(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == name,
        Some((start, rest)) => name
            .strip_prefix(start)
            .is_some_and(|tail| tail.char_indices().map(|(i, _)| i).chain([tail.len()]).any(|i| fits(rest, &tail[i..]))),
    }
}

/// How much a mode looks like a rule, 0 to 1.
pub fn score(mode: &Mode, signals: &[String], rule: &ModeRule) -> f64 {
    let natural = match rule.nature {
        Nature::Oscillation => mode.oscillates(),
        Nature::Real => !mode.oscillates(),
        Nature::Any => true,
    };
    if !natural {
        return 0.0;
    }
    let weight = |signal: &String| rule.takes_part.iter().filter(|(p, _)| fits(p, signal)).map(|(_, w)| *w).fold(0.0, f64::max);
    let share: f64 = signals.iter().zip(&mode.participation).map(|(signal, p)| weight(signal) * p).sum();
    let (low, high) = rule.frequency;
    let frequency = mode.natural_frequency();
    let ratio = if frequency < low { (low / frequency).ln() } else { (frequency / high).ln().max(0.0) };
    let damping = mode.damping_ratio();
    let off = (rule.damping.0 - damping).max(damping - rule.damping.1).max(0.0);
    share * (-(ratio / WIDTHS.0).powi(2)).exp() * (-(off / WIDTHS.1).powi(2)).exp()
}

/// Scores of all modes by all rules.
pub(super) fn scores(modes: &Modes, rules: &[ModeRule]) -> DMatrix<f64> {
    DMatrix::from_fn(modes.list.len(), rules.len(), |m, r| score(&modes.list[m], &modes.signals, &rules[r]))
}

/// Name of the signal that takes part most.
fn leading(mode: &Mode, signals: &[String]) -> String {
    let most = (0..signals.len()).max_by(|&a, &b| mode.participation[a].total_cmp(&mode.participation[b]));
    most.map_or_else(String::new, |k| signals[k].clone())
}

/// Names of all modes of one point, in their order, and the sum of all scores.
pub fn classify(modes: &Modes, rules: &[ModeRule]) -> (Vec<Name>, f64) {
    let scores = scores(modes, rules);
    let assigned = assign(&scores, rules, &vec![None; modes.list.len()]);
    let total = assigned.iter().enumerate().filter_map(|(m, rule)| rule.map(|r| scores[(m, r)])).sum();
    let name = |(m, rule): (usize, &Option<usize>)| match rule {
        Some(r) => Name { name: rules[*r].name.to_owned(), confidence: confidence(&scores, m, *r, rules) },
        None => Name { name: leading(&modes.list[m], &modes.signals), confidence: 0.0 },
    };
    (assigned.iter().enumerate().map(name).collect(), total)
}

/// The rule of every mode that has no name yet, so that the sum of all scores is largest; none where nothing fits.
pub(super) fn assign(scores: &DMatrix<f64>, rules: &[ModeRule], named: &[Option<&str>]) -> Vec<Option<usize>> {
    let open: Vec<usize> = (0..named.len()).filter(|&m| named[m].is_none()).collect();
    let free = |r: &usize| rules[*r].occurs == Occurs::Once && !named.contains(&Some(rules[*r].name));
    let once: Vec<usize> = (0..rules.len()).filter(free).collect();
    let (count, names) = (open.len(), once.len());
    let usable = |score: f64| if score < FAINT { 0.0 } else { score };
    let best_often = |m: usize| {
        let often = (0..rules.len()).filter(|&r| rules[r].occurs == Occurs::Often);
        often.map(|r| (r, usable(scores[(m, r)]))).filter(|(_, s)| *s > 0.0).max_by(|a, b| a.1.total_cmp(&b.1))
    };
    // columns: names that occur once, then one of its own for every mode; rows beyond the modes take what is left
    let cost = DMatrix::from_fn(count + names, count + names, |k, c| match (k < count, c < names) {
        (true, true) => -usable(scores[(open[k], once[c])]),
        (true, false) if c - names == k => -best_often(open[k]).map_or(0.0, |(_, s)| s),
        (true, false) => 1.0,
        (false, _) => 0.0,
    });
    let mut assigned = vec![None; named.len()];
    for (&column, &m) in cheapest(&cost).iter().zip(&open) {
        assigned[m] = match column {
            c if c < names => Some(once[c]).filter(|&r| scores[(m, r)] >= FAINT),
            _ => best_often(m).map(|(r, _)| r),
        };
    }
    assigned
}

/// Squared score of a rule over that of the best one with another name and itself.
pub(super) fn confidence(scores: &DMatrix<f64>, mode: usize, rule: usize, rules: &[ModeRule]) -> f64 {
    let others = (0..rules.len()).filter(|&r| rules[r].name != rules[rule].name).map(|r| scores[(mode, r)]);
    let (own, next) = (scores[(mode, rule)], others.fold(0.0, f64::max));
    if own > 0.0 { own * own / (own * own + next * next) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::fits;

    #[test]
    fn stars_stand_for_anything() {
        for (pattern, name, expected) in [
            ("steer.angle", "steer.angle", true),
            ("steer.angle", "steer.angle_rate", false),
            ("*.roll", "chassis.roll", true),
            ("*.roll", "chassis.roll_rate", false),
            ("front_*lateral*", "front_tire.carcass_lateral", true),
            ("*_tire.*lateral*", "rear_tire.lateral_lag", true),
            ("*", "", true),
            ("a*a", "a", false),
        ] {
            assert_eq!(fits(pattern, name), expected, "{pattern} {name}");
        }
    }
}
