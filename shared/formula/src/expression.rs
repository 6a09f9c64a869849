//! One formula over names that its user declares, as in the map of an import.

use std::collections::BTreeMap;

use crate::evaluation::arithmetic::{binary, choose, unary};
use crate::syntax::graph::{Graph, Id, Node};
use crate::syntax::parse::{Scope, parse};
use crate::unit::Unit;
use crate::variable::Variables;

/// Most names.
const MOST_NAMES: usize = 255;

/// A formula that has been read, and whose units agree.
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
    /// What is wrong and at which character, counted from 1; units that contradict each other.
    /// Checked by `tests::a_formula_over_names_has_a_value_and_a_unit`.
    pub fn read(text: &str, names: &[(String, Unit)]) -> Result<Self, String> {
        if names.len() > MOST_NAMES {
            return Err(format!("{} names must be at most {MOST_NAMES}", names.len()));
        }
        let scope = Scope {
            variables: Variables::default(),
            parameters: names,
            definitions: &BTreeMap::new(),
            place: "a formula of a map",
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

    /// The unit of its result, as far as units tell: a number has whatever unit is needed.
    pub fn unit(&self) -> Option<Unit> {
        self.graph.unit(self.result)
    }

    /// The positions of the names that it uses.
    pub fn used(&self) -> &[usize] {
        &self.used
    }

    /// Its value, from the values of all names in SI units; NaN where one that it uses is missing.
    pub fn value(&self, values: &[f64]) -> f64 {
        let mut known: Vec<f64> = Vec::with_capacity(self.graph.len());
        for place in 0..=self.result.0 {
            let of = |id: Id| known.get(usize::from(id.0)).copied().unwrap_or(f64::NAN);
            let value = match self.graph.node(Id(place)) {
                Node::Number(bits) => f64::from_bits(bits),
                // Declared names hide none of the model's variables: the scope has none.
                Node::Variable(_) => f64::NAN,
                Node::Parameter(name) => values.get(usize::from(name)).copied().unwrap_or(f64::NAN),
                Node::Unary(operation, a) => unary(operation, of(a)),
                Node::Binary(operation, a, b) => binary(operation, of(a), of(b)),
                Node::If(condition, a, b) => choose(of(condition), of(a), of(b)),
            };
            known.push(value);
        }
        known.pop().unwrap_or(f64::NAN)
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
    fn what_is_wrong_is_said_with_its_place() {
        let said = |text| Expression::read(text, &names()).unwrap_err();
        assert!(
            said("omega * r - r").starts_with("character 11: "),
            "{}",
            said("omega * r - r")
        );
        assert!(said("omeg * r").contains("\"omega\""), "{}", said("omeg * r"));
        assert!(said("1 -").starts_with("character 4: "), "{}", said("1 -"));
    }
}
