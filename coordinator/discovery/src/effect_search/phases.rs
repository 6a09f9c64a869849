//! From one phase of a search to the next.

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
use crate::laplace::tightened::tightened;
use crate::settings::Roughness;
use inference::InferenceFailure;
use statistics::likelihood::Likelihood;

impl EffectSearch {
    /// Asks for the next evaluations of a batch; returns it once it is complete.
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
        match std::mem::replace(&mut self.phase, Phase::Starts) {
            Phase::Starts => self.after_starts(answers),
            Phase::Base(mut batch) => {
                batch.tell(&self.likelihood, answers);
                self.fit_base(batch);
            }
            Phase::NumericalNoise(batch, spacing) => self.after_numerical_noise(batch, spacing, &answers),
            Phase::CompanionScreen => self.after_companion_screen(answers),
            Phase::Screen(level) => self.after_screen(level, answers),
            Phase::Tightened(tightened, mut batch) => {
                batch.tell(&tightened, answers);
                self.fit_tightened(tightened, batch);
            }
            Phase::Extensions(mut batch) => {
                batch.tell(&self.likelihood, answers);
                self.fit_extensions(batch);
            }
            Phase::FurtherExtensions(mut batch) => {
                batch.tell(&self.likelihood, answers);
                self.fit_further(batch);
            }
            Phase::Polish(mut batch) => {
                batch.tell(&self.likelihood, answers);
                self.polish(batch);
            }
            Phase::ConfirmationStarts(candidates) => self.after_confirmation_starts(candidates, answers),
            Phase::Confirmation(mut batch) => {
                batch.tell(&self.likelihood, answers);
                self.confirm(batch);
            }
            Phase::Sampling(models, waiting) => self.after_sample(models, &waiting, answers),
            over @ (Phase::Done(_) | Phase::Failed(_)) => self.phase = over,
        }
    }

    fn after_starts(&mut self, answers: Vec<Option<Vec<f64>>>) {
        let positions = std::mem::take(&mut self.asked)
            .into_iter()
            .map(|asked| asked.position);
        let draws = answers.len();
        self.evaluations.base += draws;
        let evaluated = positions.zip(answers).collect();
        let plan = if self.measures_noise {
            self.depth.base
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
        self.begin_screen();
    }

    /// Evaluates the base along a line through its best fit.
    fn measure_noise(&mut self, batch: FitBatch, spacing: f64) {
        let Some(best) = batch.best() else { return };
        let asked = numerical_noise::positions(&best.point.position, spacing);
        self.ask(Asked::all_of_model(None, asked).collect());
        self.phase = Phase::NumericalNoise(batch, spacing);
    }

    /// Adds what the predictions scatter to the noise, and fits the base again where that matters.
    fn after_numerical_noise(&mut self, batch: FitBatch, spacing: f64, answers: &[Option<Vec<f64>>]) {
        self.evaluations.base += answers.len();
        let shorter = numerical_noise::spacings().find(|other| *other < spacing);
        if let Some(shorter) = shorter.filter(|_| !numerical_noise::are_enough(answers)) {
            return self.measure_noise(batch, shorter);
        }
        self.evaluations.base += batch.evaluations();
        // Fits of which only the best go on have not been made to the end.
        let is_made = self.depth.most_bases == usize::MAX;
        let mut plan: &[FitStep] = if is_made { &[] } else { &base::PLAN };
        if self.base_frame.roughness == Roughness::Unknown {
            let mut best = batch.best().into_iter();
            let is_smooth =
                best.any(|fit| numerical_noise::is_negligible(&self.likelihood, answers, &fit.theta()));
            self.set_roughness(if is_smooth {
                Roughness::Smooth
            } else {
                Roughness::Rough
            });
        }
        let most = self.depth.most_bases;
        if let Some(sds) = numerical_noise::sds(&self.likelihood, answers)
            && let Ok(likelihood) = self.likelihood.with_numerical_noise(&sds)
        {
            self.numerical_noise_sds = sds;
            self.likelihood = likelihood;
            plan = &base::PLAN;
        }
        let again = batch.fits.into_iter().filter_map(|(_, fit)| {
            let FitPoint { position, values, .. } = fit.point;
            let frame = self.base_frame.clone();
            let point = FitPoint::new(&frame, &self.likelihood, position, values)?;
            Some((None, LaplaceFit::new(frame, point, fit.columns, plan)))
        });
        let mut again: Vec<(Option<usize>, LaplaceFit)> = again.collect();
        if again.len() > most {
            again.sort_by(|(_, a), (_, b)| a.point.value.total_cmp(&b.point.value));
            again.truncate(most);
        }
        self.fit_base(FitBatch::new(again));
    }

    /// Screens candidates by a step of the strength.
    pub(super) fn screen(&mut self, level: usize, wanted: Vec<usize>) {
        let Some(base) = &self.base else { return };
        let mut asked = Vec::new();
        for &k in &wanted {
            let frame = &self.candidates[k].frame;
            let base = &base.fit.point.position;
            let at = screen::positions(frame, base, self.depth, self.best_shape(k), level);
            asked.extend(Asked::all_of_model(Some(k), at));
        }
        if asked.is_empty() && level + 1 < LEVELS.len() {
            return self.screen(level + 1, wanted);
        }
        if asked.is_empty() {
            return self.extend();
        }
        self.ask(asked);
        self.phase = Phase::Screen(level);
    }

    fn after_screen(&mut self, level: usize, answers: Vec<Option<Vec<f64>>>) {
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
            self.extend();
        }
    }

    fn extend(&mut self) {
        let best = self.best(self.depth.most_extended).into_iter();
        let (awaiting, candidates): (Vec<usize>, Vec<usize>) = best
            .filter(|k| self.fit_of(*k).is_none())
            .partition(|k| self.awaits_model(*k));
        if !awaiting.is_empty() {
            return self.screen(0, awaiting);
        }
        // The evaluations of a rough model are too dear for fitting twice.
        let is_smooth = self.base_frame.roughness == Roughness::Smooth;
        let base = self.base.as_ref().filter(|_| is_smooth);
        match base.and_then(|base| tightened(&self.likelihood, &base.fit)) {
            Some(tightened) => {
                let fits = self.extensions(candidates, &tightened);
                self.fit_tightened(tightened, FitBatch::new(fits));
            }
            None => {
                let fits = self.extensions(candidates, &self.likelihood);
                self.fit_extensions(FitBatch::new(fits));
            }
        }
    }

    /// Fits with less room for discrepancy, from where the fits with the whole of it begin a second time.
    fn fit_tightened(&mut self, tightened: Likelihood, mut batch: FitBatch) {
        let asked = batch.ask(&tightened);
        if !asked.is_empty() {
            self.ask(asked);
            self.phase = Phase::Tightened(tightened, batch);
            return;
        }
        self.evaluations.extension += batch.evaluations();
        let mut fits = self.extensions(self.best(self.depth.most_extended), &self.likelihood);
        fits.extend(batch.fits.into_iter().filter_map(|(candidate, fit)| {
            let FitPoint { position, values, .. } = fit.point;
            let point = FitPoint::new(&fit.frame, &self.likelihood, position, values)?;
            let again = LaplaceFit::new(fit.frame, point, fit.columns, self.depth.extension);
            Some((candidate, again))
        }));
        self.fit_extensions(FitBatch::new(fits));
    }

    /// Fits of candidates, from the screen's results.
    fn extensions(
        &self,
        candidates: Vec<usize>,
        likelihood: &Likelihood,
    ) -> Vec<(Option<usize>, LaplaceFit)> {
        let fits = candidates.into_iter().filter_map(|k| {
            let base = &self.base.as_ref()?.fit;
            let state = &self.candidates[k];
            let screened = state.screened.as_ref()?;
            let fit = extension::fit(&state.frame, base, screened, likelihood, self.depth)?;
            Some((Some(k), fit))
        });
        fits.collect()
    }

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
        let further = self.extensions(near, &self.likelihood);
        self.fit_further(FitBatch::new(further));
    }

    fn fit_further(&mut self, batch: FitBatch) {
        let Some(batch) = self.next_round(batch, Phase::FurtherExtensions) else {
            return;
        };
        self.evaluations.extension += batch.evaluations();
        self.take(batch, EvidenceMethod::RankOne);
        let fits = self
            .best(self.depth.most_polished)
            .into_iter()
            .filter_map(|k| Some((Some(k), self.fit_of(k)?.continued(self.depth.polish))));
        let batch = FitBatch::new(fits.collect());
        self.polish(batch);
    }

    fn polish(&mut self, batch: FitBatch) {
        let Some(batch) = self.next_round(batch, Phase::Polish) else {
            return;
        };
        self.evaluations.polish += batch.evaluations();
        self.take(batch, EvidenceMethod::Polished);
        if !self.depth.confirms {
            return self.finish();
        }
        let first = self.best(self.confirmation().least);
        self.confirm_these(first);
    }

    fn confirmation(&self) -> &'static Confirmation {
        if self.is_wrong() {
            &self.depth.confirmation_if_wrong
        } else {
            &self.depth.confirmation
        }
    }

    /// Fits candidates from several starts.
    pub(super) fn confirm_these(&mut self, candidates: Vec<usize>) {
        let Some(base) = &self.base else { return };
        // A base that contradicts the data may lie at an end of its prior, and is then a poor start.
        let is_wrong = self.is_wrong();
        let mut asked = Vec::new();
        for &k in &candidates {
            // Of a model that scatters, each fit may stop somewhere else.
            if !self.numerical_noise_sds.is_empty() {
                let in_place = self.in_place_of_best(k);
                asked.extend(in_place.map(|position| Asked::of_model(Some(k), position)));
            }
            if self.candidates[k].had_confirmation {
                continue;
            }
            let frame = &self.candidates[k].frame;
            asked.extend(Asked::all_of_model(
                Some(k),
                confirmation::starts(frame, &base.fit),
            ));
            if is_wrong {
                let anywhere = base::starts(frame, confirmation::ANYWHERE);
                asked.extend(Asked::all_of_model(Some(k), anywhere));
            }
            // The base may also improve from the extension's mode: a Bayes factor compares their best fits.
            if let Some(fit) = self.fit_of(k) {
                let own = fit.point.position[..self.base_frame.dimension()].to_vec();
                asked.push(Asked::of_model(None, own));
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

    fn after_confirmation_starts(&mut self, candidates: Vec<usize>, answers: Vec<Option<Vec<f64>>>) {
        let Some(base) = &self.base else { return };
        self.evaluations.confirmation += answers.len();
        let mut points: BTreeMap<Option<usize>, Vec<FitPoint>> = BTreeMap::new();
        for (asked, values) in std::mem::take(&mut self.asked).into_iter().zip(answers) {
            let frame = self.frame(asked.candidate);
            let point = values.and_then(|v| FitPoint::new(frame, &self.likelihood, asked.position, v));
            points.entry(asked.candidate).or_default().extend(point);
        }
        let confirmation = self.confirmation();
        let mut fits = Vec::new();
        for (candidate, mut points) in points {
            points.sort_by(|a, b| a.value.total_cmp(&b.value));
            points.truncate(confirmation.most_starts);
            let frame = self.frame(candidate);
            let known = candidate.map_or(Some(&base.fit), |k| self.fit_of(k));
            let none = || vec![vec![0.0; base.fit.point.values.len()]; frame.dimension()];
            let known = known.filter(|_| confirmation.keeps_jacobian);
            let columns = known.map_or_else(none, |known| known.columns.clone());
            let corrections = known.map_or(&[][..], |known| &known.corrections);
            for point in points {
                let fit = LaplaceFit::new(frame.clone(), point, columns.clone(), confirmation.plan);
                fits.push((candidate, fit.corrected(corrections)));
            }
        }
        for k in candidates {
            let estimate = self.candidates[k].estimate.as_ref();
            let known = estimate.and_then(|own| Some((own.method, own.fit.as_ref()?)));
            fits.extend(known.map(|(method, fit)| match method {
                // It has had these steps; it is there to be compared with.
                EvidenceMethod::Confirmed | EvidenceMethod::Sampled => (Some(k), fit.continued(&[])),
                _ => (Some(k), confirmation.continued(fit)),
            }));
        }
        self.confirm(FitBatch::new(fits));
    }

    fn confirm(&mut self, batch: FitBatch) {
        let Some(batch) = self.next_round(batch, Phase::Confirmation) else {
            return;
        };
        self.evaluations.confirmation += batch.evaluations();
        self.take_base(&batch);
        self.take(batch, EvidenceMethod::Confirmed);
        let more = self.unconfirmed();
        if !more.is_empty() {
            return self.confirm_these(more);
        }
        let models = self.samplers();
        self.sample(models);
    }

    fn sample(&mut self, mut models: Vec<(Option<usize>, ImportanceSampler)>) {
        let mut asked = Vec::new();
        let mut waiting = Vec::new();
        for (candidate, model) in &mut models {
            let number = candidate.map_or(0, |k| k as u64 + 1);
            let positions = model.ask(self.seed, number);
            waiting.push(positions.len());
            asked.extend(Asked::all_of_model(*candidate, positions));
        }
        if asked.is_empty() {
            self.take_sampled(&models);
            // Another effect may lead now.
            let more = self.samplers();
            return if more.is_empty() {
                self.finish()
            } else {
                self.sample(more)
            };
        }
        self.ask(asked);
        self.phase = Phase::Sampling(models, waiting);
    }

    fn after_sample(
        &mut self,
        mut models: Vec<(Option<usize>, ImportanceSampler)>,
        waiting: &[usize],
        answers: Vec<Option<Vec<f64>>>,
    ) {
        self.evaluations.confirmation += answers.len();
        let mut answers = answers.into_iter();
        for ((_, model), count) in models.iter_mut().zip(waiting) {
            if *count > 0 {
                model.tell(&self.likelihood, answers.by_ref().take(*count).collect());
            }
        }
        self.sample(models);
    }
}
