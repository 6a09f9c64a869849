//! The settings of a search: its starts, its seed, and properties of the model.

/// The starts of the base's fit.
#[derive(Debug, Clone, PartialEq)]
pub enum Starts {
    /// The best of these parameter vectors, for example draws of a posterior.
    Draws(Vec<Vec<f64>>),
    /// The best of this number of points that fill the prior evenly.
    Even(usize),
}

/// Whether a model's predictions are a smooth function of its parameters, or carry numerical noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Smoothness {
    /// The predictions are smooth.
    Smooth,
    /// The predictions jump, as on a grid whose nodes enter and leave the contact.
    Rough,
    /// The measured scatter decides: the model is smooth if it is negligible beside the noise of all data.
    Unknown,
}

impl Smoothness {
    /// Returns the shortest finite difference, in standard deviations of the prior; shorter ones resolve the jumps.
    pub(crate) fn min_difference(self) -> f64 {
        match self {
            Self::Smooth => 0.03,
            Self::Rough | Self::Unknown => 0.15,
        }
    }

    /// Returns a fit ends its trial steps when the predicted gain is smaller \[nats\]; the log-likelihood of a rough model has
    /// more noise.
    pub(crate) fn min_gain(self) -> f64 {
        match self {
            Self::Smooth => 0.01,
            Self::Rough | Self::Unknown => 0.2,
        }
    }

    /// Returns a step that gains less is accepted, but counts as rejected \[nats\].
    pub(crate) fn min_counted_gain(self) -> f64 {
        match self {
            Self::Smooth => 0.0,
            Self::Rough | Self::Unknown => self.min_gain(),
        }
    }

    /// Returns the number of consecutive rejected steps that ends the trials.
    pub(crate) fn max_failures(self) -> usize {
        match self {
            Self::Smooth => 4,
            Self::Rough | Self::Unknown => 3,
        }
    }
}

/// Settings of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchSettings {
    /// The starts of the base's fit.
    pub starts: Starts,
    /// Seed of all random draws.
    pub seed: u64,
    /// Whether the model is rough; a rough model is searched with longer differences and fewer fits.
    pub smoothness: Smoothness,
    /// Whether the numerical noise is measured and added to the noise of the data.
    pub has_numerical_noise: bool,
    /// Whether a rough model has a low-fidelity model: a cheap, smooth one with the same parameters, used as a control variate.
    pub has_low_fidelity: bool,
}

impl Default for SearchSettings {
    /// Returns 32 starts that fill the prior, seed 1, for a smooth model without numerical noise.
    fn default() -> Self {
        Self {
            starts: Starts::Even(32),
            seed: 1,
            smoothness: Smoothness::Smooth,
            has_numerical_noise: false,
            has_low_fidelity: false,
        }
    }
}
