//! Priors, likelihoods and runs that several tests share.

use inference::lm::LmFit;
use inference::{Sampler, TmcmcSettings};
use statistics::rng::Stream;
use statistics::{Datum, Distribution, ErrorSd, Likelihood, LogLikelihood, Marginal, Prior};

pub(crate) fn marginal(distribution: Distribution) -> Marginal {
    Marginal::new(distribution, None).unwrap()
}

pub(crate) fn uniform(lower: f64, upper: f64) -> Marginal {
    marginal(Distribution::Uniform { lower, upper })
}

pub(crate) fn normal(mean: f64, sd: f64) -> Marginal {
    marginal(Distribution::Normal { mean, sd })
}

pub(crate) fn lognormal(median: f64, factor: f64) -> Marginal {
    marginal(Distribution::Lognormal { median, factor })
}

/// Independent standard normal parameters.
pub(crate) fn standard_normals(count: usize) -> Prior {
    Prior::new(vec![normal(0.0, 1.0); count])
}

/// Returns two standard normal parameters with this correlation.
pub(crate) fn correlated_pair(rho: f64) -> Prior {
    standard_normals(2)
        .correlated(vec![0, 1], &[vec![1.0, rho], vec![rho, 1.0]])
        .unwrap()
}

/// One datum of each run, with the sd of its number.
pub(crate) fn data(values: &[f64], sd: impl Fn(usize) -> ErrorSd) -> Likelihood {
    let datum = |(run, &value): (usize, &f64)| Datum {
        run,
        channel: 0,
        value,
        sd: sd(run),
    };
    Likelihood::new(values.iter().enumerate().map(datum).collect()).unwrap()
}

/// Shuffles a round by its number.
pub(crate) fn shuffle<T>(items: &mut [T], seed: u64, round: u64) {
    let mut stream = Stream::new(seed, 0, 0, round);
    for last in (1..items.len()).rev() {
        items.swap(last, stream.below(last + 1));
    }
}

/// Runs a fit to its end, each round's results told in an order of its own.
pub(crate) fn end(
    mut fit: LmFit,
    model: impl Fn(&[f64]) -> Option<Vec<f64>>,
    order: impl Fn(u64, &mut Vec<usize>),
) -> LmFit {
    while !fit.round().pending().is_empty() {
        let pending = fit.round().pending().to_vec();
        let mut indices: Vec<usize> = (0..pending.len()).collect();
        order(fit.round().number(), &mut indices);
        for k in indices {
            let proposal = &pending[k];
            fit.tell(proposal.particle, model(&proposal.theta).as_deref())
                .unwrap();
        }
    }
    fit
}

/// Runs a sampler to its end.
pub(crate) fn sample(prior: Prior, settings: TmcmcSettings, score: impl Fn(&[f64]) -> f64) -> Sampler {
    let mut sampler = Sampler::new(prior, settings).unwrap();
    while !sampler.round().pending().is_empty() {
        for proposal in sampler.round().pending().to_vec() {
            let value = LogLikelihood::new(score(&proposal.theta)).unwrap();
            sampler.tell(proposal.particle, value).unwrap();
        }
    }
    sampler
}
