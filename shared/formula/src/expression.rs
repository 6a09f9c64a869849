//! One formula over names that its user declares, such as in the map of an import, in a loss or in a statement.

use std::collections::BTreeMap;

use crate::evaluation::arithmetic::{binary, choose, unary};
use crate::syntax::graph::{Graph, Id, Node};
use crate::syntax::parse::{Scope, parse};
use crate::unit::Unit;
use crate::variable::Variables;

/// The maximum number of names.
const MAX_NAMES: usize = 255;

/// A formula that has been read and whose units agree.
#[derive(Debug, Clone)]
pub struct Expression {
    graph: Graph,
    result: Id,
    used: Vec<usize>,
}

impl Expression {
    /// Reads a formula over names with their units, in the order of their values.
    ///
    /// # Errors
    /// The message names the mistake and its character, counted from 1; units that contradict each other are a mistake.
    /// Checked by `tests::a_formula_over_names_has_a_value_and_a_unit`.
    pub fn read(text: &str, names: &[(String, Unit)]) -> Result<Self, String> {
        if names.len() > MAX_NAMES {
            return Err(format!("{} names must be at most {MAX_NAMES}", names.len()));
        }
        let scope = Scope {
            variables: Variables::default(),
            parameters: names,
            definitions: &BTreeMap::new(),
            place: "this formula",
        };
        let mut graph = Graph::default();
        let result = parse(text, &scope, &mut graph)
            .map_err(|mistake| format!("character {}: {}", mistake.at + 1, mistake.message))?;
        let behind = graph.behind(result).into_iter();
        let used = behind.filter_map(|id| match graph.node(id) {
            Node::Parameter(place) => Some(usize::from(place)),
            _ => None,
        });
        let used = used.collect();
        Ok(Expression { graph, result, used })
    }

    /// Returns the unit of the result, if the units determine it; a plain number takes any unit.
    pub fn unit(&self) -> Option<Unit> {
        self.graph.unit(self.result)
    }

    /// Returns the positions of the names that it uses.
    pub fn used(&self) -> &[usize] {
        &self.used
    }

    /// Computes the value from the values of all names in SI units; NaN if a used name has none.
    pub fn value(&self, values: &[f64]) -> f64 {
        let mut results: Vec<f64> = Vec::with_capacity(self.graph.len());
        for place in 0..=self.result.0 {
            let result = |id: Id| results.get(usize::from(id.0)).copied().unwrap_or(f64::NAN);
            let value = match self.graph.node(Id(place)) {
                Node::Number(bits) => f64::from_bits(bits),
                // The scope has no variables of a model.
                Node::Variable(_) => f64::NAN,
                Node::Parameter(name) => values.get(usize::from(name)).copied().unwrap_or(f64::NAN),
                Node::Unary(operation, a) => unary(operation, result(a)),
                Node::Binary(operation, a, b) => binary(operation, result(a), result(b)),
                Node::If(condition, a, b) => choose(result(condition), result(a), result(b)),
            };
            results.push(value);
        }
        results.pop().unwrap_or(f64::NAN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names() -> Vec<(String, Unit)> {
        [("omega", "1/s"), ("r", "m"), ("v", "m/s")]
            .map(|(name, unit)| (name.to_owned(), Unit::parse(unit).unwrap()))
            .into()
    }

    #[test]
    fn a_formula_over_names_has_a_value_and_a_unit() {
        let slip = Expression::read("(omega * r - v) / max(omega * r, v)", &names()).unwrap();
        assert_eq!(slip.unit(), Some(Unit::ONE));
        assert_eq!(slip.used(), [0, 1, 2]);
        assert!((slip.value(&[2.0, 0.25, 0.4]) - 0.2).abs() < 1e-15);
        assert!((slip.value(&[1.0, 0.25, 0.5]) + 0.5).abs() < 1e-15);
        assert!(slip.value(&[1.0, f64::NAN, 0.5]).is_nan());
    }

    #[test]
    fn a_mistake_is_named_with_its_place() {
        let error = |text| Expression::read(text, &names()).unwrap_err();
        assert!(
            error("omega * r - r").starts_with("character 11: "),
            "{}",
            error("omega * r - r")
        );
        assert!(error("omeg * r").contains("\"omega\""), "{}", error("omeg * r"));
        assert!(error("1 -").starts_with("character 4: "), "{}", error("1 -"));
    }
}
