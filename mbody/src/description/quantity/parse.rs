//! Reading of a number with a unit.
//!
//! ```text
//! quantity = number [unit]
//! unit     = factor { ("*" | "·" | blank) factor | "/" factor }
//! factor   = (symbol | "(" unit ")") [power]        power = "^2" | "**2" | "²" | "2" | "^-1" | "⁻¹" | "^(-1)"
//! ```
//! A product after a quotient (`kg/m s`) means two things to two people and is refused.

use super::dimension::Exponents;
use super::error::{QuantityError, shown};
use super::unit::{self, Unit};

/// A number with the unit it was written in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::description) struct Parsed {
    /// Value in SI.
    pub value: f64,
    /// Exponents of the unit; `None` for a bare number.
    pub unit: Option<Exponents>,
}

/// Reads a number with an optional unit.
pub(in crate::description) fn parse(text: &str) -> Result<Parsed, QuantityError> {
    let trimmed = text.trim();
    let (number, rest) = split_number(trimmed).ok_or_else(|| QuantityError::NotANumber { text: shown(text) })?;
    let number: f64 = number.replace('−', "-").parse().map_err(|_| QuantityError::NotANumber { text: shown(text) })?;
    let rest = rest.trim_start();
    if rest.starts_with(',') {
        return Err(QuantityError::DecimalComma { text: shown(text), instead: shown(&text.replacen(',', ".", 1)) });
    }
    let (value, unit) = if rest.is_empty() {
        (number, None)
    } else {
        let mut reader = UnitReader { text, rest, depth: 0 };
        let factor = reader.product()?;
        reader.expect_end()?;
        (number * factor.over / factor.under, Some(factor.exponents))
    };
    if value.is_finite() { Ok(Parsed { value, unit }) } else { Err(QuantityError::NotFinite { text: shown(text) }) }
}

/// Splits off the longest number at the front.
pub(in crate::description) fn split_number(text: &str) -> Option<(&str, &str)> {
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let sign = |from: usize| text[from..].chars().next().filter(|c| matches!(c, '+' | '-' | '−')).map_or(0, char::len_utf8);
    let mut end = sign(0);
    let whole = digits(end);
    end += whole;
    let mut fraction = 0;
    if text[end..].starts_with('.') {
        fraction = digits(end + 1);
        end += 1 + fraction;
    }
    if whole + fraction == 0 {
        return None;
    }
    // an exponent only where digits follow the `e`
    if text[end..].starts_with(['e', 'E']) {
        let start = end + 1 + sign(end + 1);
        let power = digits(start);
        if power > 0 {
            end = start + power;
        }
    }
    Some(text.split_at(end))
}

/// A product of units: `over / under` in SI.
#[derive(Clone, Copy)]
struct Factor {
    over: f64,
    under: f64,
    exponents: Exponents,
}

impl Factor {
    const ONE: Self = Self { over: 1.0, under: 1.0, exponents: Exponents::of([0; 4]) };

    fn times_power(self, b: Self, n: i8) -> Option<Self> {
        let (over, under) = if n < 0 { (b.under, b.over) } else { (b.over, b.under) };
        let power = i32::from(n.checked_abs()?);
        Some(Self {
            over: self.over * over.powi(power),
            under: self.under * under.powi(power),
            exponents: self.exponents.times_power(b.exponents, n)?,
        })
    }
}

struct UnitReader<'a> {
    text: &'a str,
    rest: &'a str,
    depth: usize,
}

impl UnitReader<'_> {
    const DEEPEST: usize = 4;

    fn unreadable(&self) -> QuantityError {
        QuantityError::Unreadable { text: shown(self.text), rest: shown(self.rest) }
    }

    fn skip(&mut self, pattern: &str) -> bool {
        let found = self.rest.strip_prefix(pattern);
        self.rest = found.unwrap_or(self.rest);
        found.is_some()
    }

    fn skip_blank(&mut self) {
        self.rest = self.rest.trim_start();
    }

    fn product(&mut self) -> Result<Factor, QuantityError> {
        let (first, power) = self.factor()?;
        let mut product = self.multiply(Factor::ONE, first, power)?;
        let mut divided = false;
        loop {
            self.skip_blank();
            if self.rest.is_empty() || self.rest.starts_with(')') {
                return Ok(product);
            }
            let divide = self.skip("/");
            let multiply = !divide && (self.skip("*") || self.skip("·") || self.skip("⋅") || self.skip("×"));
            if !divide && divided && (multiply || self.at_factor()) {
                return Err(QuantityError::Ambiguous { text: shown(self.text) });
            }
            divided |= divide;
            self.skip_blank();
            let (factor, power) = self.factor()?;
            product = self.multiply(product, factor, if divide { -power } else { power })?;
        }
    }

    fn multiply(&self, product: Factor, factor: Factor, power: i8) -> Result<Factor, QuantityError> {
        product.times_power(factor, power).ok_or_else(|| self.unreadable())
    }

    fn at_factor(&self) -> bool {
        self.rest.starts_with(|c: char| is_of_symbol(c) || c == '(' || c == '1')
    }

    fn factor(&mut self) -> Result<(Factor, i8), QuantityError> {
        let factor = if self.skip("(") {
            self.depth += 1;
            if self.depth > Self::DEEPEST {
                return Err(self.unreadable());
            }
            self.skip_blank();
            let inner = self.product()?;
            self.depth -= 1;
            if !self.skip(")") {
                return Err(self.unreadable());
            }
            inner
        } else if self.skip("1") {
            Factor::ONE
        } else {
            self.symbol()?
        };
        Ok((factor, self.power()?))
    }

    fn symbol(&mut self) -> Result<Factor, QuantityError> {
        let end = self.rest.find(|c: char| !is_of_symbol(c)).unwrap_or(self.rest.len());
        let (symbol, rest) = self.rest.split_at(end);
        if symbol.is_empty() {
            return Err(self.unreadable());
        }
        let Some(unit) = Unit::of_symbol(symbol) else {
            return Err(QuantityError::UnknownUnit { text: shown(self.text), unit: shown(symbol), nearest: unit::nearest(symbol) });
        };
        self.rest = rest;
        Ok(Factor { over: unit.ratio.0, under: unit.ratio.1, exponents: unit.exponents })
    }

    /// `^2`, `**2`, `²`, `2`; one where nothing is written.
    fn power(&mut self) -> Result<i8, QuantityError> {
        let raised = self.skip("^") || self.skip("**");
        let bracket = raised && self.skip("(");
        let (mut digits, mut length) = (String::new(), 0);
        for c in self.rest.chars() {
            let Some(plain) = plain_digit(c).filter(|d| *d != '-' || digits.is_empty()) else { break };
            digits.push(plain);
            length += c.len_utf8();
        }
        if digits.is_empty() && !raised {
            return Ok(1);
        }
        let power: i8 = digits.parse().map_err(|_| self.unreadable())?;
        if !(-9..=9).contains(&power) || power == 0 {
            return Err(self.unreadable());
        }
        self.rest = &self.rest[length..];
        if bracket && !self.skip(")") {
            return Err(self.unreadable());
        }
        Ok(power)
    }

    fn expect_end(&self) -> Result<(), QuantityError> {
        if self.rest.is_empty() { Ok(()) } else { Err(self.unreadable()) }
    }
}

pub(in crate::description) fn is_of_symbol(c: char) -> bool {
    c.is_alphabetic() || c == '°' || c == '%'
}

/// The digit or minus sign that a character of a power stands for.
fn plain_digit(c: char) -> Option<char> {
    const RAISED: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";
    match c {
        '0'..='9' | '-' => Some(c),
        '⁻' | '−' => Some('-'),
        _ => RAISED.chars().position(|r| r == c).and_then(|k| char::from_digit(k as u32, 10)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::PI;

    fn value(text: &str) -> f64 {
        match parse(text) {
            Ok(parsed) => parsed.value,
            Err(e) => panic!("{text}: {e}"),
        }
    }

    #[test]
    fn reads_numbers() {
        for (text, number) in [("12", 12.0), ("-1.5e3", -1500.0), (".5", 0.5), ("+2.", 2.0), ("  7 ", 7.0), ("−3", -3.0), ("1E-2", 0.01)]
        {
            assert_eq!(parse(text), Ok(Parsed { value: number, unit: None }));
        }
    }

    #[test]
    fn reads_units_exactly() {
        assert_eq!(value("1400 mm"), 1.4);
        assert_eq!(value("58 kN/m"), 58e3);
        assert_eq!(value("35 N/mm"), 35e3);
        assert_eq!(value("1.2 kN*s/m"), 1200.0);
        assert_eq!(value("108km/h"), 30.0);
        assert_eq!(value("80 %"), 0.8);
        // one rounding of 2.3, one of the product
        assert_relative_eq!(value("2.3bar"), 2.3e5, max_relative = 2.0 * f64::EPSILON);
        assert_eq!(value("3e3kg"), 3000.0);
        assert_relative_eq!(value("24 deg"), 24.0 * PI / 180.0, max_relative = 1e-15);
        assert_relative_eq!(value("1500 rpm"), 1500.0 / 60.0 * 2.0 * PI, max_relative = 1e-15);
        assert_relative_eq!(value("380 N m/deg"), 380.0 * 180.0 / PI, max_relative = 1e-15);
    }

    #[test]
    fn the_same_unit_may_be_written_in_many_ways() {
        for text in
            ["0.7 kg m²", "0.7 kg m^2", "0.7 kg*m2", "0.7kg·m²", "0.7 kg m**2", "0.7 (kg m²)", "0.7 kg m m", "0.7 kg/m^-2", "0.7 kg/m⁻²"]
        {
            let inertia = Exponents::of([2, 1, 0, 0]);
            assert_eq!(parse(text), Ok(Parsed { value: 0.7, unit: Some(inertia) }), "{text}");
        }
        assert_eq!(value("9.81 m/s^2"), value("9.81 m/s/s"));
        assert_eq!(value("2 N/(m/s)"), value("2 N s/m"));
        assert_eq!(value("4 1/s"), value("4 s^-1"));
    }

    #[test]
    fn refuses_what_is_not_a_quantity() {
        for text in [
            "", "kg", "-", "e5", "nan", "inf", "--3", "1.2.3", "3 kg)", "3 (kg", "3 m^", "3 m^0", "3 m^99", "3 /", "3 kg//m", "3 *m", "3 4",
        ] {
            assert!(parse(text).is_err(), "{text}");
        }
        assert!(matches!(parse("1e400"), Err(QuantityError::NotFinite { .. })));
        assert!(matches!(parse("2,3 bar"), Err(QuantityError::DecimalComma { .. })));
        assert!(matches!(parse("2 kg/m s"), Err(QuantityError::Ambiguous { .. })));
        assert!(matches!(parse(&format!("2 {}m", "(".repeat(9999))), Err(QuantityError::Unreadable { .. })));
    }
}
