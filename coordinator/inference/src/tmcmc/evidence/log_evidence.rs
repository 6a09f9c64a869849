//! The log-evidence and its standard error.

use super::bridge::Bridge;
use crate::tmcmc::pool::Pool;

/// The log-evidence so far.
///
/// `ln Z = ln(survivors / draws) + sum_j ln r_j`, with `r_j` the bridge between the pools of stages j - 1 and j.
///
/// Its variance, in first order: each chain has a share of the error of the (one or two) ratios that its pool enters. Chains with
/// a common ancestor are not independent, nor is a chain of its descendants, so the variance sums the squares of the shares of
/// siblings and twice their products with the shares of all later descendants of their common parent (after Chan & Lai 2013). The
/// surviving fraction f of n prior draws adds (1 - f) / (f n).
#[derive(Debug, Clone, Default)]
pub(crate) struct Evidence {
    pub(crate) log: f64,
    /// Variance of the initial estimate: the surviving fraction, or an earlier estimate.
    first_variance: f64,
    pools: Vec<EvidencePool>,
}

/// One pool of states at one tempering exponent.
#[derive(Debug, Clone)]
struct EvidencePool {
    log_likelihoods: Vec<f64>,
    chains: Vec<usize>,
    /// The chain of the pool before that each chain came from; empty for independent draws.
    ancestors: Vec<usize>,
    shares: Vec<f64>,
}

impl Evidence {
    /// Makes an evidence that is known up to an exponent, with its variance.
    pub(crate) fn from_estimate(log: f64, variance: f64) -> Self {
        Self {
            log,
            first_variance: variance,
            pools: Vec::new(),
        }
    }

    /// Accounts for prior draws that the model rejected; returns the logarithm of the surviving fraction.
    pub(crate) fn survive(&mut self, survivors: usize, draws: usize) -> f64 {
        let fraction = survivors as f64 / draws as f64;
        let log = libm::log(fraction);
        self.log += log;
        self.first_variance = (1.0 - fraction) / (fraction * draws as f64);
        log
    }

    /// Adds a pool, at an exponent `step` above the pool before; returns the increment of the log-evidence.
    pub(crate) fn add(&mut self, pool: &Pool, ancestors: Vec<usize>, step: f64) -> f64 {
        let chains = pool.chains.clone();
        let count = chains.iter().max().map_or(0, |max| max + 1);
        let log_likelihoods = pool.log_likelihoods();
        let mut current = EvidencePool {
            log_likelihoods,
            chains,
            ancestors,
            shares: vec![0.0; count],
        };
        let mut increment = 0.0;
        if let Some(before) = self.pools.last_mut() {
            let bridge = Bridge::between(&before.log_likelihoods, &current.log_likelihoods, step);
            for (&chain, error) in before.chains.iter().zip(&bridge.errors_before) {
                before.shares[chain] += error;
            }
            for (&chain, error) in current.chains.iter().zip(&bridge.errors_after) {
                current.shares[chain] += error;
            }
            before.log_likelihoods = Vec::new();
            before.chains = Vec::new();
            increment = bridge.log_ratio;
        }
        self.pools.push(current);
        self.log += increment;
        increment
    }

    pub(crate) fn standard_error(&self) -> f64 {
        let mut variance = self.first_variance;
        for (index, pool) in self.pools.iter().enumerate() {
            // The family of each chain: its siblings and all their descendants.
            let mut family = if pool.ancestors.is_empty() {
                (0..pool.shares.len()).collect()
            } else {
                pool.ancestors.clone()
            };
            let size = family.iter().max().map_or(0, |max| max + 1);
            let mut siblings = vec![0.0; size];
            for (&member, share) in family.iter().zip(&pool.shares) {
                siblings[member] += share;
            }
            let mut descendants = vec![0.0; size];
            for later in &self.pools[index + 1..] {
                family = later.ancestors.iter().map(|&parent| family[parent]).collect();
                for (&member, share) in family.iter().zip(&later.shares) {
                    descendants[member] += share;
                }
            }
            variance += siblings
                .iter()
                .zip(&descendants)
                .map(|(s, d)| s * (s + 2.0 * d))
                .sum::<f64>();
        }
        variance.max(0.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tmcmc::pool::ChainState;
    use statistics::log_likelihood::LogLikelihood;
    use statistics::rng::Stream;

    fn pool(log_likelihoods: &[f64]) -> Pool {
        let mut pool = Pool::default();
        for (chain, &value) in log_likelihoods.iter().enumerate() {
            let log_likelihood = LogLikelihood::new(value).unwrap();
            pool.push(
                chain,
                ChainState {
                    coordinates: Vec::new(),
                    log_prior: 0.0,
                    log_likelihood,
                },
            );
        }
        pool
    }

    /// Prior N(0, 1), l = -x^2 / 2, exponents 0, 1: ln Z = -ln(2) / 2; the standard error matches the scatter.
    #[test]
    fn standard_error_matches_the_scatter_over_replicates() {
        let (count, replicates) = (400, 300);
        let (mut squares, mut variance) = (0.0, 0.0);
        for replicate in 0..replicates {
            let mut stream = Stream::new(3, 0, 0, replicate);
            let prior: Vec<f64> = stream.normals(count).iter().map(|x| -0.5 * x * x).collect();
            let posterior: Vec<f64> = stream.normals(count).iter().map(|x| -0.25 * x * x).collect();
            let mut evidence = Evidence::default();
            evidence.add(&pool(&prior), Vec::new(), 0.0);
            evidence.add(&pool(&posterior), (0..count).collect(), 1.0);
            let error = evidence.log + 0.5 * std::f64::consts::LN_2;
            squares += error * error / replicates as f64;
            variance += evidence.standard_error() * evidence.standard_error() / replicates as f64;
        }
        let ratio = (squares / variance).sqrt();
        assert!((0.85..1.15).contains(&ratio), "{ratio}");
    }

    #[test]
    fn survivors_multiply_the_evidence() {
        let mut evidence = Evidence::default();
        evidence.survive(25, 100);
        // ln(1/4); (1 - 0.25) / (0.25 * 100) = 0.03.
        assert!((evidence.log + 4.0_f64.ln()).abs() < 1e-12);
        assert!((evidence.standard_error() - 0.03_f64.sqrt()).abs() < 1e-12);
    }
}
