//! Keep the best of what was fitted, choose what deserves more, and judge in the end.

use std::collections::BTreeMap;

use crate::chi_square::{ChiSquare, WRONG};
use crate::classes::classes;
use crate::descent::Descent;
use crate::engine::{Engine, Judgement, Phase};
use crate::finding::{Finding, Judged, Method};
use crate::fleet::Fleet;
use crate::importance::Importance;
use crate::screen::Absorbed;

/// A change of the predictions shorter than this many standard deviations, after projection, cannot be seen.
const LEAST_SEEN: f64 = 2.0;
/// Two effects whose Bayes factors are closer than this are told apart by draws \[nats\].
const CLOSE: f64 = 3.0;
/// Below this log Bayes factor nothing can be claimed, however the draws turn out \[nats\].
const LEAST_CLAIMED: f64 = 2.0;

/// One of the best effects.
struct Best<'a> {
    candidate: usize,
    log_bayes_factor: f64,
    fitted: &'a Descent,
}

/// What the base leaves of each effect of one standard deviation, by candidate.
struct Alike {
    /// In standard deviations of the noise, all data together.
    lengths: BTreeMap<usize, f64>,
    classes: BTreeMap<usize, usize>,
}

impl Engine {
    /// Keeps of each candidate the most probable of its fits.
    pub(crate) fn take(&mut self, fleet: Fleet, method: Method) {
        let Some((_, base)) = &self.base else { return };
        let mut best: Vec<Option<Descent>> = vec![None; self.candidates.len()];
        for (candidate, descent) in fleet.descents {
            let Some(k) = candidate else { continue };
            let better = best[k]
                .as_ref()
                .is_none_or(|other| descent.point.value < other.point.value);
            if better {
                best[k] = Some(descent);
            }
        }
        for (k, fitted) in best.into_iter().enumerate() {
            let Some(fitted) = fitted else { continue };
            if let Some(evidence) = fitted.log_evidence(&self.likelihood) {
                self.judgements[k] = Some(Judgement {
                    log_bayes_factor: evidence - base,
                    method,
                    fitted: Some(fitted),
                });
            }
        }
    }

    /// Whether the best fit so far leaves misfit that chance does not explain.
    pub(crate) fn leaves_misfit(&self) -> bool {
        let best = self.best(1).into_iter().find_map(|k| self.fit_of(k));
        let chi_square = best.and_then(|fit| ChiSquare::of(fit, &self.likelihood));
        chi_square.is_some_and(|chi| chi.p() < WRONG)
    }

    /// Replaces the base's fit by a more probable one, and weighs all that was fitted against it.
    pub(crate) fn take_base(&mut self, fleet: &Fleet) {
        let of_base = fleet.descents.iter().filter(|(candidate, _)| candidate.is_none());
        let best = of_base
            .map(|(_, descent)| descent)
            .reduce(|a, b| if b.point.value < a.point.value { b } else { a });
        let (Some(found), Some((base, evidence))) = (best, &mut self.base) else {
            return;
        };
        let Some(own) = found.log_evidence(&self.likelihood) else {
            return;
        };
        if found.point.value < base.point.value && own > *evidence {
            let gain = own - *evidence;
            (*base, *evidence) = (found.clone(), own);
            for judgement in self.judgements.iter_mut().flatten() {
                judgement.log_bayes_factor -= gain;
            }
        }
    }

    /// The candidates with the highest Bayes factors; where fits have learnt their derivatives only from their own steps, what the
    /// screen promised counts if it is more: such a fit may have stuck.
    pub(crate) fn best(&self, count: usize) -> Vec<usize> {
        let promise = |k: usize| {
            let judgement = self.judgements[k].as_ref()?;
            let screened = self.screened[k].as_ref().map(|s| s.log_bayes_factor);
            let promised = screened.filter(|_| judgement.method <= Method::RankOne);
            Some(
                judgement
                    .log_bayes_factor
                    .max(promised.unwrap_or(f64::NEG_INFINITY)),
            )
        };
        let known = (0..self.candidates.len()).filter_map(|k| Some((k, promise(k)?)));
        let mut order: Vec<(usize, f64)> = known.collect();
        order.sort_by(|a, b| b.1.total_cmp(&a.1));
        order.into_iter().take(count).map(|(k, _)| k).collect()
    }

    /// The base and the two best effects, where these are close to each other and not of one class, or the best is at a bound.
    pub(crate) fn to_be_sampled(&self) -> Vec<(Option<usize>, Importance)> {
        let none = Vec::new();
        let (Some((base, _)), Some((first, rest))) = (&self.base, self.fits_of_best()) else {
            return none;
        };
        if first.log_bayes_factor < LEAST_CLAIMED {
            return none;
        }
        let classes = self.alike().map(|alike| alike.classes).unwrap_or_default();
        let at_bound = first.fitted.frame.at_bound(&first.fitted.point.position);
        let is_open = |second: &Best| {
            first.log_bayes_factor - second.log_bayes_factor < CLOSE
                && classes.get(&first.candidate) != classes.get(&second.candidate)
        };
        if !rest.as_ref().is_some_and(is_open) && !at_bound.contains(&true) {
            return none;
        }
        let effects = std::iter::once(first).chain(rest);
        let effects = effects.map(|best| (Some(best.candidate), best.fitted));
        std::iter::once((None, base))
            .chain(effects)
            .filter_map(|(candidate, fitted)| Some((candidate, Importance::new(fitted, &self.likelihood)?)))
            .collect()
    }

    /// The best effect and the one behind it, with their fits.
    fn fits_of_best(&self) -> Option<(Best<'_>, Option<Best<'_>>)> {
        let mut best = self.best(2).into_iter().filter_map(|candidate| {
            let judgement = self.judgements[candidate].as_ref()?;
            Some(Best {
                candidate,
                log_bayes_factor: judgement.log_bayes_factor,
                fitted: judgement.fitted.as_ref()?,
            })
        });
        Some((best.next()?, best.next()))
    }

    /// What the effects have in common, after projection.
    fn alike(&self) -> Option<Alike> {
        let (base, _) = self.base.as_ref()?;
        let screened = self.screened.iter().enumerate();
        let (taken, changes): (Vec<usize>, Vec<Vec<f64>>) = screened
            .filter_map(|(k, screened)| Some((k, screened.as_ref()?.change.clone())))
            .unzip();
        let products = Absorbed::new(base, &self.likelihood)?.products(&changes);
        let lengths = (0..taken.len()).map(|i| products[(i, i)].max(0.0).sqrt());
        Some(Alike {
            lengths: taken.iter().copied().zip(lengths).collect(),
            classes: taken.iter().copied().zip(classes(&products)).collect(),
        })
    }

    /// Replaces the Bayes factors of the effects whose evidence and whose base's was had by draws.
    pub(crate) fn take_sampled(&mut self, models: &[(Option<usize>, Importance)]) {
        let of_base = models.iter().find(|(candidate, _)| candidate.is_none());
        let Some(base) = of_base.and_then(|(_, model)| model.log_evidence()) else {
            return;
        };
        for (candidate, model) in models {
            let judgement = candidate.and_then(|k| self.judgements[k].as_mut());
            if let (Some(judgement), Some(evidence)) = (judgement, model.log_evidence()) {
                judgement.log_bayes_factor = evidence - base;
                judgement.method = Method::Sampled;
            }
        }
    }

    pub(crate) fn finish(&mut self) {
        let (Some((base, _)), Some(alike)) = (&self.base, self.alike()) else {
            return;
        };
        let mut judged = vec![Judged {
            candidate: None,
            log_bayes_factor: 0.0,
            screen_log_bayes_factor: 0.0,
            log_likelihood: base.point.log_likelihood(),
            method: Method::Confirmed,
            probability: 0.0,
            class: 0,
            theta: self.base_frame.theta(&base.point.position),
            at_bound: self.base_frame.at_bound(&base.point.position),
            evaluations: self.spent.base,
        }];
        for (&k, class) in &alike.classes {
            let (Some(judgement), Some(screened)) = (&self.judgements[k], &self.screened[k]) else {
                continue;
            };
            let fitted = judgement.fitted.as_ref();
            let point = fitted.map_or(&screened.point, |f| &f.point);
            judged.push(Judged {
                candidate: Some(k),
                log_bayes_factor: judgement.log_bayes_factor,
                screen_log_bayes_factor: screened.log_bayes_factor,
                log_likelihood: point.log_likelihood(),
                method: judgement.method,
                probability: 0.0,
                class: class + 1,
                theta: self.frames[k].theta(&point.position),
                at_bound: self.frames[k].at_bound(&point.position),
                evaluations: self.own[k],
            });
        }
        let unseen = alike.lengths.iter().filter(|(_, length)| **length < LEAST_SEEN);
        let refused = (0..self.candidates.len()).filter(|k| self.screened[*k].is_none());
        let finding = Finding {
            judged,
            credible_set: Vec::new(),
            cannot_exclude: unseen.map(|(k, _)| *k).collect(),
            refused: refused.collect(),
            spent: self.spent,
        };
        self.phase = Phase::Done(Box::new(finding.weigh()));
    }
}
