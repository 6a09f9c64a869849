//! Whether a formula only scales the quantity that it replaces.

use crate::syntax::graph::{Binary, Graph, Id, Node, Unary};
use crate::variable::Variable;

/// How a value depends on a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Dependence {
    Free,
    /// The variable times something free of it.
    Proportional,
    Other,
}

/// Whether a result is a variable times something that does not depend on it, as far as its form shows.
pub(crate) fn is_proportional(graph: &Graph, result: Id, variable: Variable) -> bool {
    use Dependence::{Free, Other, Proportional};
    let mut known = vec![Other; graph.len()];
    for id in graph.behind(result) {
        let of = |id: Id| known[usize::from(id.0)];
        let dependence = match graph.node(id) {
            Node::Variable(own) if own == variable => Proportional,
            Node::Number(_) | Node::Parameter(_) | Node::Variable(_) => Free,
            Node::Unary(Unary::Negate, a) => of(a),
            node if node.arguments().all(|argument| of(argument) == Free) => Free,
            Node::Binary(Binary::Multiply, a, b) => match (of(a), of(b)) {
                (Proportional, Free) | (Free, Proportional) => Proportional,
                _ => Other,
            },
            Node::Binary(Binary::Divide, a, b) if (of(a), of(b)) == (Proportional, Free) => Proportional,
            Node::Binary(Binary::Add | Binary::Subtract, a, b) if of(a) == of(b) => of(a),
            Node::If(condition, a, b) if of(condition) == Free && of(a) == of(b) => of(a),
            Node::Unary(..) | Node::Binary(..) | Node::If(..) => Other,
        };
        known[usize::from(id.0)] = dependence;
    }
    known[usize::from(result.0)] == Proportional
}

#[cfg(test)]
mod tests {
    use crate::{Effect, Hook};

    fn scales(formula: &str) -> bool {
        let text = format!(
            "name = \"e\"\nsummary = \"s\"\nsource = \"t\"\nshear = \"{formula}\"\n\
             torque = \"torque * (1 + a)\"\n\
             [parameters.a]\nunit = \"1\"\nneutral = 0\nprior = {{ half_normal = 0.1 }}\n"
        );
        Effect::read(&text).expect("an effect").only_scales(Hook::Shear)
    }

    #[test]
    fn products_sums_and_choices_of_multiples_are_multiples() {
        for formula in [
            "tau",
            "tau * (1 - a)",
            "-(a * -tau) / 2",
            "tau * a + tau / (1 + v_t / 0.001)",
            "if(v_t > 1e-3, tau * a, tau)",
        ] {
            assert!(scales(formula), "{formula}");
        }
    }

    #[test]
    fn anything_else_is_not() {
        for formula in [
            "tau_max * a",
            "tau + a * tau_max",
            "min(tau, a * tau_max)",
            "tau * tau / tau_max * a",
            "tau_max * tau_max / tau * a",
            "if(tau > tau_max / 2, tau * a, tau)",
            "abs(tau) * a",
        ] {
            assert!(!scales(formula), "{formula}");
        }
    }
}
