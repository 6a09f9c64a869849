//! Every formula up to a size, each family of curves once as far as rules and values show it.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::link::Link;
use crate::op::Op;
use crate::program::Program;
use crate::tree::{CONSTANTS, Tree};

/// Values of the variable at which formulas are compared.
const POINTS: [f64; 6] = [0.13, 0.29, 0.47, 0.71, 0.93, 1.21];
/// Values of the constants at which formulas are compared.
const PROBES: [[f64; CONSTANTS]; 2] = [[0.77, 1.39, 0.53], [-0.31, -0.83, -1.27]];

/// Prior weight of a formula with a transcendental function inside another, over that of one without.
const NESTED: f64 = 0.1;
/// Prior weight of a formula by each square and each root in it.
const FIXED_POWER: f64 = 0.3;
/// Leaves of the formulas of a law. Numbers come first, so that they stand on the left of a sum or product.
const LEAVES: &[Op] = &[Op::Constant, Op::One, Op::Variable, Op::Threshold];
/// Functions in the formulas of a law.
const FUNCTIONS: &[Op] = &[Op::Exp, Op::Log, Op::Tanh, Op::Sqrt, Op::Square];
/// Leaves of the formulas of a correction, which is smooth.
const CORRECTION_LEAVES: &[Op] = &[Op::Constant, Op::One, Op::Variable];
/// The most constants of a formula of a correction, beside its strength.
const CORRECTION_CONSTANTS: usize = 2;
/// Functions in the formulas of a correction.
const CORRECTION_FUNCTIONS: &[Op] = &[Op::Exp, Op::Log, Op::Tanh, Op::Sqrt, Op::Square, Op::Sine];
/// Nodes by which a formula of a pure number without a scale is shorter at most.
const SHORTER: usize = 2;

/// Every formula of a variable up to a size, by rising size.
#[derive(Debug)]
pub struct FormulaLibrary {
    pub(crate) formulas: Vec<Arc<Tree>>,
    /// Sum of the prior weights of each size.
    sums: Vec<f64>,
    /// The only link of the formulas; without one they have those of the curve's host.
    pub(crate) link: Option<Link>,
}

impl FormulaLibrary {
    /// Enumerates the formulas.
    ///
    /// A formula is multiplied by a strength, so constant factors in front of it do not count. The variable enters only where constants
    /// make the formula independent of its unit; a variable that is a pure number may also enter alone, in formulas that are two nodes
    /// shorter. Checked by `library::families_are_listed_once`.
    ///
    /// # Arguments
    /// - `size`: the most nodes of a formula, without its strength.
    #[must_use]
    pub fn new(size: usize, is_dimensionless: bool) -> Self {
        let mut known = BTreeSet::new();
        let law = Grammar {
            leaves: LEAVES,
            constants: CONSTANTS,
            functions: FUNCTIONS,
            link: Link::Proportional,
            is_dimensionless: false,
        };
        let mut formulas = law.roots(size, &mut known);
        if is_dimensionless {
            let pure = Grammar {
                is_dimensionless,
                ..law
            };
            formulas.extend(pure.roots(size.saturating_sub(SHORTER), &mut known));
            formulas.sort_by_key(|tree| tree.size);
        }
        Self::weighed(formulas, size, None)
    }

    /// Enumerates the formulas of a correction by one link, with the sine among their functions, without
    /// thresholds, and with at most two constants beside the strength. Formulas without a value at the end of the
    /// link are left out, and so are those that the link makes equal to a smaller one. Checked by
    /// `library::corrections_vanish_at_their_end`.
    ///
    /// # Arguments
    /// - `size`: as of [`new`](Self::new). `link`: the only one of the formulas.
    #[must_use]
    pub fn of_corrections(size: usize, link: Link) -> Self {
        let grammar = Grammar {
            leaves: CORRECTION_LEAVES,
            constants: CORRECTION_CONSTANTS,
            functions: CORRECTION_FUNCTIONS,
            link,
            is_dimensionless: false,
        };
        Self::weighed(grammar.roots(size, &mut BTreeSet::new()), size, Some(link))
    }

    fn weighed(formulas: Vec<Arc<Tree>>, size: usize, link: Option<Link>) -> Self {
        let mut sums = vec![0.0; size + 1];
        formulas.iter().for_each(|tree| sums[tree.size] += weight(tree));
        Self { formulas, sums, link }
    }

    /// Returns the link that all formulas have; `None` if it is that of the curve's host.
    #[must_use]
    pub const fn link(&self) -> Option<Link> {
        self.link
    }

    /// Returns the logarithm of a formula's share among the formulas of its size.
    #[must_use]
    pub fn log_prior(&self, tree: &Tree) -> f64 {
        libm::log(weight(tree) / self.sums[tree.size])
    }

    /// Returns the formulas, by rising size.
    pub fn formulas(&self) -> impl Iterator<Item = &Arc<Tree>> {
        self.formulas.iter()
    }

    /// Returns the number of formulas of each size, from 0 on.
    #[must_use]
    pub fn counts(&self) -> Vec<usize> {
        let of_size = |size: usize| self.formulas.iter().filter(|tree| tree.size == size).count();
        (0..self.sums.len()).map(of_size).collect()
    }
}

/// Returns the prior weight of a formula among those of its size.
fn weight(tree: &Tree) -> f64 {
    libm::pow(NESTED, tree.nested as f64) * libm::pow(FIXED_POWER, tree.fixed_powers as f64)
}

/// What formulas are made of.
#[derive(Debug, Clone, Copy)]
struct Grammar {
    leaves: &'static [Op],
    /// The most constants.
    constants: usize,
    functions: &'static [Op],
    /// How the formulas make the values of a curve.
    link: Link,
    is_dimensionless: bool,
}

impl Grammar {
    /// Enumerates trees, and returns those that are formulas of their own.
    ///
    /// # Arguments
    /// - `known`: what is listed already.
    fn roots(self, size: usize, known: &mut BTreeSet<Vec<u32>>) -> Vec<Arc<Tree>> {
        let mut levels: Vec<Vec<Arc<Tree>>> = vec![Vec::new(); size + 1];
        let (mut parts, mut order) = (BTreeSet::new(), 0);
        for nodes in 1..=size {
            let mut level = Vec::new();
            let mut keep = |tree: Option<Tree>| {
                let Some(mut tree) =
                    tree.filter(|tree| tree.size == nodes && tree.constants <= self.constants)
                else {
                    return;
                };
                if let Some(key) = key(&tree, None)
                    && parts.insert(key)
                {
                    tree.order = order;
                    order += 1;
                    level.push(Arc::new(tree));
                }
            };
            for op in self.leaves {
                keep(Some(Tree::leaf(*op, self.is_dimensionless)));
            }
            for op in self.functions {
                levels[nodes - 1]
                    .iter()
                    .for_each(|child| keep(Tree::unary(*op, child)));
            }
            if nodes > 2 {
                levels[nodes - 2]
                    .iter()
                    .for_each(|child| keep(Tree::unary(Op::Power, child)));
            }
            for left in 1..nodes.saturating_sub(1) {
                for (a, b) in pairs(&levels[left], &levels[nodes - 1 - left]) {
                    for op in [Op::Add, Op::Subtract, Op::Multiply, Op::Divide] {
                        keep(Tree::binary(op, a, b));
                    }
                }
            }
            levels[nodes] = level;
        }
        let takes_shift = matches!(self.link, Link::Vanishing(_));
        let roots = levels.into_iter().flatten();
        let roots = roots.filter(|tree| tree.is_root() && !(takes_shift && tree.absorbs_shift));
        roots
            .filter(|tree| key(tree, Some(self.link)).is_some_and(|key| known.insert(key)))
            .collect()
    }
}

fn pairs<'a>(
    left: &'a [Arc<Tree>],
    right: &'a [Arc<Tree>],
) -> impl Iterator<Item = (&'a Arc<Tree>, &'a Arc<Tree>)> {
    left.iter().flat_map(move |a| right.iter().map(move |b| (a, b)))
}

/// Returns what two formulas of the same values have in common; `None` where a formula is nowhere defined or does not vary.
///
/// # Arguments
/// - `link`: that of a whole formula; formulas then count as equal up to a strength, and to the order and the signs of their constants.
fn key(tree: &Tree, link: Option<Link>) -> Option<Vec<u32>> {
    let program = Program::new(tree);
    let is_root = link.is_some();
    let link = link.unwrap_or(Link::Proportional);
    let is_scaled = is_root && link.has_strength();
    let orders: &[[usize; CONSTANTS]] = match (is_root, tree.constants) {
        (true, 2) => &[[0, 1, 2], [1, 0, 2]],
        (true, 3) => &[[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]],
        _ => &[[0, 1, 2]],
    };
    let masks = if is_root { 1 << tree.constants } else { 1 };
    let signed = |mask: usize, k: usize, value: f64| if mask >> k & 1 == 1 { -value } else { value };
    let values = |(order, mask): (&[usize; CONSTANTS], usize)| -> Vec<u32> {
        let of_probe = |probe: &[f64; CONSTANTS]| -> Vec<f64> {
            let constants: [f64; CONSTANTS] = std::array::from_fn(|k| signed(mask, k, probe[order[k]]));
            let values = link.anchored_values(&program, &constants, &POINTS);
            let values = values.unwrap_or_else(|| vec![f64::NAN; POINTS.len()]);
            let scale = if is_scaled { values[2] } else { 1.0 };
            values.into_iter().map(|value| value / scale).collect()
        };
        let values = PROBES.iter().flat_map(of_probe);
        values.map(bits).collect()
    };
    let variants = orders
        .iter()
        .flat_map(|order| (0..masks).map(move |mask| (order, mask)));
    let key = variants.map(values).min()?;
    let is_defined = key.iter().any(|bits| *bits != UNDEFINED);
    let is_leaf = tree.size == 1 && link.end().is_none();
    let varies = key.iter().any(|bits| *bits != key[0]) || tree.op == Op::Threshold;
    (is_leaf || is_defined && varies).then_some(key)
}

/// Stands for a value that is not finite.
const UNDEFINED: u32 = u32::MAX;

/// Returns a value to six digits, as comparable bits.
fn bits(value: f64) -> u32 {
    if !value.is_finite() {
        return UNDEFINED;
    }
    // Without a negative zero, and rounded so that the order of operations does not count.
    let rounded = (value as f32) + 0.0;
    (rounded.to_bits() + 16) >> 5
}
