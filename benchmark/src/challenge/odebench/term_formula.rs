//! Formulas of a term: products of up to three factors.

use super::super::dynamic_system::State;
use super::factor::{Argument, Constant, Factor, Shape};

/// The most nodes of a formula, without its strength.
const MAX_SIZE: usize = 8;
/// The most fitted constants.
const MAX_CONSTANTS: usize = 3;
/// The most nodes of two of three factors.
const MAX_SHORT: usize = 2;

/// A product of factors; without one it is 1.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TermFormula {
    pub factors: Vec<Factor>,
}

impl TermFormula {
    /// Returns the number of nodes.
    pub fn size(&self) -> usize {
        let sizes: usize = self.factors.iter().map(Factor::size).sum();
        (sizes + self.factors.len()).saturating_sub(1).max(1)
    }

    /// Returns the number of fitted constants.
    pub fn count(&self) -> usize {
        self.factors.iter().map(Factor::count).sum()
    }

    /// Returns the constants of all factors.
    pub fn constants(&self, sizes: &State) -> Vec<Constant> {
        self.factors
            .iter()
            .flat_map(|factor| factor.constants(sizes))
            .collect()
    }

    /// Returns the value; NaN where it is undefined.
    pub fn value(&self, state: &State, constants: &[f64]) -> f64 {
        let mut rest = constants;
        let mut value = 1.0;
        for factor in &self.factors {
            let (these, others) = rest.split_at(factor.count());
            value *= factor.value(state, these);
            rest = others;
        }
        value
    }

    /// Returns the formula as text, with a strength in front.
    pub fn text(&self, strength: f64, constants: &[f64]) -> String {
        let mut rest = constants;
        let mut text = format!("{strength:.4}");
        for factor in &self.factors {
            let (these, others) = rest.split_at(factor.count());
            text += &format!(" {}", factor.text(these));
            rest = others;
        }
        text
    }
}

/// Every formula of a number of states, with its prior probability.
///
/// Every size has the same prior probability, and so have the formulas of one size in each equation.
#[derive(Debug)]
pub struct TermLibrary {
    pub factors: Vec<Factor>,
    /// Indices of the factors of each formula.
    pub formulas: Vec<Vec<usize>>,
    dimension: usize,
    /// Number of formulas of each size.
    counts: Vec<usize>,
}

impl TermLibrary {
    pub fn new(dimension: usize) -> Self {
        let factors = factors(dimension);
        let is_short = |k: &&usize| factors[**k].size() <= MAX_SHORT;
        let is_of_state = |k: &usize| matches!(factors[*k].argument, Argument::State(_));
        let is_triple = |indices: &Vec<usize>| {
            indices.iter().all(is_of_state) && indices.iter().filter(is_short).count() > 1
        };
        let mut formulas: Vec<Vec<usize>> = vec![Vec::new()];
        formulas.extend((0..factors.len()).map(|a| vec![a]));
        for a in 0..factors.len() {
            for b in a..factors.len() {
                formulas.push(vec![a, b]);
                let thirds = (b..factors.len()).map(|c| vec![a, b, c]);
                formulas.extend(thirds.filter(|indices| is_triple(indices)));
            }
        }
        let product = |indices: &[usize]| TermFormula {
            factors: indices.iter().map(|k| factors[*k]).collect(),
        };
        formulas.retain(|indices| is_kept(&product(indices)));
        let mut counts = vec![0; MAX_SIZE + 1];
        formulas
            .iter()
            .for_each(|indices| counts[product(indices).size()] += 1);
        Self {
            factors,
            formulas,
            dimension,
            counts,
        }
    }

    pub fn formula(&self, index: usize) -> TermFormula {
        TermFormula {
            factors: self.formulas[index].iter().map(|k| self.factors[*k]).collect(),
        }
    }

    /// Returns the logarithm of the prior probability of a formula in an equation.
    pub fn log_prior(&self, size: usize) -> f64 {
        let sizes = self.counts.iter().filter(|count| **count > 0).count();
        -libm::log((sizes * self.counts[size] * self.dimension) as f64)
    }
}

/// Returns the factors of a number of states.
fn factors(dimension: usize) -> Vec<Factor> {
    let mut factors = Vec::new();
    let mut add = |argument: Argument, shapes: &[Shape]| {
        factors.extend(shapes.iter().map(|shape| Factor {
            argument,
            shape: *shape,
        }));
    };
    for i in 0..dimension {
        let powers = [1, 2, 3, 4, 5, -1, -2].map(Shape::Power);
        add(Argument::State(i), &powers);
        add(
            Argument::State(i),
            &[
                Shape::Root,
                Shape::Absolute,
                Shape::Sine,
                Shape::Cosine,
                Shape::Tangent,
                Shape::Cotangent,
                Shape::Logarithm,
                Shape::FittedPower,
                Shape::Exponential,
                Shape::ScaledLogarithm,
                Shape::Tanh,
                Shape::Decay(1),
                Shape::Decay(2),
                Shape::Hill(1),
                Shape::Hill(2),
                Shape::FittedHill,
                Shape::Logistic,
            ],
        );
        add(
            Argument::Complement(i),
            &[Shape::Power(1), Shape::Power(2), Shape::FittedPower],
        );
        for j in 0..i {
            let joint = [
                Shape::Absolute,
                Shape::Sine,
                Shape::Cosine,
                Shape::Exponential,
                Shape::Tanh,
            ];
            add(Argument::Sum(j, i), &joint);
            add(Argument::Difference(j, i), &joint);
            add(Argument::Weighted(j, i), &[Shape::Logistic]);
        }
    }
    factors
}

/// Returns whether a product is small enough, and no other way of writing one of fewer factors.
fn is_kept(formula: &TermFormula) -> bool {
    let merges = |a: &Factor, b: &Factor| {
        a.argument == b.argument
            && (a.is_power() && b.is_power()
                || a.shape == b.shape && a.count() > 0
                || matches!((a.shape, b.shape), (Shape::Power(n), Shape::Decay(m)) if n == m)
                || matches!(
                    (a.shape, b.shape),
                    (Shape::Sine, Shape::Cotangent)
                        | (Shape::Cosine, Shape::Tangent)
                        | (Shape::Tangent, Shape::Cotangent)
                ))
    };
    let factors = &formula.factors;
    // One less a state alone is two terms.
    let is_sum = factors.len() == 1
        && matches!(factors[0].argument, Argument::Complement(_))
        && factors[0].count() == 0;
    let mut pairs = (0..factors.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
    !is_sum
        && formula.size() <= MAX_SIZE
        && formula.count() <= MAX_CONSTANTS
        && !pairs.any(|(a, b)| merges(&factors[a], &factors[b]))
}
