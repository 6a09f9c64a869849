//! Phase 3, the extensions: the best candidates of the screen are fitted, each together with the base.

use crate::effect_search::depth::ExtensionDepth;
use crate::effect_search::ranking::EvidenceMethod;
use crate::effect_search::screen_result::Screened;
use crate::effect_search::state::{EffectSearch, FitPhase, Phase};
use crate::laplace::batch::FitBatch;
use crate::laplace::coordinate::NormalFrame;
use crate::laplace::correction::quotient;
use crate::laplace::fit::LaplaceFit;
use crate::laplace::noise;
use crate::laplace::point::FitPoint;
use crate::laplace::quadratic::quadratic;
use crate::laplace::reduced_discrepancy::reduced_discrepancy;
use crate::settings::Smoothness;
use statistics::likelihood::Likelihood;

/// Begins a fit at the base's fit or at the screen's point, whichever is more probable; a switch begins at the screen's point.
fn fit(
    frame: &NormalFrame,
    base: &LaplaceFit,
    screened: &Screened,
    likelihood: &Likelihood,
    depth: &ExtensionDepth,
) -> Option<LaplaceFit> {
    // The screen's point may have been computed with another likelihood.
    let FitPoint { position, values, .. } = screened.point.clone();
    let present = FitPoint::new(frame, likelihood, position, values)?;
    if frame.is_switch() {
        let (point, columns) = (present, screened.columns.clone());
        return Some(LaplaceFit::new(frame.clone(), point, columns, depth.plan));
    }
    let position = frame.without(&screened.point.position);
    let absent = FitPoint::new(frame, likelihood, position, base.point.values.clone())?;
    let is_present = present.value < absent.value;
    let mut columns = base.columns.clone();
    columns.extend_from_slice(&screened.columns[base.columns.len()..]);
    let shapes = || (base.columns.len()..frame.dimension()).filter(|k| !frame.is_strength(*k));
    if !is_present {
        if let Some((k, neutral)) = frame.strength() {
            columns[k] = quotient(
                &screened.point.values,
                &base.point.values,
                screened.point.position[k] - neutral,
            );
        }
        // The shape of an absent effect changes nothing.
        for k in shapes() {
            columns[k].fill(0.0);
        }
    }
    let point = if is_present { present } else { absent };
    let mut corrections = base.corrections.clone();
    corrections.extend_from_slice(&screened.corrections[corrections.len()..]);
    let fit = LaplaceFit::new(frame.clone(), point, columns, depth.plan);
    let mut fit = fit.corrected(&corrections);
    if depth.holds_shapes {
        fit.hold(shapes());
    }
    // Where the model rejected the last step of the base, the base with an effect leads there as well: its steps would be rejected one
    // after the other.
    if base.is_at_rejection && frame.smoothness != Smoothness::Smooth {
        let noise_sds = noise::coordinates(likelihood);
        let is_noise_sd = |k: &usize| noise_sds.iter().any(|(sd, _)| sd == k);
        fit.hold((0..base.columns.len()).filter(|k| !is_noise_sd(k)));
    }
    Some(fit)
}

/// Returns the predicted values at the optimum of the model linearised where the fit begins: the effect's change before its fit
/// has made a step. `None` if the fit cannot begin.
pub(crate) fn linearised(
    frame: &NormalFrame,
    base: &LaplaceFit,
    screened: &Screened,
    likelihood: &Likelihood,
    depth: &ExtensionDepth,
) -> Option<Vec<f64>> {
    let fit = fit(frame, base, screened, likelihood, depth)?;
    let step = quadratic(frame, likelihood, &fit.point, &fit.columns).step(0.0)?;
    let moved = |i: usize| {
        let changes = step.iter().zip(&fit.columns).map(|(by, column)| by * column[i]);
        fit.point.values[i] + changes.sum::<f64>()
    };
    Some((0..fit.point.values.len()).map(moved).collect())
}

impl EffectSearch {
    /// Fits the best candidates of the screen, each with the base. Those that only the low-fidelity model has screened are
    /// screened on the model first.
    pub(super) fn begin_extensions(&mut self) {
        let (awaiting, candidates): (Vec<usize>, Vec<usize>) =
            self.unfitted().into_iter().partition(|k| self.awaits_model(*k));
        if !awaiting.is_empty() {
            return self.screen(0, awaiting);
        }
        for &k in &candidates {
            self.candidates[k].had_extension = true;
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
                self.fit(FitPhase::Extensions, FitBatch::new(fits));
            }
        }
    }

    /// Returns the best candidates that are not fitted yet, as many as may be.
    fn unfitted(&self) -> Vec<usize> {
        let max_count = self.depth.extension.max_count;
        let begun = self.candidates.iter().filter(|state| state.had_extension);
        let room = match self.depth.within {
            Some(_) => max_count.saturating_sub(begun.count()),
            None => max_count,
        };
        let mut unfitted = self.near_best(max_count);
        unfitted.retain(|k| !self.candidates[*k].had_extension);
        unfitted.truncate(room);
        unfitted
    }

    /// Fits with a reduced discrepancy; the fits with the whole of it begin at the screen's points and, once more, at these modes.
    pub(super) fn fit_reduced_discrepancy(&mut self, reduced: Likelihood, mut batch: FitBatch) {
        let requests = batch.ask(&reduced);
        if !requests.is_empty() {
            self.ask(requests);
            self.phase = Phase::ReducedDiscrepancy(reduced, batch);
            return;
        }
        self.evaluations.extension += batch.evaluations();
        let candidates = batch.fits.iter().filter_map(|(candidate, _)| *candidate);
        let mut fits = self.extension_fits(candidates.collect(), &self.likelihood);
        fits.extend(batch.fits.into_iter().filter_map(|(candidate, fit)| {
            let FitPoint { position, values, .. } = fit.point;
            let point = FitPoint::new(&fit.frame, &self.likelihood, position, values)?;
            let plan = self.depth.extension.plan;
            Some((candidate, LaplaceFit::new(fit.frame, point, fit.columns, plan)))
        }));
        self.fit(FitPhase::Extensions, FitBatch::new(fits));
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
            let fit = fit(&state.frame, base, screened, likelihood, &self.depth.extension)?;
            Some((Some(k), fit))
        });
        fits.collect()
    }

    /// Keeps the fits of the best candidates, and fits those that the fits of the first leave near the best; then the candidates within
    /// reach of the best.
    pub(super) fn take_extensions(&mut self, batch: FitBatch) {
        self.evaluations.extension += batch.evaluations();
        self.take(batch, EvidenceMethod::RankOne);
        // The best of the screen may have promised too much.
        if self.depth.within.is_some() && !self.unfitted().is_empty() {
            return self.begin_extensions();
        }
        let near = self.within_reach();
        let awaiting: Vec<usize> = near.iter().copied().filter(|k| self.awaits_model(*k)).collect();
        if !awaiting.is_empty() {
            return self.screen(0, awaiting);
        }
        let fits = self.extension_fits(near, &self.likelihood);
        self.fit(FitPhase::WithinReach, FitBatch::new(fits));
    }

    /// Keeps the fits of the candidates within reach, and refines the best of all.
    pub(super) fn take_within_reach(&mut self, batch: FitBatch) {
        self.evaluations.extension += batch.evaluations();
        self.take(batch, EvidenceMethod::RankOne);
        let depth = &self.depth.refinement;
        let fits = self
            .near_best(depth.max_count)
            .into_iter()
            .filter_map(|k| Some((Some(k), self.fit_of(k)?.continued(depth.plan))));
        let batch = FitBatch::new(fits.collect());
        self.fit(FitPhase::Refinement, batch);
    }
}
