//! A law as a formula over constants that are fitted.

use equation::{FormulaParameter, FormulaText, ParameterKind};
use formula::expression::Expression;
use formula::unit::Unit;

/// A formula over `x` and its constants. The coordinate of a positive constant is its logarithm.
#[derive(Debug, Clone)]
pub struct ParametricLaw {
    expression: Expression,
    is_positive: Vec<bool>,
}

impl ParametricLaw {
    /// Reads a law with the coordinates of its values; `None` if the formula has none.
    pub fn new(text: &FormulaText) -> Option<(Self, Vec<f64>)> {
        let unit = Unit::parse("1").ok()?;
        let names = std::iter::once("x").chain(text.parameters.iter().map(|p| p.name.as_str()));
        let names: Vec<_> = names.map(|name| (name.to_owned(), unit)).collect();
        let law = Self {
            expression: Expression::read(&text.formula, &names).ok()?,
            is_positive: text
                .parameters
                .iter()
                .map(|p| p.kind == ParameterKind::Scale)
                .collect(),
        };
        let coordinate = |(p, is_positive): (&FormulaParameter, &bool)| match is_positive {
            true => libm::log(p.value),
            false => p.value,
        };
        let place = text
            .parameters
            .iter()
            .zip(&law.is_positive)
            .map(coordinate)
            .collect();
        Some((law, place))
    }

    /// Returns the number of constants.
    pub fn count(&self) -> usize {
        self.is_positive.len()
    }

    /// Returns the constants of coordinates.
    pub fn constants(&self, place: &[f64]) -> Vec<f64> {
        let pairs = place.iter().zip(&self.is_positive);
        pairs
            .map(|(t, is_positive)| if *is_positive { libm::exp(*t) } else { *t })
            .collect()
    }

    /// Returns the value of the law.
    pub fn value(&self, constants: &[f64], at: f64) -> f64 {
        let mut values = Vec::with_capacity(constants.len() + 1);
        values.push(at);
        values.extend_from_slice(constants);
        self.expression.value(&values)
    }
}
