//! Corrections of textbook laws, found from noisy measurements.
//!
//! An entry is told at which end of the variable the correction vanishes. A formula g is therefore searched as g - g(end) with a strength,
//! and, where the correction is a factor less 1, also as g / g(end) - 1, with the same prior probability. A formula whose fit is the limit of a
//! constant is left out: it is another formula there.

use std::sync::Arc;

use equation::{End, FittedFormula, FormulaLibrary, Link, LocatedCurve, Tree, fitted};

use super::grouping::{classes, is_within};
use super::limiting_form::is_limit;
use super::scenario::Scenario;
use super::truth::Truth;

/// Constants of each correction beside its factor; of a power the exponent, which may be fitted.
const CONSTANTS: usize = 1;
/// Formulas of each link that are fitted to all measurements.
const SCREENED: usize = 150;
/// A member of a class is listed if it has at least this share of the probability of the class's best.
const LISTED: f64 = 0.1;
/// Points at which formulas are compared.
const GRID: usize = 61;
/// Probability of the classes that are reported together.
const CREDIBLE: f64 = 0.95;
/// The log Bayes factor of the truth over every shorter formula from which on measurements decide \[nats\].
const DECIDES: f64 = 3.0;

/// The answer of the search to a scenario, judged by the hidden correction.
#[derive(Debug)]
pub struct Said {
    /// Probability of the leading class.
    pub probability: f64,
    /// Whether the truth is among the formulas that equal the most probable one within half an sd of the curve.
    pub is_in_class: bool,
    /// Whether, besides, it has a tenth of the probability of the most probable one.
    pub is_listed: bool,
    /// Whether the truth is in one of the leading classes that have a probability of 0.95 together.
    pub is_credible: bool,
    /// Number of these classes.
    pub credible: usize,
    /// Whether the simplest listed member, of the fewest nodes and parameters, is the truth.
    pub is_simplest: bool,
    /// Whether the measurements favour the truth over every shorter formula.
    pub is_decidable: bool,
    /// Number of listed members.
    pub members: usize,
    pub simplest: String,
}

/// The formulas of corrections, one library for each link.
#[derive(Debug)]
pub struct Libraries(Vec<(Link, FormulaLibrary)>);

impl Libraries {
    /// Enumerates the formulas.
    ///
    /// # Arguments
    /// - `size`: the most nodes of a formula.
    #[must_use]
    pub fn new(size: usize) -> Self {
        let ends = [End::Zero, End::Infinity];
        let links = ends.map(|end| [Link::Vanishing(end), Link::Normalised(end)]);
        let library = |link: Link| (link, FormulaLibrary::of_corrections(size, link));
        Self(links.into_iter().flatten().map(library).collect())
    }
}

/// The formulas of one link.
struct Family<'a> {
    link: Link,
    library: &'a FormulaLibrary,
    /// The hidden correction as formulas of the library, by rising size.
    truths: Vec<Arc<Tree>>,
}

/// A formula of the correction, fitted to all measurements.
struct Candidate {
    tree: Arc<Tree>,
    complexity: usize,
    /// Log prior and log evidence.
    weight: f64,
    log_evidence: f64,
    /// The correction at points of the range.
    values: Vec<f64>,
    is_true: bool,
    class: usize,
}

impl Family<'_> {
    /// Returns the leading formulas of the curve of means, fitted to the curve of all measurements.
    fn candidates(&self, averaged: &LocatedCurve, curve: &LocatedCurve, grid: &[f64]) -> Vec<Candidate> {
        let weight = |formula: &FittedFormula| self.library.log_prior(&formula.tree) + formula.log_evidence;
        let formulas = self.library.formulas();
        let screened = formulas.filter_map(|tree| fitted(averaged, tree, self.link));
        let screened = screened.filter(|formula| !is_limit(averaged, formula));
        let mut screened: Vec<(f64, FittedFormula)> = screened.map(|f| (weight(&f), f)).collect();
        screened.sort_by(|a, b| b.0.total_cmp(&a.0));
        screened.truncate(SCREENED);
        let refitted = screened
            .iter()
            .filter_map(|(_, f)| fitted(curve, &f.tree, self.link));
        let refitted = refitted.filter(|formula| !is_limit(curve, formula));
        let candidate = |formula: FittedFormula| Candidate {
            complexity: formula.tree.size + formula.parameters(),
            weight: weight(&formula),
            log_evidence: formula.log_evidence,
            values: grid.iter().map(|x| formula.law(curve, *x)).collect(),
            is_true: self.truths.iter().any(|truth| Arc::ptr_eq(truth, &formula.tree)),
            class: 0,
            tree: formula.tree,
        };
        refitted.map(candidate).collect()
    }
}

/// The search of the formula of a scenario's correction.
pub struct Search<'a> {
    scenario: &'a Scenario,
    families: Vec<Family<'a>>,
}

impl<'a> Search<'a> {
    #[must_use]
    pub fn new(scenario: &'a Scenario, libraries: &'a Libraries) -> Self {
        let truth = Truth::new(scenario.correction, scenario.range, CONSTANTS);
        let links = scenario.links();
        let of_scenario = libraries.0.iter().filter(|(link, _)| links.contains(link));
        let family = |(link, library): &'a (Link, FormulaLibrary)| Family {
            link: *link,
            library,
            truths: truth.formulas(library, *link),
        };
        Self {
            scenario,
            families: of_scenario.map(family).collect(),
        }
    }

    /// Searches the formula in measurements; `None` if they make no curve.
    ///
    /// # Arguments
    /// - `noise`: sd of the measurements over their values.
    #[must_use]
    pub fn said(&self, noise: f64, seed: u64, number: u64) -> Option<Said> {
        let measured = self.scenario.measured(noise, seed, number);
        let (averaged, curve) = (measured.averaged().ok()?, measured.curve().ok()?);
        let [first, last] = curve.range();
        let share = |i: usize| i as f64 / (GRID - 1) as f64;
        let grid: Vec<f64> = (0..GRID).map(|i| first + (last - first) * share(i)).collect();
        let families = self.families.iter();
        let mut candidates: Vec<Candidate> = families
            .flat_map(|family| family.candidates(&averaged, &curve, &grid))
            .collect();
        candidates.sort_by(|a, b| b.weight.total_cmp(&a.weight));
        let sds: Vec<f64> = grid.iter().map(|x| curve.sd(*x)).collect();
        let classes = classified(&mut candidates, &sds);
        let best = candidates.first()?;
        let class = candidates.iter().filter(|candidate| candidate.class == 0);
        let is_listed = |candidate: &&Candidate| candidate.weight - best.weight >= libm::log(LISTED);
        let listed: Vec<&Candidate> = class.clone().filter(is_listed).collect();
        let simplest = listed.iter().min_by_key(|c| (c.complexity, c.tree.constants))?;
        let credible = credible(&classes);
        Some(Said {
            probability: classes[0],
            is_in_class: class.clone().any(|candidate| candidate.is_true),
            is_listed: listed.iter().any(|candidate| candidate.is_true),
            is_credible: candidates
                .iter()
                .any(|c| c.is_true && credible.contains(&c.class)),
            credible: credible.len(),
            is_simplest: simplest.is_true,
            is_decidable: self.is_decidable(&curve, &candidates),
            members: listed.len(),
            simplest: simplest.tree.to_string(),
        })
    }

    /// Returns whether the simplest formula that is the truth has a log Bayes factor of 3 or more over every shorter formula.
    fn is_decidable(&self, curve: &LocatedCurve, candidates: &[Candidate]) -> bool {
        let truths = self.families.iter().flat_map(|family| {
            let fit = |tree: &Arc<Tree>| fitted(curve, tree, family.link);
            family.truths.iter().filter_map(fit)
        });
        let complexity = |formula: &FittedFormula| formula.tree.size + formula.parameters();
        let Some(truth) = truths.min_by_key(complexity) else {
            return false;
        };
        let is_shorter = |c: &&Candidate| !c.is_true && c.complexity < complexity(&truth);
        let mut shorter = candidates.iter().filter(is_shorter);
        shorter.all(|rival| truth.log_evidence - rival.log_evidence > DECIDES)
    }
}

/// Groups formulas, the most probable first: a formula joins the first class whose best it resembles. Returns the probability of each class.
fn classified(candidates: &mut [Candidate], sds: &[f64]) -> Vec<f64> {
    let best = candidates.first().map_or(0.0, |candidate| candidate.weight);
    let joined = classes(candidates.len(), |a, b| {
        is_within(sds, &candidates[a].values, &candidates[b].values)
    });
    let mut sums = vec![0.0; joined.iter().max().map_or(0, |last| last + 1)];
    for (candidate, class) in candidates.iter_mut().zip(joined) {
        candidate.class = class;
        sums[class] += libm::exp(candidate.weight - best);
    }
    let all: f64 = sums.iter().sum();
    sums.iter().map(|sum| sum / all).collect()
}

/// Returns the fewest classes that have the probability of a credible set together.
fn credible(classes: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..classes.len()).collect();
    order.sort_by(|a, b| classes[*b].total_cmp(&classes[*a]));
    let mut sum = 0.0;
    let is_needed = |class: &usize| {
        let is_needed = sum < CREDIBLE;
        sum += classes[*class];
        is_needed
    };
    order.into_iter().take_while(is_needed).collect()
}
