//! Fixed sigmas: one noise standard deviation for each channel of a study, in which all its errors are comparable.

use std::collections::BTreeMap;

use job::repeat_scatter;
use shared::channel::Channel;
use shared::experiment::NoiseSd;

use super::errors::ErrorTable;
use crate::finished_calibration::FinishedCalibration;
use crate::words::data_channel::{ShownUnit, short_name};
use crate::words::number;

/// The noise standard deviation of a channel for a whole study.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct FixedSigma {
    /// Standard deviation [channel's unit].
    pub sd: f64,
    /// Source of the value.
    pub source: SigmaSource,
}

/// Source of a noise standard deviation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum SigmaSource {
    /// The experiment, or its runs, declare it.
    Declared,
    /// Scatter of fitted repeats of a condition.
    Repeats,
    /// Inferred by the first calibration from its misfit.
    Inferred,
}

impl SigmaSource {
    fn words(self) -> &'static str {
        match self {
            SigmaSource::Declared => "declared",
            SigmaSource::Repeats => "from repeats of a condition",
            SigmaSource::Inferred => "inferred by the first calibration",
        }
    }
}

/// The noise standard deviations of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct FixedSigmas(BTreeMap<Channel, FixedSigma>);

impl FixedSigmas {
    /// Chooses the noise of each channel for a study whose first calibration is given: declared, else from the scatter of fitted repeats,
    /// else inferred by that calibration.
    pub fn new(first: &FinishedCalibration) -> Self {
        let sigma = |channel| Some((channel, fixed_sigma(first, channel)?));
        FixedSigmas(Channel::ALL.into_iter().filter_map(sigma).collect())
    }

    /// Returns the noise of a channel.
    pub fn get(&self, channel: Channel) -> Option<FixedSigma> {
        self.0.get(&channel).copied()
    }

    /// Returns the noise of each channel by the channel's name.
    pub fn by_name(&self) -> BTreeMap<String, FixedSigma> {
        let named = self
            .0
            .iter()
            .map(|(channel, sigma)| (channel.name().to_owned(), *sigma));
        named.collect()
    }

    /// Lists the noise by channel: `pull 1.2 N (declared), sinkage 0.58 mm (from repeats of a condition)`.
    pub fn words(&self) -> String {
        let words = self.0.iter().map(|(&channel, sigma)| {
            let unit = ShownUnit::new(channel);
            let sd = number::significant(sigma.sd * unit.factor, 2);
            format!(
                "{} {sd} {} ({})",
                short_name(channel),
                unit.name,
                sigma.source.words()
            )
        });
        words.collect::<Vec<_>>().join(", ")
    }
}

fn fixed_sigma(first: &FinishedCalibration, channel: Channel) -> Option<FixedSigma> {
    let spec = &first.spec;
    let experiment = &spec.experiment;
    let fitted = spec.fit_runs.iter().map(|&i| &experiment.runs[i]);
    let measured = fitted.filter(|run| run.measured[channel.index()].is_some());
    let declared_of_runs: Option<Vec<f64>> = measured.map(|run| run.sd[channel.index()]).collect();
    let of_runs = declared_of_runs.filter(|sds| !sds.is_empty()).map(|sds| {
        let squares: f64 = sds.iter().map(|sd| sd * sd).sum();
        (squares / sds.len() as f64).sqrt()
    });
    let declared = of_runs.or(match experiment.noise.sd[channel.index()] {
        Some(NoiseSd::Known(sd)) => Some(sd),
        _ => None,
    });
    let repeats = || repeat_scatter(experiment, &spec.fit_runs, channel).map(|(sd, _)| sd);
    let inferred = || {
        let name = shared::parameters::noise_parameter(channel);
        let place = spec.parameters.iter().position(|p| p.name == name)?;
        match first.estimate() {
            Some(estimate) => Some(estimate.theta[place]),
            None => inference::diagnostics::mean(&first.draws(place)),
        }
    };
    let from = |source| move |sd| FixedSigma { sd, source };
    declared
        .map(from(SigmaSource::Declared))
        .or_else(|| repeats().map(from(SigmaSource::Repeats)))
        .or_else(|| inferred().map(from(SigmaSource::Inferred)))
        .filter(|sigma| sigma.sd > 0.0)
}

impl ErrorTable {
    /// Returns the table with `rmse_fixed_sigma` computed for the given noise standard deviations.
    #[must_use]
    pub fn in_fixed_sigmas(mut self, sigmas: &FixedSigmas) -> ErrorTable {
        let (mut squares, mut rows) = (0.0, 0);
        for channel in Channel::ALL {
            let sigma = sigmas.get(channel);
            if let Some(error) = self.channel_mut(channel) {
                error.rmse_fixed_sigma = sigma.map(|sigma| error.rmse / sigma.sd);
                if let Some(sigmas) = error.rmse_fixed_sigma {
                    squares += error.runs as f64 * sigmas * sigmas;
                    rows += error.runs;
                }
            }
        }
        self.all.rmse_fixed_sigma = (rows > 0).then(|| (squares / rows as f64).sqrt());
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn a_declared_noise_comes_first_and_an_inferred_one_last() {
        let calibration = fixture::calibration();
        let sigmas = FixedSigmas::new(&calibration);
        let pull = sigmas.get(Channel::DrawbarPull).unwrap();
        assert_eq!((pull.sd, pull.source), (1.0, SigmaSource::Declared));
        // The three fitted measurements have three conditions, so there are no repeats.
        let sinkage = sigmas.get(Channel::Sinkage).unwrap();
        assert_eq!(sinkage.source, SigmaSource::Inferred);
        assert_eq!(sigmas.get(Channel::Torque), None);
        assert!(
            sigmas.words().starts_with("pull 1.0 N (declared), sinkage "),
            "{}",
            sigmas.words()
        );
    }

    #[test]
    fn errors_of_different_calibrations_are_in_the_same_noise() {
        let sigmas = FixedSigmas::new(&fixture::calibration());
        let table = fixture::calibration()
            .comparison()
            .fit
            .clone()
            .unwrap()
            .in_fixed_sigmas(&sigmas);
        let (pull, sinkage) = (table.drawbar_pull.unwrap(), table.sinkage.unwrap());
        assert_eq!(pull.rmse_fixed_sigma, Some(pull.rmse));
        let sum = [pull, sinkage].map(|e| e.runs as f64 * e.rmse_fixed_sigma.unwrap().powi(2));
        let all = ((sum[0] + sum[1]) / (pull.runs + sinkage.runs) as f64).sqrt();
        assert!((table.all.rmse_fixed_sigma.unwrap() - all).abs() < 1e-12);
    }
}
