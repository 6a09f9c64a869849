//! Phase 5, the confirmation: the best candidates are fitted from several starts, to find other modes.

use std::collections::BTreeMap;

use crate::effect_search::base;
use crate::effect_search::depth::Confirmation;
use crate::effect_search::ranking::EvidenceMethod;
use crate::effect_search::state::{EffectSearch, FitPhase, Phase};
use crate::laplace::batch::{FitBatch, PositionRequest};
use crate::laplace::coordinate::NormalFrame;
use crate::laplace::fit::LaplaceFit;
use crate::laplace::point::FitPoint;

/// Maximum number of candidates that are confirmed at once.
pub(crate) const COUNT: usize = 4;
/// A fit whose log Bayes factor falls short of the screen's has not converged. It is confirmed if the screen's log Bayes factor,
/// which is that of a linear model, exceeds this share of the best one.
pub(crate) const STUCK: f64 = 0.6;
/// A candidate beyond the first few is confirmed only if its log Bayes factor is higher \[nats\].
pub(crate) const MIN_PROMISE: f64 = 0.0;

/// Number of further starts that fill the prior, used where the best fit so far contradicts the data.
const ANYWHERE: usize = 16;

/// Distances of the strength from its neutral value, in standard deviations of its prior.
const ONE_SIDED: [f64; 4] = [0.05, 0.3, 1.0, 2.0];
const TWO_SIDED: [f64; 4] = [0.5, -0.5, 1.5, -1.5];

/// Returns starts at the base's fit with the effect added; a switch has only the base's fit.
fn starts(frame: &NormalFrame, base: &LaplaceFit) -> Vec<Vec<f64>> {
    if frame.is_switch() {
        return vec![base.point.position.clone()];
    }
    let strengths: &[f64] = if frame.is_one_sided() {
        &ONE_SIDED
    } else {
        &TWO_SIDED
    };
    // The shapes take turns, so that each start has another.
    let start = |(n, strength): (usize, &f64)| {
        let mut position = base.point.position.clone();
        position.resize(frame.dimension(), [0.0, 1.0, -1.0][n % 3]);
        for &(k, neutral) in &frame.strengths {
            position[k] = neutral + strength;
        }
        position
    };
    strengths.iter().enumerate().map(start).collect()
}

/// Returns the start with every parameter in the middle of its prior, and the effect one standard deviation from its absence.
fn middle(frame: &NormalFrame) -> Vec<f64> {
    let mut position = vec![0.0; frame.dimension()];
    for &(k, neutral) in &frame.strengths {
        position[k] = neutral + 1.0;
    }
    position
}

impl EffectSearch {
    /// Returns the depth at which a candidate is confirmed now; `None` if nothing is confirmed.
    pub(super) fn confirmation(&self) -> Option<&'static Confirmation> {
        let depth = self.depth.confirmation.as_ref()?;
        Some(if self.is_wrong() {
            &depth.if_wrong
        } else {
            &depth.usual
        })
    }

    /// Evaluates the starts from which candidates are confirmed.
    pub(super) fn begin_confirmation(&mut self, candidates: Vec<usize>) {
        let Some(base) = &self.base else { return };
        // A base that contradicts the data may lie at an end of its prior, and is then a poor start.
        let (is_wrong, is_pressed) = (self.is_wrong(), self.is_pressed());
        let mut requests = Vec::new();
        for &k in &candidates {
            // With numerical noise each fit may stop at another local maximum.
            if !self.numerical_noise_sds.is_empty() {
                let in_place = self.in_place_of_best(k);
                requests.extend(in_place.map(|position| PositionRequest::for_model(Some(k), position)));
            }
            if self.candidates[k].had_confirmation {
                continue;
            }
            let frame = &self.candidates[k].frame;
            requests.extend(PositionRequest::all_for_model(Some(k), starts(frame, &base.fit)));
            if is_wrong {
                let anywhere = base::starts(frame, ANYWHERE);
                requests.extend(PositionRequest::all_for_model(Some(k), anywhere));
            }
            if is_pressed {
                requests.push(PositionRequest::for_model(Some(k), middle(frame)));
            }
            // The base may also improve from the extension's mode: a Bayes factor compares their best fits.
            if let Some(fit) = self.fit_of(k) {
                let position = fit.point.position[..self.base_frame.dimension()].to_vec();
                requests.push(PositionRequest::for_model(None, position));
            }
        }
        if requests.is_empty() {
            return self.finish();
        }
        for &k in &candidates {
            self.candidates[k].had_confirmation = true;
        }
        self.ask(requests);
        self.phase = Phase::ConfirmationStarts(candidates);
    }

    /// Begins fits at the most probable starts, and continues the best fit so far of each candidate.
    pub(super) fn take_confirmation_starts(
        &mut self,
        candidates: Vec<usize>,
        answers: Vec<Option<Vec<f64>>>,
    ) {
        let (Some(base), Some(confirmation)) = (&self.base, self.confirmation()) else {
            return;
        };
        self.evaluations.confirmation += answers.len();
        let mut points: BTreeMap<Option<usize>, Vec<FitPoint>> = BTreeMap::new();
        for (request, values) in std::mem::take(&mut self.requests).into_iter().zip(answers) {
            let frame = self.frame(request.candidate);
            let point = values.and_then(|v| FitPoint::new(frame, &self.likelihood, request.position, v));
            points.entry(request.candidate).or_default().extend(point);
        }
        let mut fits = Vec::new();
        for (candidate, mut points) in points {
            points.sort_by(|a, b| a.value.total_cmp(&b.value));
            points.truncate(confirmation.max_starts);
            let frame = self.frame(candidate);
            let fitted = candidate.map_or(Some(&base.fit), |k| self.fit_of(k));
            let zeros = || vec![vec![0.0; base.fit.point.values.len()]; frame.dimension()];
            let fitted = fitted.filter(|_| confirmation.keeps_jacobian);
            let columns = fitted.map_or_else(zeros, |fit| fit.columns.clone());
            let corrections = fitted.map_or(&[][..], |fit| &fit.corrections);
            for point in points {
                let fit = LaplaceFit::new(frame.clone(), point, columns.clone(), confirmation.plan);
                fits.push((candidate, fit.corrected(corrections)));
            }
        }
        for k in candidates {
            let estimate = self.candidates[k].estimate.as_ref();
            let fitted = estimate.and_then(|estimate| Some((estimate.method, estimate.fit.as_ref()?)));
            fits.extend(fitted.map(|(method, fit)| match method {
                // A confirmed fit takes no further step; the new fits are compared with it.
                EvidenceMethod::Confirmed | EvidenceMethod::Sampled => (Some(k), fit.continued(&[])),
                _ => (Some(k), confirmation.continued(fit)),
            }));
        }
        self.fit(FitPhase::Confirmation, FitBatch::new(fits));
    }

    /// Keeps the confirmed fits. Further candidates are confirmed while any is open; then evidences are sampled.
    pub(super) fn take_confirmation(&mut self, batch: FitBatch) {
        self.evaluations.confirmation += batch.evaluations();
        self.take_base(&batch);
        self.take(batch, EvidenceMethod::Confirmed);
        let open = self.unconfirmed();
        if !open.is_empty() {
            return self.begin_confirmation(open);
        }
        let models = self.samplers();
        self.sample(models);
    }
}
