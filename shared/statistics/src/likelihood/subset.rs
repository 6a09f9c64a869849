//! The likelihood of a subset of the data.

use super::common_error::{CommonError, Sensitive};
use super::datum::LikelihoodError;
use super::error_model::Likelihood;

impl Likelihood {
    /// Returns the marginal likelihood of a subset of the data.
    ///
    /// # Arguments
    /// - `kept`: indices of the data, ascending.
    ///
    /// # Returns
    /// The likelihood, and the index of each of its predicted values among those of the whole.
    ///
    /// # Errors
    /// [`LikelihoodError::Membership`] for an index without a datum.
    ///
    /// # Validity
    /// A discrepancy keeps its size only where all data that share one are kept, or have the same noise sd. Checked by
    /// `likelihood::a_subset_has_the_density_of_its_data_alone`.
    pub fn subset(&self, kept: &[usize]) -> Result<(Likelihood, Vec<usize>), LikelihoodError> {
        let count = self.data.len();
        if let Some(&datum) = kept.iter().find(|&&i| i >= count) {
            return Err(LikelihoodError::Membership { datum, data: count });
        }
        let data = kept.iter().map(|&i| self.data[i]).collect();
        let common: Vec<CommonError> = self
            .common
            .iter()
            .filter_map(|error| error.within(kept))
            .collect();
        let subset = Self::with_common(data, self.law, common, self.discrepancies.clone())?;
        let places = self.places(kept, &subset);
        Ok((subset, places))
    }

    fn places(&self, kept: &[usize], subset: &Likelihood) -> Vec<usize> {
        let derivative = |sensitive: &Sensitive| {
            self.place(Sensitive {
                datum: kept[sensitive.datum],
                ..*sensitive
            })
        };
        let derivatives = subset.sensitive.iter().map(derivative);
        kept.iter().copied().chain(derivatives).collect()
    }
}
