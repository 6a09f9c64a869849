//! Figure of the prediction errors over the posterior (the source paper's Fig. 8).

use inference::diagnostics;
use job::Spec;
use shared::channel::Channel;

use super::mark::{Mark, MarkKind};
use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;

/// Number of grid points.
const GRID: usize = 160;

/// The density of the prediction error of a channel over the posterior.
///
/// The error of a draw is the root mean square of measured minus predicted over the fitted runs. The density is estimated by a Gaussian
/// kernel that is reflected at 0, with the bandwidth that is optimal for a normal density.
#[derive(Debug, Clone, serde::Serialize, utoipa::ToSchema)]
pub struct ErrorDensity {
    /// Channel, by its name without unit.
    #[schema(value_type = String)]
    pub channel: Channel,
    /// Unit of the errors.
    pub unit: String,
    /// Number of fitted runs that measured the channel.
    pub runs: usize,
    /// Number of final draws that the model accepted.
    pub draws: usize,
    /// Errors at which the density is given, from 0 upwards.
    pub grid: Vec<f64>,
    /// Density, in 1 over the unit; empty if all draws have the same error.
    pub density: Vec<f64>,
    /// Errors of the posterior mean, of the draw with the highest likelihood, and of the point estimates.
    pub marks: Vec<Mark<f64>>,
}

/// Returns the density of each fitted channel.
pub(super) fn all(study: &Study, sample: &FinishedCalibration) -> Vec<ErrorDensity> {
    Channel::ALL
        .into_iter()
        .filter_map(|channel| density(study, sample, channel))
        .collect()
}

/// Returns the root mean square error of predicted values in a channel; `None` if the channel was not fitted.
fn error(spec: &Spec, values: &[f64], channel: Channel) -> Option<f64> {
    let data = spec.likelihood.data().iter().zip(values);
    let of_channel = data.filter(|(datum, _)| datum.channel == channel.index());
    let squares: Vec<f64> = of_channel
        .map(|(datum, value)| (datum.value - value) * (datum.value - value))
        .collect();
    diagnostics::mean(&squares).map(libm::sqrt)
}

fn density(study: &Study, sample: &FinishedCalibration, channel: Channel) -> Option<ErrorDensity> {
    let errors = |calibration: &FinishedCalibration| -> Vec<f64> {
        let accepted = calibration
            .predictive_draws()
            .iter()
            .filter_map(|d| d.fit.as_ref().ok());
        accepted
            .filter_map(|o| error(&calibration.spec, &calibration.spec.predicted_values(o), channel))
            .collect()
    };
    let over_draws = errors(sample);
    let mut marks = vec![Mark::new(MarkKind::Mean, "mean", diagnostics::mean(&over_draws)?)];
    let likeliest = sample.likeliest_values.as_deref();
    if let Some(at) = likeliest.and_then(|values| error(&sample.spec, values, channel)) {
        marks.push(Mark::new(MarkKind::MaximumLikelihood, "maximum likelihood", at));
    }
    for (label, calibration) in study.optima_beside(sample) {
        let at = errors(calibration).first().copied();
        marks.extend(at.map(|at| Mark::new(MarkKind::PointEstimate, label, at)));
    }
    let shown = over_draws.iter().chain(marks.iter().map(|m| &m.at)).copied();
    let reach = shown.fold(0.0, f64::max) + 3.0 * diagnostics::bandwidth(&over_draws).unwrap_or(0.0);
    let grid: Vec<f64> = (0..GRID).map(|k| reach * k as f64 / (GRID - 1) as f64).collect();
    let data = sample.spec.likelihood.data();
    Some(ErrorDensity {
        channel,
        unit: channel.unit().to_owned(),
        runs: data.iter().filter(|d| d.channel == channel.index()).count(),
        draws: over_draws.len(),
        density: diagnostics::density(&over_draws, (0.0, f64::INFINITY), &grid).unwrap_or_default(),
        grid,
        marks,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn the_density_holds_all_draws_and_marks_are_their_errors() {
        let study = fixture::study();
        for of_channel in all(&study, &study.lead) {
            let step = of_channel.grid[1] - of_channel.grid[0];
            let inner: f64 = of_channel
                .density
                .windows(2)
                .map(|f| 0.5 * (f[0] + f[1]) * step)
                .sum();
            assert!(
                (inner - 1.0).abs() < 0.01,
                "{} holds {inner}",
                of_channel.channel.name()
            );
            let labels: Vec<&str> = of_channel.marks.iter().map(|m| m.label.as_str()).collect();
            assert_eq!(labels, ["mean", "maximum likelihood", "GA optimum"]);
            let last = *of_channel.grid.last().unwrap();
            assert!(of_channel.marks.iter().all(|m| (0.0..=last).contains(&m.at)));
        }
    }

    #[test]
    fn the_error_of_several_runs_is_their_root_mean_square() {
        let study = fixture::study();
        let spec = &study.lead.spec;
        // The errors of the runs alternate between 3 and -4, with root mean square sqrt((9 + 16) / 2).
        let mut sign = 0;
        let values: Vec<f64> = spec
            .likelihood
            .data()
            .iter()
            .map(|d| {
                sign += usize::from(d.channel == Channel::Sinkage.index());
                d.value + if sign % 2 == 0 { 3.0 } else { -4.0 }
            })
            .collect();
        let got = error(spec, &values, Channel::Sinkage).unwrap();
        assert!((got - 12.5_f64.sqrt()).abs() < 1e-12, "{got}");
        assert_eq!(error(spec, &values, Channel::Torque), None);
    }
}
