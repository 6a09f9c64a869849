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

use super::design::{CHANNELS, Plan, PlannedRun, experiment};
use super::error::StudyError;

/// Random streams of this study, separate from those of samplers and searches.
const STAGE: u64 = 1 << 41;
/// Most draws of the prior in a row that the model rejects.
const MAX_REFUSED: u64 = 1000;
/// Noise sd of a channel over the root mean square of its noise-free values in the fitted runs.
pub const NOISE: f64 = 0.03;

/// The values of a run, in the order of the channels.
type Values = [f64; CHANNELS];

/// A synthetic experiment and its truth.
#[derive(Debug, Clone)]
pub struct SyntheticCase {
    pub plan: Plan,
    /// The hidden effects, and the job of the model with them.
    pub hidden: Vec<String>,
    pub truth_job: FileSet,
    pub theta: Vec<f64>,
    pub rows: Vec<PlannedRun>,
    pub noise_free: Vec<Values>,
    pub measured: Vec<Values>,
    pub sds: Values,
}

/// Parses a job and its experiment.
pub fn spec(job: &FileSet, experiment: &FileSet) -> Result<Spec, StudyError> {
    Ok(Spec::new("job.toml", job, "experiment.toml", experiment)?)
}

/// The values of each run.
pub fn values(seen: &Observables, runs: usize) -> Vec<Values> {
    let of = |channel: Channel, run: usize| seen.channel(channel)[run];
    (0..runs)
        .map(|run| [Channel::DrawbarPull, Channel::Torque, Channel::Sinkage].map(|c| of(c, run)))
        .collect()
}

fn evaluated(variant: &ModelVariant, theta: &[f64]) -> Result<Option<Vec<Values>>, StudyError> {
    match Evaluate::new(variant)?.evaluate(theta) {
        Outcome::Evaluated(seen) => Ok(Some(values(&seen, variant.conditions.len()))),
        Outcome::Rejected(_) => Ok(None),
        Outcome::Fault(fault) => Err(format!("{fault:?}").into()),
    }
}

/// Placeholder values before the runs are made.
pub fn blank(rows: &[PlannedRun]) -> FileSet {
    experiment(rows, &vec![[0.0; CHANNELS]; rows.len()], [1.0; CHANNELS])
}

/// Runs a known model; `None` where it rejects one of the runs.
pub fn run(job: &FileSet, rows: &[PlannedRun], theta: &[f64]) -> Result<Option<Vec<Values>>, StudyError> {
    let spec = spec(job, &blank(rows))?;
    let theta = spec.model_theta(theta);
    let Some(mut all) = evaluated(&spec.fit_variant, theta)? else {
        return Ok(None);
    };
    if let Some(variant) = &spec.holdout_variant {
        let Some(holdout) = evaluated(variant, theta)? else {
            return Ok(None);
        };
        all.extend(holdout);
    }
    Ok(Some(all))
}

impl SyntheticCase {
    /// Draws a truth from the priors of the base and the hidden effects, and measures it.
    ///
    /// # Arguments
    /// - `hidden`: the name of each effect with its addition to the job. `attempt`: another truth of the same number.
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
        for refused in 0..MAX_REFUSED {
            let stage = STAGE + 2 * attempt;
            let theta = prior.sample(&mut Stream::new(seed, stage, number, refused));
            let Some(noise_free) = run(&truth_job, &rows, &theta)? else {
                continue;
            };
            let mut sds = [0.0; CHANNELS];
            for (channel, sd) in sds.iter_mut().enumerate() {
                let fitted = rows.iter().zip(&noise_free).filter(|(row, _)| !row.is_holdout);
                let squares: Vec<f64> = fitted.map(|(_, v)| v[channel] * v[channel]).collect();
                *sd = NOISE * (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
            }
            let mut noise = Stream::new(seed, stage + 1, number, 0)
                .normals(CHANNELS * rows.len())
                .into_iter();
            let mut noisy = |v: &Values| {
                let mut measured = *v;
                for (x, sd) in measured.iter_mut().zip(sds) {
                    *x += sd * noise.next().unwrap_or(0.0);
                }
                measured
            };
            return Ok(Self {
                plan,
                hidden: hidden.iter().map(|(name, _)| name.clone()).collect(),
                measured: noise_free.iter().map(&mut noisy).collect(),
                truth_job,
                theta,
                rows,
                noise_free,
                sds,
            });
        }
        Err(format!("the model rejected {MAX_REFUSED} draws of the prior in a row").into())
    }

    /// The files of a campaign on the same soil before its effects acted; `None` where the model rejects that.
    ///
    /// # Arguments
    /// - `noise`: the random stream of its noise.
    pub fn reference(&self, mut noise: Stream) -> Result<Option<FileSet>, StudyError> {
        let names = |job: &FileSet| {
            let all = spec(job, &blank(&self.rows))?.parameters;
            Ok::<_, StudyError>(all.into_iter().map(|p| p.name).collect::<Vec<_>>())
        };
        let with = names(&self.truth_job)?;
        let place = |name: &String| with.iter().position(|own| own == name);
        let base = names(&self.plan.job())?;
        let theta: Vec<f64> = base
            .iter()
            .filter_map(|name| Some(self.theta[place(name)?]))
            .collect();
        let Some(mut values) = run(&self.plan.job(), &self.rows, &theta)? else {
            return Ok(None);
        };
        let mut normals = noise.normals(CHANNELS * values.len()).into_iter();
        for (x, sd) in values.iter_mut().flat_map(|run| run.iter_mut().zip(self.sds)) {
            *x += sd * normals.next().unwrap_or(0.0);
        }
        Ok(Some(experiment(&self.rows, &values, self.sds)))
    }

    /// The files that the search gets.
    pub fn experiment(&self) -> FileSet {
        experiment(&self.rows, &self.measured, self.sds)
    }

    /// The same without noise.
    pub fn noise_free(&self) -> FileSet {
        experiment(&self.rows, &self.noise_free, self.sds)
    }
}
