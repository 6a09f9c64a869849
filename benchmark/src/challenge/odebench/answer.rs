//! What the search of a term says: formulas by their weight, and the class of the most probable ones.

use super::super::grouping::classes;
use super::hypothesis::Hypothesis;

/// Predictions whose distance makes a log likelihood ratio of at most this are of one class; a term is claimed above it.
pub const DISTINCT: f64 = 3.0;
/// A member of a class is listed if it has at least this share of the probability of the class's best.
const LISTED: f64 = 0.1;

/// A hypothesis that was fitted through the equations of motion.
#[derive(Debug)]
pub struct WeighedTerm<'a> {
    pub hypothesis: Hypothesis<'a>,
    pub place: Vec<f64>,
    /// Log evidence, and log prior of the formula.
    pub weight: f64,
    /// Predicted measurements in sds.
    pub predictions: Vec<f64>,
    /// Half the squares of the residuals.
    pub misfit: f64,
}

/// What the search says.
#[derive(Debug)]
pub struct Answer<'a> {
    /// By falling weight.
    pub terms: Vec<WeighedTerm<'a>>,
    /// Members of the class with the greatest probability, as indices of the terms, and those that have a tenth of its best's probability.
    pub class: Vec<usize>,
    pub listed: Vec<usize>,
    /// Probability of the class among all terms.
    pub probability: f64,
    /// Log odds of any missing term over none, whose prior probabilities are equal.
    pub log_odds: f64,
}

/// Groups terms, the greatest weight first; `None` without any: a term joins the first class whose best predicts what it does.
pub fn answer(terms: Vec<WeighedTerm<'_>>, without: f64) -> Option<Answer<'_>> {
    let best = terms.first()?.weight;
    let relative: Vec<f64> = terms.iter().map(|term| libm::exp(term.weight - best)).collect();
    let joined = classes(terms.len(), |a, b| {
        let pairs = terms[a].predictions.iter().zip(&terms[b].predictions);
        0.5 * pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f64>() <= DISTINCT
    });
    let mut members = vec![Vec::new(); terms.len()];
    for (index, class) in joined.into_iter().enumerate() {
        members[class].push(index);
    }
    members.retain(|class| !class.is_empty());
    let sum = |class: &[usize]| class.iter().map(|index| relative[*index]).sum::<f64>();
    let all: f64 = relative.iter().sum();
    let leading = members.into_iter().max_by(|a, b| sum(a).total_cmp(&sum(b)))?;
    let probability = sum(&leading) / all;
    let least = LISTED * relative[leading[0]];
    Some(Answer {
        listed: leading
            .iter()
            .copied()
            .filter(|index| relative[*index] >= least)
            .collect(),
        class: leading,
        probability,
        log_odds: best + libm::log(all) - without,
        terms,
    })
}
