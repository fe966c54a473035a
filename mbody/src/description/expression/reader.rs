//! From the text of a formula to its parts, by recursive descent.

use super::{ExpressionError, FUNCTIONS, Node, Operator, PLAIN, Value, What};
use crate::description::quantity::parse::{is_of_symbol, parse, split_number};
use crate::description::quantity::{Unit, unit};

/// Parentheses, signs and powers within each other at most.
const DEEPEST: usize = 48;

pub(super) fn read(text: &str) -> Result<Node, ExpressionError> {
    let mut reader = Reader { text, at: 0, depth: 0 };
    let sum = reader.sum()?;
    match reader.peek() {
        None => Ok(sum),
        Some(_) => Err(reader.expected("an operator or the end")),
    }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

impl<'a> Reader<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn peek(&mut self) -> Option<char> {
        self.at += self.rest().len() - self.rest().trim_start().len();
        self.rest().chars().next()
    }

    fn take(&mut self, wanted: char) -> bool {
        let there = self.peek() == Some(wanted);
        if there {
            self.at += wanted.len_utf8();
        }
        there
    }

    fn expected(&self, expected: impl Into<String>) -> ExpressionError {
        let found: String = self.rest().chars().take(12).collect();
        let found = if found.is_empty() { "the end".to_owned() } else { found };
        ExpressionError::Syntax { expected: expected.into(), found, text: self.text.to_owned() }
    }

    fn node(&self, what: What, from: usize) -> Node {
        Node { what, span: (from, self.at) }
    }

    fn binary(&self, operator: Operator, left: Node, right: Node) -> Node {
        let from = left.span.0;
        self.node(What::Binary(operator, Box::new(left), Box::new(right)), from)
    }

    fn sum(&mut self) -> Result<Node, ExpressionError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.expected("fewer parentheses"));
        }
        let mut left = self.product()?;
        loop {
            if self.take('+') {
                let right = self.product()?;
                left = self.binary(Operator::Plus, left, right);
            } else if self.take('-') || self.take('−') {
                let right = self.product()?;
                left = self.binary(Operator::Minus, left, right);
            } else {
                self.depth -= 1;
                return Ok(left);
            }
        }
    }

    fn product(&mut self) -> Result<Node, ExpressionError> {
        let mut left = self.sign()?;
        loop {
            if self.take('*') || self.take('·') || self.take('×') {
                let right = self.sign()?;
                left = self.binary(Operator::Times, left, right);
            } else if self.take('/') {
                let right = self.sign()?;
                left = self.binary(Operator::Over, left, right);
            } else {
                return Ok(left);
            }
        }
    }

    fn sign(&mut self) -> Result<Node, ExpressionError> {
        self.peek();
        let from = self.at;
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.expected("fewer signs and powers"));
        }
        let node = if self.take('-') || self.take('−') {
            let inner = self.sign()?;
            self.node(What::Negative(Box::new(inner)), from)
        } else {
            let base = self.atom()?;
            match self.take('^') {
                true => {
                    let exponent = self.sign()?;
                    self.node(What::Power(Box::new(base), Box::new(exponent)), from)
                }
                false => base,
            }
        };
        self.depth -= 1;
        Ok(node)
    }

    fn atom(&mut self) -> Result<Node, ExpressionError> {
        match self.peek() {
            Some('(') => {
                let from = self.at;
                self.take('(');
                let inner = self.sum()?;
                match self.take(')') {
                    true => Ok(Node { span: (from, self.at), ..inner }),
                    false => Err(self.expected("`)`")),
                }
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' => self.name(),
            _ => Err(self.expected("a number, a parameter or `(`")),
        }
    }

    /// A number and the unit behind it.
    fn number(&mut self) -> Result<Node, ExpressionError> {
        let from = self.at;
        let (number, rest) = split_number(self.rest()).ok_or_else(|| self.expected("a number"))?;
        let end = self.at + number.len() + unit_length(rest);
        let read = parse(&self.text[self.at..end])?;
        self.at = end;
        Ok(self.node(What::Number(Value { si: read.value, exponents: read.unit.unwrap_or(PLAIN) }), from))
    }

    fn name(&mut self) -> Result<Node, ExpressionError> {
        let from = self.at;
        let rest = self.rest();
        let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
        let word = &rest[..end];
        self.at += end;
        if let Some((name, function, least, most)) = FUNCTIONS.iter().find(|(name, ..)| *name == word) {
            if !self.take('(') {
                return Err(self.expected(format!("`(` behind `{name}`")));
            }
            let mut arguments = vec![self.sum()?];
            while self.take(',') {
                arguments.push(self.sum()?);
            }
            if !self.take(')') {
                return Err(self.expected("`,` or `)`"));
            }
            if !(*least..=*most).contains(&arguments.len()) {
                let expected = match (least, most) {
                    (1, 1) => "one argument".to_owned(),
                    (2, 2) => "two arguments".to_owned(),
                    _ => format!("{least} to {most} arguments"),
                };
                return Err(ExpressionError::Arguments { function: name, expected, found: arguments.len() });
            }
            return Ok(self.node(What::Call(*function, arguments), from));
        }
        Ok(match word {
            "pi" => self.node(What::Number(Value { si: std::f64::consts::PI, exponents: PLAIN }), from),
            _ => self.node(What::Name(word.to_owned()), from),
        })
    }
}

/// Length of the unit at the front of a text, blanks before it included; zero where there is none.
///
/// What follows `*` or `/` belongs to the unit only where it is one itself: `2 m / trail` ends after `m`.
fn unit_length(text: &str) -> usize {
    let mut end = 0;
    let blanks = |at: usize| text[at..].len() - text[at..].trim_start().len();
    let mut at = blanks(0);
    while let Some(length) = unit_factor(&text[at..]) {
        end = at + length;
        at = end + blanks(end);
        if let Some(sign) = text[at..].chars().next().filter(|c| matches!(c, '/' | '*' | '·' | '⋅' | '×')) {
            at += sign.len_utf8();
            at += blanks(at);
        }
    }
    // a unit that nobody knows is for the reader of quantities to explain
    let (blank, rest) = text.split_at(blanks(0));
    let word = &rest[..rest.find(|c: char| !is_of_symbol(c)).unwrap_or(rest.len())];
    let meant = !word.is_empty() && !rest[word.len()..].starts_with(['_', '(']) && (blank.is_empty() || unit::nearest(word).is_some());
    if end == 0 && meant { blank.len() + word.len() } else { end }
}

/// Length of a symbol, or of units in parentheses, with its power.
fn unit_factor(text: &str) -> Option<usize> {
    let end = if let Some(inner) = text.strip_prefix('(') {
        let close = inner.find(')')?;
        let content = inner[..close].trim_end();
        if unit_length(content) != content.len() || content.is_empty() {
            return None;
        }
        close + 2
    } else {
        let end = text.find(|c: char| !is_of_symbol(c)).unwrap_or(text.len());
        // a name goes on, or a function begins
        if Unit::of_symbol(&text[..end]).is_none() || text[..end] == *"1" || text[end..].starts_with(['_', '(']) {
            return None;
        }
        end
    };
    let rest = &text[end..];
    let raised = if rest.starts_with("**") { 2 } else { usize::from(rest.starts_with('^')) };
    let digit = |c: char| c.is_ascii_digit() || "⁰¹²³⁴⁵⁶⁷⁸⁹⁻".contains(c) || (raised > 0 && c == '-');
    let digits = rest[raised..].find(|c| !digit(c)).unwrap_or(rest.len() - raised);
    Some(end + if digits > 0 { raised + digits } else { 0 })
}
