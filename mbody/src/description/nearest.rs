//! Names that are nearly right.

/// The candidate that `name` most probably stands for.
///
/// Compares by edit distance (with transpositions) regardless of case, `-` and blanks; at most a third of the letters may differ, so
/// that a name of two letters resembles only itself.
/// Failing that, a candidate of which `name` is a part, or the reverse. `None` where nothing is near.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // edit distance takes time and memory with the product of the lengths: a name this long is no typing error
    const LONGEST: usize = 64;
    if name.len() > LONGEST {
        return None;
    }
    let plain = |s: &str| s.to_lowercase().replace(['-', ' '], "_");
    let sought = plain(name);
    let allowed = sought.chars().count() / 3;
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates {
        let known = plain(candidate);
        let distance = strsim::damerau_levenshtein(&sought, &known);
        let near = distance <= allowed;
        let part = sought.len() >= 4 && known.len() >= 4 && (known.contains(&sought) || sought.contains(&known));
        let rank = if near { distance } else { 1000 + distance };
        if (near || part) && best.is_none_or(|(r, _)| rank < r) {
            best = Some((rank, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// Advice about an unknown name: the nearest known one, else the known ones where they are few.
pub fn suggestion<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    const FEW: usize = 16;
    let candidates: Vec<&str> = candidates.into_iter().collect();
    if let Some(near) = nearest(name, candidates.iter().copied()) {
        return Some(format!("did you mean `{near}`?"));
    }
    match candidates.len() {
        0 => None,
        1 => Some(format!("only `{}` is known here", candidates[0])),
        n if n <= FEW => Some(format!("known here: {}", names(&candidates))),
        _ => None,
    }
}

/// Names in back-ticks, separated by commas.
pub(crate) fn names<S: AsRef<str>>(names: &[S]) -> String {
    names.iter().map(|n| format!("`{}`", n.as_ref())).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_nearest_name() {
        let known = ["stiffness", "damping", "free_length", "spring_damper"];
        assert_eq!(nearest("stifness", known), Some("stiffness"));
        assert_eq!(nearest("dampnig", known), Some("damping"));
        assert_eq!(nearest("Free-Length", known), Some("free_length"));
        assert_eq!(nearest("damper", known), Some("spring_damper"));
        assert_eq!(nearest("color", known), None);
        assert_eq!(nearest("q", ["x", "y"]), None);
        assert_eq!(nearest("kp", ["km", "kPa"]), None);
        assert_eq!(nearest("KN", ["kN", "mN"]), Some("kN"));
        assert_eq!(nearest(&"x".repeat(100_000), known), None);
        assert_eq!(suggestion("color", ["x", "y"]).as_deref(), Some("known here: `x`, `y`"));
    }
}
