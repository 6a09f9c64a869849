//! The phases of a search for one effect, in their order; the module's page describes them.

use std::collections::BTreeMap;

use crate::effect_search::depth::Confirmation;
use crate::effect_search::ranking::EvidenceMethod;
use crate::effect_search::screen::{self, Evaluated, LEVELS};
use crate::effect_search::state::{EffectSearch, Phase};
use crate::effect_search::{base, confirmation, extension, numerical_noise};
use crate::laplace::batch::{Asked, FitBatch};
use crate::laplace::fit::{FitStep, FittedModel, LaplaceFit};
use crate::laplace::importance::ImportanceSampler;
use crate::laplace::point::FitPoint;
use crate::laplace::reduced_discrepancy::reduced_discrepancy;
use crate::settings::Smoothness;
use inference::InferenceFailure;
use statistics::likelihood::Likelihood;

impl EffectSearch {
    /// Asks for the next evaluations of a batch; returns the batch once it is complete.
    fn next_round(&mut self, mut batch: FitBatch, phase: fn(FitBatch) -> Phase) -> Option<FitBatch> {
        let asked = batch.ask(&self.likelihood);
        if asked.is_empty() {
            return Some(batch);
        }
        self.ask(asked);
        self.phase = phase(batch);
        None
    }

    /// Takes the answers of a round and begins the next.
    pub(super) fn advance(&mut self, answers: Vec<Option<Vec<f64>>>) {
        match std::mem::replace(&mut self.phase, Phase::BaseStarts) {
            Phase::BaseStarts => self.take_base_starts(answers),
            Phase::Base(mut batch) => {
                batch.tell(&self.likelihood, answers);
                self.fit_base(batch);
            }
            Phase::NumericalNoise(batch, spacing) => self.take_noise(batch, spacing, &answers),
            Phase::LowFidelityScreen => self.take_low_fidelity_screen(answers),
            Phase::Screen(level) => self.take_screen(level, answers),
            Phase::ReducedDiscrepancy(likelihood, mut batch) => {
                batch.tell(&likelihood, answers);
                self.fit_reduced_discrepancy(likelihood, batch);
            }
            Phase::Extensions(mut batch) => {
                batch.tell(&self.likelihood, answers);
                self.fit_extensions(batch);
            }
            Phase::WithinReach(mut batch) => {
                batch.tell(&self.likelihood, answers);
                self.fit_within_reach(batch);
            }
            Phase::Refinement(mut batch) => {
                batch.tell(&self.likelihood, answers);
                self.refine(batch);
            }
            Phase::ConfirmationStarts(candidates) => self.take_confirmation_starts(candidates, answers),
            Phase::Confirmation(mut batch) => {
                batch.tell(&self.likelihood, answers);
                self.confirm(batch);
            }
            Phase::Sampling(models, counts) => self.take_sample(models, &counts, answers),
            over @ (Phase::Done(_) | Phase::Failed(_)) => self.phase = over,
        }
    }

    /// Begins fits of the base at the most probable of its starts.
    fn take_base_starts(&mut self, answers: Vec<Option<Vec<f64>>>) {
        let positions = std::mem::take(&mut self.asked)
            .into_iter()
            .map(|asked| asked.position);
        let draws = answers.len();
        self.evaluations.base += draws;
        let evaluated = positions.zip(answers).collect();
        let plan = if self.measures_noise {
            self.depth.base.plan
        } else {
            &base::PLAN
        };
        let fits = base::fits(&self.base_frame, &self.likelihood, plan, evaluated);
        if fits.is_empty() {
            self.phase = Phase::Failed(InferenceFailure::AllImpossible { draws });
        } else {
            self.fit_base(FitBatch::new(fits.into_iter().map(|fit| (None, fit)).collect()));
        }
    }

    /// Continues the fits of the base. Once they are complete the numerical noise is measured, the first time, and the screen begins.
    fn fit_base(&mut self, batch: FitBatch) {
        let Some(batch) = self.next_round(batch, Phase::Base) else {
            return;
        };
        if std::mem::take(&mut self.measures_noise) {
            return self.measure_noise(batch, numerical_noise::SPACING);
        }
        self.evaluations.base += batch.evaluations();
        self.base = batch.best().cloned().and_then(|fit| {
            Some(FittedModel {
                log_evidence: fit.log_evidence(&self.likelihood)?,
                fit,
            })
        });
        self.screen_low_fidelity();
    }

    /// Evaluates the base along a line through its best fit.
    fn measure_noise(&mut self, batch: FitBatch, spacing: f64) {
        let Some(best) = batch.best() else { return };
        let asked = numerical_noise::positions(&best.point.position, spacing);
        self.ask(Asked::all_for_model(None, asked).collect());
        self.phase = Phase::NumericalNoise(batch, spacing);
    }

    /// Adds the numerical noise to that of the data, and fits the base again where it matters.
    fn take_noise(&mut self, batch: FitBatch, spacing: f64, answers: &[Option<Vec<f64>>]) {
        self.evaluations.base += answers.len();
        let shorter = numerical_noise::spacings().find(|candidate| *candidate < spacing);
        if let Some(shorter) = shorter.filter(|_| !numerical_noise::are_enough(answers)) {
            return self.measure_noise(batch, shorter);
        }
        self.evaluations.base += batch.evaluations();
        if self.base_frame.smoothness == Smoothness::Unknown {
            let mut best = batch.best().into_iter();
            let is_smooth =
                best.any(|fit| numerical_noise::is_negligible(&self.likelihood, answers, &fit.theta()));
            self.set_smoothness(if is_smooth {
                Smoothness::Smooth
            } else {
                Smoothness::Rough
            });
        }
        self.continue_base(batch, answers);
    }

    /// Continues the best fits of the base, with the numerical noise where it is not negligible.
    ///
    /// # Arguments
    /// - `answers`: the predictions along the line of [`measure_noise`](Self::measure_noise).
    fn continue_base(&mut self, batch: FitBatch, answers: &[Option<Vec<f64>>]) {
        let max_count = self.depth.base.max_continued;
        // Fits of which only the best continue were preliminary.
        let mut plan: &[FitStep] = if max_count == usize::MAX { &[] } else { &base::PLAN };
        if let Some(sds) = numerical_noise::sds(&self.likelihood, answers)
            && let Ok(likelihood) = self.likelihood.with_numerical_noise(&sds)
        {
            self.numerical_noise_sds = sds;
            self.likelihood = likelihood;
            plan = &base::PLAN;
        }
        let fits = batch.fits.into_iter().filter_map(|(_, fit)| {
            let FitPoint { position, values, .. } = fit.point;
            let frame = self.base_frame.clone();
            let point = FitPoint::new(&frame, &self.likelihood, position, values)?;
            Some((None, LaplaceFit::new(frame, point, fit.columns, plan)))
        });
        let mut fits: Vec<(Option<usize>, LaplaceFit)> = fits.collect();
        if fits.len() > max_count {
            fits.sort_by(|(_, a), (_, b)| a.point.value.total_cmp(&b.point.value));
            fits.truncate(max_count);
        }
        self.fit_base(FitBatch::new(fits));
    }

    /// Evaluates candidates at the strengths of a level.
    pub(super) fn screen(&mut self, level: usize, candidates: Vec<usize>) {
        let Some(base) = &self.base else { return };
        let mut asked = Vec::new();
        for &k in &candidates {
            let frame = &self.candidates[k].frame;
            let base = &base.fit.point.position;
            let positions = screen::positions(frame, base, &self.depth.screen, self.best_shape(k), level);
            asked.extend(Asked::all_for_model(Some(k), positions));
        }
        if asked.is_empty() && level + 1 < LEVELS.len() {
            return self.screen(level + 1, candidates);
        }
        if asked.is_empty() {
            return self.begin_extensions();
        }
        self.ask(asked);
        self.phase = Phase::Screen(level);
    }

    /// Keeps the results of a level; candidates that the model refused at it are screened at the next.
    fn take_screen(&mut self, level: usize, answers: Vec<Option<Vec<f64>>>) {
        let Some(base) = &self.base else { return };
        self.evaluations.screen += answers.len();
        let mut evaluated: Vec<Vec<Evaluated>> = vec![Vec::new(); self.candidates.len()];
        for (asked, values) in std::mem::take(&mut self.asked).into_iter().zip(answers) {
            if let Some(k) = asked.candidate {
                evaluated[k].push((asked.position, values));
            }
        }
        let mut refused = Vec::new();
        for (k, (state, evaluated)) in self.candidates.iter_mut().zip(evaluated).enumerate() {
            if evaluated.is_empty() {
                continue;
            }
            let screened = screen::screened(&state.frame, base, &self.likelihood, &evaluated);
            state.take_screened(screened, base.fit.point.position.len());
            if state.screened.is_none() {
                refused.push(k);
            }
        }
        if level + 1 < LEVELS.len() && !refused.is_empty() {
            self.screen(level + 1, refused);
        } else {
            self.begin_extensions();
        }
    }

    /// Fits the best candidates of the screen, each with the base. Those that only the low-fidelity model has screened are screened on
    /// the model first.
    fn begin_extensions(&mut self) {
        let best = self.best(self.depth.extension.max_count).into_iter();
        let (awaiting, candidates): (Vec<usize>, Vec<usize>) = best
            .filter(|k| self.fit_of(*k).is_none())
            .partition(|k| self.awaits_model(*k));
        if !awaiting.is_empty() {
            return self.screen(0, awaiting);
        }
        // The evaluations of a rough model are too expensive for fitting twice.
        let is_smooth = self.base_frame.smoothness == Smoothness::Smooth;
        let base = self.base.as_ref().filter(|_| is_smooth);
        match base.and_then(|base| reduced_discrepancy(&self.likelihood, &base.fit)) {
            Some(reduced) => {
                let fits = self.extension_fits(candidates, &reduced);
                self.fit_reduced_discrepancy(reduced, FitBatch::new(fits));
            }
            None => {
                let fits = self.extension_fits(candidates, &self.likelihood);
                self.fit_extensions(FitBatch::new(fits));
            }
        }
    }

    /// Fits with a reduced discrepancy; the fits with the whole of it begin at the screen's points and, once more, at these modes.
    fn fit_reduced_discrepancy(&mut self, reduced: Likelihood, mut batch: FitBatch) {
        let asked = batch.ask(&reduced);
        if !asked.is_empty() {
            self.ask(asked);
            self.phase = Phase::ReducedDiscrepancy(reduced, batch);
            return;
        }
        self.evaluations.extension += batch.evaluations();
        let best = self.best(self.depth.extension.max_count);
        let mut fits = self.extension_fits(best, &self.likelihood);
        fits.extend(batch.fits.into_iter().filter_map(|(candidate, fit)| {
            let FitPoint { position, values, .. } = fit.point;
            let point = FitPoint::new(&fit.frame, &self.likelihood, position, values)?;
            let plan = self.depth.extension.plan;
            Some((candidate, LaplaceFit::new(fit.frame, point, fit.columns, plan)))
        }));
        self.fit_extensions(FitBatch::new(fits));
    }

    /// Fits of candidates that begin at the screen's results.
    fn extension_fits(
        &self,
        candidates: Vec<usize>,
        likelihood: &Likelihood,
    ) -> Vec<(Option<usize>, LaplaceFit)> {
        let fits = candidates.into_iter().filter_map(|k| {
            let base = &self.base.as_ref()?.fit;
            let state = &self.candidates[k];
            let screened = state.screened.as_ref()?;
            let fit = extension::fit(&state.frame, base, screened, likelihood, &self.depth.extension)?;
            Some((Some(k), fit))
        });
        fits.collect()
    }

    /// Continues the fits of the best candidates. Once they are complete, candidates within reach of the best are fitted too.
    fn fit_extensions(&mut self, batch: FitBatch) {
        let Some(batch) = self.next_round(batch, Phase::Extensions) else {
            return;
        };
        self.evaluations.extension += batch.evaluations();
        self.take(batch, EvidenceMethod::RankOne);
        let near = self.within_reach();
        let awaiting: Vec<usize> = near.iter().copied().filter(|k| self.awaits_model(*k)).collect();
        if !awaiting.is_empty() {
            return self.screen(0, awaiting);
        }
        let fits = self.extension_fits(near, &self.likelihood);
        self.fit_within_reach(FitBatch::new(fits));
    }

    /// Continues the fits of the candidates within reach; the best of all are refined next.
    fn fit_within_reach(&mut self, batch: FitBatch) {
        let Some(batch) = self.next_round(batch, Phase::WithinReach) else {
            return;
        };
        self.evaluations.extension += batch.evaluations();
        self.take(batch, EvidenceMethod::RankOne);
        let depth = &self.depth.refinement;
        let fits = self
            .best(depth.max_count)
            .into_iter()
            .filter_map(|k| Some((Some(k), self.fit_of(k)?.continued(depth.plan))));
        let batch = FitBatch::new(fits.collect());
        self.refine(batch);
    }

    /// Fits the best candidates again with new derivatives.
    fn refine(&mut self, batch: FitBatch) {
        let Some(batch) = self.next_round(batch, Phase::Refinement) else {
            return;
        };
        self.evaluations.refinement += batch.evaluations();
        self.take(batch, EvidenceMethod::Refined);
        let Some(confirmation) = self.confirmation() else {
            return self.finish();
        };
        let best = self.best(confirmation.min_count);
        self.begin_confirmation(best);
    }

    /// How a candidate is confirmed now; `None` if nothing is confirmed.
    fn confirmation(&self) -> Option<&'static Confirmation> {
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
        let is_wrong = self.is_wrong();
        let mut asked = Vec::new();
        for &k in &candidates {
            // With numerical noise each fit may stop at another local maximum.
            if !self.numerical_noise_sds.is_empty() {
                let in_place = self.in_place_of_best(k);
                asked.extend(in_place.map(|position| Asked::for_model(Some(k), position)));
            }
            if self.candidates[k].had_confirmation {
                continue;
            }
            let frame = &self.candidates[k].frame;
            asked.extend(Asked::all_for_model(
                Some(k),
                confirmation::starts(frame, &base.fit),
            ));
            if is_wrong {
                let anywhere = base::starts(frame, confirmation::ANYWHERE);
                asked.extend(Asked::all_for_model(Some(k), anywhere));
            }
            // The base may also improve from the extension's mode: a Bayes factor compares their best fits.
            if let Some(fit) = self.fit_of(k) {
                let position = fit.point.position[..self.base_frame.dimension()].to_vec();
                asked.push(Asked::for_model(None, position));
            }
        }
        if asked.is_empty() {
            return self.finish();
        }
        for &k in &candidates {
            self.candidates[k].had_confirmation = true;
        }
        self.ask(asked);
        self.phase = Phase::ConfirmationStarts(candidates);
    }

    /// Begins fits at the most probable starts, and continues the best fit so far of each candidate.
    fn take_confirmation_starts(&mut self, candidates: Vec<usize>, answers: Vec<Option<Vec<f64>>>) {
        let (Some(base), Some(confirmation)) = (&self.base, self.confirmation()) else {
            return;
        };
        self.evaluations.confirmation += answers.len();
        let mut points: BTreeMap<Option<usize>, Vec<FitPoint>> = BTreeMap::new();
        for (asked, values) in std::mem::take(&mut self.asked).into_iter().zip(answers) {
            let frame = self.frame(asked.candidate);
            let point = values.and_then(|v| FitPoint::new(frame, &self.likelihood, asked.position, v));
            points.entry(asked.candidate).or_default().extend(point);
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
        self.confirm(FitBatch::new(fits));
    }

    /// Continues the fits of a confirmation. Further candidates follow while any is open; then evidences are sampled.
    fn confirm(&mut self, batch: FitBatch) {
        let Some(batch) = self.next_round(batch, Phase::Confirmation) else {
            return;
        };
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

    /// Asks for the next draws of each importance sampler; the search ends once all samplers are done and no other is needed.
    fn sample(&mut self, mut models: Vec<(Option<usize>, ImportanceSampler)>) {
        let mut asked = Vec::new();
        let mut counts = Vec::new();
        for (candidate, model) in &mut models {
            let number = candidate.map_or(0, |k| k as u64 + 1);
            let positions = model.ask(self.seed, number);
            counts.push(positions.len());
            asked.extend(Asked::all_for_model(*candidate, positions));
        }
        if asked.is_empty() {
            self.take_sampled(&models);
            // Another effect may lead now.
            let samplers = self.samplers();
            return if samplers.is_empty() {
                self.finish()
            } else {
                self.sample(samplers)
            };
        }
        self.ask(asked);
        self.phase = Phase::Sampling(models, counts);
    }

    fn take_sample(
        &mut self,
        mut models: Vec<(Option<usize>, ImportanceSampler)>,
        counts: &[usize],
        answers: Vec<Option<Vec<f64>>>,
    ) {
        self.evaluations.confirmation += answers.len();
        let mut answers = answers.into_iter();
        for ((_, model), count) in models.iter_mut().zip(counts) {
            if *count > 0 {
                model.tell(&self.likelihood, answers.by_ref().take(*count).collect());
            }
        }
        self.sample(models);
    }
}
