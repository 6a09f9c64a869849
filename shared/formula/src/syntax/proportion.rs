//! The proportions in a formula: the check that it only scales the quantity that it replaces.

use crate::syntax::graph::{Binary, Graph, Id, Node, Unary};
use crate::variable::Variable;

/// The dependence of a value on a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Dependence {
    Free,
    /// Proportional to the variable: the variable times a factor that does not depend on it.
    Proportional,
    Other,
}

/// Returns whether the form of a result shows that it is the variable times a factor that does not depend on the
/// variable.
pub(crate) fn is_proportional(graph: &Graph, result: Id, variable: Variable) -> bool {
    use Dependence::{Free, Other, Proportional};
    let mut dependences = vec![Other; graph.len()];
    for id in graph.behind(result) {
        let at = |id: Id| dependences[usize::from(id.0)];
        let dependence = match graph.node(id) {
            Node::Variable(candidate) if candidate == variable => Proportional,
            Node::Number(_) | Node::Parameter(_) | Node::Variable(_) => Free,
            Node::Unary(Unary::Negate, a) => at(a),
            node if node.arguments().all(|argument| at(argument) == Free) => Free,
            Node::Binary(Binary::Multiply, a, b) => match (at(a), at(b)) {
                (Proportional, Free) | (Free, Proportional) => Proportional,
                _ => Other,
            },
            Node::Binary(Binary::Divide, a, b) if (at(a), at(b)) == (Proportional, Free) => Proportional,
            Node::Binary(Binary::Add | Binary::Subtract, a, b) if at(a) == at(b) => at(a),
            Node::If(condition, a, b) if at(condition) == Free && at(a) == at(b) => at(a),
            Node::Unary(..) | Node::Binary(..) | Node::If(..) => Other,
        };
        dependences[usize::from(id.0)] = dependence;
    }
    dependences[usize::from(result.0)] == Proportional
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
