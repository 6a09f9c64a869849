//! Measured values and the law of their errors.

use super::common_error::{self, CommonError, CommonErrorSize, Discrepancy, ErrorBlock, Sensitive};
use super::datum::{Datum, ErrorSd, LikelihoodError};
use super::law::ErrorLaw;

/// Measured values and the law of their errors.
#[derive(Debug, Clone, PartialEq)]
pub struct Likelihood {
    pub(super) data: Vec<Datum>,
    pub(super) law: ErrorLaw,
    pub(super) common: Vec<CommonError>,
    /// The inadequacy of each group of data.
    pub(super) discrepancies: Vec<Discrepancy>,
    /// The groups that share an unknown m.
    pub(super) families: Vec<Vec<usize>>,
    /// Data without a common error.
    pub(super) alone: Vec<usize>,
    pub(super) blocks: Vec<ErrorBlock>,
    pub(super) sensitive: Vec<Sensitive>,
}

impl Likelihood {
    /// Creates a likelihood with independent normal errors; the sums follow the order of the data. An invalid datum
    /// gives [`LikelihoodError::Value`] or [`LikelihoodError::Noise`].
    pub fn new(data: Vec<Datum>) -> Result<Self, LikelihoodError> {
        Self::with_common(data, ErrorLaw::Gaussian, Vec::new(), Vec::new())
    }

    /// Errors with a law, some of them common to several data.
    ///
    /// # Arguments
    /// - `discrepancies`: m of each group of data, for the common errors that are [`CommonErrorSize::Discrepancy`].
    ///
    /// # Errors
    /// [`LikelihoodError::Value`], [`LikelihoodError::Noise`], [`LikelihoodError::Setting`],
    /// [`LikelihoodError::Membership`], [`LikelihoodError::Group`].
    pub fn with_common(
        data: Vec<Datum>,
        law: ErrorLaw,
        common: Vec<CommonError>,
        discrepancies: Vec<Discrepancy>,
    ) -> Result<Self, LikelihoodError> {
        data.iter().try_for_each(Datum::check)?;
        law.check()?;
        discrepancies
            .iter()
            .try_for_each(|discrepancy| discrepancy.check())?;
        common_error::check(data.len(), discrepancies.len(), &common)?;
        let (alone, mut blocks) = common_error::blocks(&data, &common, &discrepancies);
        Ok(Self {
            sensitive: common_error::sensitive(&common),
            families: common_error::families(&mut blocks),
            data,
            law,
            common,
            discrepancies,
            alone,
            blocks,
        })
    }

    /// Returns the data, in their order.
    #[must_use]
    pub fn data(&self) -> &[Datum] {
        &self.data
    }

    /// Returns the law of the errors.
    #[must_use]
    pub fn law(&self) -> ErrorLaw {
        self.law
    }

    /// Returns the inadequacy m of the model for each group of data.
    #[must_use]
    pub fn discrepancies(&self) -> &[Discrepancy] {
        &self.discrepancies
    }

    /// Returns whether any group has a discrepancy.
    #[must_use]
    pub fn has_discrepancy(&self) -> bool {
        let some = |error: &CommonError| matches!(error.size, CommonErrorSize::Discrepancy { .. });
        self.common.iter().any(some)
    }

    /// Returns the common errors.
    #[must_use]
    pub fn common(&self) -> &[CommonError] {
        &self.common
    }

    /// Returns the needed derivatives, ascending: they follow the predictions in the predicted values.
    #[must_use]
    pub fn sensitive(&self) -> &[Sensitive] {
        &self.sensitive
    }

    /// Returns the number of predicted values: one for each datum, then the derivatives.
    #[must_use]
    pub fn values(&self) -> usize {
        self.data.len() + self.sensitive.len()
    }

    /// Returns the place of a derivative among the predicted values.
    pub(super) fn place(&self, wanted: Sensitive) -> usize {
        let position = self.sensitive.binary_search(&wanted);
        self.data.len() + position.expect("every common error has its derivatives among the sensitive ones")
    }

    /// Returns whether some inferred sd has no closed form: it belongs to correlated or heavy-tailed data, or to a common error, as does
    /// an inferred correlation length.
    #[must_use]
    pub fn entangles_unknown_sds(&self) -> bool {
        let is_inferred = |sd: ErrorSd| sd.parameter().is_some();
        let heavy = self.law != ErrorLaw::Gaussian && self.data.iter().any(|d| is_inferred(d.sd));
        let tied = self.blocks.iter().flat_map(|block| &block.data);
        let common = self
            .common
            .iter()
            .any(|error| error.size.hyperparameters().any(is_inferred));
        heavy || common || tied.into_iter().any(|&i| is_inferred(self.data[i].sd))
    }
}
