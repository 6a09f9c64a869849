//! The candidates that are kept, sampled and ranked.

use std::collections::BTreeMap;

use crate::chi_square::FitChiSquare;
use crate::effect_search::class::{Projection, classes};
use crate::effect_search::confirmation;
use crate::effect_search::ranking::{EffectRanking, EvidenceMethod, RankedEffect};
use crate::effect_search::state::{EffectSearch, EvidenceEstimate, Phase};
use crate::laplace::batch::FitBatch;
use crate::laplace::coordinate::NormalFrame;
use crate::laplace::fit::{FittedModel, LaplaceFit};
use crate::laplace::importance::ImportanceSampler;
use crate::laplace::point::FitPoint;

/// A change of the predictions shorter than this many standard deviations, after projection, cannot be seen.
const LEAST_SEEN: f64 = 2.0;
/// Two effects with closer Bayes factors are compared by importance sampling \[nats\].
const CLOSE: f64 = 3.0;
/// Least log Bayes factor of the best effect for which importance sampling is worth its evaluations \[nats\].
const LEAST_CLAIMED: f64 = 2.0;

/// One of the best effects.
struct Best<'a> {
    candidate: usize,
    log_bayes_factor: f64,
    fit: &'a LaplaceFit,
}

/// The effects after projection out of what the base absorbs, by candidate.
struct Projected {
    /// Length of the change by one prior standard deviation of the strength, in standard deviations of the noise.
    lengths: BTreeMap<usize, f64>,
    classes: BTreeMap<usize, usize>,
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
                .is_none_or(|other| fit.point.value < other.point.value);
            if better {
                best[k] = Some(fit);
            }
        }
        for (state, fit) in self.candidates.iter_mut().zip(best) {
            let Some(fit) = fit else { continue };
            if let Some(evidence) = fit.log_evidence(&self.likelihood) {
                state.estimate = Some(EvidenceEstimate {
                    log_bayes_factor: evidence - base.log_evidence,
                    method,
                    fit: Some(fit),
                });
            }
        }
    }

    /// Whether the best fit so far contradicts the data.
    pub(super) fn is_wrong(&self) -> bool {
        let best = self.best(1).into_iter().find_map(|k| self.fit_of(k));
        let chi_square = best.and_then(|fit| FitChiSquare::of(fit, &self.likelihood));
        chi_square.is_some_and(|chi| chi.is_wrong())
    }

    /// Replaces the base's fit by a more probable one, and corrects all Bayes factors.
    pub(super) fn take_base(&mut self, batch: &FitBatch) {
        let of_base = batch.fits.iter().filter(|(candidate, _)| candidate.is_none());
        let best = of_base
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
                let estimate = candidate.estimate.as_mut().map(|e| &mut e.log_bayes_factor);
                let screened = candidate.screened.as_mut().map(|s| &mut s.log_bayes_factor);
                for factor in estimate.into_iter().chain(screened) {
                    *factor -= gain;
                }
            }
        }
    }

    /// The candidates with the highest Bayes factors. Until a candidate is confirmed the screen's Bayes factor counts if it is higher,
    /// because its fit may not have converged.
    pub(super) fn best(&self, count: usize) -> Vec<usize> {
        self.promises().into_iter().take(count).map(|(k, _)| k).collect()
    }

    /// Candidates that are to be confirmed next: those near the best that are not confirmed yet.
    pub(super) fn unconfirmed(&self) -> Vec<usize> {
        let promises = self.promises();
        let Some(&(_, best)) = promises.first() else {
            return Vec::new();
        };
        let least = (best - confirmation::WITHIN).max(confirmation::LEAST_PROMISE);
        let near = promises.into_iter().filter(|(_, promise)| *promise > least);
        let is_open = |k: &usize| {
            let estimate = self.candidates[*k].estimate.as_ref();
            estimate.is_some_and(|estimate| estimate.method < EvidenceMethod::Confirmed)
        };
        near.map(|(k, _)| k)
            .filter(is_open)
            .take(confirmation::COUNT)
            .collect()
    }

    /// The candidates with their Bayes factors, the highest first.
    fn promises(&self) -> Vec<(usize, f64)> {
        let states = self.candidates.iter().enumerate();
        let mut order: Vec<(usize, f64)> = states
            .filter_map(|(k, state)| {
                let estimate = state.estimate.as_ref()?;
                let screened = state.screened.as_ref().map(|s| s.log_bayes_factor);
                let screened = screened.filter(|_| estimate.method < EvidenceMethod::Confirmed);
                let highest = estimate
                    .log_bayes_factor
                    .max(screened.unwrap_or(f64::NEG_INFINITY));
                Some((k, highest))
            })
            .collect();
        order.sort_by(|a, b| b.1.total_cmp(&a.1));
        order
    }

    /// Samplers of the base and the two best effects, where these are close and of different classes, or the best is at a bound.
    pub(super) fn samplers(&self) -> Vec<(Option<usize>, ImportanceSampler)> {
        let none = Vec::new();
        let (Some(base), Some((first, rest))) = (&self.base, self.fits_of_best()) else {
            return none;
        };
        if first.log_bayes_factor < LEAST_CLAIMED {
            return none;
        }
        let classes = self.projected().map(|projected| projected.classes);
        let classes = classes.unwrap_or_default();
        let at_bound = first.fit.frame.at_bound(&first.fit.point.position);
        let is_close = |second: &Best| {
            first.log_bayes_factor - second.log_bayes_factor < CLOSE
                && classes.get(&first.candidate) != classes.get(&second.candidate)
        };
        if !rest.as_ref().is_some_and(is_close) && !at_bound.contains(&true) {
            return none;
        }
        let effects = std::iter::once(first).chain(rest);
        let effects = effects.map(|best| (Some(best.candidate), best.fit));
        std::iter::once((None, &base.fit))
            .chain(effects)
            .filter_map(|(candidate, fit)| Some((candidate, ImportanceSampler::new(fit, &self.likelihood)?)))
            .collect()
    }

    /// The best effect and the second, with their fits.
    fn fits_of_best(&self) -> Option<(Best<'_>, Option<Best<'_>>)> {
        let mut best = self.best(2).into_iter().filter_map(|candidate| {
            let estimate = self.candidates[candidate].estimate.as_ref()?;
            Some(Best {
                candidate,
                log_bayes_factor: estimate.log_bayes_factor,
                fit: estimate.fit.as_ref()?,
            })
        });
        Some((best.next()?, best.next()))
    }

    fn projected(&self) -> Option<Projected> {
        let states = self.candidates.iter().enumerate();
        let (taken, changes): (Vec<usize>, Vec<Vec<f64>>) = states
            .filter_map(|(k, state)| Some((k, state.screened.as_ref()?.change.clone())))
            .unzip();
        let products = Projection::new(&self.base.as_ref()?.fit, &self.likelihood)?.products(&changes);
        let lengths = (0..taken.len()).map(|i| products[(i, i)].max(0.0).sqrt());
        Some(Projected {
            lengths: taken.iter().copied().zip(lengths).collect(),
            classes: taken.iter().copied().zip(classes(&products)).collect(),
        })
    }

    /// Takes the evidence of the sampled effects, where the base was sampled too.
    pub(super) fn take_sampled(&mut self, models: &[(Option<usize>, ImportanceSampler)]) {
        let of_base = models.iter().find(|(candidate, _)| candidate.is_none());
        let Some(base) = of_base.and_then(|(_, model)| model.log_evidence()) else {
            return;
        };
        for (candidate, model) in models {
            let estimate = candidate.and_then(|k| self.candidates[k].estimate.as_mut());
            if let (Some(estimate), Some(evidence)) = (estimate, model.log_evidence()) {
                estimate.log_bayes_factor = evidence - base;
                estimate.method = EvidenceMethod::Sampled;
            }
        }
    }

    /// Ranks the candidates; the search is done.
    pub(super) fn finish(&mut self) {
        let (Some(base), Some(projected)) = (&self.base, self.projected()) else {
            return;
        };
        let ranked = |candidate, frame: &NormalFrame, point: &FitPoint| RankedEffect {
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
            at_bound: frame.at_bound(&point.position),
            evaluations: self.evaluations.base,
        };
        let mut effects = vec![ranked(None, &self.base_frame, &base.fit.point)];
        for (&k, class) in &projected.classes {
            let state = &self.candidates[k];
            let (Some(estimate), Some(screened)) = (&state.estimate, &state.screened) else {
                continue;
            };
            let point = estimate.fit.as_ref().map_or(&screened.point, |fit| &fit.point);
            let gain = estimate
                .fit
                .as_ref()
                .and_then(|fit| fit.stated_gain(&self.likelihood));
            effects.push(RankedEffect {
                log_bayes_factor: estimate.log_bayes_factor,
                stated_log_bayes_factor: estimate.log_bayes_factor + gain.unwrap_or(0.0),
                screen_log_bayes_factor: screened.log_bayes_factor,
                method: estimate.method,
                class: class + 1,
                evaluations: state.evaluations,
                ..ranked(Some(k), &state.frame, point)
            });
        }
        let unseen = projected
            .lengths
            .iter()
            .filter(|(_, length)| **length < LEAST_SEEN);
        let refused = (0..self.candidates.len()).filter(|k| self.candidates[*k].screened.is_none());
        let mut ranking = EffectRanking {
            effects,
            cannot_exclude: unseen.map(|(k, _)| *k).collect(),
            refused: refused.collect(),
            evaluations: self.evaluations,
        };
        ranking.weigh(|_| Vec::new(), None, 1.0);
        self.phase = Phase::Done(Box::new(ranking));
    }
}
