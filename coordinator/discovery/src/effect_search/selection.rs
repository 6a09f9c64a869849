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
const LEAST_CLAIMED: f64 = 1.0;
/// Beyond this log Bayes factor the posterior of a strength excludes its absence \[nats\].
const CERTAINLY_PRESENT: f64 = 10.0;
/// A fit that is not confirmed counts at most so much less than the screen promises \[nats\].
const MOST_SHORT: f64 = 3.0;
/// Most effects that are sampled, which bounds the cost where many lead in turn.
const MOST_SAMPLED: usize = 3;
/// A strength within so many standard deviations of its prior from where the effect is absent lies where the prior is not normal.
const NEARLY_ABSENT: f64 = 0.1;

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

    /// Samplers of the base and the best effect, where Laplace's approximation is doubtful: a parameter of either is at a bound, or the
    /// effect is nearly absent; and of the second effect where it is close and of another class. None of what was sampled before.
    pub(super) fn samplers(&self) -> Vec<(Option<usize>, ImportanceSampler)> {
        let none = Vec::new();
        let (Some(base), Some((first, rest))) = (&self.base, self.fits_of_best()) else {
            return none;
        };
        if first.log_bayes_factor < LEAST_CLAIMED || self.sampled.len() > MOST_SAMPLED {
            return none;
        }
        let classes = self.projected().map(|projected| projected.classes);
        let classes = classes.unwrap_or_default();
        let is_close = |second: &Best| {
            first.log_bayes_factor - second.log_bayes_factor < CLOSE
                && classes.get(&first.candidate) != classes.get(&second.candidate)
        };
        let second = rest.filter(is_close);
        let is_at_bound = |fit: &LaplaceFit| fit.frame.at_bound(&fit.point.position).contains(&true);
        let position = &first.fit.point.position;
        let strength = first.fit.frame.strength();
        let is_nearly_absent =
            strength.is_some_and(|(k, neutral)| (position[k] - neutral).abs() < NEARLY_ABSENT);
        if second.is_none() && !is_nearly_absent && !is_at_bound(&base.fit) && !is_at_bound(first.fit) {
            return none;
        }
        let of_base = || Some((None, ImportanceSampler::new(&base.fit, &self.likelihood)?));
        let of_effect = |best: Best| {
            let sampler = ImportanceSampler::new(best.fit, &self.likelihood)?;
            let may_be_absent = best.log_bayes_factor < CERTAINLY_PRESENT;
            let sampler = if may_be_absent {
                sampler.or_absent(&base.fit, &self.likelihood)
            } else {
                sampler
            };
            Some((Some(best.candidate), sampler))
        };
        let effects = std::iter::once(first).chain(second).filter_map(of_effect);
        of_base()
            .into_iter()
            .chain(effects)
            .filter(|(candidate, _)| !self.sampled.contains_key(candidate))
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

    /// Takes the evidence of the sampled effects over the sampled base. Other factors keep Laplace's approximation of both, whose errors at
    /// a common bound cancel.
    pub(super) fn take_sampled(&mut self, models: &[(Option<usize>, ImportanceSampler)]) {
        let evidences = models
            .iter()
            .map(|(candidate, model)| (*candidate, model.log_evidence()));
        self.sampled.extend(evidences);
        let Some(base) = self.sampled.get(&None).copied().flatten() else {
            return;
        };
        for (candidate, model) in models {
            let estimate = candidate.and_then(|k| self.candidates[k].estimate.as_mut());
            if let (Some(estimate), Some(evidence)) = (estimate, model.log_evidence()) {
                estimate.log_bayes_factor = evidence - base;
                estimate.stated_log_bayes_factor = estimate.log_bayes_factor + model.stated_gain();
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
            // A fit that falls far short of the screen's promise, and that is not confirmed, may be stuck.
            let least = if self.depth.confirms && estimate.method < EvidenceMethod::Confirmed {
                screened.log_bayes_factor - MOST_SHORT
            } else {
                f64::NEG_INFINITY
            };
            effects.push(RankedEffect {
                log_bayes_factor: estimate.log_bayes_factor.max(least),
                stated_log_bayes_factor: estimate.stated_log_bayes_factor.max(least),
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
