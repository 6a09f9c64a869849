//! The error of an entry of `[priors]`.

use shared::model::ModelError;
use statistics::PriorError;

/// The distributions of a prior.
pub(crate) const DISTRIBUTIONS: [&str; 5] = ["uniform", "loguniform", "normal", "lognormal", "half_normal"];

/// A reason why an entry of `[priors]`, or the prior in an effect file, is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PriorEntryError {
    /// The model has no such parameter.
    #[error(transparent)]
    Parameter(#[from] ModelError),
    /// An unknown word, with the nearest known word.
    #[error("{0}")]
    Unknown(String),
    /// A fixed noise sd, which belongs to the experiment.
    #[error("{0} is fixed in the experiment's [noise], not here")]
    FixedNoise(String),
    /// A dotted name without quotes.
    #[error("write the name in quotes: \"{name}.{key}\"")]
    Unquoted {
        /// The text before the dot.
        name: String,
        /// The text behind the dot.
        key: String,
    },
    /// The prior of one parameter.
    #[error("{name}: {error}")]
    InParameter {
        /// The parameter.
        name: String,
        /// Error of the parameter's entry.
        error: Box<PriorEntryError>,
    },
    /// Neither a number nor a table.
    #[error("a number or a table is expected")]
    NotATable,
    /// A table without a distribution.
    #[error("no distribution; known are {}", DISTRIBUTIONS.join(", "))]
    NoDistribution,
    /// A table with two distributions.
    #[error("two distributions: {0} and {1}")]
    TwoDistributions(String, String),
    /// A distribution has other arguments.
    #[error("{key} = {value}: {expected} expected")]
    Arguments {
        /// The distribution, or `bounds`.
        key: String,
        /// Value of the entry as written.
        value: String,
        /// The arguments that it takes.
        expected: &'static str,
    },
    /// The prior reaches beyond the physical bounds.
    #[error("{}[{a}, {b}]{unit} {} the admissible range [{lower}, {upper}]{unit}",
        if *.stated { "bounds " } else { "" }, if *.stated { "leave" } else { "leaves" })]
    OutOfRange {
        /// Whether the stated bounds of the prior are beyond, or its support.
        stated: bool,
        /// Lower end.
        a: f64,
        /// Upper end.
        b: f64,
        /// Unit with a space in front, or nothing.
        unit: String,
        /// The least admissible value.
        lower: f64,
        /// The largest admissible value.
        upper: f64,
    },
    /// The distribution refuses its arguments.
    #[error(transparent)]
    Distribution(#[from] PriorError),
}

impl PriorEntryError {
    /// Adds the name of the parameter.
    pub(crate) fn in_parameter(self, name: impl Into<String>) -> Self {
        PriorEntryError::InParameter {
            name: name.into(),
            error: Box::new(self),
        }
    }
}
