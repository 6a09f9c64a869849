//! Diagnostics of a calibration, computed once for report, terminal, REST and `diagnose`.
//!
//! # Layout
//! - `sampler`: stages, equilibrium, effective sample size.
//! - `channels`: what each channel can say, how well it is met, how its intervals hold.
//! - `residuals`: every fitted measurement beside its prediction. `trends`: whether they follow a condition of the runs;
//!   `causes`: what that looks like, and what it may come from.
//! - `parameters`: contraction, bounds, conflict with the prior. `directions`: what is known only together.
//! - `rejections`: refusals and faults by region of the prior.
//! - `datum`: names and units of data. `flags`: what of it deserves attention. `terminal`: all of it as text.
//!
//! The statistics are [`inference::diagnostics`]'s. Nothing here but the coverage of holdout rows, which decides nothing,
//! reads a holdout row.

mod causes;
mod channels;
mod datum;
mod directions;
mod flags;
mod parameters;
mod rejections;
mod residuals;
mod sampler;
pub mod terminal;
mod trends;

use inference::diagnostics::PredictedDraw;

use super::{Comparison, FinishedCalibration, Flag};

pub use channels::{ChannelDiagnostics, ChiSquareTest, CoverageCount};
pub(super) use datum::shown;
pub use directions::{DirectionDiagnostics, Loading};
pub(super) use flags::findings_that_alarm;
pub use parameters::{ParameterDiagnostics, PriorConflict};
pub use rejections::{Bin, BinnedParameter, PriorRegion, RegionSide, RejectionDiagnostics};
pub use residuals::ResidualDiagnostics;
pub use sampler::SamplerDiagnostics;
pub use trends::{Against, TrendDiagnostics};

/// A test with a smaller probability raises a flag.
pub(super) const LEVEL: f64 = 0.01;

/// How far a calibration can be trusted, and where its model fails. What a fit or a search cannot know is null or empty.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Diagnostics {
    /// What the sampler did; null of a fit.
    pub sampler: Option<SamplerDiagnostics>,
    /// What each channel can say and how well it is met, in the order of all tables.
    pub channels: Vec<ChannelDiagnostics>,
    /// The misfit of all fitted data together; null where the noise of all is inferred.
    pub chi_square: Option<ChiSquareTest>,
    /// Every fitted measurement beside its prediction.
    pub residuals: Vec<ResidualDiagnostics>,
    /// The residuals of each channel against each condition that its runs vary.
    pub trends: Vec<TrendDiagnostics>,
    /// What the data did to each parameter, in the order of the job.
    pub parameters: Vec<ParameterDiagnostics>,
    /// The prior of all parameters together against the data.
    pub conflict: Option<PriorConflict>,
    /// Combinations of parameters, the worst known first.
    pub directions: Vec<DirectionDiagnostics>,
    /// Refusals and faults by region of the prior.
    pub rejections: RejectionDiagnostics,
    /// The findings in plain words.
    pub findings: Vec<String>,
    /// What deserves attention.
    pub flags: Vec<Flag>,
}

impl FinishedCalibration {
    /// The diagnostics.
    ///
    /// # Arguments
    /// - `comparison`: [`FinishedCalibration::comparison`], whose intervals are counted.
    pub fn diagnostics(&self, comparison: &Comparison) -> Diagnostics {
        let posterior = posterior_draws(self);
        let residuals = residuals::residuals(self, &posterior);
        let trends = trends::trends(self, &posterior);
        let (parameters, conflict) = parameters::parameters(self);
        let directions = directions::directions(self);
        let rejections = rejections::rejections(self);
        let channels = channels::channels(self, comparison, &posterior, &residuals);
        let chi_square = channels::chi_square(self, &posterior, |_| true);
        let findings = channels
            .iter()
            .filter_map(|channel| channel.silence.clone())
            .chain(chi_square.as_ref().map(ChiSquareTest::words))
            .chain(causes::shared_causes(&trends))
            .chain(directions::worst_known(self, &directions))
            .chain(rejections.words())
            .collect();
        let mut diagnostics = Diagnostics {
            sampler: sampler::sampler(self),
            channels,
            chi_square,
            residuals,
            trends,
            parameters,
            conflict,
            directions,
            rejections,
            findings,
            flags: Vec::new(),
        };
        diagnostics.flags = self.flags(&diagnostics);
        diagnostics
    }
}

/// The final draws with the values that the likelihood takes.
fn posterior_draws(outcome: &FinishedCalibration) -> Vec<PredictedDraw> {
    let draws = outcome.predictive_draws().iter();
    let predicted = draws.filter_map(|draw| {
        Some(PredictedDraw {
            theta: draw.theta.clone(),
            values: outcome.spec.predicted_values(draw.fit.as_ref().ok()?),
        })
    });
    predicted.collect()
}

/// A probability: `0.012`, `3e-7`, `< 1e-12`.
pub(super) fn probability(p: f64) -> String {
    if p < 1e-12 {
        "< 1e-12".into()
    } else if p < 1e-3 {
        format!("{p:.0e}")
    } else {
        super::report::number::significant(p, 2)
    }
}

/// The same in a sentence: `p = 0.012`, `p < 1e-12`.
pub(crate) fn p_words(p: f64) -> String {
    let value = probability(p);
    let relation = if value.starts_with('<') { "p" } else { "p =" };
    format!("{relation} {value}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::fixture;

    #[test]
    fn all_of_it_comes_back_from_json() {
        for outcome in [fixture::outcome(), fixture::all_refused(), fixture::fit()] {
            let diagnostics = outcome.diagnostics(&outcome.comparison());
            let json = serde_json::to_string(&diagnostics).unwrap();
            assert_eq!(serde_json::from_str::<Diagnostics>(&json).unwrap(), diagnostics);
        }
    }

    #[test]
    fn a_fit_claims_nothing_that_it_cannot_know() {
        let outcome = fixture::fit();
        let diagnostics = outcome.diagnostics(&outcome.comparison());
        assert_eq!(diagnostics.sampler, None);
        assert_eq!(diagnostics.chi_square, None);
        assert!(diagnostics.residuals.is_empty() && diagnostics.directions.is_empty());
        assert_eq!(diagnostics.trends, []);
        assert!(diagnostics.findings.is_empty(), "{:?}", diagnostics.findings);
        assert!(diagnostics.parameters.iter().all(|p| p.contraction.is_none()));
        assert!(diagnostics.parameters[1].at_bound);
    }

    #[test]
    fn probabilities_in_words() {
        let words = [0.0123, 3.4e-7, 0.0].map(p_words);
        assert_eq!(words, ["p = 0.012", "p = 3e-7", "p < 1e-12"]);
    }
}
