//! The probability of each error that runs share: an offset of sessions, a taring, wear, a load that the guide carries (step 13).
//!
//! Errors of sessions and tarings are part of the likelihood of every model, with inferred sds, so that no effect is credited with what
//! they explain. Here it is asked, beside the best explanation, whether each sd differs from 0. Errors that are not part of the
//! likelihood are added to it for the question. Nothing is simulated: predictions are linear in the parameters about the fit.

use crate::laplace::conditional::LinearisedModel;
use crate::laplace::evidence::log_sum_exp;
use crate::laplace::point::FitPoint;
use crate::stages::scored_fit::ScoredFit;
use crate::suspected_error::{SuspectedError, SuspectedShift};
use statistics::likelihood::{CommonError, CommonErrorSize, ErrorSd, Likelihood, Sensitive};
use statistics::prior::{Distribution, Marginal};

/// Normal scores, in the prior of an sd, of the values that are compared: from a tenth of its scale to five scales.
const SCORES: [f64; 14] = [
    -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0,
];
/// Index of the derivative by a factor on a datum. The job numbers those of the soil, 0 and 1.
const BY_FACTOR: usize = 2;

/// An error that runs share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SharedErrorSource {
    /// The error whose sd is this parameter of the base.
    Parameter(usize),
    /// The error of this index among [`SearchTask::suspected_errors`](crate::task::SearchTask::suspected_errors).
    Suspected(usize),
}

impl SharedErrorSource {
    /// Returns the source in the numbering of the base.
    ///
    /// # Arguments
    /// - `kept`: the parameters of the base that the model of this source keeps.
    pub(super) fn in_base(self, kept: &[usize]) -> Self {
        match self {
            Self::Parameter(k) => Self::Parameter(kept[k]),
            Self::Suspected(_) => self,
        }
    }
}

/// What the data say of an error that runs share.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgedError {
    /// The error.
    pub source: SharedErrorSource,
    /// Log evidence with the error over that without it.
    pub log_bayes_factor: f64,
    /// Probability that it acts; one half before the data.
    pub probability: f64,
    /// Posterior mean of its sd if it acts: in the unit of the data, or relative.
    pub sd: f64,
    /// The error of each group; of an error that is autocorrelated along the travel, each of its innovations.
    pub groups: Vec<GroupError>,
}

/// The error of one group of data.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupError {
    /// The data that share it.
    pub data: Vec<usize>,
    /// Posterior mean: in the unit of the data, or relative.
    pub mean: f64,
    /// Posterior sd, in the unit of the mean.
    pub sd: f64,
}

/// The question whether one error acts, about one fit.
struct SharedErrorQuestion<'a> {
    suspects: &'a [SuspectedError],
    model: ScoredFit<'a>,
    source: SharedErrorSource,
    /// Prior of the sd.
    prior: Marginal,
    /// Derivatives that the likelihood takes beyond those of the fit.
    further_values: Vec<f64>,
}

/// Judges every inferred and suspected error beside an explanation. Checked by
/// `shared_errors::an_offset_of_sessions_is_found_and_where_none_acts_none_is`.
///
/// # Returns
/// The errors; an inferred sd is numbered as the parameters of the explanation.
pub(super) fn judged_errors(suspects: &[SuspectedError], explanation: ScoredFit) -> Vec<JudgedError> {
    let common = explanation.likelihood.common().iter();
    let mut parameters: Vec<usize> = common.filter_map(inferred_sd).collect();
    parameters.sort_unstable();
    parameters.dedup();
    let parameters = parameters.into_iter().map(SharedErrorSource::Parameter);
    let suspected = (0..suspects.len()).map(SharedErrorSource::Suspected);
    let sources = parameters.chain(suspected);
    sources
        .filter_map(|source| SharedErrorQuestion::new(suspects, explanation, source)?.judged())
        .collect()
}

/// Returns the parameter that is the sd of a common error.
fn inferred_sd(error: &CommonError) -> Option<usize> {
    error.size.sd()?.parameter()
}

impl<'a> SharedErrorQuestion<'a> {
    fn new(suspects: &'a [SuspectedError], model: ScoredFit<'a>, source: SharedErrorSource) -> Option<Self> {
        let fit = model.fit;
        let (prior, further_values) = match source {
            SharedErrorSource::Parameter(k) => (fit.frame.coordinates.get(k)?.marginal.clone(), Vec::new()),
            SharedErrorSource::Suspected(k) => {
                let error = suspects.get(k)?;
                let scale = error.prior_scale;
                let prior = Marginal::new(Distribution::HalfNormal { scale }, None).ok()?;
                (prior, factor_derivatives(error, &fit.point.values))
            }
        };
        Some(Self {
            suspects,
            model,
            source,
            prior,
            further_values,
        })
    }

    /// Returns the likelihood with a given sd of the error.
    fn likelihood(&self, sd: f64) -> Option<Likelihood> {
        let whole = self.model.likelihood;
        let sd = ErrorSd::Known(sd);
        let mut common = whole.common().to_vec();
        match self.source {
            SharedErrorSource::Parameter(k) => {
                for error in common.iter_mut().filter(|error| inferred_sd(error) == Some(k)) {
                    error.size = error.size.with_sd(sd);
                }
            }
            SharedErrorSource::Suspected(k) => {
                let suspected = &self.suspects[k];
                let size = match suspected.shift {
                    SuspectedShift::Offset => CommonErrorSize::Shift(sd),
                    SuspectedShift::Factor => CommonErrorSize::Sensitivity {
                        sd,
                        derivative: BY_FACTOR,
                    },
                };
                let groups = suspected.groups.iter().cloned();
                common.extend(groups.map(|data| CommonError {
                    data,
                    size: size.clone(),
                }));
            }
        }
        let discrepancies = whole.discrepancies().to_vec();
        Likelihood::with_common(whole.data().to_vec(), whole.law(), common, discrepancies).ok()
    }

    /// Returns the errors in question among those of a likelihood.
    fn errors<'b>(&self, likelihood: &'b Likelihood) -> impl Iterator<Item = &'b CommonError> {
        let whole = self.model.likelihood.common();
        let source = self.source;
        let errors = likelihood.common().iter().enumerate();
        errors.filter_map(move |(place, error)| {
            let is_asked = match source {
                SharedErrorSource::Parameter(k) => inferred_sd(&whole[place]) == Some(k),
                SharedErrorSource::Suspected(_) => place >= whole.len(),
            };
            is_asked.then_some(error)
        })
    }

    /// Returns the mode and its log evidence for an sd.
    fn at(&self, sd: f64, start: Vec<f64>) -> Option<(FitPoint, f64)> {
        let likelihood = self.likelihood(sd)?;
        let model = self.linearised(&likelihood);
        let mode = model.mode(start)?;
        let evidence = model.log_evidence(&mode)?;
        Some((mode, evidence))
    }

    fn linearised<'b>(&'b self, likelihood: &'b Likelihood) -> LinearisedModel<'b> {
        LinearisedModel {
            fit: self.model.fit,
            likelihood,
            further_values: &self.further_values,
        }
    }

    fn judged(&self) -> Option<JudgedError> {
        let (absent, without) = self.at(0.0, self.model.fit.point.position.clone())?;
        let mut start = absent.position;
        let mut weighed = Vec::new();
        for t in SCORES {
            let sd = self.prior.from_normal_score(t);
            // An sd that the data exclude has no evidence.
            let evidence = match self.at(sd, start.clone()) {
                Some((mode, evidence)) => {
                    start = mode.position;
                    evidence
                }
                None => f64::NEG_INFINITY,
            };
            weighed.push((sd, evidence - without - 0.5 * t * t));
        }
        let prior = log_sum_exp(SCORES.into_iter().map(|t| -0.5 * t * t));
        let posterior = log_sum_exp(weighed.iter().map(|(_, weight)| *weight));
        let shares = weighed
            .iter()
            .map(|(sd, weight)| sd * libm::exp(weight - posterior));
        let (log_bayes_factor, sd) = (posterior - prior, shares.sum());
        Some(JudgedError {
            source: self.source,
            log_bayes_factor,
            probability: 1.0 / (1.0 + libm::exp(-log_bayes_factor)),
            sd,
            groups: self.groups(sd)?,
        })
    }

    /// Returns the error of each group for an sd.
    fn groups(&self, sd: f64) -> Option<Vec<GroupError>> {
        let likelihood = self.likelihood(sd)?;
        let model = self.linearised(&likelihood);
        let mode = model.mode(self.model.fit.point.position.clone())?;
        let theta = self.model.fit.frame.theta(&mode.position);
        let mut directions = Vec::new();
        for error in self.errors(&likelihood) {
            directions.push(direction(&likelihood, error, sd, &mode.values, &theta)?);
        }
        let factors = model.factors(&mode, directions.into_iter())?;
        let group = |(error, [mean, spread]): (&CommonError, [f64; 2])| {
            let scale = match &error.size {
                CommonErrorSize::Innovation(innovation) => innovation.sd_at_point(&theta).ok()?,
                CommonErrorSize::Shift(_) | CommonErrorSize::Sensitivity { .. } => sd,
                CommonErrorSize::Discrepancy { .. } => return None,
            };
            Some(GroupError {
                data: error.data.clone(),
                mean: scale * mean,
                sd: scale * spread,
            })
        };
        self.errors(&likelihood).zip(factors).map(group).collect()
    }
}

/// Returns the derivatives by a factor on each datum of a suspected error: the predictions, in the order of the data.
fn factor_derivatives(error: &SuspectedError, values: &[f64]) -> Vec<f64> {
    if error.shift == SuspectedShift::Offset {
        return Vec::new();
    }
    let mut data: Vec<usize> = error.groups.iter().flatten().copied().collect();
    data.sort_unstable();
    data.dedup();
    data.into_iter().map(|i| values[i]).collect()
}

/// Returns the shift of each datum by one sd of a common error; `None` where theta has an sd or correlation length out of bounds.
fn direction(
    likelihood: &Likelihood,
    error: &CommonError,
    sd: f64,
    values: &[f64],
    theta: &[f64],
) -> Option<Vec<f64>> {
    let mut direction = vec![0.0; likelihood.data().len()];
    if let CommonErrorSize::Innovation(innovation) = &error.size {
        for (&datum, shift) in error.data.iter().zip(innovation.shifts(theta).ok()?) {
            direction[datum] = shift;
        }
        return Some(direction);
    }
    for &datum in &error.data {
        direction[datum] = match error.size {
            CommonErrorSize::Sensitivity { derivative, .. } => {
                let sensitive = Sensitive { derivative, datum };
                let place = likelihood.sensitive().binary_search(&sensitive);
                place.map_or(0.0, |place| sd * values[likelihood.data().len() + place])
            }
            _ => sd,
        };
    }
    Some(direction)
}
