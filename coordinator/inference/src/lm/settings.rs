//! The settings of a fit, and their errors.

use super::stencil::Sides;
use crate::tmcmc::MAX_PARTICLES;

/// Settings of a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LmSettings {
    /// Points of the first round: the prior mean, then prior draws.
    pub starts: usize,
    /// Maximum number of evaluations of all rounds together.
    pub max_evaluations: usize,
    /// Number of draws from the normal approximation about the result; 0 gives a point estimate alone.
    pub draws: usize,
    /// Shortest step of the differences, in units of the prior's width: its standard deviation, or that of a uniform
    /// density between its bounds where these are closer.
    ///
    /// The error of a difference over h is the model's curvature times h/2 plus its noise times 2/h. A model on a grid has noise
    /// of about 0.3 % of a force; over one width of its prior an influential parameter changes a force by a third or more, so 2 %
    /// of a width changes it by twice the noise: enough for the direction of descent from dozens of data. It is not enough where
    /// parameters can compensate each other: there the noise looks like information. So once the parabola gives the uncertainty
    /// of a parameter, steps grow to a quarter of it and, for the last Jacobian, to all of it, taken to both sides; to at most
    /// ten times the setting. Checked by `lm::a_model_with_the_noise_of_a_grid_is_fitted_within_its_uncertainty`.
    pub difference_step: f64,
    /// Seed of the prior draws.
    pub seed: u64,
    /// The fit has converged when a step decreases f, or can decrease it, by no more than this share of 1 + |f|.
    pub decrease_tolerance: f64,
    /// The fit takes no steps shorter than this, in units of the prior's width.
    pub step_tolerance: f64,
}

impl Default for LmSettings {
    /// Returns 5 starts, 200 evaluations, 1000 draws, differences over 2 % of the prior's width, seed 1, tolerances 1e-6 and
    /// 1e-4.
    fn default() -> Self {
        Self {
            starts: 5,
            max_evaluations: 200,
            draws: 1000,
            difference_step: 0.02,
            seed: 1,
            decrease_tolerance: 1e-6,
            step_tolerance: 1e-4,
        }
    }
}

/// Minimum number of draws, because their quantiles are the intervals.
const MIN_DRAWS: usize = 20;

/// Largest ratio of a difference's length, which grows with the uncertainty, to the stated length.
const LONGER: f64 = 10.0;
/// Length of a one-sided difference as a share of the uncertainty: short, because the model's curvature biases it.
const SHARE_TO_ONE_SIDE: f64 = 0.25;

/// A setting outside its bounds.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum LmSettingsError {
    /// The prior has no parameters.
    #[error("the prior has no parameters")]
    NoParameters,
    /// The fit has no start.
    #[error("starts = 0 is below 1")]
    NoStart,
    /// The budget does not suffice for a first step.
    #[error(
        "max_evaluations = {max_evaluations} is below {min}: {starts} starts, {dimension} differences and one step"
    )]
    TooFewEvaluations {
        /// The budget as given.
        max_evaluations: usize,
        /// The smallest possible budget.
        min: usize,
        /// Number of starts.
        starts: usize,
        /// Number of parameters.
        dimension: usize,
    },
    /// The budget is too large.
    #[error(
        "max_evaluations = {max_evaluations} is above {}",
        LmSettings::MAX_EVALUATIONS
    )]
    TooManyEvaluations {
        /// The budget as given.
        max_evaluations: usize,
    },
    /// The step of the differences is not in (0, 0.5].
    #[error(
        "difference_step = {value} prior widths is not above 0 and at most {}",
        LmSettings::MAX_DIFFERENCE_STEP
    )]
    DifferenceStep {
        /// The step as given.
        value: f64,
    },
    /// The draws are too few for an interval.
    #[error("particles = {draws} must be 0 or at least {MIN_DRAWS}")]
    TooFewDraws {
        /// The draws as given.
        draws: usize,
    },
    /// The number of draws exceeds what a store should keep.
    #[error("particles = {draws} must be at most {MAX_PARTICLES}")]
    TooManyDraws {
        /// The draws as given.
        draws: usize,
    },
    /// A tolerance is not a finite number above 0.
    #[error("{name} = {value} is not a finite number above 0")]
    Tolerance {
        /// Name of the setting.
        name: &'static str,
        /// The tolerance as given.
        value: f64,
    },
}

impl LmSettings {
    /// Largest number of evaluations of a fit.
    pub const MAX_EVALUATIONS: usize = 1_000_000;
    /// Longest difference: a step to one side always fits between the bounds.
    pub const MAX_DIFFERENCE_STEP: f64 = 0.5;

    /// Returns the step of a difference along an axis with this uncertainty, if it is known; both in prior widths.
    pub(super) fn difference(&self, sides: Sides, uncertainty: Option<f64>) -> f64 {
        let share = match sides {
            Sides::One => SHARE_TO_ONE_SIDE,
            Sides::Both => 1.0,
        };
        let longest = (LONGER * self.difference_step).min(Self::MAX_DIFFERENCE_STEP);
        uncertainty.map_or(self.difference_step, |sd| {
            (share * sd).min(longest).max(self.difference_step)
        })
    }

    /// Checks the settings for a prior of `dimension` parameters.
    ///
    /// # Errors
    /// [`LmSettingsError`] with the setting, its value and its bound.
    pub fn check(&self, dimension: usize) -> Result<(), LmSettingsError> {
        let &Self {
            starts,
            max_evaluations,
            difference_step: value,
            ..
        } = self;
        let min = starts.saturating_add(dimension + 1);
        if dimension == 0 {
            return Err(LmSettingsError::NoParameters);
        }
        if starts == 0 {
            return Err(LmSettingsError::NoStart);
        }
        if max_evaluations < min {
            return Err(LmSettingsError::TooFewEvaluations {
                max_evaluations,
                min,
                starts,
                dimension,
            });
        }
        if max_evaluations > Self::MAX_EVALUATIONS {
            return Err(LmSettingsError::TooManyEvaluations { max_evaluations });
        }
        if (1..MIN_DRAWS).contains(&self.draws) {
            return Err(LmSettingsError::TooFewDraws { draws: self.draws });
        }
        if self.draws > MAX_PARTICLES {
            return Err(LmSettingsError::TooManyDraws { draws: self.draws });
        }
        if !(value > 0.0 && value <= Self::MAX_DIFFERENCE_STEP) {
            return Err(LmSettingsError::DifferenceStep { value });
        }
        for (name, value) in [
            ("decrease_tolerance", self.decrease_tolerance),
            ("step_tolerance", self.step_tolerance),
        ] {
            if !(value.is_finite() && value > 0.0) {
                return Err(LmSettingsError::Tolerance { name, value });
            }
        }
        Ok(())
    }
}
