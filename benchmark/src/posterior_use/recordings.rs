//! Synthetic recordings of `quasi_static` whose soil changes twice: coverage of the true parameters in time, delays of detection, false
//! alarms, and the time that a sample takes.
//!
//! A truth is drawn from the prior and calibrated from six runs. Then slip and load of a wheel oscillate for 200 s at 10 Hz, with noise of
//! the samples that is correlated over 0.2 s, while the soil is replaced twice by another draw from the prior. Radius and shear modulus
//! stay.

use std::fmt;
use std::sync::Arc;
use std::time::Instant;

use coordinator::embedded::Evaluate;
use inference::tracking::tracker::WALK_SIZES;
use job::Spec;
use prediction::recording::{
    CompiledModel, FollowedRecording, RecordedTime, RecordingFollower, read_samples,
};
use result::FinishedCalibration;
use shared::channel::Channel;
use shared::file::FileSet;
use shared::model::{ModelVariant, RunCondition};
use shared::outcome::Outcome;
use statistics::rng::Stream;

use super::finished::finished;
use crate::error::StudyError;
use crate::parallel::each;

const EXPERIMENT: &str = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.2\ntorque_n_m = 0.15\nsinkage_m = 0.0004\n";
const JOB: &str = "[model]\nkind = \"quasi_static\"\n[priors]\nlog10_p_ref = { uniform = [4.0, 5.6] }\nkappa = 0.0\nn = { normal = [1.1, 0.2], bounds = [0.8, 2.0] }\nfriction_angle_deg = { normal = [28.0, 5.0], bounds = [11.5, 45.0] }\nwheel_radius_m = { uniform = [0.125, 0.155] }\n\"janosi_hanamoto.shear_modulus_m\" = { lognormal = [0.01, 1.8] }\n[sampler]\nparticles = 400\n";
/// The parameters of the soil, in the order of the answer.
pub const SOIL: [&str; 3] = ["log10_p_ref", "n", "friction_angle_deg"];
const CONDITIONS: [(f64, f64); 6] = [
    (0.05, 60.0),
    (0.15, 60.0),
    (0.3, 60.0),
    (0.05, 120.0),
    (0.15, 120.0),
    (0.3, 120.0),
];
const SLED_SPEED_M_S: f64 = 0.02;
/// The measured channels with the noise of a run and that of a sample.
const MEASURED: [(Channel, f64, f64); 3] = [
    (Channel::DrawbarPull, 1.2, 4.0),
    (Channel::Torque, 0.15, 0.5),
    (Channel::Sinkage, 0.0004, 0.0015),
];
/// Correlation of the noise of neighbouring samples.
const CORRELATION: f64 = 0.6;
/// The first random stream of this study, which no sampler uses.
const STAGE: u64 = 1 << 47;
/// The largest number of draws of the prior that the model may refuse.
const MAX_REFUSED: u64 = 2000;
/// Number of samples.
const SAMPLES: usize = 2000;
/// Times of the changes `[s]`.
pub const CHANGES_S: [f64; 2] = [70.0, 140.0];
/// Time after a change, and after the first sample, that does not count for the coverage `[s]`.
pub const SETTLING_S: f64 = 5.0;

/// What a recording shows.
#[derive(Debug)]
pub struct Judged {
    /// At each time: the time `[s]`, and whether the interval of each parameter of the soil holds the truth.
    held: Vec<(f64, [bool; 3])>,
    /// Delay of each change `[s]`; `None` if it was not found before the next one.
    delays: Vec<Option<f64>>,
    /// Changes that were flagged and did not happen.
    false_alarms: usize,
    /// Time that each sample took `[s]`.
    sample_s: Vec<f64>,
    /// Probability of each size of the walk at the end.
    walk: Vec<f64>,
}

/// What many recordings show.
#[derive(Debug)]
pub struct Tally {
    name: &'static str,
    recordings: Vec<Judged>,
}

impl Tally {
    /// Returns the share of times and recordings at which the interval of a parameter holds the truth.
    ///
    /// # Arguments
    /// - `settling_s`: time after a change that does not count.
    pub fn coverage(&self, parameter: usize, settling_s: f64) -> f64 {
        let begins = [0.0, CHANGES_S[0], CHANGES_S[1]];
        let settled = |t_s: f64| {
            let since = begins.iter().rev().find(|begin| **begin < t_s);
            t_s - since.unwrap_or(&0.0) > settling_s
        };
        let counted = self.recordings.iter().flat_map(|judged| &judged.held);
        let counted: Vec<bool> = counted
            .filter(|(t_s, _)| settled(*t_s))
            .map(|(_, held)| held[parameter])
            .collect();
        counted.iter().filter(|held| **held).count() as f64 / counted.len() as f64
    }

    /// Returns the coverage over all parameters of the soil.
    pub fn mean_coverage(&self) -> f64 {
        (0..3)
            .map(|parameter| self.coverage(parameter, SETTLING_S))
            .sum::<f64>()
            / 3.0
    }

    /// Returns the delays of the changes that were found, in ascending order, and the number of those that were not.
    pub fn delays(&self) -> (Vec<f64>, usize) {
        let all: Vec<Option<f64>> = self
            .recordings
            .iter()
            .flat_map(|judged| judged.delays.clone())
            .collect();
        let mut found: Vec<f64> = all.iter().flatten().copied().collect();
        found.sort_by(f64::total_cmp);
        let missed = all.len() - found.len();
        (found, missed)
    }

    /// Returns the number of flagged changes that did not happen.
    pub fn false_alarms(&self) -> usize {
        self.recordings.iter().map(|judged| judged.false_alarms).sum()
    }

    /// Returns the times of samples `[s]`, in ascending order.
    pub fn sample_times_s(&self) -> Vec<f64> {
        let times = self.recordings.iter().flat_map(|judged| &judged.sample_s);
        let mut times: Vec<f64> = times.copied().collect();
        times.sort_by(f64::total_cmp);
        times
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.recordings.len();
        writeln!(f, "{count} recordings {}", self.name)?;
        for (parameter, name) in SOIL.iter().enumerate() {
            let [settled, all] = [SETTLING_S, 0.0].map(|after| 100.0 * self.coverage(parameter, after));
            writeln!(
                f,
                "  {name:<20} in the 90 % interval {settled:.1} % of the time, with settling {all:.1} %"
            )?;
        }
        writeln!(f, "  all parameters: {:.1} %", 100.0 * self.mean_coverage())?;
        let at = |sorted: &[f64], share: f64| {
            let place = (share * (sorted.len() as f64 - 1.0)).round();
            sorted.get(place as usize).copied().unwrap_or(f64::NAN)
        };
        let (delays, missed) = self.delays();
        if delays.len() + missed > 0 {
            writeln!(
                f,
                "  changes found {} of {}, delay {:.1} s (median), {:.1} s (90 %), {:.1} s (most)",
                delays.len(),
                delays.len() + missed,
                at(&delays, 0.5),
                at(&delays, 0.9),
                at(&delays, 1.0)
            )?;
        }
        writeln!(
            f,
            "  false alarms: {} in {:.0} s",
            self.false_alarms(),
            0.1 * (count * SAMPLES) as f64
        )?;
        let walk: Vec<String> = (0..WALK_SIZES.len())
            .map(|k| {
                let sum: f64 = self.recordings.iter().map(|judged| judged.walk[k]).sum();
                format!("{} ({:.2})", WALK_SIZES[k], sum / count as f64)
            })
            .collect();
        writeln!(f, "  sizes of the walk (mean probability): {}", walk.join(", "))?;
        let times = self.sample_times_s();
        writeln!(
            f,
            "  time of a sample: {:.2} ms (mean), {:.2} ms (99 %), {:.2} ms (most)",
            1e3 * times.iter().sum::<f64>() / times.len() as f64,
            1e3 * at(&times, 0.99),
            1e3 * at(&times, 1.0)
        )
    }
}

/// Follows a number of recordings, with two changes of the soil or without, on all threads of the machine.
///
/// # Arguments
/// - `walk`: standard deviation by which the soil walks in a second, over that of the prior, in normal scores.
pub fn run(count: u64, seed: u64, changes: bool, walk: f64) -> Result<Tally, StudyError> {
    let recordings = each(count, |number| {
        Campaign {
            number,
            seed,
            changes,
            walk,
        }
        .judged()
    })?;
    let name = match (changes, walk > 0.0) {
        (true, false) => "with two changes of the soil",
        (false, false) => "without a change",
        (true, true) => "with two changes of a soil that walks",
        (false, true) => "of a soil that walks",
    };
    Ok(Tally { name, recordings })
}

/// One recording.
struct Campaign {
    number: u64,
    seed: u64,
    changes: bool,
    walk: f64,
}

impl Campaign {
    fn judged(&self) -> Result<Judged, StudyError> {
        let blank = spec(&[[0.0; 3]; 6], 1)?;
        for attempt in 0..MAX_REFUSED {
            let mut stream = Stream::new(self.seed, STAGE, self.number, attempt);
            let truths = self.truths(&blank, &mut stream);
            let Some(rows) = self.runs(&blank, &truths[0], &mut stream)? else {
                continue;
            };
            let Some(text) = self.recording(&blank, &truths, &mut stream)? else {
                continue;
            };
            let calibration = finished(spec(&rows, self.seed + 1 + self.number)?)?;
            return self.judge(&blank, &calibration, &truths, &text);
        }
        Err(format!("the model refused {MAX_REFUSED} draws of the prior in a row").into())
    }

    /// Returns the parameters at each sample.
    fn truths(&self, blank: &Spec, stream: &mut Stream) -> Vec<Vec<f64>> {
        let prior = blank.prior();
        let varying = soil(blank);
        let mut theta = prior.sample(stream);
        let mut truths = Vec::with_capacity(SAMPLES);
        for i in 0..SAMPLES {
            let t_s = 0.1 * i as f64;
            let changes = self.changes && CHANGES_S.iter().any(|change| (change - t_s).abs() < 0.05);
            let other = prior.sample(stream);
            let variance = 0.1 * self.walk * self.walk;
            for &k in &varying {
                let marginal = &prior.marginals()[k];
                if changes {
                    theta[k] = other[k];
                } else if variance > 0.0 {
                    let step = variance.sqrt() * marginal.normal_score(other[k]);
                    let score = (1.0 - variance).sqrt() * marginal.normal_score(theta[k]) + step;
                    theta[k] = marginal.from_normal_score(score);
                }
            }
            truths.push(theta.clone());
        }
        truths
    }

    /// Returns the measured channels of the calibrated runs; `None` where the model refuses the parameters.
    fn runs(
        &self,
        blank: &Spec,
        theta: &[f64],
        stream: &mut Stream,
    ) -> Result<Option<[[f64; 3]; 6]>, StudyError> {
        let mut rows = [[0.0; 3]; 6];
        for (row, (slip, load)) in rows.iter_mut().zip(CONDITIONS) {
            let Some(values) = simulated(blank, theta, slip, load)? else {
                return Ok(None);
            };
            let noise = stream.normals(3);
            *row = std::array::from_fn(|k| values[k] + MEASURED[k].1 * noise[k]);
        }
        Ok(Some(rows))
    }

    /// Returns the recording as text; `None` where the model refuses the parameters.
    fn recording(
        &self,
        blank: &Spec,
        truths: &[Vec<f64>],
        stream: &mut Stream,
    ) -> Result<Option<String>, StudyError> {
        let mut text = "t_s,slip,wheel_load_n,sled_speed_m_s".to_owned();
        for (channel, _, _) in MEASURED {
            text += &format!(",{}", channel.column());
        }
        text.push('\n');
        let mut noise = stream.normals(3);
        for (i, theta) in truths.iter().enumerate() {
            let t_s = 0.1 * i as f64;
            let slip = 0.2 + 0.15 * libm::sin(t_s * std::f64::consts::TAU / 31.0);
            let load = 90.0 + 30.0 * libm::sin(t_s * std::f64::consts::TAU / 47.0);
            let Some(values) = simulated(blank, theta, slip, load)? else {
                return Ok(None);
            };
            text += &format!("{t_s:.1},{slip},{load},{SLED_SPEED_M_S}");
            let fresh = stream.normals(3);
            for k in 0..3 {
                noise[k] = CORRELATION * noise[k] + (1.0 - CORRELATION * CORRELATION).sqrt() * fresh[k];
                text += &format!(",{}", values[k] + MEASURED[k].2 * noise[k]);
            }
            text.push('\n');
        }
        Ok(Some(text))
    }

    fn judge(
        &self,
        blank: &Spec,
        calibration: &FinishedCalibration,
        truths: &[Vec<f64>],
        text: &str,
    ) -> Result<Judged, StudyError> {
        let compile = |variant: &ModelVariant| -> Result<CompiledModel, String> {
            Ok(Evaluate::new(variant)?.at_one_condition())
        };
        let mut follower = RecordingFollower::new(calibration, &[], &compile)?;
        let defaults = RecordingFollower::defaults(calibration);
        let (mut times, mut sample_s): (Vec<RecordedTime>, Vec<f64>) = (Vec::new(), Vec::new());
        for sample in read_samples(text.as_bytes(), None, &defaults)? {
            let sample = sample?;
            let begin = Instant::now();
            times.extend(follower.take(sample)?);
            sample_s.push(begin.elapsed().as_secs_f64());
        }
        let followed = follower.end(times);
        let varying = soil(blank);
        let held = followed.times.iter().map(|time| {
            let truth = &truths[((time.t_s * 10.0).round() as usize).min(SAMPLES - 1)];
            let holds = std::array::from_fn(|k| {
                let [low, high] = time.parameters[k].interval;
                (low..=high).contains(&truth[varying[k]])
            });
            (time.t_s, holds)
        });
        let (delays, false_alarms) = self.delays(&followed);
        Ok(Judged {
            held: held.collect(),
            delays,
            false_alarms,
            sample_s,
            walk: followed.walk.iter().map(|size| size.probability).collect(),
        })
    }

    /// Returns the delays of the changes, and the number of flagged changes that did not happen.
    fn delays(&self, followed: &FollowedRecording) -> (Vec<Option<f64>>, usize) {
        if !self.changes {
            return (Vec::new(), followed.changes.len());
        }
        let mut right = 0;
        let delays = CHANGES_S.iter().enumerate().map(|(i, change)| {
            let next = CHANGES_S.get(i + 1).copied().unwrap_or(f64::INFINITY);
            let mut flagged = followed.changes.iter();
            let found = flagged.find(|flagged| flagged.found_s >= *change && flagged.found_s < next)?;
            right += 1;
            Some(found.found_s - change)
        });
        let delays: Vec<Option<f64>> = delays.collect();
        (delays, followed.changes.len() - right)
    }
}

/// Returns the positions of the parameters of the soil.
fn soil(blank: &Spec) -> Vec<usize> {
    let names = blank.fit_variant.parameters.iter().enumerate();
    names
        .filter(|(_, name)| SOIL.contains(&name.as_str()))
        .map(|(i, _)| i)
        .collect()
}

/// Returns the channels of a condition; `None` where the model refuses the parameters.
fn simulated(blank: &Spec, theta: &[f64], slip: f64, load: f64) -> Result<Option<[f64; 3]>, StudyError> {
    let condition = RunCondition {
        slip,
        wheel_load_n: load,
        sled_speed_m_s: SLED_SPEED_M_S,
        ..blank.fit_variant.conditions[0].clone()
    };
    let variant = ModelVariant {
        conditions: Arc::new([condition]),
        ..blank.fit_variant.clone()
    };
    match Evaluate::new(&variant)?.evaluate(blank.model_theta(theta)) {
        Outcome::Evaluated(seen) => Ok(Some(MEASURED.map(|(channel, _, _)| seen.channel(channel)[0]))),
        Outcome::Rejected(_) => Ok(None),
        Outcome::Fault(fault) => Err(fault.message.into()),
    }
}

/// Returns the specification of a calibration of measured rows.
fn spec(rows: &[[f64; 3]; 6], seed: u64) -> Result<Spec, StudyError> {
    let mut runs = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s".to_owned();
    for (channel, _, _) in MEASURED {
        runs += &format!(",{}", channel.column());
    }
    for (number, ((slip, load), row)) in CONDITIONS.iter().zip(rows).enumerate() {
        let [pull, torque, sinkage] = row;
        runs += &format!("\nr{number},w,s,{slip},{load},{SLED_SPEED_M_S},{pull},{torque},{sinkage}");
    }
    let files = FileSet {
        toml: EXPERIMENT.into(),
        files: [("runs.csv".to_owned(), runs + "\n")].into(),
    };
    let job = FileSet {
        toml: format!("{JOB}seed = {seed}\n"),
        files: Default::default(),
    };
    Ok(Spec::new("job.toml", &job, "experiment.toml", &files)?)
}
