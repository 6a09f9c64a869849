//! Phase 1, the base: the model without a candidate is fitted from starts that fill its prior, and its numerical noise is measured.

use crate::effect_search::depth::BASE_PLAN;
use crate::effect_search::state::{EffectSearch, FitPhase, Phase};
use crate::laplace::batch::{FitBatch, PositionRequest};
use crate::laplace::coordinate::NormalFrame;
use crate::laplace::fit::{FitStep, FittedModel, LaplaceFit};
use crate::laplace::point::FitPoint;
use crate::settings::Smoothness;
use inference::InferenceFailure;
use inference::numerical_noise;
use statistics::likelihood::Likelihood;

/// Number of starts, the most probable, at which fits begin.
const COUNT: usize = 3;

/// Returns starts that fill the prior evenly: Kronecker's sequence with the generalised golden ratio, mapped by the quantiles of
/// the priors.
///
/// # Source
/// Roberts 2018, "The unreasonable effectiveness of quasirandom sequences". Checked by `tests::starts_fill_the_prior`.
pub(crate) fn starts(frame: &NormalFrame, count: usize) -> Vec<Vec<f64>> {
    let dimension = frame.dimension();
    let golden = golden_ratio(dimension);
    let fraction = |n: usize, k: usize| {
        let x = 0.5 + n as f64 * libm::pow(golden, -(k as f64 + 1.0));
        x - libm::floor(x)
    };
    let start = |n: usize| {
        let marginals = frame.coordinates.iter().map(|c| &c.marginal).enumerate();
        let theta: Vec<f64> = marginals.map(|(k, m)| m.quantile(fraction(n, k))).collect();
        frame.position(&theta)
    };
    (0..count).map(start).collect()
}

/// Returns the root above 1 of `x^(d+1) = x + 1`.
fn golden_ratio(dimension: usize) -> f64 {
    let power = 1.0 / (dimension as f64 + 1.0);
    (0..64).fold(2.0, |x: f64, _| libm::pow(1.0 + x, power))
}

/// Begins fits at the best of evaluated starts; returns none if the model rejected all starts.
fn fits(
    frame: &NormalFrame,
    likelihood: &Likelihood,
    plan: &[FitStep],
    evaluated: Vec<(Vec<f64>, Option<Vec<f64>>)>,
) -> Vec<LaplaceFit> {
    let points = evaluated
        .into_iter()
        .filter_map(|(position, values)| FitPoint::new(frame, likelihood, position, values?));
    let mut points: Vec<FitPoint> = points.collect();
    points.sort_by(|a, b| a.value.total_cmp(&b.value));
    points.truncate(COUNT);
    let fit = |point: FitPoint| {
        let columns = vec![vec![0.0; point.values.len()]; frame.dimension()];
        LaplaceFit::new(frame.clone(), point, columns, plan)
    };
    points.into_iter().map(fit).collect()
}

impl EffectSearch {
    /// Begins fits of the base at the most probable of its starts.
    pub(super) fn take_base_starts(&mut self, answers: Vec<Option<Vec<f64>>>) {
        let positions = std::mem::take(&mut self.requests)
            .into_iter()
            .map(|request| request.position);
        let draws = answers.len();
        self.evaluations.base += draws;
        let evaluated = positions.zip(answers).collect();
        let plan = if self.measures_noise {
            self.depth.base.plan
        } else {
            &BASE_PLAN
        };
        let fits = fits(&self.base_frame, &self.likelihood, plan, evaluated);
        if fits.is_empty() {
            self.phase = Phase::Failed(InferenceFailure::AllImpossible { draws });
        } else {
            self.fit(
                FitPhase::Base,
                FitBatch::new(fits.into_iter().map(|fit| (None, fit)).collect()),
            );
        }
    }

    /// Keeps the best fit of the base and begins the screen; the first time, the numerical noise is measured before.
    pub(super) fn take_base_fits(&mut self, batch: FitBatch) {
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
        let positions = numerical_noise::positions(&best.point.position, spacing);
        self.ask(PositionRequest::all_for_model(None, positions).collect());
        self.phase = Phase::NumericalNoise(batch, spacing);
    }

    /// Adds the numerical noise to that of the data, and fits the base again where it matters.
    pub(super) fn take_noise(&mut self, batch: FitBatch, spacing: f64, answers: &[Option<Vec<f64>>]) {
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
        let mut plan: &[FitStep] = if max_count == usize::MAX { &[] } else { &BASE_PLAN };
        if let Some(sds) = numerical_noise::sds(&self.likelihood, answers)
            && let Ok(likelihood) = self.likelihood.with_numerical_noise(&sds)
        {
            self.numerical_noise_sds = sds;
            self.likelihood = likelihood;
            plan = &BASE_PLAN;
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
        self.fit(FitPhase::Base, FitBatch::new(fits));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Smoothness;
    use statistics::prior::{Distribution, Marginal, Prior};

    #[test]
    fn starts_fill_the_prior() {
        let uniform = |lower, upper| Marginal::new(Distribution::Uniform { lower, upper }, None).unwrap();
        let frame = NormalFrame::base(
            &Prior::new(vec![uniform(0.0, 1.0), uniform(0.0, 4.0)]),
            Smoothness::Smooth,
        );
        let thetas: Vec<Vec<f64>> = starts(&frame, 32).iter().map(|t| frame.theta(t)).collect();
        for quarter in 0..4 {
            let low = f64::from(quarter);
            let inside = |x: f64| (low..low + 1.0).contains(&x);
            let first = thetas.iter().filter(|x| inside(4.0 * x[0])).count();
            let second = thetas.iter().filter(|x| inside(x[1])).count();
            assert!(
                (7..=10).contains(&first) && (7..=10).contains(&second),
                "{first} {second}"
            );
        }
    }
}
