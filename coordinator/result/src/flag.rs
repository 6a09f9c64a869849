//! Flags: warnings about a result, and their kinds.

use crate::diagnostics::trends::TrendVariable;
use crate::words::data_channel::DataChannel;

/// A warning about a result.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Flag {
    /// Kind of the flag.
    #[schema(value_type = String)]
    pub kind: FlagKind,
    /// Channel that the flag is about.
    #[schema(value_type = Option<String>)]
    pub channel: Option<DataChannel>,
    /// Condition that the residuals follow.
    #[schema(value_type = Option<String>)]
    pub against: Option<TrendVariable>,
    /// Probability of the observation if nothing were wrong.
    pub p: Option<f64>,
    /// Meaning of the flag in words.
    pub text: String,
}

/// Kind of a flag.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FlagKind {
    /// Residuals follow a condition of the runs.
    Trend,
    /// Residuals are larger than the assumed errors explain.
    Chi2,
    /// One residual is larger than chance allows.
    Outlier,
    /// Data and prior contradict each other.
    Conflict,
    /// A parameter lies at a bound of its prior.
    Bound,
    /// A sampler, a fit or a search did not converge.
    NotEquilibrated,
    /// The data are uninformative about a parameter, or a channel is uninformative.
    NoInformation,
    /// The model rejected parameter vectors.
    Rejections,
    /// The best explanation of a search leaves a significant misfit.
    Incomplete,
    /// The runs were made in the order of a condition.
    Order,
    /// A worker computed wrongly, or evaluations failed on every worker that tried them.
    Worker,
    /// Interpolation without physics predicts held-out runs better than the model.
    InterpolationBeats,
    /// The posterior of the soil under the wheel contradicts the plate tests.
    PlatesConflict,
}

impl FlagKind {
    /// Returns the name in `summary.json`.
    pub fn name(self) -> &'static str {
        match self {
            FlagKind::Trend => "trend",
            FlagKind::Chi2 => "chi2",
            FlagKind::Outlier => "outlier",
            FlagKind::Conflict => "conflict",
            FlagKind::Bound => "bound",
            FlagKind::NotEquilibrated => "not_equilibrated",
            FlagKind::NoInformation => "no_information",
            FlagKind::Rejections => "rejections",
            FlagKind::Incomplete => "incomplete",
            FlagKind::Order => "order",
            FlagKind::Worker => "worker",
            FlagKind::InterpolationBeats => "interpolation_beats",
            FlagKind::PlatesConflict => "plates_conflict",
        }
    }
}

impl Flag {
    /// Returns a flag without channel, condition and probability.
    pub fn plain(kind: FlagKind, text: String) -> Self {
        Flag {
            kind,
            channel: None,
            against: None,
            p: None,
            text,
        }
    }
}
