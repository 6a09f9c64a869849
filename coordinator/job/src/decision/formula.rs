//! Formulas over the quantities of a run, and statements about them.

use formula::expression::Expression;
use formula::unit::Unit;

use super::quantity::{QUANTITIES, QuantityValues};

/// A formula over the quantities of a run, such as a loss.
#[derive(Debug, Clone)]
pub struct QuantityFormula {
    /// The formula as written.
    pub text: String,
    expression: Expression,
}

impl QuantityFormula {
    /// Reads a formula; its grammar is that of effect files.
    ///
    /// # Errors
    /// A sentence that names the mistake and its character; units that contradict each other are a mistake.
    /// Checked by `tests::a_loss_reads_channels_and_what_follows_from_them`.
    pub fn read(text: &str) -> Result<Self, String> {
        Ok(QuantityFormula {
            text: text.to_owned(),
            expression: read(text)?,
        })
    }

    /// Computes the value; NaN if a quantity that it uses has none.
    pub fn value(&self, values: &QuantityValues) -> f64 {
        self.expression.value(values)
    }
}

/// A statement about a run, such as `drawbar_pull_n > 12`.
#[derive(Debug, Clone)]
pub struct Statement {
    /// The statement as written.
    pub text: String,
    expression: Expression,
}

impl Statement {
    /// Reads a comparison of two formulas.
    ///
    /// # Errors
    /// A sentence that names the mistake.
    /// Checked by `tests::a_statement_is_a_comparison`.
    pub fn read(text: &str) -> Result<Self, String> {
        let text = text.trim();
        if !text.contains(['<', '>', '=']) {
            return Err(format!(
                "\"{text}\" is no comparison: write it like drawbar_pull_n > 12"
            ));
        }
        // The grammar has comparisons inside `if` alone. Blanks keep the characters of messages where the user counts them.
        let expression = read(&format!("if({text}, 1, 0)")).map_err(|message| shifted(&message))?;
        Ok(Statement {
            text: text.to_owned(),
            expression,
        })
    }

    /// Returns whether the statement holds; `None` if a quantity that it uses has no value.
    pub fn holds(&self, values: &QuantityValues) -> Option<bool> {
        let used = self.expression.used();
        let has_values = used.iter().all(|&name| values[name].is_finite());
        has_values.then(|| self.expression.value(values) > 0.5)
    }
}

fn read(text: &str) -> Result<Expression, String> {
    let names = QUANTITIES.iter().map(|quantity| {
        let unit = Unit::parse(quantity.unit).expect("the units of the quantities are known");
        (quantity.name.to_owned(), unit)
    });
    Expression::read(text, &names.collect::<Vec<_>>())
}

/// Length of what stands before a statement in its formula.
const BEFORE: usize = "if(".len();

/// Counts the character of a message from the start of the statement.
fn shifted(message: &str) -> String {
    let parts = message
        .strip_prefix("character ")
        .and_then(|rest| rest.split_once(": "));
    match parts.and_then(|(at, rest)| Some((at.parse::<usize>().ok()?, rest))) {
        Some((at, rest)) => format!("character {}: {rest}", at.saturating_sub(BEFORE).max(1)),
        None => message.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decision::quantity::position_of;

    fn with(name: &str, value: f64) -> QuantityValues {
        let mut values = [f64::NAN; QUANTITIES.len()];
        values[position_of(name).unwrap()] = value;
        values
    }

    #[test]
    fn a_loss_reads_channels_and_what_follows_from_them() {
        let loss = QuantityFormula::read("2 * energy_j_m + 1").unwrap();
        assert!((loss.value(&with("energy_j_m", 3.0)) - 7.0).abs() < 1e-12);
        assert!(loss.value(&with("slip", 3.0)).is_nan());
        let unknown = QuantityFormula::read("energy").unwrap_err();
        assert!(unknown.contains("energy_j_m"), "{unknown}");
        assert!(QuantityFormula::read("drawbar_pull_n + sinkage_m").is_err());
    }

    #[test]
    fn a_statement_is_a_comparison() {
        let statement = Statement::read(" drawbar_pull_n > 12 ").unwrap();
        assert_eq!(statement.holds(&with("drawbar_pull_n", 12.5)), Some(true));
        assert_eq!(statement.holds(&with("drawbar_pull_n", 11.5)), Some(false));
        assert_eq!(statement.holds(&with("slip", 1.0)), None);
        assert!(
            Statement::read("drawbar_pull_n")
                .unwrap_err()
                .contains("is no comparison")
        );
        let mistake = Statement::read("drawbar_pull > 12").unwrap_err();
        assert!(mistake.starts_with("character 1: "), "{mistake}");
    }
}
