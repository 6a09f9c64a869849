//! Prior-data conflict: whether the posterior lies where the prior did not expect it.

use super::spectrum::{mean_and_covariance, principal_directions};
use super::tail::chi_square_tail;
use statistics::likelihood::ErrorLaw;
use statistics::prior::Prior;

/// Ratio of posterior to prior variance above which a direction is left out: the data say too little about it.
const INFORMED: f64 = 0.75;

/// The distance of the posterior from the prior.
#[derive(Debug, Clone, PartialEq)]
pub struct Conflict {
    /// For each parameter the probability of a posterior this far out, if the prior is right; `None` if the data hold too little
    /// information.
    pub parameters: Vec<Option<f64>>,
    /// Squared distance of the posterior's mean over all directions that the data inform.
    pub statistic: f64,
    /// Number of these directions.
    pub degrees_of_freedom: usize,
    /// Probability of a distance this large; `None` where no direction is informed.
    pub p: Option<f64>,
}

/// Compares the posterior with the prior; `None` with fewer than two draws.
///
/// # Equation
/// Every parameter is turned into its normal score `u = Phi^-1(F(theta))`, F its prior distribution, so that the prior is
/// standard normal; where it is correlated, D takes scores made independent. With m and S the posterior's mean and covariance of
/// u, `z_i = m_i / sqrt(1 - S_ii)`, and over the eigenvectors v of S with eigenvalues l, `D = sum (v'm)^2 / (1 - l)`. Under the
/// prior predictive distribution `Cov(m) = I - S`, so z is standard normal and D chi-square.
///
/// # Arguments
/// - `draws`: equally weighted draws of the posterior, in the order of the prior.
///
/// # Validity
/// Exact where predictions are linear in the scores and errors normal with known sds; D is then the check of Evans and Moshonov
/// on the minimal sufficient statistic. Directions whose variance is above 0.75 of the prior's are left out: 1 - l would be
/// sampling error.
///
/// # Source
/// Evans & Moshonov 2006, *Checking for prior-data conflict*, Bayesian Analysis 1:893, doi:10.1214/06-BA129, section 3. Checked by
/// `diagnostics::conflict_is_rare_where_the_prior_is_right` and `diagnostics::a_prior_that_is_wrong_is_contradicted`.
#[must_use]
pub fn conflict(prior: &Prior, draws: &[&[f64]]) -> Option<Conflict> {
    let mut scores: Vec<Vec<f64>> = draws
        .iter()
        .map(|theta| {
            let marginals = prior.marginals().iter().zip(*theta);
            marginals.map(|(marginal, &x)| marginal.normal_score(x)).collect()
        })
        .collect();
    let (mean, covariance) = mean_and_covariance(&scores)?;
    // The mean of the draws has a sampling error of its own.
    let sampling = 1.0 / draws.len() as f64;
    let squared_z = |distance: f64, variance: f64| {
        (variance < INFORMED).then(|| distance * distance / (1.0 - variance + variance * sampling))
    };
    let parameters = mean
        .iter()
        .enumerate()
        .map(|(i, &m)| Some(two_sided(squared_z(m, covariance[(i, i)])?.sqrt())))
        .collect();
    scores
        .iter_mut()
        .for_each(|scores| prior.make_independent(scores));
    let (centre, _) = mean_and_covariance(&scores)?;
    let informed: Vec<f64> = principal_directions(&scores)
        .iter()
        .filter_map(|direction| {
            let along: f64 = direction.loadings.iter().zip(&centre).map(|(v, m)| v * m).sum();
            squared_z(along, direction.variance)
        })
        .collect();
    let statistic = informed.iter().sum();
    Some(Conflict {
        parameters,
        statistic,
        degrees_of_freedom: informed.len(),
        p: chi_square_tail(statistic, informed.len() as f64),
    })
}

/// Returns P(|Z| >= z) of a standard normal Z.
fn two_sided(z: f64) -> f64 {
    2.0 * ErrorLaw::Gaussian.cumulative(-z.abs())
}
