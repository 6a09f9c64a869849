//! Diagnostics of a calibration with their findings and flags, computed once for report, terminal, REST and `diagnose`.

use inference::diagnostics::PredictedDraw;

use crate::diagnostics::calibration::Diagnostics;
use crate::diagnostics::channels::{self, ChiSquareTest};
use crate::diagnostics::{directions, parameters, rejections, residuals, sampler, trends};
use crate::finished_calibration::FinishedCalibration;
use crate::flag::cause;
use crate::table::comparison::Comparison;

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
            .chain(cause::shared_causes(&trends))
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
            verification: (&self.verified).into(),
            findings,
            flags: Vec::new(),
        };
        diagnostics.flags = self.flags(&diagnostics);
        diagnostics
    }
}

/// The final draws with the values that the likelihood takes.
fn posterior_draws(calibration: &FinishedCalibration) -> Vec<PredictedDraw> {
    let draws = calibration.predictive_draws().iter();
    let predicted = draws.filter_map(|draw| {
        Some(PredictedDraw {
            theta: draw.theta.clone(),
            values: calibration.spec.predicted_values(draw.fit.as_ref().ok()?),
        })
    });
    predicted.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn all_of_it_comes_back_from_json() {
        for calibration in [fixture::calibration(), fixture::all_rejected(), fixture::fit()] {
            let diagnostics = calibration.diagnostics(calibration.comparison());
            let json = serde_json::to_string(&diagnostics).unwrap();
            assert_eq!(serde_json::from_str::<Diagnostics>(&json).unwrap(), diagnostics);
        }
    }

    #[test]
    fn a_fit_claims_nothing_that_it_cannot_know() {
        let calibration = fixture::fit();
        let diagnostics = calibration.diagnostics(calibration.comparison());
        assert_eq!(diagnostics.sampler, None);
        assert_eq!(diagnostics.chi_square, None);
        assert!(diagnostics.residuals.is_empty() && diagnostics.directions.is_empty());
        assert_eq!(diagnostics.trends, []);
        assert!(diagnostics.findings.is_empty(), "{:?}", diagnostics.findings);
        assert!(diagnostics.parameters.iter().all(|p| p.contraction.is_none()));
        assert!(diagnostics.parameters[1].at_bound);
    }
}
