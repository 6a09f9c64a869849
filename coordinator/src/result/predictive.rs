//! The posterior predictive distribution of every run and channel.

use inference::Sd;
use shared::channel::Channel;
use shared::experiment::NoiseSd;
use shared::outcome::Observables;
use shared::parameters::noise_parameter;

use super::Outcome;

/// What the calibrated model predicts for one run and channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Predictive {
    /// Mean of the model over the posterior, or its value at the point that a fit found [channel's unit].
    pub mean: f64,
    /// 5 % and 95 % quantile of a new measurement: model and noise. `None` of a fit, which has no distribution.
    pub interval: Option<[f64; 2]>,
    /// Noise standard deviation: declared, its posterior mean, or fitted.
    pub noise_sd: Option<f64>,
}

/// Where the noise sd of a channel of a run stands.
fn noise_source(outcome: &Outcome, run: usize, channel: Channel) -> Option<Sd> {
    let spec = &outcome.spec;
    let c = channel.index();
    match (spec.experiment.runs[run].sd[c], spec.experiment.noise.sd[c]) {
        (Some(sd), _) | (None, Some(NoiseSd::Known(sd))) => Some(Sd::Known(sd)),
        (None, Some(NoiseSd::Unknown)) => {
            let name = noise_parameter(channel);
            spec.parameters
                .iter()
                .position(|p| p.name == name)
                .map(|parameter| Sd::Inferred { parameter })
        }
        // Pooled from the fitted repeats: every fitted datum of the channel without an sd of its own has it.
        (None, Some(NoiseSd::Replicates)) => {
            let shares = |d: &&inference::Datum| {
                d.channel == c && spec.experiment.runs[spec.fit_runs[d.run]].sd[c].is_none()
            };
            spec.likelihood.data().iter().find(shares).map(|d| d.sd)
        }
        (None, None) => None,
    }
}

/// The predictive distribution of a run and channel; `None` where every draw was refused.
pub(super) fn predictive(outcome: &Outcome, run: usize, channel: Channel) -> Option<Predictive> {
    let source = noise_source(outcome, run, channel);
    let spec = &outcome.spec;
    let position = |runs: &[usize]| runs.iter().position(|&r| r == run);
    let place = match position(&spec.fit_runs) {
        Some(position) => Place::Fit(position),
        None => Place::Holdout(position(&spec.holdout_runs)?),
    };
    let draws: Vec<(f64, Option<f64>)> = accepted(outcome, place)
        .map(|(theta, observables, position)| {
            let sd = source.map(|s| match s {
                Sd::Known(sd) => sd,
                Sd::Inferred { parameter } => theta[parameter],
            });
            (observables.channel(channel)[position], sd)
        })
        .collect();
    let values: Vec<f64> = draws.iter().map(|d| d.0).collect();
    let mean = inference::diagnostics::mean(&values)?;
    let sds: Vec<f64> = draws.iter().filter_map(|d| d.1).collect();
    Some(Predictive {
        mean,
        interval: outcome
            .estimate
            .is_none()
            .then(|| [0.05, 0.95].map(|p| mixture_quantile(&draws, p))),
        noise_sd: inference::diagnostics::mean(&sds),
    })
}

/// Where a run stands in the observables of a final draw.
#[derive(Clone, Copy)]
enum Place {
    Fit(usize),
    Holdout(usize),
}

/// The final draws that the model took.
fn accepted(outcome: &Outcome, place: Place) -> impl Iterator<Item = (&[f64], &Observables, usize)> {
    outcome.predictive_draws().iter().filter_map(move |p| {
        let (result, position) = match place {
            Place::Fit(position) => (&p.fit, position),
            Place::Holdout(position) => (p.holdout.as_ref()?, position),
        };
        let observables = result.as_ref().ok()?;
        Some((p.theta.as_slice(), observables, position))
    })
}

/// Quantile of an equal mixture of normals by bisection; without noise, of the values themselves.
fn mixture_quantile(draws: &[(f64, Option<f64>)], p: f64) -> f64 {
    let cdf = |y: f64| {
        let sum: f64 = draws
            .iter()
            .map(|&(mean, sd)| match sd {
                Some(sd) => 0.5 * libm::erfc((mean - y) / (sd * std::f64::consts::SQRT_2)),
                None => f64::from(u8::from(mean <= y)),
            })
            .sum();
        sum / draws.len() as f64
    };
    let spread = |sign: f64| {
        draws
            .iter()
            .map(move |&(mean, sd)| mean + sign * 10.0 * sd.unwrap_or(0.0))
    };
    let mut low = spread(-1.0).fold(f64::INFINITY, f64::min);
    let mut high = spread(1.0).fold(f64::NEG_INFINITY, f64::max);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if cdf(middle) < p {
            low = middle
        } else {
            high = middle
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::mixture_quantile;

    #[test]
    fn quantiles_of_one_normal_are_the_normal_s() {
        let draws = [(3.0, Some(2.0)); 5];
        assert!((mixture_quantile(&draws, 0.95) - (3.0 + 2.0 * 1.644_853_627)).abs() < 1e-6);
        assert!((mixture_quantile(&draws, 0.05) - (3.0 - 2.0 * 1.644_853_627)).abs() < 1e-6);
    }

    #[test]
    fn a_wide_mixture_is_wider_than_its_parts() {
        let draws = [(-5.0, Some(1.0)), (5.0, Some(1.0))];
        assert!(mixture_quantile(&draws, 0.95) > 5.0);
        assert!(mixture_quantile(&draws, 0.05) < -5.0);
    }
}
