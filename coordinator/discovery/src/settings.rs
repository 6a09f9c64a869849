//! Settings of a search.

/// Where the fit of the base begins.
#[derive(Debug, Clone, PartialEq)]
pub enum Starts {
    /// At the best of these parameter vectors, for example draws of a posterior.
    Draws(Vec<Vec<f64>>),
    /// At the best of so many points that fill the prior evenly.
    Even(usize),
}

/// How a model's predictions follow its parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Roughness {
    /// Smoothly.
    Smooth,
    /// In jumps, as on a grid that the contact crosses node by node.
    Rough,
    /// As the scatter says where it is measured: smoothly where that is negligible beside the noise of all data, in jumps otherwise.
    Unknown,
}

impl Roughness {
    /// Shortest finite difference, in standard deviations of the prior; shorter ones show the jumps.
    pub(crate) fn least_difference(self) -> f64 {
        match self {
            Self::Smooth => 0.03,
            Self::Rough | Self::Unknown => 0.15,
        }
    }

    /// A step of a fit that is predicted to gain less ends its trials \[nats\]: the log-likelihood of a rough model scatters by more.
    pub(crate) fn least_gain(self) -> f64 {
        match self {
            Self::Smooth => 0.01,
            Self::Rough | Self::Unknown => 0.2,
        }
    }

    /// A step that gains less is taken and counts as rejected \[nats\].
    pub(crate) fn least_counted_gain(self) -> f64 {
        match self {
            Self::Smooth => 0.0,
            Self::Rough | Self::Unknown => self.least_gain(),
        }
    }

    /// Rejected steps in a row that end the trials.
    pub(crate) fn most_failures(self) -> usize {
        match self {
            Self::Smooth => 4,
            Self::Rough | Self::Unknown => 3,
        }
    }
}

/// Settings of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchSettings {
    /// Where the fit of the base begins.
    pub starts: Starts,
    /// Seed of the draws.
    pub seed: u64,
    /// How the model's predictions follow its parameters: a rough model is searched by long differences and fewer fits.
    pub roughness: Roughness,
    /// Whether the scatter of the model's predictions is measured, and counted as noise.
    pub has_numerical_noise: bool,
    /// Whether a rough model has a companion: a cheap, smooth one of the same parameters, whose differences stand for the model's.
    pub has_companion: bool,
}

impl Default for SearchSettings {
    /// 32 starts that fill the prior, seed 1, for a smooth model without numerical noise.
    fn default() -> Self {
        Self {
            starts: Starts::Even(32),
            seed: 1,
            roughness: Roughness::Smooth,
            has_numerical_noise: false,
            has_companion: false,
        }
    }
}
