//! Draws of the posterior of a job, by the sampler or by a fit with its normal approximation.

use farm::calibration::CalibrationResult;
use shared::file::FileSet;

use super::case::spec;
use crate::calibration::calibrate;
use crate::error::StudyError;

/// A sample of the posterior.
#[derive(Debug, Clone)]
pub struct PosteriorSample {
    pub log_evidence: f64,
    parameters: Vec<String>,
    draws: Vec<Vec<f64>>,
    log_likelihoods: Vec<f64>,
}

impl PosteriorSample {
    /// Returns the highest ln p(data | theta) among the draws.
    pub fn highest(&self) -> f64 {
        let all = self.log_likelihoods.iter().copied();
        all.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns the name of each parameter, the mean of its draws and their sd.
    pub fn moments(&self) -> impl Iterator<Item = (&str, f64, f64)> {
        let count = self.draws.len() as f64;
        self.parameters.iter().enumerate().map(move |(k, name)| {
            let mean = self.draws.iter().map(|draw| draw[k]).sum::<f64>() / count;
            let squares: f64 = self.draws.iter().map(|draw| (draw[k] - mean).powi(2)).sum();
            (name.as_str(), mean, (squares / (count - 1.0)).sqrt())
        })
    }

    /// Returns the draws in the form of `posterior.csv`.
    pub fn csv(&self) -> String {
        let mut text = self.parameters.join(",");
        for draw in &self.draws {
            let cells: Vec<String> = draw.iter().map(|x| format!("{x:?}")).collect();
            text += "\n";
            text += &cells.join(",");
        }
        text + "\n"
    }
}

/// Calibrates a job.
///
/// # Arguments
/// - `sampler`: the table `[sampler]` without its seed.
pub fn sample(
    job: &FileSet,
    experiment: &FileSet,
    sampler: &str,
    seed: u64,
) -> Result<PosteriorSample, StudyError> {
    let job = FileSet {
        toml: format!("{}{sampler}seed = {seed}\n", job.toml),
        files: job.files.clone(),
    };
    let spec = spec(&job, experiment)?;
    let parameters = spec.parameters.iter().map(|p| p.name.clone()).collect();
    let calibration = calibrate(spec)?;
    let (log_evidence, particles) = match calibration.engine().finding() {
        Some(CalibrationResult::Posterior(posterior)) => (posterior.log_evidence, &posterior.particles),
        Some(CalibrationResult::Estimate(estimate)) => {
            let normal = estimate.approximation.as_ref().ok_or("the fit gives no draws")?;
            (normal.log_evidence, &normal.draws)
        }
        Some(CalibrationResult::Discovery(_)) | None => return Err("the calibration has no posterior".into()),
    };
    Ok(PosteriorSample {
        log_evidence,
        parameters,
        draws: particles.iter().map(|p| p.theta.clone()).collect(),
        log_likelihoods: particles.iter().map(|p| p.log_likelihood.value()).collect(),
    })
}
