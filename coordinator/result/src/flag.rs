//! A flag and its kind.

use crate::diagnostics::trends::TrendVariable;
use crate::words::data_channel::DataChannel;

/// A warning about a result.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Flag {
    /// Its kind.
    #[schema(value_type = String)]
    pub kind: FlagKind,
    /// The channel it is about.
    #[schema(value_type = Option<String>)]
    pub channel: Option<DataChannel>,
    /// The condition it varies with.
    #[schema(value_type = Option<String>)]
    pub against: Option<TrendVariable>,
    /// Probability of the observation if nothing were wrong.
    pub p: Option<f64>,
    /// Its meaning.
    pub text: String,
}

/// Kind of a flag.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FlagKind {
    /// Residuals follow a condition of the runs.
    Trend,
    /// Residuals are larger than the declared errors.
    Chi2,
    /// One residual is beyond chance.
    Outlier,
    /// Data and prior contradict each other.
    Conflict,
    /// A parameter lies at a bound of its prior.
    Bound,
    /// A sampler, a fit or a search did not reach its target.
    NotEquilibrated,
    /// The data say nothing about a parameter, or a channel says nothing.
    NoInformation,
    /// The model rejected parameter vectors.
    Rejections,
    /// The best explanation of the misfit leaves some of it.
    Incomplete,
    /// The runs were made in the order of a condition.
    Order,
    /// A worker computed wrongly, or evaluations failed on every worker that tried them.
    Worker,
    /// Interpolation without physics predicts held-out runs better than the model.
    InterpolationBeats,
    /// The posterior of the wheel's soil contradicts what plates say.
    PlatesConflict,
}

impl FlagKind {
    /// Name in `summary.json`.
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
    /// A flag that is about no channel and no probability.
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
