//! The likelihood of a model that has some of the parameters.

use super::common_error::CommonError;
use super::datum::{Datum, ErrorSd, LikelihoodError};
use super::error_model::Likelihood;

impl Likelihood {
    /// Returns the likelihood of the same data under a model that keeps some of the parameters: each inferred sd or correlation
    /// length is read at its parameter's position among the kept ones.
    ///
    /// # Arguments
    /// - `kept`: positions in theta of the kept parameters, in the order of the model's theta.
    ///
    /// # Errors
    /// [`LikelihoodError::DroppedSd`] if the parameter of an inferred sd or correlation length is not kept. Checked by
    /// `tests::an_inferred_sd_is_read_at_its_place_among_the_kept_parameters`.
    pub fn with_parameters(&self, kept: &[usize]) -> Result<Likelihood, LikelihoodError> {
        let data = self.data.iter().map(|datum| -> Result<Datum, LikelihoodError> {
            Ok(Datum {
                sd: renumbered(datum.sd, kept)?,
                ..*datum
            })
        });
        let common = self
            .common
            .iter()
            .map(|error| -> Result<CommonError, LikelihoodError> {
                let mut size = error.size.clone();
                if let Some(sd) = size.sd() {
                    size = size.with_sd(renumbered(sd, kept)?);
                }
                if let Some(length_m) = size.correlation_length_m() {
                    size = size.with_correlation_length_m(renumbered(length_m, kept)?);
                }
                Ok(CommonError {
                    data: error.data.clone(),
                    size,
                })
            });
        Self::with_common(
            data.collect::<Result<_, _>>()?,
            self.law,
            common.collect::<Result<_, _>>()?,
            self.discrepancies.clone(),
        )
    }
}

fn renumbered(sd: ErrorSd, kept: &[usize]) -> Result<ErrorSd, LikelihoodError> {
    let Some(parameter) = sd.parameter() else {
        return Ok(sd);
    };
    let place = kept.iter().position(|k| *k == parameter);
    let parameter = place.ok_or(LikelihoodError::DroppedSd { parameter })?;
    Ok(ErrorSd::Inferred { parameter })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::{CommonErrorSize, Discrepancy, ErrorLaw};

    /// Returns four data of two channels with a declared sd, the sd of parameter 2, the common sds of parameters 3 and 4, and a
    /// discrepancy.
    fn whole() -> Likelihood {
        let inferred = |parameter| ErrorSd::Inferred { parameter };
        let sds = [ErrorSd::Known(0.5), inferred(2), inferred(2), ErrorSd::Known(0.7)];
        let data = sds.into_iter().enumerate().map(|(run, sd)| Datum {
            run,
            channel: run % 2,
            value: 0.3 * run as f64,
            sd,
        });
        let common = [
            (vec![0, 1], CommonErrorSize::Shift(inferred(3))),
            (
                vec![2, 3],
                CommonErrorSize::Sensitivity {
                    sd: inferred(4),
                    derivative: 0,
                },
            ),
            (vec![1, 2], CommonErrorSize::Discrepancy { group: 0 }),
        ];
        let common = common.map(|(data, size)| CommonError { data, size });
        Likelihood::with_common(
            data.collect(),
            ErrorLaw::Gaussian,
            common.to_vec(),
            vec![Discrepancy::Known(1.5)],
        )
        .unwrap()
    }

    #[test]
    fn an_inferred_sd_is_read_at_its_place_among_the_kept_parameters() {
        let values = [0.1, 0.5, 0.2, 1.0, 2.0, -1.0];
        let whole = whole();
        let reduced = whole.with_parameters(&[0, 2, 3, 4]).unwrap();
        assert_eq!(
            reduced.log_likelihood(&values, &[9.0, 0.4, 0.2, 0.3]),
            whole.log_likelihood(&values, &[9.0, 8.0, 0.4, 0.2, 0.3])
        );
        let all: Vec<usize> = (0..5).collect();
        assert_eq!(whole.with_parameters(&all).unwrap(), whole);
    }

    #[test]
    fn the_parameter_of_an_inferred_sd_must_be_kept() {
        for (kept, parameter) in [([0, 3, 4], 2), ([0, 2, 4], 3), ([0, 2, 3], 4)] {
            let refused = whole().with_parameters(&kept);
            assert_eq!(refused, Err(LikelihoodError::DroppedSd { parameter }));
        }
    }
}
