//! Settings of a search.

/// Where the fit of the base begins.
#[derive(Debug, Clone, PartialEq)]
pub enum Starts {
    /// At the best of these parameter vectors, for example draws of a posterior.
    Draws(Vec<Vec<f64>>),
    /// At the best of so many points that fill the prior evenly.
    Even(usize),
}

/// Settings of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchSettings {
    /// Where the fit of the base begins.
    pub starts: Starts,
    /// Seed of the draws.
    pub seed: u64,
    /// Shortest finite difference, in standard deviations of the prior; shorter ones show the roughness of a model on a grid.
    pub least_difference: f64,
    /// Whether the scatter of the model's predictions is measured, and counted as noise.
    pub has_numerical_noise: bool,
}

impl Default for SearchSettings {
    /// 32 starts that fill the prior, seed 1, differences for a smooth model, without numerical noise.
    fn default() -> Self {
        Self {
            starts: Starts::Even(32),
            seed: 1,
            least_difference: 0.03,
            has_numerical_noise: false,
        }
    }
}
