//! Modes along a sweep: which eigenvalue of one point is which of the next, and names that are carried along.
//!
//! Cost of a pair `|s_i − s_j| / (|s_i| + ω₀) + 1 − MAC_ij` with `MAC = |v_iᴴ v_j|² / (‖v_i‖² ‖v_j‖²)` in nominal states; the cheapest assignment of all
//! eigenvalues, conjugate ones included. Every eigenvalue thereby has one path; where two real ones become a pair, or a pair falls
//! apart, two paths meet. Where vectors resemble each other too little, a point between is asked for.
//!
//! Names are given at the point where the rules fit best and carried from there. Two paths of one pair with different names: the one that fits the
//! pair better stays. A pair that falls apart leaves its name to both real eigenvalues.
//!
//! Real eigenvalues that pass each other on the axis exchange their vectors, by way of a short-lived pair or not at all visibly: what was the spin
//! of a wheel is a suspension afterwards. A real mode, or one damped nearly as much, therefore keeps its name only while no other
//! rule fits clearly better; oscillations keep theirs, whatever they turn into. Two oscillations may veer: come close and leave on each other's way. Where
//! the rules hold (straight running) they exchange their names as soon as the names of each other fit both clearly better, and a pair that came out of two real
//! eigenvalues takes the name of an oscillation that fits it clearly better.
//!
//! Source: theory manual 8.4; R. J. Allemang, D. L. Brown, Proc. 1st Int. Modal Analysis Conf. 1982 (MAC).

use super::Modes;
use super::assignment::cheapest;
use super::naming::{FAINT, Name, assign, classify, confidence, scores};
use nalgebra::{Complex, DMatrix, DVector};
use problem::{ModeRule, Nature, Occurs};

/// ω₀, 1/s: eigenvalues slower than this are compared by their absolute distance.
const SLOW: f64 = 1.0;

/// Resemblance below which a point between is asked for.
const ALIKE: f64 = 0.8;

/// Damping ratio above which an oscillation is hardly one.
const OVERDAMPED: f64 = 0.9;

/// How many times better another rule must fit a real mode.
const CLEARLY: f64 = 1.6;

/// How often a step may be halved.
const DEPTH: usize = 6;

/// Which eigenvalue of one point is which of another.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// For every eigenvalue of the first point its place at the second.
    pub to: Vec<usize>,
    /// Resemblance of their vectors, 0 to 1; 1 where real eigenvalues became a pair or the other way round.
    pub alike: Vec<f64>,
}

impl Link {
    /// The way back.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let mut back = Self { to: vec![0; self.to.len()], alike: vec![0.0; self.to.len()] };
        for (from, &to) in self.to.iter().enumerate() {
            (back.to[to], back.alike[to]) = (from, self.alike[from]);
        }
        back
    }

    /// This way, then another one.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        let alike = self.to.iter().zip(&self.alike).map(|(&k, a)| a.min(next.alike[k]));
        Self { to: self.to.iter().map(|&k| next.to[k]).collect(), alike: alike.collect() }
    }
}

/// `|aᴴ b|²` of vectors of unit length.
fn mac(a: &DVector<Complex<f64>>, b: &DVector<Complex<f64>>) -> f64 {
    a.dotc(b).norm_sqr().min(1.0)
}

/// Links two neighboring points with the same states. Points with another number of states have nothing in common.
pub fn link(from: &Modes, to: &Modes) -> Option<Link> {
    let n = from.spectrum.values.len();
    if n != to.spectrum.values.len() || from.states != to.states {
        return None;
    }
    let (a, b) = (&from.spectrum.values, &to.spectrum.values);
    let resemblance = DMatrix::from_fn(n, n, |i, j| mac(&from.scaled[i], &to.scaled[j]));
    let cost = DMatrix::from_fn(n, n, |i, j| (a[i] - b[j]).norm() / (a[i].norm() + SLOW) + 1.0 - resemblance[(i, j)]);
    let to = cheapest(&cost);
    let kept = |i: usize| (a[i].im == 0.0) == (b[to[i]].im == 0.0);
    let alike = (0..n).map(|i| if kept(i) { resemblance[(i, to[i])] } else { 1.0 }).collect();
    Some(Link { to, alike })
}

/// Links two points of a sweep; `between` computes a point at a fraction of the way, or none where there is none.
pub fn link_finely(from: &Modes, to: &Modes, between: &mut dyn FnMut(f64) -> Option<Modes>) -> Option<Link> {
    refine((from, 0.0), (to, 1.0), between, DEPTH)
}

fn refine(from: (&Modes, f64), to: (&Modes, f64), between: &mut dyn FnMut(f64) -> Option<Modes>, depth: usize) -> Option<Link> {
    let direct = link(from.0, to.0)?;
    if depth == 0 || direct.alike.iter().all(|a| *a >= ALIKE) {
        return Some(direct);
    }
    let middle = 0.5 * (from.1 + to.1);
    let Some(modes) = between(middle) else { return Some(direct) };
    let first = refine(from, (&modes, middle), between, depth - 1)?;
    Some(first.then(&refine((&modes, middle), to, between, depth - 1)?))
}

/// Two points of a sweep and how they are linked.
#[derive(Clone, Debug)]
pub struct Edge {
    /// Index of one point.
    pub from: usize,
    /// Index of the other.
    pub to: usize,
    /// From the one to the other.
    pub link: Link,
}

/// Names of the modes of all points, in the order of each point's modes; empty where there is no point.
///
/// `edges` join neighbors in any order; points that nothing joins to the rest are named by themselves. Points marked as `plain` are those that
/// the rules are made for (straight running): where there are some, names are given there.
pub fn names(points: &[Option<&Modes>], plain: &[bool], edges: &[Edge], rules: &[ModeRule]) -> Vec<Vec<Name>> {
    let alone: Vec<(Vec<Name>, f64)> = points.iter().map(|p| p.map_or((Vec::new(), 0.0), |modes| classify(modes, rules))).collect();
    let mut named: Vec<Option<Vec<Name>>> = vec![None; points.len()];
    let rank = |k: usize| (plain[k] && points[k].is_some(), alone[k].1);
    let best_left = |named: &[Option<Vec<Name>>]| {
        let left = (0..points.len()).filter(|&k| named[k].is_none());
        left.fold(None, |best: Option<usize>, k| best.filter(|&b| rank(b) >= rank(k)).or(Some(k)))
    };
    while let Some(anchor) = best_left(&named) {
        named[anchor] = Some(alone[anchor].0.clone());
        let mut reached = vec![anchor];
        while let Some(at) = reached.pop() {
            for edge in edges.iter().filter(|e| e.from == at || e.to == at) {
                let (next, link) = if edge.from == at { (edge.to, edge.link.clone()) } else { (edge.from, edge.link.reversed()) };
                if let (None, Some(from), Some(to), Some(names)) = (&named[next], points[at], points[next], &named[at]) {
                    let mut names = carried(from, names, &link, to, rules);
                    if plain[next] {
                        mend(&mut names, to, rules);
                    }
                    named[next] = Some(names);
                    reached.push(next);
                }
            }
        }
    }
    named.into_iter().map(Option::unwrap_or_default).collect()
}

/// Mends names of oscillations where the rules hold. Two that fit each other's names clearly better exchange them: their paths have veered away
/// from each other. One that fits a name clearly better that no oscillation has takes it: it came out of real eigenvalues.
fn mend(names: &mut [Name], modes: &Modes, rules: &[ModeRule]) {
    let scores = scores(modes, rules);
    let rule = |name: &Name| {
        let of_name = |r: &ModeRule| r.name == name.name && r.nature == Nature::Oscillation && r.occurs == Occurs::Once;
        rules.iter().position(of_name)
    };
    let shake: Vec<usize> = (0..names.len()).filter(|&m| modes.list[m].oscillates()).collect();
    for (k, &a) in shake.iter().enumerate() {
        for &b in &shake[k + 1..] {
            let (Some(of_a), Some(of_b)) = (rule(&names[a]), rule(&names[b])) else { continue };
            let crossed = scores[(a, of_b)] + scores[(b, of_a)];
            if crossed > CLEARLY * (scores[(a, of_a)] + scores[(b, of_b)]) {
                let name = |m: usize, r: usize| Name { name: rules[r].name.to_owned(), confidence: confidence(&scores, m, r, rules) };
                (names[a], names[b]) = (name(a, of_b), name(b, of_a));
            }
        }
    }
    for &m in &shake {
        let own = (0..rules.len()).filter(|&r| rules[r].name == names[m].name).map(|r| scores[(m, r)]).fold(0.0, f64::max);
        let taken = |name: &str| shake.iter().any(|&other| names[other].name == name);
        let open = (0..rules.len()).filter(|&r| rules[r].nature == Nature::Oscillation && !taken(rules[r].name));
        let best = open.max_by(|&a, &b| scores[(m, a)].total_cmp(&scores[(m, b)]));
        if let Some(r) = best.filter(|&r| scores[(m, r)] > FAINT.max(CLEARLY * own)) {
            names[m] = Name { name: rules[r].name.to_owned(), confidence: confidence(&scores, m, r, rules) };
        }
    }
}

/// The names at a point, carried from a neighbor.
fn carried(from: &Modes, names: &[Name], link: &Link, to: &Modes, rules: &[ModeRule]) -> Vec<Name> {
    let n = to.spectrum.values.len();
    // the name of every eigenvalue, conjugate ones included
    let mut slots: Vec<Option<Name>> = vec![None; n];
    for (mode, name) in from.list.iter().zip(names) {
        let own = if mode.oscillates() { mode.slot..mode.slot + 2 } else { mode.slot..mode.slot + 1 };
        for slot in own {
            let confidence = name.confidence.min(link.alike[slot]);
            slots[link.to[slot]] = Some(Name { name: name.name.clone(), confidence });
        }
    }
    let scores = scores(to, rules);
    let fit = |m: usize, name: &Name| {
        let of_name = (0..rules.len()).filter(|&r| rules[r].name == name.name);
        of_name.max_by(|&a, &b| scores[(m, a)].total_cmp(&scores[(m, b)]))
    };
    let score = |m: usize, name: &Name| fit(m, name).map_or(0.0, |r| scores[(m, r)]);
    let choose = |(m, mode): (usize, &super::Mode)| {
        let candidates: Vec<&Name> = slots[mode.slot..].iter().take(if mode.oscillates() { 2 } else { 1 }).flatten().collect();
        let Some(&best) = candidates.iter().max_by(|a, b| score(m, a).total_cmp(&score(m, b))) else {
            return Name { name: String::new(), confidence: 0.0 };
        };
        // two names for one pair: the confidence is that of the rule here
        match candidates.iter().all(|c| c.name == best.name) {
            true => best.clone(),
            false => Name { name: best.name.clone(), confidence: fit(m, best).map_or(0.0, |r| confidence(&scores, m, r, rules)) },
        }
    };
    let carried: Vec<Name> = to.list.iter().enumerate().map(choose).collect();
    // a name without a rule for what the mode is now (a weave that fell apart) has nothing to be compared with
    let keeps = |m: usize| (to.list[m].oscillates() && to.list[m].damping_ratio() < OVERDAMPED) || score(m, &carried[m]) == 0.0;
    let named: Vec<Option<&str>> = (0..carried.len()).map(|m| keeps(m).then_some(carried[m].name.as_str())).collect();
    let mut preferring = scores.clone();
    for (m, name) in carried.iter().enumerate() {
        (0..rules.len()).filter(|&r| rules[r].name == name.name).for_each(|r| preferring[(m, r)] *= CLEARLY);
    }
    let renamed = assign(&preferring, rules, &named);
    let settle = |(m, name): (usize, &Name)| match renamed[m] {
        Some(r) => Name { name: rules[r].name.to_owned(), confidence: confidence(&scores, m, r, rules) },
        None => name.clone(),
    };
    carried.iter().enumerate().map(settle).collect()
}
