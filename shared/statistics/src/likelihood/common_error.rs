//! Common errors of several data, and the blocks of correlated data.

use serde::{Deserialize, Serialize};

use super::datum::{Datum, ErrorSd, LikelihoodError};

/// An error that several data have in common: it adds `v v'` to their covariance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CommonError {
    /// Indices of the data, ascending.
    pub data: Vec<usize>,
    /// The elements of v.
    pub size: CommonErrorSize,
}

/// How a common error acts on each of its data.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum CommonErrorSize {
    /// Shifts all equally: `v_i` = this sd, in the unit of the data, >= 0.
    Shift(ErrorSd),
    /// Shifts all equally by the inadequacy of the model: `v_i = m sigma`, sigma the root mean square of their noise
    /// sds and m of [`Discrepancy`].
    Discrepancy,
    /// Shifts each along a sensitivity: `v_i` = this sd times a derivative of the prediction, which the predicted values
    /// include. A datum may have several, along one derivative or along different ones.
    Sensitivity {
        /// The sd.
        sd: ErrorSd,
        /// The number of the derivative.
        derivative: usize,
    },
}

/// A derivative of the prediction of a datum, among the predicted values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Sensitive {
    /// The number of the derivative.
    pub derivative: usize,
    /// The datum.
    pub datum: usize,
}

/// The inadequacy of the model, in noise sds.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub enum Discrepancy {
    /// None.
    #[default]
    None,
    /// m itself, > 0.
    Known(f64),
    /// m is marginalised over [`DISCREPANCY_LEVELS`] values from [`LEAST_DISCREPANCY`] to [`GREATEST_DISCREPANCY`], equally probable and equally spaced in
    /// ln m.
    Unknown,
}

/// Number of values of an unknown m.
pub const DISCREPANCY_LEVELS: usize = 9;
/// The least value of an unknown m.
pub const LEAST_DISCREPANCY: f64 = 0.5;
/// The largest value of an unknown m.
pub const GREATEST_DISCREPANCY: f64 = 8.0;

impl Discrepancy {
    /// The values of m, each with the same prior probability; none without discrepancy.
    #[must_use]
    pub fn levels(self) -> Vec<f64> {
        match self {
            Self::None => Vec::new(),
            Self::Known(m) => vec![m],
            Self::Unknown => {
                let step =
                    libm::log(GREATEST_DISCREPANCY / LEAST_DISCREPANCY) / (DISCREPANCY_LEVELS - 1) as f64;
                (0..DISCREPANCY_LEVELS)
                    .map(|k| LEAST_DISCREPANCY * libm::exp(step * k as f64))
                    .collect()
            }
        }
    }

    pub(super) fn check(self) -> Result<(), LikelihoodError> {
        match self {
            Self::Known(value) if !(value.is_finite() && value > 0.0) => Err(LikelihoodError::Setting {
                name: "discrepancy",
                value,
                bound: "a finite number above 0",
            }),
            _ => Ok(()),
        }
    }
}

/// Data with correlated errors.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ErrorBlock {
    /// Indices of the data, ascending.
    pub(super) data: Vec<usize>,
    /// Indices of the common errors, ascending.
    pub(super) common: Vec<usize>,
    /// Whether a discrepancy is among them.
    pub(super) has_discrepancy: bool,
}

/// Splits the data into independent ones and blocks, in the order of their first datum.
pub(super) fn blocks(data: &[Datum], common: &[CommonError]) -> (Vec<usize>, Vec<ErrorBlock>) {
    // A block is named by its least member; joining two renames the larger.
    let mut least: Vec<usize> = (0..data.len()).collect();
    for error in common {
        let names: Vec<usize> = error.data.iter().map(|&i| least[i]).collect();
        let Some(&first) = names.iter().min() else {
            continue;
        };
        for name in &mut least {
            if names.contains(name) {
                *name = first;
            }
        }
    }
    let is_tied = |i: usize| common.iter().any(|error| error.data.contains(&i));
    let alone = (0..data.len()).filter(|&i| !is_tied(i)).collect();
    let blocks = (0..data.len())
        .filter(|&i| least[i] == i && is_tied(i))
        .map(|first| {
            let own: Vec<usize> = (0..common.len())
                .filter(|&c| common[c].data.first().is_some_and(|&i| least[i] == first))
                .collect();
            ErrorBlock {
                data: (0..data.len()).filter(|&i| least[i] == first).collect(),
                has_discrepancy: own
                    .iter()
                    .any(|&c| common[c].size == CommonErrorSize::Discrepancy),
                common: own,
            }
        })
        .collect();
    (alone, blocks)
}

/// The derivatives that are needed, each once, ascending.
pub(super) fn sensitive(common: &[CommonError]) -> Vec<Sensitive> {
    let of = |error: &CommonError| match error.size {
        CommonErrorSize::Sensitivity { derivative, .. } => {
            let own = error.data.iter();
            own.map(|&datum| Sensitive { derivative, datum }).collect()
        }
        CommonErrorSize::Shift(_) | CommonErrorSize::Discrepancy => Vec::new(),
    };
    let mut sensitive: Vec<Sensitive> = common.iter().flat_map(of).collect();
    sensitive.sort_unstable();
    sensitive.dedup();
    sensitive
}

/// Refuses invalid memberships and sds.
pub(super) fn check(count: usize, common: &[CommonError]) -> Result<(), LikelihoodError> {
    let refuse = |datum| LikelihoodError::Membership { datum, data: count };
    for error in common {
        if let Some(&beyond) = error.data.iter().find(|&&i| i >= count) {
            return Err(refuse(beyond));
        }
        if let Some(pair) = error.data.windows(2).find(|pair| pair[1] <= pair[0]) {
            return Err(refuse(pair[1]));
        }
        if let CommonErrorSize::Shift(ErrorSd::Known(value))
        | CommonErrorSize::Sensitivity {
            sd: ErrorSd::Known(value),
            ..
        } = error.size
            && !(value.is_finite() && value >= 0.0)
        {
            return Err(LikelihoodError::Setting {
                name: "sd of a common error",
                value,
                bound: "a finite number of at least 0",
            });
        }
    }
    Ok(())
}
