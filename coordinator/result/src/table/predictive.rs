//! The posterior predictive distribution of a run and channel, and its components for each draw.

use job::Spec;
use record::Prediction;
use shared::channel::Channel;
use shared::experiment::NoiseSd;
use shared::outcome::Observables;
use shared::parameters::noise_parameter;
use statistics::likelihood::discrepancy_levels;
use statistics::{Discrepancy, ErrorSd};

use super::mixture::{Component, quantile};
use crate::finished_calibration::FinishedCalibration;

/// Posterior predictive distribution of one run and channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Predictive {
    /// Mean of the model over the posterior, or its value at the point that a fit found [channel's unit].
    pub mean: f64,
    /// 5 % and 95 % quantile of a new measurement on a new soil bed in a new condition, with noise, scatter of the soil and discrepancy.
    /// `None` for a fit, which has no distribution.
    pub interval: Option<[f64; 2]>,
    /// Noise standard deviation: declared, its posterior mean, or fitted.
    pub noise_sd: Option<f64>,
    /// Scale of the total error (noise, scatter of the soil, discrepancy): the root mean square over the draws. For normal errors it is
    /// the standard deviation.
    pub error_sd: Option<f64>,
}

/// Returns the source of the noise of a channel in a run.
fn noise_source(calibration: &FinishedCalibration, run: usize, channel: Channel) -> Option<ErrorSd> {
    let spec = &calibration.spec;
    let c = channel.index();
    match (spec.experiment.runs[run].sd[c], spec.experiment.noise.sd[c]) {
        (Some(sd), _) | (None, Some(NoiseSd::Known(sd))) => Some(ErrorSd::Known(sd)),
        (None, Some(NoiseSd::Unknown)) => {
            let name = noise_parameter(channel);
            spec.parameters
                .iter()
                .position(|p| p.name == name)
                .map(|parameter| ErrorSd::Inferred { parameter })
        }
        // The noise is pooled from fitted repeats. Each fitted datum of the channel without its own standard deviation has it.
        (None, Some(NoiseSd::Replicates)) => {
            let shares = |d: &&statistics::Datum| {
                d.channel == c && spec.experiment.runs[spec.fit_runs[d.run]].sd[c].is_none()
            };
            spec.likelihood.data().iter().find(shares).map(|d| d.sd)
        }
        (None, None) => None,
    }
}

/// Returns the predictive distribution of a run and channel; `None` if the model rejects every draw, or half of the draws or more in a
/// holdout run.
pub fn predictive(
    calibration: &FinishedCalibration,
    levels: &Levels,
    run: usize,
    channel: Channel,
) -> Option<Predictive> {
    let refusal = || calibration.refusal(run);
    if calibration.spec.holdout_runs.contains(&run)
        && refusal().is_some_and(|refusal| refusal.is_at_half_or_more())
    {
        return None;
    }
    let draws = new_measurements(calibration, levels, run, channel)?;
    let sds: Vec<f64> = draws.iter().filter_map(|draw| draw.noise_sd).collect();
    let components: Vec<Component> = draws.into_iter().flat_map(|draw| draw.components).collect();
    let values: Vec<(f64, f64)> = components.iter().map(|c| (c.mean, c.weight)).collect();
    let mean = weighted_mean(&values)?;
    let law = calibration.spec.likelihood.law();
    Some(Predictive {
        mean,
        interval: calibration
            .estimate()
            .is_none()
            .then(|| [0.05, 0.95].map(|p| quantile(&components, law, p))),
        noise_sd: inference::diagnostics::mean(&sds),
        error_sd: error_sd(&components),
    })
}

/// Returns the root mean square of the scales; `None` if one of them is unknown.
fn error_sd(components: &[Component]) -> Option<f64> {
    let squares: Option<Vec<(f64, f64)>> = components
        .iter()
        .map(|c| Some((c.scale?.powi(2), c.weight)))
        .collect();
    weighted_mean(&squares?).map(f64::sqrt)
}

/// The prediction of a new measurement by one final draw.
#[derive(Debug, Clone)]
pub struct NewMeasurement {
    /// Number of the draw.
    pub draw: usize,
    /// Standard deviation of the noise only [channel's unit]; `None` if it is unknown.
    pub noise_sd: Option<f64>,
    /// The model's value and the scale of the error, for each value of the discrepancy.
    pub components: Vec<Component>,
}

/// Predictions of new measurements by the final draws of a calibration.
#[derive(Debug)]
pub struct NewMeasurements<'a> {
    calibration: &'a FinishedCalibration,
    levels: Levels,
}

impl<'a> NewMeasurements<'a> {
    /// Prepares predictions of new measurements from a calibration.
    pub fn new(calibration: &'a FinishedCalibration) -> Self {
        let levels = Levels::new(calibration);
        NewMeasurements { calibration, levels }
    }

    /// Predicts a run and channel at each draw that the model accepts.
    ///
    /// # Arguments
    /// - `run`: position in the experiment.
    pub fn at(&self, run: usize, channel: Channel) -> Vec<NewMeasurement> {
        new_measurements(self.calibration, &self.levels, run, channel).unwrap_or_default()
    }
}

/// Predicts new measurements of a run and channel at each accepted draw; `None` for a run that is neither fitted nor held out.
fn new_measurements(
    calibration: &FinishedCalibration,
    levels: &Levels,
    run: usize,
    channel: Channel,
) -> Option<Vec<NewMeasurement>> {
    let spec = &calibration.spec;
    let source = noise_source(calibration, run, channel);
    let place = RunPosition::find(spec, run)?;
    let of_draw = |(draw, theta, observables, position): (usize, &[f64], &Observables, usize)| {
        let noise_sd = source.map(|source| source.at(theta));
        // An external model may not predict the channel.
        let mean = *observables.channel(channel).get(position)?;
        let soil = shared_error(calibration, run, channel, (theta, observables, position));
        let component = |&(m, weight): &(f64, f64)| {
            let scale = noise_sd.map(|sd| widened(sd, [m * sd, soil]));
            Component { mean, scale, weight }
        };
        Some(NewMeasurement {
            draw,
            noise_sd,
            components: levels.0[draw][channel.index()].iter().map(component).collect(),
        })
    };
    Some(accepted(calibration, place).filter_map(of_draw).collect())
}

/// Returns the standard deviation of a channel of a run that the errors cause that runs share [channel's unit].
///
/// # Arguments
/// - `draw`: parameters, observables, position of the run in them.
pub(super) fn shared_error(
    calibration: &FinishedCalibration,
    run: usize,
    channel: Channel,
    (theta, observables, position): (&[f64], &Observables, usize),
) -> f64 {
    let spec = &calibration.spec;
    let radius_m = spec.experiment.wheels[&spec.experiment.runs[run].wheel].radius_m;
    let shifts = spec
        .shared_errors
        .iter()
        .map(|error| error.shift(theta, observables, (channel, position), radius_m));
    shifts.map(|shift| shift * shift).sum::<f64>().sqrt()
}

/// Values of the discrepancy with their posterior probabilities, for each final draw and channel; m = 0 without a discrepancy.
#[derive(Debug)]
pub struct Levels(Vec<[Vec<(f64, f64)>; 4]>);

impl Levels {
    /// Computes the values of every final draw of a calibration.
    pub fn new(calibration: &FinishedCalibration) -> Self {
        let draws = calibration.predictive_draws().iter();
        Levels(draws.map(|draw| Self::at(&calibration.spec, draw)).collect())
    }

    fn at(spec: &Spec, draw: &Prediction) -> [Vec<(f64, f64)>; 4] {
        let discrepancies = spec.likelihood_settings.discrepancies;
        let mut weights = Vec::new();
        if discrepancies.contains(&Discrepancy::Unknown) {
            let values = draw.fit.as_ref().ok().map(|o| spec.predicted_values(o));
            let found = values.and_then(|v| spec.likelihood.discrepancy_weights(&v, &draw.theta).ok());
            weights = found.unwrap_or_default();
        }
        Channel::ALL.map(|channel| match discrepancies[channel.index()] {
            Discrepancy::None => vec![(0.0, 1.0)],
            Discrepancy::Known(m) => vec![(m, 1.0)],
            // Without predictions or fitted data, the posterior of the discrepancy is its prior.
            Discrepancy::Unknown => weights.get(channel.index()).cloned().unwrap_or_else(|| {
                let levels = discrepancy_levels();
                let share = 1.0 / levels.len() as f64;
                levels.into_iter().map(|m| (m, share)).collect()
            }),
        })
    }
}

/// Adds independent errors to a standard deviation; exactly the same value if they are 0.
fn widened(sd: f64, further: [f64; 2]) -> f64 {
    let more: f64 = further.iter().map(|o| o * o).sum();
    if more > 0.0 { (sd * sd + more).sqrt() } else { sd }
}

/// Returns the posterior probabilities of the discrepancy's values for each fitted channel with an unknown discrepancy, averaged over the
/// final draws.
pub fn discrepancy_posterior(calibration: &FinishedCalibration) -> Vec<(Channel, Vec<(f64, f64)>)> {
    let spec = &calibration.spec;
    let is_fitted = |channel: &Channel| {
        let mut data = spec.likelihood.data().iter();
        data.any(|d| d.channel == channel.index())
    };
    let is_unknown =
        |channel: &Channel| spec.likelihood_settings.discrepancies[channel.index()] == Discrepancy::Unknown;
    let unknown = Channel::ALL.into_iter().filter(|c| is_unknown(c) && is_fitted(c));
    let draws = Levels::new(calibration).0;
    let posterior = |channel: Channel| {
        let mut sum: Vec<(f64, f64)> = discrepancy_levels().into_iter().map(|m| (m, 0.0)).collect();
        for levels in &draws {
            for (total, (_, weight)) in sum.iter_mut().zip(&levels[channel.index()]) {
                total.1 += weight / draws.len() as f64;
            }
        }
        (channel, sum)
    };
    unknown.map(posterior).collect()
}

/// Returns the weighted mean; if all weights are 1, bit for bit the plain mean.
fn weighted_mean(values: &[(f64, f64)]) -> Option<f64> {
    let plain = values.iter().all(|(_, weight)| (weight - 1.0).abs() <= 0.0);
    if plain {
        let values: Vec<f64> = values.iter().map(|v| v.0).collect();
        return inference::diagnostics::mean(&values);
    }
    let total: f64 = values.iter().map(|(_, weight)| weight).sum();
    Some(values.iter().map(|(value, weight)| value * weight).sum::<f64>() / total)
}

/// Position of a run in the observables of a final draw.
#[derive(Clone, Copy)]
pub(crate) enum RunPosition {
    Fit(usize),
    Holdout(usize),
}

impl RunPosition {
    /// Finds the position of a run; `None` if it is neither fitted nor held out.
    pub(crate) fn find(spec: &Spec, run: usize) -> Option<Self> {
        let position = |runs: &[usize]| runs.iter().position(|&r| r == run);
        match position(&spec.fit_runs) {
            Some(position) => Some(RunPosition::Fit(position)),
            None => position(&spec.holdout_runs).map(RunPosition::Holdout),
        }
    }
}

/// Returns the final draws that the model accepts: number, parameters, observables, position of the run in the observables.
pub(crate) fn accepted(
    calibration: &FinishedCalibration,
    place: RunPosition,
) -> impl Iterator<Item = (usize, &[f64], &Observables, usize)> {
    let draws = calibration.predictive_draws().iter().enumerate();
    draws.filter_map(move |(number, p)| {
        let (observables, position) = match place {
            RunPosition::Fit(position) => (p.fit.as_ref().ok()?, position),
            RunPosition::Holdout(position) => p.holdout.as_ref()?.run(position).ok()?,
        };
        Some((number, p.theta.as_slice(), observables, position))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_errors_together_are_the_root_mean_square_over_draws_and_discrepancies() {
        let component = |scale, weight| Component {
            mean: 7.0,
            scale,
            weight,
        };
        let both = [component(Some(3.0), 0.25), component(Some(5.0), 0.75)];
        assert!((error_sd(&both).unwrap() - 21.0_f64.sqrt()).abs() < 1e-15);
        assert_eq!(error_sd(&[component(Some(3.0), 1.0), component(None, 1.0)]), None);
        assert_eq!(error_sd(&[]), None);
    }

    #[test]
    fn independent_errors_add_their_squares_and_none_changes_nothing() {
        assert!((widened(3.0, [4.0, 0.0]) - 5.0).abs() < 1e-15);
        assert!((widened(2.0, [3.0, 6.0]) - 7.0).abs() < 1e-15);
        assert_eq!(widened(0.1, [0.0, -0.0]).to_bits(), 0.1_f64.to_bits());
    }
}
