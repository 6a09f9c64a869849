//! The first round: points that are spread over the prior.

use statistics::prior::normal::lower_quantile;
use statistics::rng::Stream;

use super::sampler::EmulatedSampler;

/// Points of the first round for each parameter of the model, and beside these.
const DESIGN_POINTS: [usize; 2] = [6, 4];

impl EmulatedSampler {
    /// Returns points that cover the prior evenly: a Latin hypercube of prior quantiles.
    pub(super) fn design(&self) -> Vec<Vec<f64>> {
        let count = DESIGN_POINTS[0] * self.model_parameters + DESIGN_POINTS[1];
        let count = count.max(self.settings.batch);
        let mut scores = vec![vec![0.0; self.prior.dimension()]; count];
        for parameter in 0..self.prior.dimension() {
            let mut stream = Stream::new(self.settings.seed, 0, parameter as u64, 0);
            let mut order: Vec<usize> = (0..count).collect();
            for i in (1..count).rev() {
                order.swap(i, stream.below(i + 1));
            }
            for (row, place) in scores.iter_mut().zip(order) {
                let share = (place as f64 + stream.uniform()) / count as f64;
                row[parameter] = normal_quantile(share);
            }
        }
        for row in &mut scores {
            self.prior.make_dependent(row);
        }
        let theta = |row: Vec<f64>| {
            let pairs = self.prior.marginals().iter().zip(row);
            pairs.map(|(marginal, z)| marginal.from_normal_score(z)).collect()
        };
        scores.into_iter().map(theta).collect()
    }
}

fn normal_quantile(share: f64) -> f64 {
    if share <= 0.5 {
        lower_quantile(share)
    } else {
        -lower_quantile(1.0 - share)
    }
}
