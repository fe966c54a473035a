//! Formulas over named quantities, with units: `0.5 * spring_stiffness + 2 kN/m`.
//!
//! Numbers with units, names, `+ - * / ^`, parentheses, `sqrt abs sin cos tan atan atan2 min max`, `pi`. A unit belongs to the number before
//! it; a word that is a unit is never a name. Every step is a step of dimensions, too: a length and a force cannot be added.
//!
//! Angles: where mass or length take part, the radian may be left out, as in quantities (`N m` and `N m/rad` are the same there).
//!
//! Source: BIPM, *The International System of Units*, 9th edition (2019), 2.3.3 and 5.4 (dimensions of products, sums of equal kinds).
//! The test that holds it: `description::expression::tests`.

mod error;
mod reader;

pub use error::ExpressionError;

use super::finding::suggestion;
use super::quantity::dimension::{Exponents, describe};
use error::Side;

/// A value in SI and what it measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value {
    /// In SI.
    pub si: f64,
    /// Powers of the base units.
    pub exponents: Exponents,
}

/// A formula that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    text: String,
    root: Node,
}

/// A part of a formula and where in the text it stands.
#[derive(Clone, Debug, PartialEq)]
struct Node {
    what: What,
    span: (usize, usize),
}

#[derive(Clone, Debug, PartialEq)]
enum What {
    Number(Value),
    Name(String),
    Negative(Box<Node>),
    Binary(Operator, Box<Node>, Box<Node>),
    Power(Box<Node>, Box<Node>),
    Call(Function, Vec<Node>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Operator {
    Plus,
    Minus,
    Times,
    Over,
}

/// A named function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Function {
    Sqrt,
    Abs,
    Sin,
    Cos,
    Tan,
    Atan,
    Atan2,
    Min,
    Max,
}

/// Name, function, how many arguments at least and at most.
const FUNCTIONS: &[(&str, Function, usize, usize)] = &[
    ("sqrt", Function::Sqrt, 1, 1),
    ("abs", Function::Abs, 1, 1),
    ("sin", Function::Sin, 1, 1),
    ("cos", Function::Cos, 1, 1),
    ("tan", Function::Tan, 1, 1),
    ("atan", Function::Atan, 1, 1),
    ("atan2", Function::Atan2, 2, 2),
    ("min", Function::Min, 2, 16),
    ("max", Function::Max, 2, 16),
];

/// Whether a word cannot be the name of a quantity, and why.
pub fn reserved(word: &str) -> Option<&'static str> {
    let function = FUNCTIONS.iter().any(|(name, ..)| *name == word);
    if word == "pi" || function {
        Some("the word of a function or constant")
    } else if super::quantity::Unit::of_symbol(word).is_some() {
        Some("the symbol of a unit")
    } else {
        let mut letters = word.chars();
        let first = letters.next().is_some_and(|c| c.is_alphabetic() || c == '_');
        let plain = first && letters.all(|c| c.is_alphanumeric() || c == '_');
        (!plain).then_some("not made of letters, digits and `_` alone")
    }
}

/// The formula of a text that is one: what stands behind `=`.
pub fn formula(text: &str) -> Option<&str> {
    text.trim_start().strip_prefix('=').map(str::trim)
}

impl Expression {
    /// Reads a formula, without its `=`.
    ///
    /// # Errors
    /// What stands at a place where something else belongs; a unit that is none.
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        Ok(Self { text: text.to_owned(), root: reader::read(text)? })
    }

    /// Every name that occurs.
    pub fn names(&self) -> Vec<&str> {
        let mut found = Vec::new();
        collect(&self.root, &mut found);
        found
    }

    /// The value, given those of the names.
    ///
    /// # Errors
    /// A name that `known` does not have, quantities that do not go together, a result that is not finite.
    pub fn value(&self, known: &dyn Fn(&str) -> Option<Value>, all: &[&str]) -> Result<Value, ExpressionError> {
        let value = Evaluation { text: &self.text, known, all }.of(&self.root)?;
        match value.si.is_finite() {
            true => Ok(value),
            false => Err(ExpressionError::NotFinite { text: self.text.clone(), value: value.si }),
        }
    }
}

fn collect<'a>(node: &'a Node, found: &mut Vec<&'a str>) {
    match &node.what {
        What::Number(_) => {}
        What::Name(name) => found.push(name),
        What::Negative(a) => collect(a, found),
        What::Binary(_, a, b) | What::Power(a, b) => [a, b].into_iter().for_each(|n| collect(n, found)),
        What::Call(_, arguments) => arguments.iter().for_each(|n| collect(n, found)),
    }
}

const PLAIN: Exponents = Exponents::of([0; 4]);
const ANGLE: Exponents = Exponents::of([0, 0, 0, 1]);

/// Whether two quantities may be added or compared, and what the sum is then; see the header on angles.
pub(in crate::description) fn together(a: Exponents, b: Exponents) -> Option<Exponents> {
    let mechanical = a.length != 0 || a.mass != 0;
    let alike = Exponents { angle: 0, ..a } == Exponents { angle: 0, ..b };
    (a == b || (mechanical && alike)).then_some(a)
}

struct Evaluation<'a> {
    text: &'a str,
    known: &'a dyn Fn(&str) -> Option<Value>,
    all: &'a [&'a str],
}

impl Evaluation<'_> {
    fn of(&self, node: &Node) -> Result<Value, ExpressionError> {
        match &node.what {
            What::Number(value) => Ok(*value),
            What::Name(name) => (self.known)(name).ok_or_else(|| ExpressionError::UnknownName {
                name: name.clone(),
                hint: suggestion(name, self.all.iter().copied().chain(FUNCTIONS.iter().map(|f| f.0)).chain(["pi"])),
            }),
            What::Negative(a) => self.of(a).map(|v| Value { si: -v.si, ..v }),
            What::Binary(operator, a, b) => self.binary(*operator, a, b),
            What::Power(a, n) => self.power(a, n),
            What::Call(function, arguments) => self.call(*function, arguments),
        }
    }

    fn side(&self, node: &Node, value: Value) -> Side {
        let text = self.text.get(node.span.0..node.span.1).unwrap_or_default().trim();
        Side { text: text.to_owned(), is: describe(value.exponents) }
    }

    fn binary(&self, operator: Operator, a: &Node, b: &Node) -> Result<Value, ExpressionError> {
        let (x, y) = (self.of(a)?, self.of(b)?);
        let sum = |word, si| match together(x.exponents, y.exponents) {
            Some(exponents) => Ok(Value { si, exponents }),
            None => Err(ExpressionError::Unlike { verb: word, left: self.side(a, x), right: self.side(b, y) }),
        };
        let product = |si, n| match x.exponents.times_power(y.exponents, n) {
            Some(exponents) => Ok(Value { si, exponents }),
            None => Err(ExpressionError::Power { text: self.text.to_owned() }),
        };
        match operator {
            Operator::Plus => sum("added", x.si + y.si),
            Operator::Minus => sum("subtracted", x.si - y.si),
            Operator::Times => product(x.si * y.si, 1),
            Operator::Over => product(x.si / y.si, -1),
        }
    }

    fn power(&self, a: &Node, n: &Node) -> Result<Value, ExpressionError> {
        let (x, n) = (self.of(a)?, self.plain("the exponent", n)?);
        match raised(x.exponents, n) {
            Some(exponents) => Ok(Value { si: x.si.powf(n), exponents }),
            None => Err(ExpressionError::Power { text: self.text.to_owned() }),
        }
    }

    /// A number without unit; an angle where the function takes one.
    fn plain(&self, what: &'static str, node: &Node) -> Result<f64, ExpressionError> {
        let value = self.of(node)?;
        let fits = value.exponents == PLAIN || (what == "the argument of an angle function" && value.exponents == ANGLE);
        if fits { Ok(value.si) } else { Err(ExpressionError::NotPlain { what, side: self.side(node, value) }) }
    }

    fn call(&self, function: Function, arguments: &[Node]) -> Result<Value, ExpressionError> {
        let first = &arguments[0];
        let turned =
            |f: fn(f64) -> f64| self.plain("the argument of an angle function", first).map(|x| Value { si: f(x), exponents: PLAIN });
        match function {
            Function::Sin => turned(f64::sin),
            Function::Cos => turned(f64::cos),
            Function::Tan => turned(f64::tan),
            Function::Atan => Ok(Value { si: self.plain("the argument of `atan`", first)?.atan(), exponents: ANGLE }),
            Function::Abs => self.of(first).map(|v| Value { si: v.si.abs(), ..v }),
            Function::Sqrt => {
                let x = self.of(first)?;
                match raised(x.exponents, 0.5) {
                    Some(exponents) => Ok(Value { si: x.si.sqrt(), exponents }),
                    None => Err(ExpressionError::Power { text: self.text.to_owned() }),
                }
            }
            Function::Atan2 | Function::Min | Function::Max => {
                let mut all = Vec::with_capacity(arguments.len());
                for node in arguments {
                    let value = self.of(node)?;
                    let before: &Value = all.first().unwrap_or(&value);
                    if together(before.exponents, value.exponents).is_none() {
                        let (left, right) = (self.side(first, *before), self.side(node, value));
                        return Err(ExpressionError::Unlike { verb: "compared", left, right });
                    }
                    all.push(value);
                }
                let si = all.iter().map(|v| v.si);
                Ok(match function {
                    Function::Atan2 => Value { si: all[0].si.atan2(all[1].si), exponents: ANGLE },
                    Function::Min => Value { si: si.fold(f64::INFINITY, f64::min), ..all[0] },
                    _ => Value { si: si.fold(f64::NEG_INFINITY, f64::max), ..all[0] },
                })
            }
        }
    }
}

/// Powers of a quantity to the n; `None` where they are no whole numbers, or beyond any unit.
fn raised(exponents: Exponents, n: f64) -> Option<Exponents> {
    let power = |e: i8| {
        let p = f64::from(e) * n;
        ((p - p.round()).abs() < 1e-9 && p.abs() <= 100.0).then_some(p.round() as i8)
    };
    let Exponents { length, mass, time, angle } = exponents;
    Some(Exponents { length: power(length)?, mass: power(mass)?, time: power(time)?, angle: power(angle)? })
}

#[cfg(test)]
mod tests;
