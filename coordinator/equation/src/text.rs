//! A fitted formula as text, in the grammar of effect files, with its parameters.

use std::fmt;

use crate::answer::FittedFormula;
use crate::curve::{Host, LocatedCurve};
use crate::link::Link;
use crate::op::Op;
use crate::tree::{CONSTANTS, Tree};

/// What a parameter of a formula is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParameterKind {
    /// The strength: at 0 the law changes nothing. Its unit is that of the law.
    Strength,
    /// A scale of the variable, in its unit; positive.
    Scale,
    /// A distance along the variable, in its unit.
    Shift,
    /// A threshold of the variable, in its unit.
    Threshold,
    /// An exponent.
    Exponent,
    /// A factor or summand without a unit.
    Factor,
}

/// A parameter of a formula with its fitted value.
#[derive(Debug, Clone, PartialEq)]
pub struct FormulaParameter {
    /// Name in the formula: `scale`, `exponent_2`.
    pub name: String,
    /// What it is.
    pub kind: ParameterKind,
    /// Its value, SI.
    pub value: f64,
}

/// A formula over named parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct FormulaText {
    /// The quantity with the law: `tau * (1 + strength * (1 - exp(-j / scale)))`.
    pub formula: String,
    /// The parameters in the order of the formula, the strength first.
    pub parameters: Vec<FormulaParameter>,
}

/// Writes constants one after the other.
struct Writer<'a> {
    variable: &'a str,
    /// The magnitude by which the variable is divided.
    scale: f64,
    constants: std::slice::Iter<'a, f64>,
    parameters: Vec<FormulaParameter>,
}

/// A part of a formula, with the level of its outermost operation.
struct Part {
    text: String,
    level: Level,
}

/// How tightly an operation binds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Sum,
    Product,
    Power,
    Atom,
}

impl Part {
    fn new(level: Level, text: String) -> Self {
        Self { text, level }
    }

    /// Returns the text, in parentheses where it binds less tightly.
    fn within(self, level: Level) -> String {
        if self.level < level {
            format!("({})", self.text)
        } else {
            self.text
        }
    }
}

impl FormulaText {
    /// Writes the law that a formula is on a quantity. Checked by `text::a_formula_gives_the_law_that_was_fitted`.
    ///
    /// # Arguments
    /// - `target`, `variable`: names of the quantity and of the variable in formulas.
    #[must_use]
    pub fn new(curve: &LocatedCurve, formula: &FittedFormula, target: &str, variable: &str) -> Self {
        let constants: [f64; CONSTANTS] = formula.constants(curve);
        let mut writer = Writer {
            variable,
            scale: curve.scale,
            constants: constants.iter(),
            parameters: vec![FormulaParameter {
                name: "strength".into(),
                kind: ParameterKind::Strength,
                value: formula.strength(curve),
            }],
        };
        let formula = match (
            curve.host,
            formula.link,
            formula.tree.op,
            formula.tree.left.as_deref(),
        ) {
            (Host::Factor, Link::Proportional, Op::Log, Some(base)) => {
                format!("{target} * {}^strength", writer.part(base).within(Level::Atom))
            }
            (host, link, ..) => {
                let shape = writer.part(&formula.tree).within(Level::Product);
                match (host, link) {
                    (Host::Factor, Link::Proportional) => format!("{target} * exp(strength * {shape})"),
                    (Host::Factor, Link::Relative) => format!("{target} * (1 + strength * {shape})"),
                    (Host::Addition, Link::Proportional | Link::Relative) => {
                        format!("{target} + strength * {shape}")
                    }
                    (_, Link::Vanishing(_)) => {
                        let end = writer.parameter(ParameterKind::Factor, formula.at_end(curve));
                        format!("{target} + strength * ({shape} - {end})")
                    }
                    (_, Link::Normalised(_)) => {
                        let end = writer.parameter(ParameterKind::Factor, formula.at_end(curve));
                        format!("{target} + strength * ({shape} / {end} - 1)")
                    }
                }
            }
        };
        Self {
            formula,
            parameters: writer.parameters,
        }
    }

    /// Returns the formula with the fitted values, to some digits, in the place of the parameters.
    #[must_use]
    pub fn with_values(&self, digits: usize) -> String {
        let mut parameters: Vec<&FormulaParameter> = self.parameters.iter().collect();
        // A longer name may contain a shorter one.
        parameters.sort_by_key(|parameter| std::cmp::Reverse(parameter.name.len()));
        let text = parameters.iter().fold(self.formula.clone(), |text, parameter| {
            text.replace(&parameter.name, &number(parameter.value, digits))
        });
        text.replace("+ -", "- ").replace("- -", "+ ").replace("--", "")
    }
}

/// Writes a number to some significant digits.
fn number(value: f64, digits: usize) -> String {
    let decimals = digits.saturating_sub(1);
    let rounded: f64 = format!("{value:.decimals$e}").parse().unwrap_or(value);
    if rounded.fract() == 0.0 && rounded.abs() < 1e6 {
        format!("{rounded:.0}")
    } else {
        format!("{rounded:?}")
    }
}

impl Writer<'_> {
    /// Takes the next constant as a parameter, and returns its name.
    ///
    /// # Arguments
    /// - `value`: the value of the parameter by the constant.
    fn parameter(&mut self, kind: ParameterKind, value: f64) -> String {
        let word = match kind {
            ParameterKind::Strength => "strength",
            ParameterKind::Scale => "scale",
            ParameterKind::Shift => "shift",
            ParameterKind::Threshold => "threshold",
            ParameterKind::Exponent => "exponent",
            ParameterKind::Factor => "factor",
        };
        let same = self
            .parameters
            .iter()
            .filter(|parameter| parameter.kind == kind)
            .count();
        let name = match same {
            0 => word.to_owned(),
            same => format!("{word}_{}", same + 1),
        };
        self.parameters.push(FormulaParameter {
            name: name.clone(),
            kind,
            value,
        });
        name
    }

    fn constant(&mut self) -> f64 {
        self.constants.next().copied().unwrap_or(f64::NAN)
    }

    fn part(&mut self, tree: &Tree) -> Part {
        let (left, right) = (tree.left.as_deref(), tree.right.as_deref());
        if is_length(tree) {
            let length = self.length(tree).within(Level::Product);
            return Part::new(Level::Product, format!("{length} / {:?}", self.scale));
        }
        if tree.op == Op::Multiply && is_of_constant_and_variable(tree) {
            return self.over_scale();
        }
        let function = |name: &str, inner: Part| Part::new(Level::Atom, format!("{name}({})", inner.text));
        match (tree.op, left, right) {
            (Op::One, ..) => Part::new(Level::Atom, "1".into()),
            (Op::Threshold, ..) => {
                let value = self.constant() * self.scale;
                let name = self.parameter(ParameterKind::Threshold, value);
                Part::new(Level::Atom, format!("if({} > {name}, 1, 0)", self.variable))
            }
            (Op::Add | Op::Subtract, Some(a), Some(b)) => {
                let sign = if tree.op == Op::Add { '+' } else { '-' };
                let a = self.part(a).within(Level::Sum);
                Part::new(
                    Level::Sum,
                    format!("{a} {sign} {}", self.part(b).within(Level::Product)),
                )
            }
            // The scale of both cancels.
            (Op::Divide, Some(a), Some(b)) if is_length(a) && is_length(b) => {
                let a = self.length(a).within(Level::Product);
                Part::new(
                    Level::Product,
                    format!("{a} / {}", self.length(b).within(Level::Power)),
                )
            }
            (Op::Multiply | Op::Divide, Some(a), Some(b)) => {
                let sign = if tree.op == Op::Multiply { '*' } else { '/' };
                let a = self.part(a).within(Level::Product);
                Part::new(
                    Level::Product,
                    format!("{a} {sign} {}", self.part(b).within(Level::Power)),
                )
            }
            (Op::Exp, Some(a), _) => function("exp", self.part(a)),
            (Op::Log, Some(a), _) => function("log", self.part(a)),
            (Op::Tanh, Some(a), _) => function("tanh", self.part(a)),
            (Op::Sine, Some(a), _) => function("sin", self.part(a)),
            (Op::Sqrt, Some(a), _) => function("sqrt", self.part(a)),
            (Op::Square, Some(a), _) => {
                Part::new(Level::Power, format!("{}^2", self.part(a).within(Level::Atom)))
            }
            (Op::Power, Some(a), _) => {
                let base = self.part(a).within(Level::Atom);
                let value = self.constant();
                let name = self.parameter(ParameterKind::Exponent, value);
                Part::new(Level::Power, format!("{base}^{name}"))
            }
            _ => {
                let value = self.constant();
                Part::new(Level::Atom, self.parameter(ParameterKind::Factor, value))
            }
        }
    }

    /// Writes the variable over a scale of its own.
    fn over_scale(&mut self) -> Part {
        let (variable, constant) = (self.variable, self.constant());
        let name = self.parameter(ParameterKind::Scale, self.scale / constant.abs());
        match constant < 0.0 {
            true => Part::new(Level::Sum, format!("-{variable} / {name}")),
            false => Part::new(Level::Product, format!("{variable} / {name}")),
        }
    }

    /// Writes the variable or its distance from a place, in its unit.
    fn length(&mut self, tree: &Tree) -> Part {
        let variable = self.variable;
        if tree.op == Op::Variable {
            return Part::new(Level::Atom, variable.to_owned());
        }
        let shift = self.constant() * self.scale;
        let name = self.parameter(ParameterKind::Shift, shift);
        let distance = match tree.op {
            Op::Add => format!("{variable} + {name}"),
            _ => format!("{name} - {variable}"),
        };
        Part::new(Level::Sum, distance)
    }
}

/// Returns whether an operation is on a constant and the variable.
fn is_of_constant_and_variable(tree: &Tree) -> bool {
    let is = |tree: Option<&Tree>, op: Op| tree.is_some_and(|tree| tree.op == op);
    is(tree.left.as_deref(), Op::Constant) && is(tree.right.as_deref(), Op::Variable)
}

/// Returns whether a part is the variable or its distance from a place, over the magnitude of the variable.
fn is_length(tree: &Tree) -> bool {
    let is_distance = matches!(tree.op, Op::Add | Op::Subtract) && is_of_constant_and_variable(tree);
    tree.op == Op::Variable || is_distance
}

/// The structure of a formula: `c` is a constant, `x` the variable.
impl fmt::Display for Tree {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.op, self.left.as_deref(), self.right.as_deref()) {
            (Op::Add, Some(a), Some(b)) => write!(f, "({a} + {b})"),
            (Op::Subtract, Some(a), Some(b)) => write!(f, "({a} - {b})"),
            (Op::Multiply, Some(a), Some(b)) => write!(f, "{a} * {b}"),
            (Op::Divide, Some(a), Some(b)) => write!(f, "{a} / ({b})"),
            (Op::Power, Some(a), _) => write!(f, "({a})^c"),
            (Op::Exp, Some(a), _) => write!(f, "exp({a})"),
            (Op::Log, Some(a), _) => write!(f, "log({a})"),
            (Op::Tanh, Some(a), _) => write!(f, "tanh({a})"),
            (Op::Sine, Some(a), _) => write!(f, "sin({a})"),
            (Op::Sqrt, Some(a), _) => write!(f, "sqrt({a})"),
            (Op::Square, Some(a), _) => write!(f, "({a})^2"),
            (Op::Variable, ..) => write!(f, "x"),
            (Op::One, ..) => write!(f, "1"),
            (Op::Threshold, ..) => write!(f, "if(x > c, 1, 0)"),
            _ => write!(f, "c"),
        }
    }
}
