//! The selection of candidates between the phases: which fit of each is kept, which are fitted next, and their final ranking.

use std::collections::BTreeMap;

use crate::chi_square::FitChiSquare;
use crate::effect_search::class::{classes, log_bayes_factor_deficit};
use crate::effect_search::confirmation;
use crate::effect_search::depth::MIN_SCREENED_SHARE;
use crate::effect_search::extension;
use crate::effect_search::projection::Projection;
use crate::effect_search::ranking::{EffectRanking, EvidenceMethod, RankedEffect};
use crate::effect_search::state::{EffectSearch, EvidenceEstimate, Phase};
use crate::laplace::batch::FitBatch;
use crate::laplace::coordinate::NormalFrame;
use crate::laplace::fit::{FittedModel, LaplaceFit};
use crate::laplace::point::FitPoint;
use crate::probability::{DETECTED, PRIOR_OF_NONE};
use crate::settings::Smoothness;

/// A projected change of the predictions shorter than this many noise standard deviations is invisible.
const MIN_VISIBLE: f64 = 2.0;
/// The log Bayes factor of a fit that is not confirmed counts as at most this much less than the screened one \[nats\].
const MAX_DEFICIT: f64 = 3.0;

/// The changes of the candidates after projection out of those that the base absorbs.
pub(super) struct Projected {
    /// Length of the change by one prior standard deviation of the strength, in standard deviations of the noise.
    lengths: BTreeMap<usize, f64>,
    pub(super) classes: BTreeMap<usize, usize>,
}

impl EffectSearch {
    /// Keeps the most probable fit of each candidate.
    pub(super) fn take(&mut self, batch: FitBatch, method: EvidenceMethod) {
        let Some(base) = &self.base else { return };
        let mut best: Vec<Option<LaplaceFit>> = vec![None; self.candidates.len()];
        for (candidate, fit) in batch.fits {
            let Some(k) = candidate else { continue };
            let better = best[k]
                .as_ref()
                .is_none_or(|best| fit.point.value < best.point.value);
            if better {
                best[k] = Some(fit);
            }
        }
        for (state, fit) in self.candidates.iter_mut().zip(best) {
            let Some(fit) = fit else { continue };
            if let Some(evidence) = fit.log_evidence(&self.likelihood) {
                let log_bayes_factor = evidence - base.log_evidence;
                let gain = fit.stated_gain(&self.likelihood).unwrap_or(0.0);
                state.estimate = Some(EvidenceEstimate {
                    log_bayes_factor,
                    stated_log_bayes_factor: log_bayes_factor + gain,
                    method,
                    fit: Some(fit),
                });
            }
        }
    }

    /// Returns whether the best fit so far contradicts the data.
    pub(super) fn is_wrong(&self) -> bool {
        let best = self.best(1).into_iter().find_map(|k| self.fit_of(k));
        // For a rough model the result decides how thoroughly it is confirmed; a discrepancy, which takes up any misfit, must not
        // count.
        let chi_square_of = match self.base_frame.smoothness {
            Smoothness::Smooth => FitChiSquare::of_fit,
            Smoothness::Rough | Smoothness::Unknown => FitChiSquare::of_declared_noise,
        };
        let chi_square = best.and_then(|fit| chi_square_of(fit, &self.likelihood));
        chi_square.is_some_and(|chi| chi.is_wrong())
    }

    /// Replaces the base's fit by a more probable one, and corrects all Bayes factors.
    pub(super) fn take_base(&mut self, batch: &FitBatch) {
        let fits = batch.fits.iter().filter(|(candidate, _)| candidate.is_none());
        let best = fits
            .map(|(_, fit)| fit)
            .reduce(|a, b| if b.point.value < a.point.value { b } else { a });
        let (Some(fit), Some(base)) = (best, &mut self.base) else {
            return;
        };
        let Some(log_evidence) = fit.log_evidence(&self.likelihood) else {
            return;
        };
        if fit.point.value < base.fit.point.value && log_evidence > base.log_evidence {
            let gain = log_evidence - base.log_evidence;
            *base = FittedModel {
                fit: fit.clone(),
                log_evidence,
            };
            for candidate in &mut self.candidates {
                if let Some(estimate) = &mut candidate.estimate {
                    estimate.log_bayes_factor -= gain;
                    estimate.stated_log_bayes_factor -= gain;
                }
                if let Some(screened) = &mut candidate.screened {
                    screened.log_bayes_factor -= gain;
                }
            }
        }
    }

    /// Returns the candidates with the highest Bayes factors. Until a candidate is confirmed the screen's Bayes factor counts if
    /// it is higher, because its fit may not have converged.
    pub(super) fn best(&self, count: usize) -> Vec<usize> {
        self.promises().into_iter().take(count).map(|(k, _)| k).collect()
    }

    /// Returns the candidates with the highest Bayes factors, without those that the depth of the search leaves out. The best fit is the
    /// measure once there is one: the screen may promise far more than a fit keeps.
    pub(super) fn near_best(&self, count: usize) -> Vec<usize> {
        let mut promises = self.promises();
        let best = self.best_fitted();
        let best = best.or(promises.first().map(|(_, promise)| *promise));
        if let (Some(within), Some(best)) = (self.depth.within, best) {
            promises.retain(|(_, promise)| *promise >= (best - within).min(MIN_SCREENED_SHARE * best));
        }
        promises.into_iter().take(count).map(|(k, _)| k).collect()
    }

    /// Returns the highest log Bayes factor of a fit; `None` before the first.
    fn best_fitted(&self) -> Option<f64> {
        let fitted = (0..self.candidates.len()).filter(|k| self.fit_of(*k).is_some());
        fitted
            .filter_map(|k| self.log_bayes_factor_of(k))
            .reduce(f64::max)
    }

    /// Returns candidates that were only screened and whose log Bayes factor is not far below that of the best fit.
    pub(super) fn within_reach(&self) -> Vec<usize> {
        // Where nothing is detected, what may still be detected is within reach.
        let best = self.best_fitted().unwrap_or(DETECTED).max(DETECTED);
        let Some(share) = self.depth.extension.reach else {
            return Vec::new();
        };
        let promises = self.promises().into_iter();
        let near = promises.filter(|(k, promise)| self.fit_of(*k).is_none() && *promise > share * best);
        near.map(|(k, _)| k).collect()
    }

    /// Candidates to confirm next: those near the best that are not confirmed, and where the base lies at a bound those to which the
    /// screen promises most. Once there are none, those whose fits got stuck (once). Last, with numerical noise, members of the best
    /// candidate's class that fall short of it.
    pub(super) fn unconfirmed(&mut self) -> Vec<usize> {
        let promises = self.promises();
        let (Some(&(_, best)), Some(depth)) = (promises.first(), &self.depth.confirmation) else {
            return Vec::new();
        };
        let confirmed = self.candidates.iter().filter(|state| state.had_confirmation);
        // The rank of fits that contradict the data says little.
        let room = match self.is_wrong() {
            true => usize::MAX,
            false => depth.max_count.saturating_sub(confirmed.count()),
        };
        // A candidate that the model refused from all starts, or that has no evidence, would stay unconfirmed for ever.
        let unconfirmed = |k: usize| {
            let state = &self.candidates[k];
            state.estimate.as_ref().filter(|_| !state.had_confirmation)
        };
        let is_stuck = |k: usize, promise: f64| {
            unconfirmed(k).is_some_and(|estimate| estimate.log_bayes_factor < promise - MAX_DEFICIT)
        };
        let first = |accepts: &dyn Fn(usize, f64) -> bool, min_promise: f64| -> Vec<usize> {
            let above = promises.iter().filter(|(_, promise)| *promise > min_promise);
            let accepted = above.filter(|(k, promise)| accepts(*k, *promise));
            let count = confirmation::COUNT.min(room);
            accepted.map(|(k, _)| *k).take(count).collect()
        };
        let is_pressed = self.is_pressed();
        let within = if is_pressed {
            depth.within_if_pressed
        } else {
            depth.within
        };
        let near = (best - within).max(confirmation::MIN_PROMISE);
        let next = first(&|k, _| unconfirmed(k).is_some(), near);
        if !next.is_empty() {
            return next;
        }
        if is_pressed {
            let leaders = self.leaders_of_screen().into_iter();
            let open = leaders.filter(|k| unconfirmed(*k).is_some());
            let open: Vec<usize> = open.take(room).collect();
            if !open.is_empty() {
                return open;
            }
        }
        let stuck = if std::mem::replace(&mut self.has_confirmed_stuck, true) {
            Vec::new()
        } else {
            first(&is_stuck, confirmation::STUCK * best.max(0.0))
        };
        // With numerical noise fits get stuck more often.
        if !stuck.is_empty() || self.numerical_noise_sds.is_empty() {
            return stuck;
        }
        self.same_class(room)
    }

    /// Whether a parameter of the base lies at a bound of its prior. The base's fit is then a poor start: an effect that takes the
    /// pressure from the bound has its optimum far away.
    pub(super) fn is_pressed(&self) -> bool {
        let is_smooth = self.base_frame.smoothness == Smoothness::Smooth;
        let at_bound = |model: &FittedModel| model.fit.frame.at_bound(&model.fit.point.position);
        is_smooth
            && self
                .base
                .as_ref()
                .is_some_and(|model| at_bound(model).contains(&true))
    }

    /// The candidates to which the screen promises most.
    fn leaders_of_screen(&self) -> Vec<usize> {
        let states = self.candidates.iter().enumerate();
        let screened = states.filter_map(|(k, state)| Some((k, state.screened.as_ref()?.log_bayes_factor)));
        let mut leaders: Vec<(usize, f64)> = screened
            .filter(|(_, promise)| *promise > confirmation::MIN_PROMISE)
            .collect();
        leaders.sort_by(|a, b| b.1.total_cmp(&a.1));
        leaders
            .into_iter()
            .take(confirmation::COUNT)
            .map(|(k, _)| k)
            .collect()
    }

    /// Members of the best candidate's class that fall short of it, once for each of the first few best candidates. Effects that
    /// change the predictions alike fit alike, unless a fit got stuck.
    fn same_class(&mut self, mut room: usize) -> Vec<usize> {
        let promises = self.promises();
        let Some(&(best, nats)) = promises.first() else {
            return Vec::new();
        };
        let had_turn = self.compared_best.len() >= confirmation::COUNT || self.compared_best.contains(&best);
        if had_turn || nats <= DETECTED {
            return Vec::new();
        }
        self.compared_best.push(best);
        let expected = nats - log_bayes_factor_deficit(nats);
        let short = promises.into_iter().filter(|(_, promise)| *promise < expected);
        let short = short.filter(|(k, _)| self.fit_of(*k).is_some() && self.in_place_of_best(*k).is_some());
        let has_room = |k: &usize| {
            let counts = !self.candidates[*k].had_confirmation;
            let has_room = !counts || room > 0;
            room -= usize::from(counts && has_room);
            has_room
        };
        short
            .map(|(k, _)| k)
            .filter(has_room)
            .take(confirmation::COUNT)
            .collect()
    }

    /// Returns a start for a member of the best candidate's class that predicts as the best fit does: the strength gives an equal
    /// change, and the base's parameters absorb the rest. `None` for the best itself, for other classes, without a single
    /// strength, and beyond the limits.
    pub(super) fn in_place_of_best(&self, candidate: usize) -> Option<Vec<f64>> {
        let best = self.best(1).pop().filter(|best| *best != candidate)?;
        let projected = self.projected()?;
        let class = |k: usize| projected.classes.get(&k);
        if class(candidate)? != class(best)? {
            return None;
        }
        let fit = self.fit_of(best)?;
        let (strength_of_best, absent) = fit.frame.strength()?;
        let frame = &self.candidates[candidate].frame;
        let strength = frame.strength()?;
        let screened = self.candidates[candidate].screened.as_ref()?;
        let change_of_best = self.candidates[best].screened.as_ref()?.change.clone();
        let projection = Projection::new(&self.base.as_ref()?.fit, &self.likelihood)?;
        let step = fit.point.position[strength_of_best] - absent;
        let exchange = projection.exchange([screened.change.clone(), change_of_best], step);
        // The change was computed at the screen's shape.
        let mut position = screened.point.position.clone();
        let base = self.base_frame.dimension();
        position[..base].copy_from_slice(&fit.point.position[..base]);
        let position = exchange.applied_to(position, strength);
        frame.holds(&position).then_some(position)
    }

    /// Returns the candidates with their Bayes factors, the highest first.
    fn promises(&self) -> Vec<(usize, f64)> {
        let states = self.candidates.iter().enumerate();
        let mut order: Vec<(usize, f64)> = states
            .filter(|(_, state)| !state.is_refused())
            .filter_map(|(k, state)| {
                let estimate = state.estimate.as_ref()?;
                let screened = state.screened.as_ref().map(|s| s.log_bayes_factor);
                // The screen of the low-fidelity model alone does not count once the model is fitted.
                let is_of_model = state.low_fidelity.is_none() || state.is_screened_on_model;
                let counts = estimate.method < EvidenceMethod::Confirmed && is_of_model;
                let screened = screened.filter(|_| counts);
                let highest = estimate
                    .log_bayes_factor
                    .max(screened.unwrap_or(f64::NEG_INFINITY));
                Some((k, highest))
            })
            .collect();
        order.sort_by(|a, b| b.1.total_cmp(&a.1));
        order
    }

    pub(super) fn projected(&self) -> Option<Projected> {
        let states = self.candidates.iter().enumerate();
        let (indices, changes): (Vec<usize>, Vec<Vec<f64>>) = states
            .filter_map(|(k, state)| Some((k, state.screened.as_ref()?.change.clone())))
            .unzip();
        let products = Projection::new(&self.base.as_ref()?.fit, &self.likelihood)?.products(&changes);
        let lengths = (0..indices.len()).map(|i| products[(i, i)].max(0.0).sqrt());
        let limit_of = |k: &usize| {
            let of = self.candidates[*k].limit_of?;
            indices.iter().position(|index| *index == of)
        };
        let limits: Vec<Option<usize>> = indices.iter().map(limit_of).collect();
        let classes = classes(&products, &limits);
        Some(Projected {
            lengths: indices.iter().copied().zip(lengths).collect(),
            classes: indices.iter().copied().zip(classes).collect(),
        })
    }

    /// Ranks the candidates; the search is done.
    pub(super) fn finish(&mut self) {
        let (Some(base), Some(projected)) = (&self.base, self.projected()) else {
            return;
        };
        let mut effects = vec![self.ranked(None, &self.base_frame, &base.fit.point)];
        let classes = projected.classes.iter();
        effects.extend(classes.filter_map(|(&k, class)| self.ranked_candidate(k, *class, &base.fit)));
        let unseen = projected
            .lengths
            .iter()
            .filter(|(_, length)| **length < MIN_VISIBLE);
        let refused = (0..self.candidates.len()).filter(|k| self.candidates[*k].is_refused());
        let mut ranking = EffectRanking {
            effects,
            cannot_exclude: unseen.map(|(k, _)| *k).collect(),
            refused: refused.collect(),
            evaluations: self.evaluations,
        };
        ranking.weigh(|_| Vec::new(), None, PRIOR_OF_NONE, 1.0);
        self.phase = Phase::Done(Box::new(ranking));
    }

    /// Returns the entry of a model in the ranking, without evidence and probability.
    fn ranked(&self, candidate: Option<usize>, frame: &NormalFrame, point: &FitPoint) -> RankedEffect {
        RankedEffect {
            candidate,
            log_bayes_factor: 0.0,
            stated_log_bayes_factor: 0.0,
            screen_log_bayes_factor: 0.0,
            log_likelihood: point.log_likelihood(frame),
            prior_sds: frame.strength_distance(&point.position),
            method: EvidenceMethod::Confirmed,
            probability: 0.0,
            class: 0,
            is_credible: false,
            theta: frame.theta(&point.position),
            predicted: point.values.clone(),
            at_bound: frame.at_bound(&point.position),
            evaluations: self.evaluations.base,
        }
    }

    /// Returns the entry of a candidate with its evidence; `None` if the model refused it.
    fn ranked_candidate(&self, k: usize, class: usize, base: &LaplaceFit) -> Option<RankedEffect> {
        let state = &self.candidates[k];
        let (estimate, screened) = (state.estimate.as_ref()?, state.screened.as_ref()?);
        if state.is_refused() {
            return None;
        }
        let fitted = estimate.fit.as_ref().map(|fit| &fit.point);
        // A fit that falls far short of the screen's promise, and that is not confirmed, may be stuck.
        let min_factor = if self.depth.confirmation.is_some() && estimate.method < EvidenceMethod::Confirmed {
            screened.log_bayes_factor - MAX_DEFICIT
        } else {
            f64::NEG_INFINITY
        };
        let predicted = fitted.map(|point| point.values.clone()).or_else(|| {
            let depth = &self.depth.extension;
            extension::linearised(&state.frame, base, screened, &self.likelihood, depth)
        });
        Some(RankedEffect {
            predicted: predicted.unwrap_or_default(),
            log_bayes_factor: estimate.log_bayes_factor.max(min_factor),
            stated_log_bayes_factor: estimate.stated_log_bayes_factor.max(min_factor),
            screen_log_bayes_factor: screened.log_bayes_factor,
            method: estimate.method,
            class: class + 1,
            evaluations: state.evaluations,
            ..self.ranked(Some(k), &state.frame, fitted.unwrap_or(&screened.point))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::candidate::Candidate;
    use crate::effect_search::depth::QUICK;
    use crate::settings::SearchSettings;
    use statistics::likelihood::{Datum, ErrorSd, Likelihood};
    use statistics::prior::{Distribution, Marginal, Prior};

    const DATA: usize = 12;

    /// Predictions of a line and of two effects: a square, and twice the square with a part of the line.
    fn predicted(theta: &[f64], effect: Option<usize>) -> Vec<f64> {
        let at = |i: usize| {
            let x = i as f64 / 6.0 - 1.0;
            let change = match effect {
                None => 0.0,
                Some(0) => theta[2] * x * x,
                Some(_) => theta[2] * (2.0 * x * x - 0.5 * x),
            };
            theta[0] + theta[1] * x + change
        };
        (0..DATA).map(at).collect()
    }

    fn searched() -> EffectSearch {
        let normal = || Marginal::new(Distribution::Normal { mean: 0.0, sd: 1.0 }, None).unwrap();
        let candidate = |name: &str| Candidate::new(name, vec![normal()], vec![0]);
        let clean = predicted(&[0.2, -0.4, 0.9], Some(0));
        let datum = |(run, value): (usize, f64)| Datum {
            run,
            channel: 0,
            value,
            sd: ErrorSd::Known(0.05),
        };
        let data = clean.into_iter().enumerate().map(datum).collect();
        let prior = Prior::new(vec![normal(), normal()]);
        let likelihood = Likelihood::new(data).unwrap();
        let candidates = ["one", "other"].map(candidate);
        let mut search =
            EffectSearch::new(&prior, likelihood, &candidates, &SearchSettings::default()).unwrap();
        while search.ranking().is_none() {
            let pending: Vec<_> = search.pending().collect();
            for (index, request) in pending.iter().enumerate() {
                let values = predicted(&request.theta, request.candidate);
                search.tell(index, Some(&values)).unwrap();
            }
        }
        search
    }

    /// Gives a candidate a log Bayes factor by its screen and by its fit.
    fn rate(search: &mut EffectSearch, k: usize, screened: f64, fitted: f64) {
        let state = &mut search.candidates[k];
        state.screened.as_mut().unwrap().log_bayes_factor = screened;
        state.estimate.as_mut().unwrap().log_bayes_factor = fitted;
    }

    #[test]
    fn the_best_fit_is_the_measure_of_who_is_near() {
        let mut search = searched();
        let best = search.best(1)[0];
        search.depth = &QUICK;
        // The screen promises 130 nats of a candidate, and its fit keeps 5.
        for (k, screened, fitted) in [(best, 130.0, 5.0), (1 - best, 20.0, 30.0)] {
            rate(&mut search, k, screened, fitted);
            search.candidates[k].estimate.as_mut().unwrap().method = EvidenceMethod::RankOne;
        }
        assert_eq!(search.near_best(2).len(), 2);
    }

    #[test]
    fn beyond_a_set_a_candidate_far_below_the_best_is_left_out() {
        let mut search = searched();
        let best = search.best(1)[0];
        let mut count = |factors: [f64; 2], depth| {
            search.depth = depth;
            for (k, factor) in [(best, factors[0]), (1 - best, factors[1])] {
                rate(&mut search, k, factor, factor);
            }
            search.near_best(2).len()
        };
        // Far below, within 8 nats, and within a quarter.
        let counts = [[40.0, 9.0], [9.0, 1.5], [40.0, 11.0]].map(|factors| count(factors, &QUICK));
        assert_eq!(counts, [1, 2, 2]);
        let mut every = searched();
        rate(&mut every, 1 - best, -40.0, -40.0);
        assert_eq!(
            every.near_best(2).len(),
            2,
            "the search over the library fits all"
        );
    }

    #[test]
    fn a_start_in_place_of_the_best_predicts_as_the_best_does() {
        let search = searched();
        let best = search.best(1)[0];
        let rival = 1 - best;
        let start = search.in_place_of_best(rival).unwrap();
        let theta = search.candidates[rival].frame.theta(&start);
        let expected = &search.fit_of(best).unwrap().point.values;
        for (value, expected) in predicted(&theta, Some(rival)).iter().zip(expected) {
            assert!((value - expected).abs() < 0.01, "{value} {expected}");
        }
        assert_eq!(search.in_place_of_best(best), None);
    }

    #[test]
    fn what_the_model_refuses_from_all_starts_is_confirmed_once() {
        let mut search = searched();
        let refused = 1 - search.best(1)[0];
        let state = &mut search.candidates[refused];
        state.had_confirmation = false;
        let estimate = state.estimate.as_mut().unwrap();
        (estimate.method, estimate.fit) = (EvidenceMethod::Screen, None);
        search.begin_confirmation(vec![refused]);
        for _ in 0..20 {
            let pending: Vec<_> = search.pending().collect();
            for (index, request) in pending.iter().enumerate() {
                let values = predicted(&request.theta, request.candidate);
                let answer = (request.candidate != Some(refused)).then_some(values.as_slice());
                search.tell(index, answer).unwrap();
            }
        }
        let ranking = search.ranking().unwrap();
        assert_eq!(ranking.refused, [refused]);
        assert!(ranking.effect(Some(refused)).is_none() && ranking.effect(Some(1 - refused)).is_some());
    }

    #[test]
    fn what_changes_alike_and_falls_short_is_confirmed_once_for_each_best() {
        let mut search = searched();
        let best = search.best(1)[0];
        let factor = search.candidates[best]
            .estimate
            .as_ref()
            .unwrap()
            .log_bayes_factor;
        assert_eq!(search.same_class(usize::MAX), []);
        search.compared_best.clear();
        let rival = &mut search.candidates[1 - best];
        rival.screened.as_mut().unwrap().log_bayes_factor = factor / 2.0;
        rival.estimate.as_mut().unwrap().log_bayes_factor = factor / 2.0;
        assert_eq!(search.same_class(usize::MAX), [1 - best]);
        assert_eq!(search.same_class(usize::MAX), []);
    }
}
