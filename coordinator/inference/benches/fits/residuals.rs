//! The problems that are sums of squares, for the Levenberg-Marquardt fit.

use inference::lm::{LmFit, LmSettings};
use inference::point_estimate::ModeEstimate;
use statistics::{Datum, Distribution, ErrorSd, Likelihood, Marginal, Prior};

use crate::problems::{self, LOG_PRESSURE, SINKAGE};

type Model = fn(&[f64]) -> Vec<f64>;

/// Name, prior, data with their noise, model.
type Case = (&'static str, Prior, Vec<(f64, ErrorSd)>, Model);

fn fitted(prior: &Prior, data: &[(f64, ErrorSd)], model: Model, seeds: u64) -> Vec<ModeEstimate> {
    let data = data.iter().enumerate().map(|(run, &(value, sd))| Datum {
        run,
        channel: 0,
        value,
        sd,
    });
    let likelihood = Likelihood::new(data.collect()).unwrap();
    let fit = |seed| {
        let settings = LmSettings {
            seed,
            ..LmSettings::default()
        };
        let mut fit = LmFit::new(prior.clone(), likelihood.clone(), settings).unwrap();
        while !fit.round().pending().is_empty() {
            for proposal in fit.round().pending().to_vec() {
                fit.tell(proposal.particle, Some(&model(&proposal.theta)))
                    .unwrap();
            }
        }
        fit.estimate().unwrap().clone()
    };
    (1..=seeds).map(fit).collect()
}

/// Prints a line for each; the optimum is the best that any seed found, which for a and b is the problem's own.
pub(crate) fn print(seeds: u64) {
    let unit = |value: f64| (value, ErrorSd::Known(1.0));
    let tau = Distribution::Loguniform {
        lower: 1e-3,
        upper: libm::exp10(0.5),
    };
    let mut bekker = problems::bekker_reparametrised().prior().marginals()[..3].to_vec();
    bekker.push(Marginal::new(tau, None).unwrap());
    let plates: Vec<(f64, ErrorSd)> = LOG_PRESSURE
        .iter()
        .map(|&value| (value, ErrorSd::Inferred { parameter: 3 }))
        .collect();
    let cases: [Case; 3] = [
        (
            "a",
            problems::correlated_gaussian().prior(),
            vec![unit(0.0); 5],
            problems::whitened,
        ),
        (
            "b",
            problems::shear_building().prior(),
            vec![unit(0.0); 2],
            problems::frequency_residuals,
        ),
        ("c5'", Prior::new(bekker), plates, |theta| {
            SINKAGE
                .iter()
                .map(|&z| theta[0] * std::f64::consts::LN_10 + theta[2] * (libm::log(z) - libm::log(0.025)))
                .collect()
        }),
    ];
    for (name, prior, data, model) in cases {
        let runs = fitted(&prior, &data, model, seeds);
        let best = runs
            .iter()
            .fold(f64::NEG_INFINITY, |best, run| best.max(run.log_posterior()));
        super::row(name, "lm", best, &runs);
    }
}
