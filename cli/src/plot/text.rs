//! Measures of text in the embedded font, and numbers as they are printed in figures.

use std::fmt::Write;
use std::sync::OnceLock;
use ttf_parser::{Face, OutlineBuilder};

/// Font families in the order of preference, for the SVG. The embedded font is the first; Arial and Helvetica are nearly as wide.
pub(super) const FAMILIES: &str = "DejaVu Sans Condensed, Arial, Helvetica, Liberation Sans, sans-serif";

/// The embedded font, DejaVu Sans Condensed (Bitstream Vera license).
fn face() -> Option<&'static Face<'static>> {
    static FACE: OnceLock<Option<Face<'static>>> = OnceLock::new();
    FACE.get_or_init(|| Face::parse(dejavu::sans_condensed::regular(), 0).ok()).as_ref()
}

/// Width of `text` set in `size`, kerning ignored.
pub(super) fn width(text: &str, size: f64) -> f64 {
    let Some(face) = face() else { return 0.55 * size * text.chars().count() as f64 };
    let advance = |c| face.glyph_index(c).and_then(|g| face.glyph_hor_advance(g)).unwrap_or(face.units_per_em() / 2);
    text.chars().map(|c| f64::from(advance(c))).sum::<f64>() * size / f64::from(face.units_per_em())
}

/// SVG path data of `text` in font units, y upwards, from the origin to the right, and the scale that makes it `size`.
pub(super) fn outlines(text: &str, size: f64) -> (String, f64) {
    let Some(face) = face() else { return (String::new(), 1.0) };
    let mut pen = PathPen { x: 0.0, data: String::new() };
    for glyph in text.chars().map(|c| face.glyph_index(c).unwrap_or_default()) {
        face.outline_glyph(glyph, &mut pen);
        pen.x += f32::from(face.glyph_hor_advance(glyph).unwrap_or(face.units_per_em() / 2));
    }
    (pen.data, size / f64::from(face.units_per_em()))
}

/// Collects glyph outlines side by side.
struct PathPen {
    x: f32,
    data: String,
}

impl OutlineBuilder for PathPen {
    fn move_to(&mut self, x: f32, y: f32) {
        let _ = write!(self.data, "M{} {y}", self.x + x);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let _ = write!(self.data, "L{} {y}", self.x + x);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let _ = write!(self.data, "Q{} {y1} {} {y}", self.x + x1, self.x + x);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let _ = write!(self.data, "C{} {y1} {} {y2} {} {y}", self.x + x1, self.x + x2, self.x + x);
    }

    fn close(&mut self) {
        self.data.push('Z');
    }
}

/// `value` with so many decimals and a typographic minus sign; never `−0`.
pub(super) fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().any(|c| c.is_ascii_digit() && c != '0') => format!("\u{2212}{digits}"),
        Some(digits) => digits.to_owned(),
        None => text,
    }
}

/// `value` with at most so many significant digits, no trailing zeros.
pub(super) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return number(value, 0);
    }
    let decimals = (digits as i32 - 1 - value.abs().log10().floor() as i32).clamp(0, 15) as usize;
    let text = number(value, decimals);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Decimals that tell multiples of `step` apart.
pub(super) fn decimals(step: f64) -> usize {
    (0..12).find(|&d| (step * 10f64.powi(d) - (step * 10f64.powi(d)).round()).abs() < 1e-6 * step * 10f64.powi(d)).unwrap_or(12) as usize
}

/// `exponent` in superior figures.
pub(super) fn superscript(exponent: i32) -> String {
    const FIGURES: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    exponent.to_string().chars().map(|c| c.to_digit(10).map_or('⁻', |d| FIGURES[d as usize])).collect()
}

/// A unit as printed: `m/s^2` becomes `m/s²`, `*` a middle dot.
pub(super) fn unit(text: &str) -> String {
    let mut printed = String::new();
    let mut raised = false;
    for c in text.chars() {
        match c {
            '^' => raised = true,
            '-' if raised => printed.push('⁻'),
            '0'..='9' if raised => printed.push_str(&superscript(c as i32 - '0' as i32)),
            '*' => printed.push('·'),
            _ => {
                raised = false;
                printed.push(c);
            }
        }
    }
    printed
}

/// The name of a limit or signal in plain words: `tire_saturated` becomes `tire saturated`.
pub(super) fn words(name: &str) -> String {
    name.replace('_', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_typographic_minus_and_no_negative_zero() {
        assert_eq!(number(-1.5, 1), "\u{2212}1.5");
        assert_eq!(number(-1e-9, 2), "0.00");
        assert_eq!(number(-0.004, 2), "0.00");
    }

    #[test]
    fn decimals_follow_the_step() {
        assert_eq!([0.25, 0.5, 2.0, 0.02, 100.0].map(decimals), [2, 1, 0, 2, 0]);
    }

    #[test]
    fn units_are_set_with_superior_figures() {
        assert_eq!(unit("m/s^2"), "m/s²");
        assert_eq!(unit("kg*m^2"), "kg·m²");
        assert_eq!(unit("s^-1"), "s⁻¹");
        assert_eq!(superscript(-12), "⁻¹²");
    }

    #[test]
    fn embedded_font_has_every_sign_we_print() {
        let face = face().expect("embedded font parses");
        for c in "\u{2212}0123456789.×·°⁻⁰¹²³⁴⁵⁶⁷⁸⁹αδφτκ–…".chars() {
            assert!(face.glyph_index(c).is_some(), "no glyph for {c}");
        }
    }
}
