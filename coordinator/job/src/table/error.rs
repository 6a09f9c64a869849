//! The error of a table of a job.

/// A reason why a table of a job is refused; the caller names the table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum TableError {
    /// An unknown word, with the nearest known word.
    #[error("{0}")]
    Unknown(String),
    /// A value breaks its rule.
    #[error("{key} = {value} {rule}")]
    Value {
        /// The key.
        key: &'static str,
        /// Value of the key as written.
        value: String,
        /// The rule that the value breaks.
        rule: String,
    },
    /// Normal errors have no degrees of freedom.
    #[error("degrees_of_freedom belongs to kind = \"student_t\"")]
    DegreesOfFreedom,
    /// A key of other algorithms.
    #[error("{key} belongs to algorithm {owners}; {algorithm} takes {keys}")]
    ForeignKey {
        /// The key that does not belong to the job's algorithm.
        key: String,
        /// The algorithms that it belongs to.
        owners: String,
        /// The job's algorithm.
        algorithm: &'static str,
        /// The keys of the job's algorithm.
        keys: String,
    },
    /// A point estimate is named twice.
    #[error("point_estimates names {0} twice")]
    Twice(String),
    /// A study is extended only by calibrations that sample.
    #[error("apply = \"{apply}\" needs a posterior: {algorithm} without draws keeps no ledger of errors")]
    NoLedger {
        /// The value as written.
        apply: String,
        /// The job's algorithm.
        algorithm: &'static str,
    },
    /// A value of another type.
    #[error("{key} = {value}: {expected} expected")]
    Type {
        /// The key.
        key: &'static str,
        /// Value of the key as written.
        value: String,
        /// The value that is expected, with a verb.
        expected: &'static str,
    },
    /// Moduli that the draws do not have.
    #[error("moduli = \"literal\" asks for draws of {0}, which has no column")]
    NoColumn(&'static str),
    /// Keys of a posterior that is not named.
    #[error("transfer and moduli belong to posterior = \"FILE.csv\", which is missing")]
    NoPosterior,
}

impl TableError {
    /// Returns the error of a value of another type.
    pub(crate) fn kind(key: &'static str, value: &toml::Value, expected: &'static str) -> Self {
        TableError::Type {
            key,
            value: value.to_string(),
            expected,
        }
    }

    /// Returns the error of a value that breaks its rule.
    pub(crate) fn value(key: &'static str, value: impl ToString, rule: impl Into<String>) -> Self {
        TableError::Value {
            key,
            value: value.to_string(),
            rule: rule.into(),
        }
    }
}
