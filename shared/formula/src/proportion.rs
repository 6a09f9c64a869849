//! Tell whether a formula only scales what it replaces.

use crate::graph::{Binary, Graph, Id, Node, Unary};
use crate::variable::Variable;

/// Whether a result is a variable times something that does not depend on it, as far as its form shows.
pub(crate) fn is_proportional(graph: &Graph, result: Id, variable: Variable) -> bool {
    let free = |id: Id| !graph.variables(id).contains(variable);
    let scales = |id: Id| is_proportional(graph, id, variable);
    match graph.node(result) {
        Node::Variable(own) => own == variable,
        Node::Unary(Unary::Negate, a) => scales(a),
        Node::Binary(Binary::Multiply, a, b) => (scales(a) && free(b)) || (free(a) && scales(b)),
        Node::Binary(Binary::Divide, a, b) => scales(a) && free(b),
        Node::Binary(Binary::Add | Binary::Subtract, a, b) => scales(a) && scales(b),
        Node::If(condition, a, b) => free(condition) && scales(a) && scales(b),
        Node::Number(_) | Node::Parameter(_) | Node::Unary(..) | Node::Binary(..) => false,
    }
}

#[cfg(test)]
mod tests {
    use crate::{Effect, Hook};

    fn scales(formula: &str) -> bool {
        let text = format!(
            "name = \"e\"\nsummary = \"s\"\nsource = \"t\"\nshear = \"{formula}\"\n\
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
