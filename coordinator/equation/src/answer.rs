//! The search: every formula is fitted to a curve and weighed, and formulas that the curve cannot tell apart are one class.

use std::sync::Arc;

use crate::curve::{Host, LocatedCurve};
use crate::enumeration::FormulaLibrary;
use crate::fit::{Fit, Problem};
use crate::link::Link;
use crate::program::Program;
use crate::tree::{CONSTANTS, Tree};

/// Formulas that are grouped, the most probable.
const GROUPED: usize = 400;
/// Two formulas are of one class where they differ by at most this share of the curve's sd.
const CLASS: f64 = 0.5;
/// Two formulas are one and the same where they differ by at most this share of the curve's sd.
const SAME: f64 = 0.02;
/// A member of a class is listed if it has at least this share of the probability of the class's best.
const LISTED: f64 = 0.1;
/// A formula with its fitted values.
#[derive(Debug, Clone)]
pub struct FittedFormula {
    /// The formula g.
    pub tree: Arc<Tree>,
    /// How strength and formula make the law.
    pub link: Link,
    /// Probability among all formulas.
    pub probability: f64,
    /// Log evidence \[nats\], without a part that all formulas share.
    pub log_evidence: f64,
    /// Half the sum of squared residuals in sds of the curve.
    pub misfit: f64,
    /// The law at the points of comparison.
    pub(crate) values: Vec<f64>,
    pub(crate) fit: Fit,
    pub(crate) program: Program,
}

/// A fitted formula with its log evidence and log prior \[nats\].
#[derive(Debug, Clone)]
pub struct WeighedFit {
    weight: f64,
    formula: FittedFormula,
}

/// The formulas of a curve.
#[derive(Debug, Clone)]
pub struct Answer {
    /// Formulas by falling probability.
    pub formulas: Vec<FittedFormula>,
    /// Classes by falling probability.
    pub classes: Vec<FormulaClass>,
}

/// Formulas that the curve cannot tell apart.
#[derive(Debug, Clone)]
pub struct FormulaClass {
    /// Probability of the class: the sum over its formulas.
    pub probability: f64,
    /// Indices of the members among the formulas, the most probable first; formulas that only add constants to another are left out.
    pub members: Vec<usize>,
}

impl WeighedFit {
    /// Returns the formula, of which the probability is not known before [`answer`].
    #[must_use]
    pub fn formula(&self) -> &FittedFormula {
        &self.formula
    }

    /// Returns the formula as data behind the curve have it; `None` where it then has a pole in the range.
    ///
    /// The evidence is turned into that with the priors of [`fits`] by the densities of both priors at the most probable values
    /// (Laplace's approximation). Misfit and covariance remain those of the curve, at the new values. Checked by
    /// `refitted::the_prior_of_a_formula_is_a_density`.
    ///
    /// # Arguments
    /// - `parameters`: their most probable values in the order of [`FormulaText::parameters`](crate::FormulaText).
    /// - `log_evidence`: of the data, over that of something that all formulas share. `log_prior`: log density of the priors with which
    ///   it was computed, at these values.
    #[must_use]
    pub fn refitted(
        &self,
        curve: &LocatedCurve,
        parameters: &[f64],
        log_evidence: f64,
        log_prior: f64,
    ) -> Option<Self> {
        let place = self.formula.place_of(curve, parameters);
        let problem = self.formula.problem(curve);
        let fit = problem.at(place)?;
        let log_evidence = log_evidence + self.formula.log_prior(curve, parameters, &place) - log_prior;
        Some(Self {
            weight: self.weight - self.formula.log_evidence + log_evidence,
            formula: FittedFormula {
                log_evidence,
                misfit: fit.misfit,
                values: problem.on_grid(&place),
                fit,
                ..self.formula.clone()
            },
        })
    }
}

impl Answer {
    /// Returns the member of a class with the fewest nodes and constants.
    #[must_use]
    pub fn simplest(&self, class: &FormulaClass) -> usize {
        let complexity = |k: usize| self.formulas[k].tree.size + self.formulas[k].tree.constants;
        let members = class.members.iter().copied();
        members.fold(class.members[0], |simplest, k| {
            if complexity(k) < complexity(simplest) {
                k
            } else {
                simplest
            }
        })
    }
}

impl FittedFormula {
    /// Returns the number of parameters: the strength, where there is one, and the constants.
    #[must_use]
    pub fn parameters(&self) -> usize {
        usize::from(self.link.has_strength()) + self.tree.constants
    }

    pub(crate) fn problem<'a>(&'a self, curve: &'a LocatedCurve) -> Problem<'a> {
        Problem {
            curve,
            program: &self.program,
            link: self.link,
        }
    }

    /// Returns the fitted constants beside the strength, of the variable over its greatest magnitude: as many as the formula has, then 0.
    #[must_use]
    pub fn constants(&self, curve: &LocatedCurve) -> [f64; CONSTANTS] {
        self.problem(curve).constants(&self.fit.place)
    }

    /// Returns the formula's value, without its strength, at the end at which it vanishes; 0 without an end.
    pub(crate) fn at_end(&self, curve: &LocatedCurve) -> f64 {
        self.problem(curve).at_end(&self.constants(curve))
    }

    /// Returns the factor before the formula.
    pub(crate) fn strength(&self, curve: &LocatedCurve) -> f64 {
        self.fit.place[0] / self.problem(curve).size(&self.fit.place)
    }
}

/// Searches the formulas of a curve, one after the other; [`fits`] and [`answer`] are its parts, for several threads.
#[must_use]
pub fn search(curve: &LocatedCurve, library: &FormulaLibrary) -> Answer {
    let formulas = 0..library.formulas.len();
    answer(curve, formulas.flat_map(|formula| fits(curve, library, formula)))
}

/// Fits a formula of the library in each way in which it may make the law.
///
/// Every size has the same prior probability, and so have the formulas of one size, of which one with a transcendental function inside
/// another counts as a tenth, and one with a square or a root by 0.3 for each. The prior of a strength is normal with twice the curve's root mean square, that of a coefficient c of the
/// variable over its greatest magnitude is normal with sd 1.5 in arsinh c, that of an exponent normal with sd 1.5, and that of a
/// threshold uniform over the range.
///
/// # Arguments
/// - `formula`: its place in [`FormulaLibrary::formulas`].
#[must_use]
pub fn fits(curve: &LocatedCurve, library: &FormulaLibrary, formula: usize) -> Vec<WeighedFit> {
    let links: &[Link] = match (&library.link, curve.host) {
        (Some(link), _) => std::slice::from_ref(link),
        (None, Host::Addition) => &[Link::Proportional],
        (None, Host::Factor) => &[Link::Proportional, Link::Relative],
    };
    let tree = &library.formulas[formula];
    let fits = links.iter().filter_map(|link| fitted(curve, tree, *link));
    fits.map(|formula| WeighedFit {
        weight: library.log_prior(tree) + formula.log_evidence,
        formula,
    })
    .collect()
}

/// Returns fits by falling probability.
#[must_use]
pub fn ranked(fits: impl IntoIterator<Item = WeighedFit>) -> Vec<WeighedFit> {
    let mut ranked: Vec<WeighedFit> = fits.into_iter().collect();
    ranked.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    ranked
}

/// Returns the probability of each of some fits among all of them.
///
/// # Arguments
/// - `ranked`: as [`ranked`] returns them.
#[must_use]
pub fn probabilities(ranked: &[WeighedFit]) -> Vec<f64> {
    let best = ranked.first().map_or(0.0, |fit| fit.weight);
    let relative = ranked.iter().map(|fit| libm::exp(fit.weight - best));
    let relative: Vec<f64> = relative.collect();
    let sum: f64 = relative.iter().sum();
    relative.into_iter().map(|weight| weight / sum).collect()
}

/// Weighs formulas against each other, and groups them.
pub fn answer(curve: &LocatedCurve, fits: impl IntoIterator<Item = WeighedFit>) -> Answer {
    let mut ranked = ranked(fits);
    ranked.truncate(GROUPED);
    let best = ranked.first().map_or(0.0, |fit| fit.weight);
    let formulas = ranked.into_iter().map(|fit| FittedFormula {
        probability: libm::exp(fit.weight - best),
        ..fit.formula
    });
    grouped(curve, formulas.collect())
}

/// Fits one formula to a curve; `None` where it has no fit without a pole in the range. Its probability is 1.
#[must_use]
pub fn fitted(curve: &LocatedCurve, tree: &Arc<Tree>, link: Link) -> Option<FittedFormula> {
    let program = Program::new(tree);
    let problem = Problem {
        curve,
        program: &program,
        link,
    };
    let fit = problem.fit()?;
    let values = problem.on_grid(&fit.place);
    Some(FittedFormula {
        tree: tree.clone(),
        link,
        probability: 1.0,
        log_evidence: fit.log_evidence,
        misfit: fit.misfit,
        values,
        fit,
        program,
    })
}

/// Returns the greatest difference of two formulas in sds of the curve.
fn difference(curve: &LocatedCurve, a: &FittedFormula, b: &FittedFormula) -> f64 {
    let pairs = a.values.iter().zip(&b.values).zip(&curve.sds);
    pairs.fold(0.0, |greatest, ((a, b), sd)| greatest.max((a - b).abs() / sd))
}

/// Groups formulas, the most probable first: a formula joins the first class whose best it resembles.
fn grouped(curve: &LocatedCurve, ranked: Vec<FittedFormula>) -> Answer {
    let mut formulas: Vec<FittedFormula> = Vec::new();
    let mut classes: Vec<FormulaClass> = Vec::new();
    for formula in ranked {
        // The same curve with as many constants is the same formula, written in another way.
        let twin = formulas
            .iter()
            .find(|other| difference(curve, other, &formula) < SAME);
        if twin.is_some_and(|twin| twin.parameters() == formula.parameters()) {
            continue;
        }
        let adds_nothing = twin.is_some_and(|twin| twin.parameters() < formula.parameters());
        let mut joined = classes.iter_mut();
        let joined = joined.find(|class| difference(curve, &formulas[class.members[0]], &formula) <= CLASS);
        let index = formulas.len();
        match joined {
            Some(class) => {
                class.probability += formula.probability;
                if !adds_nothing && formula.probability >= LISTED * formulas[class.members[0]].probability {
                    class.members.push(index);
                }
            }
            None => classes.push(FormulaClass {
                probability: formula.probability,
                members: vec![index],
            }),
        }
        formulas.push(formula);
    }
    let sum: f64 = classes.iter().map(|class| class.probability).sum();
    classes.iter_mut().for_each(|class| class.probability /= sum);
    formulas.iter_mut().for_each(|formula| formula.probability /= sum);
    classes.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    Answer { formulas, classes }
}
