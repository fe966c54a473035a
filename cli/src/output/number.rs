//! Numbers for readers: six significant digits, decimal points under each other.

/// Digits shown.
const SIGNIFICANT: i32 = 6;
/// Below this a value is rounding noise of an iteration and shown as zero; no quantity of a vehicle in SI units lives there.
const NOISE: f64 = 1e-12;

/// `value` with six significant digits and without trailing zeros; an exponent only below 1e-4 and from 1e7 on; `-` for no value.
pub fn number(value: f64) -> String {
    if !value.is_finite() {
        return "-".to_owned();
    }
    if value.abs() < NOISE {
        return "0".to_owned();
    }
    // the exponent of the rounded value: 9.9999996 has six digits as 10
    let scientific = format!("{value:.*e}", SIGNIFICANT as usize - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..7).contains(&exponent) {
        trimmed(&format!("{value:.*}", (SIGNIFICANT - 1 - exponent).max(0) as usize)).to_owned()
    } else {
        format!("{}e{exponent}", trimmed(mantissa))
    }
}

fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

/// The texts padded to one width, decimal points under each other.
pub(super) fn aligned(texts: &[String]) -> Vec<String> {
    let split = |text: &str| text.find(['.', 'e']).unwrap_or(text.len());
    let before = texts.iter().map(|t| split(t)).max().unwrap_or(0);
    let after = texts.iter().map(|t| t.len() - split(t)).max().unwrap_or(0);
    let pad = |t: &String| format!("{:before$}{t}{:after$}", "", "", before = before - split(t), after = after - (t.len() - split(t)));
    texts.iter().map(pad).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_digits_and_no_more() {
        let shown =
            [0.6, 1623.4567, 34.377_467_7, -0.000_123_456_78, 1.2e-5, 1.5e9, 3e-17, -0.0, 1_234_567.8, 9.999_999_6, f64::NAN].map(number);
        assert_eq!(shown, ["0.6", "1623.46", "34.3775", "-0.000123457", "1.2e-5", "1.5e9", "0", "0", "1234568", "10", "-"]);
    }

    #[test]
    fn decimal_points_stand_under_each_other() {
        let texts = ["1623.46", "-0.5", "30", "1.2e-5", "-"].map(str::to_owned);
        assert_eq!(aligned(&texts), ["1623.46  ", "  -0.5   ", "  30     ", "   1.2e-5", "   -     "]);
    }
}
