//! The sampler under a correlated prior against the conjugate normal.

use inference::{Sampler, TmcmcSettings};
use statistics::{Distribution, LogLikelihood, Marginal, Prior};

/// A normal prior N(0, R) and one datum d of a + b with sd e: the posterior is normal, the evidence N(d; 0, 2 (1 + rho) + e^2).
#[test]
fn a_correlated_prior_is_updated_as_on_paper() {
    let (rho, datum, sd): (f64, f64, f64) = (0.9, 3.0, 0.5);
    let normal = Marginal::new(Distribution::Normal { mean: 0.0, sd: 1.0 }, None).unwrap();
    let prior = Prior::new(vec![normal.clone(), normal])
        .correlated(vec![0, 1], &[vec![1.0, rho], vec![rho, 1.0]])
        .unwrap();
    let settings = TmcmcSettings {
        particles: 2000,
        seed: 4,
        ..TmcmcSettings::default()
    };
    let mut sampler = Sampler::new(prior, settings).unwrap();
    while !sampler.round().pending().is_empty() {
        for proposal in sampler.round().pending().to_vec() {
            let z = (datum - proposal.theta[0] - proposal.theta[1]) / sd;
            let value = -0.5 * z * z - 0.5 * libm::log(std::f64::consts::TAU * sd * sd);
            sampler
                .tell(proposal.particle, LogLikelihood::new(value).unwrap())
                .unwrap();
        }
    }
    let posterior = sampler.posterior().unwrap();
    // a and b each covary with the sum by 1 + rho
    let variance = 2.0 * (1.0 + rho) + sd * sd;
    let mean = (1.0 + rho) * datum / variance;
    let spread = (1.0 - (1.0 + rho) * (1.0 + rho) / variance).sqrt();
    let evidence = -0.5 * datum * datum / variance - 0.5 * libm::log(std::f64::consts::TAU * variance);
    let difference = (2.0 * (1.0 - rho)).sqrt();
    let n = posterior.particles.len() as f64;
    let moments = |f: &dyn Fn(&[f64]) -> f64| {
        let values: Vec<f64> = posterior.particles.iter().map(|p| f(&p.theta)).collect();
        let mean = values.iter().sum::<f64>() / n;
        let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n;
        (mean, variance.sqrt())
    };
    for parameter in [0, 1] {
        let (got, sd) = moments(&|theta| theta[parameter]);
        assert!((got - mean).abs() < 0.15 * spread, "{got} {mean}");
        assert!((sd / spread - 1.0).abs() < 0.1, "{sd} {spread}");
    }
    // the datum says nothing of a - b, whose sd the correlation alone gives
    let (_, sd) = moments(&|theta| theta[0] - theta[1]);
    assert!((sd / difference - 1.0).abs() < 0.1, "{sd} {difference}");
    assert!(
        (posterior.log_evidence - evidence).abs() < 0.2,
        "{}",
        posterior.log_evidence
    );
}
