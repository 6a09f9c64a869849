//! The mixture of proposals of a stage: random walk, differential evolution, autoregressive jumps.

use super::covariance::CovarianceFactor;
use statistics::rng::Stream;

/// Number of attempts to draw two different members of the frozen population before a random-walk step is taken instead.
const PAIR_TRIES: usize = 8;

/// Share of differential-evolution steps whose length is the full difference, which jump between modes.
const FULL_DIFFERENCES: f64 = 0.2;

/// sd of ln(length): steps of many lengths suit targets whose width varies.
const LENGTH_SPREAD: f64 = 0.7;

/// Share of autoregressive jumps. On a nearly normal target they mix many times faster than a random walk; a larger share
/// mixes worse in a funnel, because jumps miss its neck.
const JUMPS: f64 = 0.1;

/// Weight of the new deviation in a jump; the weight of the old deviation is sqrt(1 - 0.9^2).
const JUMP_NOVELTY: f64 = 0.9;

/// A mixture of proposals, fixed for a stage.
#[derive(Debug, Clone)]
pub(crate) struct ProposalMixture {
    /// Mean and covariance of the pool that the stage began with.
    pub(crate) factor: CovarianceFactor,
    /// Members for differential evolution; empty for a pure random walk.
    pub(crate) frozen: Vec<Vec<f64>>,
}

/// A proposed state.
#[derive(Debug, Clone)]
pub(crate) struct ProposedMove {
    /// The proposed coordinates.
    pub(crate) coordinates: Vec<f64>,
    /// True if its length is proportional to the scale.
    pub(crate) scaled: bool,
    /// ln q(from | candidate) - ln q(candidate | from).
    pub(crate) log_correction: f64,
}

impl ProposalMixture {
    /// Draws a candidate, with m and C the weighted mean and covariance of the pool at the start of the stage.
    ///
    /// - 10 %: autoregressive, `m + sqrt(1 - 0.81) (x - m) + 0.9 N(0, C)` (reversible for N(m, C); Neal
    ///   1999);
    /// - 45 %: random walk, `x + s N(0, C)`;
    /// - 45 %: differential evolution, `x + s / sqrt(2) (a - b)` with members a, b of the frozen population,
    ///   or `x + (a - b)` in one of five (ter Braak 2006).
    ///
    /// s is `scale` times a lognormal factor. Without frozen members: the random walk, s = `scale`.
    ///
    /// # Source
    /// ter Braak 2006, Stat. Comput. 16:239, doi:10.1007/s11222-006-8769-1.
    pub(crate) fn candidate(&self, from: &[f64], scale: f64, stream: &mut Stream) -> ProposedMove {
        if self.frozen.is_empty() {
            return self.walk(from, scale, stream);
        }
        if stream.uniform() < JUMPS
            && let Some(jump) = self.jump(from, stream)
        {
            return jump;
        }
        let scale = scale * libm::exp(LENGTH_SPREAD * stream.normal_pair().0);
        if stream.uniform() < 0.5
            && let Some(difference) = self.difference(from, scale, stream)
        {
            return difference;
        }
        self.walk(from, scale, stream)
    }

    /// Returns `None` if the covariance is singular.
    fn jump(&self, from: &[f64], stream: &mut Stream) -> Option<ProposedMove> {
        let old = self.factor.whiten(from)?;
        let kept = (1.0 - JUMP_NOVELTY * JUMP_NOVELTY).sqrt();
        let normals = stream.normals(old.len());
        let new: Vec<f64> = old
            .iter()
            .zip(&normals)
            .map(|(w, z)| kept * w + JUMP_NOVELTY * z)
            .collect();
        let half_square = |w: &[f64]| 0.5 * w.iter().map(|x| x * x).sum::<f64>();
        let log_correction = half_square(&new) - half_square(&old);
        let coordinates = self.factor.colour(&new);
        Some(ProposedMove {
            coordinates,
            scaled: false,
            log_correction,
        })
    }

    /// Returns `None` if no two different members are found.
    fn difference(&self, from: &[f64], scale: f64, stream: &mut Stream) -> Option<ProposedMove> {
        let full = stream.uniform() < FULL_DIFFERENCES;
        let gamma = if full {
            1.0
        } else {
            scale * std::f64::consts::FRAC_1_SQRT_2
        };
        for _ in 0..PAIR_TRIES {
            let first = &self.frozen[stream.below(self.frozen.len())];
            let second = &self.frozen[stream.below(self.frozen.len())];
            if first != second {
                let pairs = first.iter().zip(second);
                let coordinates = from
                    .iter()
                    .zip(pairs)
                    .map(|(u, (a, b))| u + gamma * (a - b))
                    .collect();
                return Some(ProposedMove {
                    coordinates,
                    scaled: !full,
                    log_correction: 0.0,
                });
            }
        }
        None
    }

    fn walk(&self, from: &[f64], scale: f64, stream: &mut Stream) -> ProposedMove {
        let step = self.factor.spread(&stream.normals(from.len()));
        let coordinates = from.iter().zip(&step).map(|(u, step)| u + scale * step).collect();
        ProposedMove {
            coordinates,
            scaled: true,
            log_correction: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identical_members_fall_back_to_the_random_walk() {
        let states: [&[f64]; 2] = [&[0.0], &[2.0]];
        let factor = CovarianceFactor::new(&states, &[0.5, 0.5]);
        let mixture = ProposalMixture {
            factor,
            frozen: vec![vec![1.0]; 4],
        };
        for particle in 0..50 {
            let candidate = mixture.candidate(&[1.0], 1.0, &mut Stream::new(1, 0, particle, 0));
            assert!((candidate.coordinates[0] - 1.0).abs() > 0.0);
        }
    }

    /// Checks `q(x' | x) N(x) = q(x | x') N(x')`: a jump is always accepted on the normal target of the pool.
    #[test]
    fn the_jump_is_reversible_for_the_pool_s_normal() {
        let states: [&[f64]; 4] = [&[0.0, 1.0], &[2.0, 3.5], &[1.0, 0.0], &[5.0, 6.0]];
        let factor = CovarianceFactor::new(&states, &[0.25; 4]);
        let mixture = ProposalMixture {
            factor,
            frozen: vec![vec![1.0, 1.0]; 4],
        };
        let from = [0.3, 4.0];
        let jump = mixture.jump(&from, &mut Stream::new(1, 0, 0, 0)).unwrap();
        let log_normal = |x: &[f64]| {
            -0.5 * mixture
                .factor
                .whiten(x)
                .unwrap()
                .iter()
                .map(|w| w * w)
                .sum::<f64>()
        };
        let ratio = log_normal(&jump.coordinates) - log_normal(&from) + jump.log_correction;
        assert!(ratio.abs() < 1e-9, "{ratio}");
    }
}
