//! Common errors of several data, and the blocks of correlated data.

use super::datum::{Datum, ErrorSd, LikelihoodError};
use super::innovation::{Innovation, check_sd};

/// An error that several data share: it adds `v v'` to their covariance.
#[derive(Debug, Clone, PartialEq)]
pub struct CommonError {
    /// Indices of the data, ascending.
    pub data: Vec<usize>,
    /// The elements of v.
    pub size: CommonErrorSize,
}

impl CommonError {
    /// Returns the common errors of one history, whose errors are autocorrelated along the travel: one [`Innovation`] for each datum.
    ///
    /// # Arguments
    /// - `data`: indices of the data of the history, ascending.
    /// - `coordinates_m`: travel of each datum \[m\], ascending; equal coordinates are allowed.
    /// - `sd`: of the autocorrelated error, in the unit of the data, >= 0.
    /// - `correlation_length_m`: distance over which the correlation decays by a factor e \[m\], > 0, known or inferred.
    ///
    /// # Errors
    /// [`LikelihoodError::Distances`] if data and coordinates differ in number, [`LikelihoodError::Setting`] for a coordinate that is
    /// not finite or below the previous one. Checked by `autocorrelation::a_history_has_the_density_of_its_kernel`.
    pub fn of_history(
        data: &[usize],
        coordinates_m: &[f64],
        sd: ErrorSd,
        correlation_length_m: ErrorSd,
    ) -> Result<Vec<Self>, LikelihoodError> {
        if data.len() != coordinates_m.len() {
            return Err(LikelihoodError::Distances {
                expected: data.len(),
                given: coordinates_m.len(),
            });
        }
        let innovations = Innovation::of_history(coordinates_m, sd, correlation_length_m)?;
        let error = |(k, innovation)| Self {
            data: data[k..].to_vec(),
            size: CommonErrorSize::Innovation(innovation),
        };
        Ok(innovations.into_iter().enumerate().map(error).collect())
    }

    /// Returns the same error on the data that remain in a subset; `None` if none does.
    ///
    /// # Arguments
    /// - `kept`: indices of the remaining data, ascending.
    pub(super) fn within(&self, kept: &[usize]) -> Option<Self> {
        let (mut data, mut places) = (Vec::new(), Vec::new());
        for (k, datum) in kept.iter().enumerate() {
            if let Ok(place) = self.data.binary_search(datum) {
                data.push(k);
                places.push(place);
            }
        }
        let size = match &self.size {
            CommonErrorSize::Innovation(innovation) => CommonErrorSize::Innovation(innovation.on(&places)),
            size => size.clone(),
        };
        (!data.is_empty()).then_some(Self { data, size })
    }
}

/// The effect of a common error on each of its data.
#[derive(Debug, Clone, PartialEq)]
pub enum CommonErrorSize {
    /// Shifts all data equally: `v_i` = this sd, in the unit of the data, >= 0.
    Shift(ErrorSd),
    /// Shifts all data equally by the inadequacy of the model: `v_i = m sigma`, sigma the root mean square of their noise
    /// sds and m the [`Discrepancy`] of a group of data, such as a channel.
    Discrepancy {
        /// Index of the group.
        group: usize,
    },
    /// Shifts each datum along a sensitivity: `v_i` = this sd times a derivative of the prediction; the predicted values
    /// include the derivatives.
    ///
    /// A datum may have several, along one derivative or different ones.
    Sensitivity {
        /// Standard deviation of the factor along the sensitivity.
        sd: ErrorSd,
        /// Index of the derivative.
        derivative: usize,
    },
    /// Shifts each datum by an innovation of an error that is autocorrelated along the travel; [`CommonError::of_history`] creates all
    /// those of a history.
    Innovation(Innovation),
}

impl CommonErrorSize {
    /// Returns the standard deviation; `None` for a discrepancy, whose size follows from the noise.
    #[must_use]
    pub fn sd(&self) -> Option<ErrorSd> {
        match self {
            Self::Shift(sd) | Self::Sensitivity { sd, .. } => Some(*sd),
            Self::Discrepancy { .. } => None,
            Self::Innovation(innovation) => Some(innovation.sd),
        }
    }

    /// Returns the correlation length \[m\]; `None` for an error that does not decay.
    #[must_use]
    pub fn correlation_length_m(&self) -> Option<ErrorSd> {
        match self {
            Self::Innovation(innovation) => Some(innovation.correlation_length_m),
            Self::Shift(_) | Self::Sensitivity { .. } | Self::Discrepancy { .. } => None,
        }
    }

    /// Returns the numbers on which the error depends, known or inferred: the sd, then the correlation length.
    pub fn hyperparameters(&self) -> impl Iterator<Item = ErrorSd> {
        self.sd().into_iter().chain(self.correlation_length_m())
    }

    /// Returns the same error with another standard deviation; a discrepancy is unchanged, as it has none.
    #[must_use]
    pub fn with_sd(&self, sd: ErrorSd) -> Self {
        match self {
            Self::Shift(_) => Self::Shift(sd),
            Self::Sensitivity { derivative, .. } => Self::Sensitivity {
                sd,
                derivative: *derivative,
            },
            Self::Discrepancy { .. } => self.clone(),
            Self::Innovation(innovation) => Self::Innovation(Innovation {
                sd,
                ..innovation.clone()
            }),
        }
    }

    /// Returns the same error with another correlation length \[m\]; an error that does not decay is unchanged.
    #[must_use]
    pub fn with_correlation_length_m(&self, correlation_length_m: ErrorSd) -> Self {
        match self {
            Self::Innovation(innovation) => Self::Innovation(Innovation {
                correlation_length_m,
                ..innovation.clone()
            }),
            Self::Shift(_) | Self::Sensitivity { .. } | Self::Discrepancy { .. } => self.clone(),
        }
    }
}

/// A derivative of the prediction of a datum, among the predicted values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Sensitive {
    /// Index of the derivative.
    pub derivative: usize,
    /// Index of the datum.
    pub datum: usize,
}

/// The inadequacy of the model for a group of data, in noise sds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Discrepancy {
    /// The model is adequate.
    #[default]
    None,
    /// The known m, > 0.
    Known(f64),
    /// m is marginalised over [`DISCREPANCY_LEVELS`] values from [`MIN_DISCREPANCY`] to [`MAX_DISCREPANCY`], equally
    /// probable and equally spaced in ln m.
    ///
    /// Groups with correlated errors share one m.
    Unknown,
}

/// Number of values of an unknown m.
pub const DISCREPANCY_LEVELS: usize = 17;
/// The smallest value of an unknown m.
pub const MIN_DISCREPANCY: f64 = 0.25;
/// The largest value of an unknown m: a model with larger errors is useless.
pub const MAX_DISCREPANCY: f64 = 64.0;

/// Returns the values of an unknown m, each with the same prior probability.
pub fn discrepancy_levels() -> Vec<f64> {
    let step = libm::log(MAX_DISCREPANCY / MIN_DISCREPANCY) / (DISCREPANCY_LEVELS - 1) as f64;
    (0..DISCREPANCY_LEVELS)
        .map(|k| MIN_DISCREPANCY * libm::exp(step * k as f64))
        .collect()
}

impl Discrepancy {
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
    /// The groups with an unknown discrepancy in this block, ascending.
    unknown: Vec<usize>,
    /// Index of its unknown m; blocks with the same index share it.
    pub(super) family: Option<usize>,
}

/// Splits the data into independent ones and blocks, in the order of their first datum.
pub(super) fn blocks(
    data: &[Datum],
    common: &[CommonError],
    discrepancies: &[Discrepancy],
) -> (Vec<usize>, Vec<ErrorBlock>) {
    // A block is named by its smallest member; joining two renames the larger.
    let mut smallest: Vec<usize> = (0..data.len()).collect();
    for error in common {
        let names: Vec<usize> = error.data.iter().map(|&i| smallest[i]).collect();
        let Some(&first) = names.iter().min() else {
            continue;
        };
        for name in &mut smallest {
            if names.contains(name) {
                *name = first;
            }
        }
    }
    let is_tied = |i: usize| common.iter().any(|error| error.data.contains(&i));
    let alone = (0..data.len()).filter(|&i| !is_tied(i)).collect();
    let blocks = (0..data.len())
        .filter(|&i| smallest[i] == i && is_tied(i))
        .map(|first| {
            let members: Vec<usize> = (0..common.len())
                .filter(|&c| common[c].data.first().is_some_and(|&i| smallest[i] == first))
                .collect();
            let unknown = members.iter().filter_map(|&c| match common[c].size {
                CommonErrorSize::Discrepancy { group } => Some(group),
                CommonErrorSize::Shift(_)
                | CommonErrorSize::Sensitivity { .. }
                | CommonErrorSize::Innovation(_) => None,
            });
            let mut unknown: Vec<usize> = unknown
                .filter(|&group| discrepancies[group] == Discrepancy::Unknown)
                .collect();
            unknown.sort_unstable();
            unknown.dedup();
            ErrorBlock {
                data: (0..data.len()).filter(|&i| smallest[i] == first).collect(),
                common: members,
                unknown,
                family: None,
            }
        })
        .collect();
    (alone, blocks)
}

/// Assigns an unknown m to each block: blocks with a group in common share one. Returns the groups of each m, ascending.
pub(super) fn families(blocks: &mut [ErrorBlock]) -> Vec<Vec<usize>> {
    let mut families: Vec<Vec<usize>> = Vec::new();
    for block in blocks.iter().filter(|block| !block.unknown.is_empty()) {
        let (tied, apart): (Vec<_>, Vec<_>) = families
            .into_iter()
            .partition(|family| family.iter().any(|group| block.unknown.contains(group)));
        let mut joined: Vec<usize> = tied.into_iter().flatten().chain(block.unknown.clone()).collect();
        joined.sort_unstable();
        joined.dedup();
        families = apart;
        families.push(joined);
    }
    families.sort_unstable();
    for block in blocks {
        let first = block.unknown.first();
        block.family = first.and_then(|group| families.iter().position(|family| family.contains(group)));
    }
    families
}

/// Returns the needed derivatives, each once, ascending.
pub(super) fn sensitive(common: &[CommonError]) -> Vec<Sensitive> {
    let sensitive = |error: &CommonError| match error.size {
        CommonErrorSize::Sensitivity { derivative, .. } => {
            let data = error.data.iter();
            data.map(|&datum| Sensitive { derivative, datum }).collect()
        }
        CommonErrorSize::Shift(_) | CommonErrorSize::Discrepancy { .. } | CommonErrorSize::Innovation(_) => {
            Vec::new()
        }
    };
    let mut sensitive: Vec<Sensitive> = common.iter().flat_map(sensitive).collect();
    sensitive.sort_unstable();
    sensitive.dedup();
    sensitive
}

/// Refuses invalid memberships and sds.
///
/// # Arguments
/// - `count`: of the data. `groups`: number of groups with a discrepancy.
pub(super) fn check(count: usize, groups: usize, common: &[CommonError]) -> Result<(), LikelihoodError> {
    let refuse = |datum| LikelihoodError::Membership { datum, data: count };
    for error in common {
        if let Some(&beyond) = error.data.iter().find(|&&i| i >= count) {
            return Err(refuse(beyond));
        }
        if let Some(pair) = error.data.windows(2).find(|pair| pair[1] <= pair[0]) {
            return Err(refuse(pair[1]));
        }
        if let CommonErrorSize::Discrepancy { group } = error.size
            && group >= groups
        {
            return Err(LikelihoodError::Group { group, groups });
        }
        if let Some(ErrorSd::Known(value)) = error.size.sd() {
            check_sd(value)?;
        }
        if let CommonErrorSize::Innovation(innovation) = &error.size {
            innovation.check(error.data.len())?;
        }
    }
    Ok(())
}
