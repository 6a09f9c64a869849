//! Diagnosis: computes the diagnostics of a calibration with their findings and flags, for report, terminal and REST.

use crate::flag::calibration::flags;
use crate::flag::cause;
use result::diagnostics::calibration::Diagnostics;
use result::diagnostics::channels::{self, ChiSquareTest};
use result::diagnostics::emulator::{self, EmulatorDiagnostics};
use result::diagnostics::{directions, parameters, posterior_draws, rejections, residuals, sampler, trends};
use result::finished_calibration::FinishedCalibration;
use result::table::comparison::Comparison;

/// Computes the diagnostics of a calibration.
///
/// # Arguments
/// - `comparison`: [`FinishedCalibration::comparison`], for the coverage of its intervals.
pub fn diagnostics(calibration: &FinishedCalibration, comparison: &Comparison) -> Diagnostics {
    let posterior = posterior_draws(calibration);
    let residuals = residuals::residuals(calibration, &posterior);
    let trends = trends::trends(calibration, &posterior);
    let (parameters, conflict) = parameters::parameters(calibration);
    let directions = directions::directions(calibration);
    let rejections = rejections::rejections(calibration);
    let channels = channels::channels(calibration, comparison, &posterior, &residuals);
    let chi_square = channels::chi_square(calibration, &posterior, |_| true);
    let emulator = emulator::emulator(calibration);
    let silences = channels.iter().filter_map(|channel| channel.silence.clone());
    let findings = emulator
        .iter()
        .flat_map(EmulatorDiagnostics::words)
        .chain(silences)
        .chain(chi_square.as_ref().map(ChiSquareTest::words))
        .chain(cause::shared_causes(&trends))
        .chain(directions::worst_known(calibration, &directions))
        .chain(rejections.words())
        .collect();
    let mut diagnostics = Diagnostics {
        sampler: sampler::sampler(calibration),
        emulator,
        channels,
        chi_square,
        residuals,
        trends,
        parameters,
        conflict,
        directions,
        rejections,
        verification: (&calibration.verified).into(),
        findings,
        flags: Vec::new(),
    };
    diagnostics.flags = flags(calibration, &diagnostics);
    diagnostics
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn all_of_it_comes_back_from_json() {
        for calibration in [fixture::calibration(), fixture::all_rejected(), fixture::fit()] {
            let diagnostics = diagnostics(&calibration, calibration.comparison());
            let json = serde_json::to_string(&diagnostics).unwrap();
            assert_eq!(serde_json::from_str::<Diagnostics>(&json).unwrap(), diagnostics);
        }
    }

    #[test]
    fn a_fit_claims_nothing_that_it_cannot_know() {
        let calibration = fixture::fit();
        let diagnostics = diagnostics(&calibration, calibration.comparison());
        assert_eq!(diagnostics.sampler, None);
        assert_eq!(diagnostics.chi_square, None);
        assert!(diagnostics.residuals.is_empty() && diagnostics.directions.is_empty());
        assert_eq!(diagnostics.trends, []);
        assert!(diagnostics.findings.is_empty(), "{:?}", diagnostics.findings);
        assert!(diagnostics.parameters.iter().all(|p| p.contraction.is_none()));
        assert!(diagnostics.parameters[1].at_bound);
    }
}
