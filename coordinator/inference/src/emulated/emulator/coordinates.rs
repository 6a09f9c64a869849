//! The coordinates of the model's parameters in which an emulator is fitted.

use statistics::prior::Prior;

/// The coordinates of the model's parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum EmulatorCoordinates {
    /// The coordinates of the sampler are ln x for log-uniform and lognormal parameters, else x. Outputs at an end of a prior are
    /// smooth in them.
    Sampling,
    /// Independent normal scores. Outputs that change fast near an end of a prior, as at the border of what a model accepts, are
    /// smoother here.
    NormalScores,
}

impl EmulatorCoordinates {
    /// Both kinds.
    pub(crate) const ALL: [Self; 2] = [Self::Sampling, Self::NormalScores];

    /// Returns the coordinates of the first `count` parameters.
    pub(crate) fn coordinates(self, prior: &Prior, theta: &[f64], count: usize) -> Vec<f64> {
        let mut coordinates = match self {
            Self::Sampling => prior.coordinates(theta),
            Self::NormalScores => {
                let pairs = prior.marginals().iter().zip(theta);
                let mut scores: Vec<f64> = pairs.map(|(marginal, &x)| marginal.normal_score(x)).collect();
                prior.make_independent(&mut scores);
                scores
            }
        };
        coordinates.truncate(count);
        coordinates
    }
}
