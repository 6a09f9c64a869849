//! The search of the term that a system lacks.

use super::super::dynamic_system::State;
use super::answer::{Answer, WeighedTerm, answer};
use super::measured::POINTS;
use super::problem::{HORIZONS, Problem, Refined};
use super::screening::screened;
use super::term_formula::TermLibrary;

/// Formulas that are fitted to the weak form, the best by each screening.
const SCREENED: usize = 100;
/// Formulas that are fitted through the equations of motion, the best by the weak form, and how many where none of these fits.
const FITTED: [usize; 2] = [30, 100];
/// Searches one after the other, each on the states that the one before predicts.
const CYCLES: usize = 2;

impl<'a> Problem<'a> {
    /// Returns the formulas that fit the weak form best, the best first, screened about a place and about that of the best formula.
    fn candidates(
        &'a self,
        library: &TermLibrary,
        states: &[State],
        mut place: Vec<f64>,
    ) -> Vec<Refined<'a>> {
        let model = self.hypothesis(self.removed, None);
        let mut refined: Vec<Refined<'a>> = Vec::new();
        for _ in 0..2 {
            let screened = screened(
                &self.form,
                states,
                &self.support,
                &model,
                &place,
                library,
                SCREENED,
            );
            for candidate in screened {
                let term = (candidate.equation, candidate.formula);
                if refined.iter().all(|r| r.hypothesis.term.as_ref() != Some(&term)) {
                    let log_prior = library.log_prior(term.1.size());
                    let hypothesis = self.hypothesis(self.removed, Some(term));
                    let begin = place.iter().chain(&candidate.begin).copied().collect();
                    refined.extend(self.refined(hypothesis, begin, states, log_prior));
                }
            }
            refined.sort_by(|a, b| b.weight.total_cmp(&a.weight));
            if let Some(best) = refined.first() {
                place = best.place[..place.len()].to_vec();
            }
        }
        refined
    }

    /// Searches the term; `None` if no formula has a fit.
    ///
    /// The weak form has smooth states at first, and then those that the best formula predicts, which are more exact.
    pub fn search(&'a self, library: &TermLibrary) -> Option<Answer<'a>> {
        let dimension = self.system.dimension();
        let enough = (2 * POINTS * dimension) as f64;
        let mut place: Vec<f64> = self.parameters.iter().map(|c| c.mean).collect();
        let mut states = self.support.points.clone();
        let mut terms: Vec<WeighedTerm<'a>> = Vec::new();
        for _ in 0..CYCLES {
            let refined = self.candidates(library, &states, place.clone());
            for (horizons, count) in HORIZONS.into_iter().zip(FITTED) {
                let weighed = refined
                    .iter()
                    .take(count)
                    .filter_map(|r| self.weighed(&r.hypothesis, &r.place, r.log_prior, horizons));
                for term in weighed {
                    match terms
                        .iter_mut()
                        .find(|t| t.hypothesis.term == term.hypothesis.term)
                    {
                        Some(before) if before.weight < term.weight => *before = term,
                        Some(_) => {}
                        None => terms.push(term),
                    }
                }
                terms.sort_by(|a, b| b.weight.total_cmp(&a.weight));
                if terms.first().is_some_and(|best| best.misfit < enough) {
                    break;
                }
            }
            let best = terms.first().filter(|best| best.misfit < enough);
            let Some(best) = best else { break };
            place = best.place[..place.len()].to_vec();
            for (k, predicted) in best.predictions.chunks(dimension).enumerate() {
                let state = &mut states[k + 1 + k / POINTS];
                (0..dimension).for_each(|i| state[i] = predicted[i] * self.measured.sds[i]);
            }
        }
        let without = self
            .without(self.removed, None)
            .map_or(f64::NEG_INFINITY, |w| w.weight);
        answer(terms, without)
    }
}
