//! A synthetic experiment: a truth drawn from the priors, and its measurements with noise.

use coordinator::embedded::Evaluate;
use job::Spec;
use record::Extension;
use search::candidate::extended;
use shared::channel::Channel;
use shared::file::FileSet;
use shared::model::ModelVariant;
use shared::outcome::{Observables, Outcome};
use statistics::rng::Stream;

use super::design::{CHANNELS, Plan, PlannedRun, experiment, experiment_stating};
use super::noise::{RunValues, add_heavy_noise, add_noise, noise_sds};
use super::wheel_size::WheelSize;
use crate::error::StudyError;

/// The first random stream of this study, which no sampler and no search uses.
const STAGE: u64 = 1 << 41;
/// The largest number of consecutive draws of the prior that the model may reject.
pub const MAX_REJECTED: u64 = 1000;
/// Noise sd of a channel over the root mean square of its noise-free values in the fitted runs.
pub const NOISE: f64 = 0.03;

/// A synthetic experiment and its truth.
#[derive(Debug, Clone)]
pub struct SyntheticCase {
    pub plan: Plan,
    /// The hidden effects, and the job of the model with them.
    pub hidden: Vec<String>,
    pub truth_job: FileSet,
    pub theta: Vec<f64>,
    /// The size of the wide wheel that the experiment states.
    pub stated: WheelSize,
    pub rows: Vec<PlannedRun>,
    pub noise_free: Vec<RunValues>,
    pub measured: Vec<RunValues>,
    pub sds: RunValues,
}

/// Parses a job and its experiment.
pub fn spec(job: &FileSet, experiment: &FileSet) -> Result<Spec, StudyError> {
    Ok(Spec::new("job.toml", job, "experiment.toml", experiment)?)
}

/// Returns the values of each run.
pub fn values(seen: &Observables, runs: usize) -> Vec<RunValues> {
    let channels = [Channel::DrawbarPull, Channel::Torque, Channel::Sinkage];
    (0..runs)
        .map(|run| channels.map(|channel| seen.channel(channel)[run]))
        .collect()
}

fn evaluated(variant: &ModelVariant, theta: &[f64]) -> Result<Option<Vec<RunValues>>, StudyError> {
    match Evaluate::new(variant)?.evaluate(theta) {
        Outcome::Evaluated(seen) => Ok(Some(values(&seen, variant.conditions.len()))),
        Outcome::Rejected(_) => Ok(None),
        Outcome::Fault(fault) => Err(format!("{fault:?}").into()),
    }
}

/// Returns the files of an experiment whose runs are not measured yet: every value is zero.
pub fn blank(rows: &[PlannedRun]) -> FileSet {
    experiment(rows, &vec![[0.0; CHANNELS]; rows.len()], [1.0; CHANNELS])
}

/// Simulates the runs with a parameter vector; `None` if the model rejects one of them.
pub fn run(job: &FileSet, rows: &[PlannedRun], theta: &[f64]) -> Result<Option<Vec<RunValues>>, StudyError> {
    let spec = spec(job, &blank(rows))?;
    let theta = spec.model_theta(theta);
    let mut all = Vec::new();
    for variant in [Some(&spec.fit_variant), spec.holdout_variant.as_ref()]
        .into_iter()
        .flatten()
    {
        let Some(values) = evaluated(variant, theta)? else {
            return Ok(None);
        };
        all.extend(values);
    }
    Ok(Some(all))
}

impl SyntheticCase {
    /// Draws a truth from the priors of the base and the hidden effects, and measures it.
    ///
    /// # Arguments
    /// - `hidden`: the name of each effect with its addition to the job. `attempt`: distinguishes truths of the same number.
    pub fn draw(
        plan: Plan,
        hidden: &[(String, Extension)],
        seed: u64,
        number: u64,
        attempt: u64,
    ) -> Result<Self, StudyError> {
        let extensions: Vec<&Extension> = hidden.iter().map(|(_, extension)| extension).collect();
        let truth_job = extended("job.toml", &plan.job(), &extensions)?;
        let rows = plan.rows();
        let prior = spec(&truth_job, &blank(&rows))?.prior();
        for rejected in 0..MAX_REJECTED {
            let stage = STAGE + 2 * attempt;
            let theta = prior.sample(&mut Stream::new(seed, stage, number, rejected));
            let Some(noise_free) = run(&truth_job, &rows, &theta)? else {
                continue;
            };
            let fitted = rows.iter().zip(&noise_free).filter(|(row, _)| !row.is_holdout);
            let sds = noise_sds(NOISE, fitted.map(|(_, values)| values));
            let mut measured = noise_free.clone();
            add_noise(&mut measured, sds, &mut Stream::new(seed, stage + 1, number, 0));
            return Ok(Self {
                plan,
                hidden: hidden.iter().map(|(name, _)| name.clone()).collect(),
                measured,
                truth_job,
                theta,
                stated: WheelSize::TRUE,
                rows,
                noise_free,
                sds,
            });
        }
        Err(format!("the model rejected {MAX_REJECTED} draws of the prior in a row").into())
    }

    /// Measures the same truth again, with noise of the same sds that has heavy tails.
    pub fn measured_with_heavy_noise(mut self, mut noise: Stream) -> Self {
        self.measured.clone_from(&self.noise_free);
        add_heavy_noise(&mut self.measured, self.sds, &mut noise);
        self
    }

    /// Returns the files of a campaign on the same soil without the hidden effects; `None` if the model rejects it.
    ///
    /// # Arguments
    /// - `noise`: the random stream of its noise.
    pub fn reference(&self, mut noise: Stream) -> Result<Option<FileSet>, StudyError> {
        let names = |job: &FileSet| {
            let all = spec(job, &blank(&self.rows))?.parameters;
            Ok::<_, StudyError>(all.into_iter().map(|p| p.name).collect::<Vec<_>>())
        };
        let with = names(&self.truth_job)?;
        let place = |name: &String| with.iter().position(|parameter| parameter == name);
        let base = names(&self.plan.job())?;
        let theta: Vec<f64> = base
            .iter()
            .filter_map(|name| Some(self.theta[place(name)?]))
            .collect();
        let Some(mut values) = run(&self.plan.job(), &self.rows, &theta)? else {
            return Ok(None);
        };
        add_noise(&mut values, self.sds, &mut noise);
        Ok(Some(experiment(&self.rows, &values, self.sds)))
    }

    /// Returns the files of the measured experiment.
    pub fn experiment(&self) -> FileSet {
        experiment_stating(self.stated, &self.rows, &self.measured, self.sds)
    }

    /// Returns the files of the experiment without noise.
    pub fn noise_free(&self) -> FileSet {
        experiment_stating(self.stated, &self.rows, &self.noise_free, self.sds)
    }
}
