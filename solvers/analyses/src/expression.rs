//! A small language for conditions on signals: `-0.25 * front_brake.torque`, `chassis.yaw_rate / chassis.forward_speed`.
//!
//! Numbers, signal names, `rate(signal)`, `+ - * / ^`, parentheses, `sqrt abs sin cos tan atan exp`. Values are SI.
//! Derivatives are exact, by the chain rule over the tree.

use crate::{Variable, Variables};
use thiserror::Error;

/// A formula over the signals of a plant.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// A number.
    Constant(f64),
    /// A signal.
    Variable(Variable),
    /// −a.
    Negative(Box<Expression>),
    /// a + b.
    Sum(Box<Expression>, Box<Expression>),
    /// a − b.
    Difference(Box<Expression>, Box<Expression>),
    /// a b.
    Product(Box<Expression>, Box<Expression>),
    /// a / b.
    Quotient(Box<Expression>, Box<Expression>),
    /// a to a constant power.
    Power(Box<Expression>, f64),
    /// One of the named functions.
    Call(Function, Box<Expression>),
}

/// A named function of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// √x.
    Sqrt,
    /// |x|.
    Abs,
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Tangent.
    Tan,
    /// Arc tangent.
    Atan,
    /// eˣ.
    Exp,
}

/// Why a formula cannot be read.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ExpressionError {
    /// A name that is no signal.
    #[error("`{name}` is no signal of this model")]
    UnknownSignal {
        /// The name.
        name: String,
    },
    /// Something is missing or too much.
    #[error("expected {expected} at `{found}` in `{text}`")]
    Syntax {
        /// What was expected.
        expected: &'static str,
        /// What stands there.
        found: String,
        /// The whole formula.
        text: String,
    },
    /// An exponent that depends on signals.
    #[error("the exponent in `{text}` is not a number")]
    Exponent {
        /// The whole formula.
        text: String,
    },
}

impl Function {
    const ALL: [(&'static str, Self); 7] = [
        ("sqrt", Self::Sqrt),
        ("abs", Self::Abs),
        ("sin", Self::Sin),
        ("cos", Self::Cos),
        ("tan", Self::Tan),
        ("atan", Self::Atan),
        ("exp", Self::Exp),
    ];

    /// Value and slope.
    fn at(self, x: f64) -> (f64, f64) {
        match self {
            Self::Sqrt => (x.sqrt(), 0.5 / x.sqrt()),
            Self::Abs => (x.abs(), if x == 0.0 { 0.0 } else { x.signum() }),
            Self::Sin => (x.sin(), x.cos()),
            Self::Cos => (x.cos(), -x.sin()),
            Self::Tan => (x.tan(), 1.0 + x.tan().powi(2)),
            Self::Atan => (x.atan(), 1.0 / (1.0 + x * x)),
            Self::Exp => (x.exp(), x.exp()),
        }
    }
}

impl Expression {
    /// A signal minus a value: the condition that the signal has the value.
    pub fn variable(variable: Variable) -> Self {
        Self::Variable(variable)
    }

    /// Reads a formula.
    ///
    /// # Errors
    /// Unknown signals and misplaced signs, with the place.
    pub fn parse(text: &str, variables: &Variables) -> Result<Self, ExpressionError> {
        let mut parser = Parser { text, rest: text, variables };
        let sum = parser.sum()?;
        match parser.peek() {
            None => Ok(sum),
            Some(_) => Err(parser.expected("the end or an operator")),
        }
    }

    /// Value, given the values of the signals.
    pub fn value(&self, of: &dyn Fn(Variable) -> f64) -> f64 {
        match self {
            Self::Constant(c) => *c,
            Self::Variable(v) => of(*v),
            Self::Negative(a) => -a.value(of),
            Self::Sum(a, b) => a.value(of) + b.value(of),
            Self::Difference(a, b) => a.value(of) - b.value(of),
            Self::Product(a, b) => a.value(of) * b.value(of),
            Self::Quotient(a, b) => a.value(of) / b.value(of),
            Self::Power(a, n) => a.value(of).powf(*n),
            Self::Call(f, a) => f.at(a.value(of)).0,
        }
    }

    /// Hands `weight · ∂/∂variable` of every occurrence to `sink`.
    pub fn gradient(&self, of: &dyn Fn(Variable) -> f64, weight: f64, sink: &mut dyn FnMut(Variable, f64)) {
        match self {
            Self::Constant(_) => {}
            Self::Variable(v) => sink(*v, weight),
            Self::Negative(a) => a.gradient(of, -weight, sink),
            Self::Sum(a, b) => {
                a.gradient(of, weight, sink);
                b.gradient(of, weight, sink);
            }
            Self::Difference(a, b) => {
                a.gradient(of, weight, sink);
                b.gradient(of, -weight, sink);
            }
            Self::Product(a, b) => {
                a.gradient(of, weight * b.value(of), sink);
                b.gradient(of, weight * a.value(of), sink);
            }
            Self::Quotient(a, b) => {
                let d = b.value(of);
                a.gradient(of, weight / d, sink);
                b.gradient(of, -weight * a.value(of) / (d * d), sink);
            }
            Self::Power(a, n) => a.gradient(of, weight * n * a.value(of).powf(n - 1.0), sink),
            Self::Call(f, a) => a.gradient(of, weight * f.at(a.value(of)).1, sink),
        }
    }

    /// Every signal that occurs.
    pub fn variables(&self) -> Vec<Variable> {
        let mut found = Vec::new();
        self.gradient(&|_| 1.0, 1.0, &mut |v, _| found.push(v));
        found.sort_unstable();
        found.dedup();
        found
    }
}

struct Parser<'a> {
    text: &'a str,
    rest: &'a str,
    variables: &'a Variables,
}

impl<'a> Parser<'a> {
    fn peek(&mut self) -> Option<char> {
        self.rest = self.rest.trim_start();
        self.rest.chars().next()
    }

    fn take(&mut self, wanted: char) -> bool {
        let there = self.peek() == Some(wanted);
        if there {
            self.rest = &self.rest[wanted.len_utf8()..];
        }
        there
    }

    fn expected(&self, expected: &'static str) -> ExpressionError {
        let found = if self.rest.is_empty() { "the end".to_owned() } else { self.rest.chars().take(12).collect() };
        ExpressionError::Syntax { expected, found, text: self.text.to_owned() }
    }

    fn sum(&mut self) -> Result<Expression, ExpressionError> {
        let mut left = self.product()?;
        loop {
            if self.take('+') {
                left = Expression::Sum(Box::new(left), Box::new(self.product()?));
            } else if self.take('-') {
                left = Expression::Difference(Box::new(left), Box::new(self.product()?));
            } else {
                return Ok(left);
            }
        }
    }

    fn product(&mut self) -> Result<Expression, ExpressionError> {
        let mut left = self.sign()?;
        loop {
            if self.take('*') {
                left = Expression::Product(Box::new(left), Box::new(self.sign()?));
            } else if self.take('/') {
                left = Expression::Quotient(Box::new(left), Box::new(self.sign()?));
            } else {
                return Ok(left);
            }
        }
    }

    fn sign(&mut self) -> Result<Expression, ExpressionError> {
        if self.take('-') {
            return Ok(match self.sign()? {
                Expression::Constant(c) => Expression::Constant(-c),
                other => Expression::Negative(Box::new(other)),
            });
        }
        let base = self.atom()?;
        if !self.take('^') {
            return Ok(base);
        }
        match self.sign()? {
            Expression::Constant(n) => Ok(Expression::Power(Box::new(base), n)),
            _ => Err(ExpressionError::Exponent { text: self.text.to_owned() }),
        }
    }

    fn atom(&mut self) -> Result<Expression, ExpressionError> {
        if self.take('(') {
            let inner = self.sum()?;
            return if self.take(')') { Ok(inner) } else { Err(self.expected("`)`")) };
        }
        match self.peek() {
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_ascii_alphabetic() || c == '_' => self.name(),
            _ => Err(self.expected("a number, a signal or `(`")),
        }
    }

    fn number(&mut self) -> Result<Expression, ExpressionError> {
        let mut end = 0;
        let bytes = self.rest.as_bytes();
        while end < bytes.len() {
            let exponent_sign = matches!(bytes[end], b'+' | b'-') && end > 0 && matches!(bytes[end - 1], b'e' | b'E');
            if bytes[end].is_ascii_digit() || matches!(bytes[end], b'.' | b'e' | b'E') || exponent_sign {
                end += 1;
            } else {
                break;
            }
        }
        let value = self.rest[..end].parse().map_err(|_| self.expected("a number"))?;
        self.rest = &self.rest[end..];
        Ok(Expression::Constant(value))
    }

    fn word(&mut self) -> &'a str {
        let end = self.rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '.')).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        word
    }

    fn name(&mut self) -> Result<Expression, ExpressionError> {
        let word = self.word();
        if word == "rate" && self.take('(') {
            self.peek();
            let name = format!("rate({})", self.word());
            if !self.take(')') {
                return Err(self.expected("`)`"));
            }
            return self.signal(&name);
        }
        if let Some((_, f)) = Function::ALL.iter().find(|(name, _)| *name == word) {
            if !self.take('(') {
                return Err(self.expected("`(`"));
            }
            let argument = self.sum()?;
            return if self.take(')') { Ok(Expression::Call(*f, Box::new(argument))) } else { Err(self.expected("`)`")) };
        }
        self.signal(word)
    }

    fn signal(&self, name: &str) -> Result<Expression, ExpressionError> {
        match self.variables.find(name) {
            Some(v) => Ok(Expression::Variable(v)),
            None => Err(ExpressionError::UnknownSignal { name: name.to_owned() }),
        }
    }
}
