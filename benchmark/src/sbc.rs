//! Draw data sets from the prior, calibrate each, and ask where the truth ranks.
//!
//! A parameter vector is drawn from the prior, three runs are simulated at it and noise is added; the calibration of these
//! data sees nothing else. If the whole chain is right (prior, likelihood, sampler, model through the worker's evaluator), the
//! truth is one more draw of the posterior: its rank among independent draws is uniform, whatever the problem.
//!
//! Vectors that the model refuses are drawn again: the prior is conditioned on a model that answers, and so is the sampler's,
//! to which a refusal is a likelihood of zero.
//!
//! # Source
//! Talts, Betancourt, Simpson, Vehtari, Gelman 2018, "Validating Bayesian inference algorithms with simulation-based
//! calibration", arXiv:1804.06788.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use coordinator::embedded::Evaluate;
use farm::calibration::{Calibration, CalibrationIdentity, CalibrationResult, SimulationResult};
use inference::diagnostics::chi_square_tail;
use inference::diagnostics::quantile;
use job::Spec;
use shared::channel::Channel;
use shared::file::FileSet;
use shared::outcome::Outcome;
use statistics::rng::Stream;

/// Draws of a posterior that the truth is ranked among: evenly spaced, because particles beside one another may be copies.
pub const RANKED: usize = 19;
/// Vectors of the prior that the model may refuse in a row.
const MAX_REFUSED: u64 = 1000;
/// Streams of this study, far from those of any sampler.
const STAGE: u64 = 1 << 40;

const EXPERIMENT: &str = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\n[soil.s]\n[noise]\ndrawbar_pull_n = \"unknown\"\ntorque_n_m = 0.3\nsinkage_m = 0.0008\n";
const CONDITIONS: [&str; 3] = ["a,w,s,0.1,80,0.01", "b,w,s,0.3,120,0.01", "c,w,s,0.6,100,0.01"];
/// The channels of runs.csv behind the conditions.
const MEASURED: [Channel; 3] = [Channel::DrawbarPull, Channel::Torque, Channel::Sinkage];

/// What is calibrated, how often.
#[derive(Debug, Clone, Copy)]
pub struct Study {
    /// Number of data sets.
    pub sets: usize,
    /// Particles of each calibration.
    pub particles: usize,
    /// Seed of data and calibrations.
    pub seed: u64,
    /// Factor on the noise that is added, which the calibration does not know of: 1, or a mistake to be found.
    pub noise_factor: f64,
}

/// How one truth fared.
#[derive(Debug, Clone)]
pub struct Fate {
    /// By parameter: how many of [`RANKED`] draws lie below the truth.
    pub ranks: Vec<usize>,
    /// By parameter: whether the truth lies between the 5 % and the 95 % quantile of all draws.
    pub covered: Vec<bool>,
    /// Whether every stage reached equilibrium.
    pub equilibrated: bool,
    /// Vectors of the prior that the model refused before it took one.
    pub refused: u64,
}

/// A data set and where it comes from.
struct Case {
    truth: Vec<f64>,
    /// Drawbar pull, torque and sinkage of each run.
    measured: Vec<[f64; 3]>,
    /// Vectors of the prior that the model refused before.
    refused: u64,
}

impl Study {
    fn job(&self, seed: u64) -> String {
        let particles = self.particles;
        format!(
            "[model]\nkind = \"quasi_static\"\n[priors]\nlog10_p_ref = {{ uniform = [4.0, 5.6] }}\nkappa = 0.0\nn = {{ normal = [1.1, 0.2], bounds = [0.8, 2.0] }}\nfriction_angle_deg = {{ normal = [30.0, 5.7], bounds = [11.5, 45.0] }}\nwheel_radius_m = {{ uniform = [0.125, 0.155] }}\n\"noise.drawbar_pull_n\" = {{ lognormal = [2.0, 1.5] }}\n[sampler]\nparticles = {particles}\nseed = {seed}\n"
        )
    }

    /// The specification of measured rows.
    fn spec(&self, rows: &[[f64; 3]], seed: u64) -> Result<Spec, String> {
        let mut runs = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s".to_owned();
        for channel in MEASURED {
            runs += &format!(",{}", channel.column());
        }
        for (condition, row) in CONDITIONS.iter().zip(rows) {
            runs += &format!("\n{condition},{},{},{}", row[0], row[1], row[2]);
        }
        let files = FileSet {
            toml: EXPERIMENT.into(),
            files: [("runs.csv".to_owned(), runs + "\n")].into(),
        };
        let job = FileSet {
            toml: self.job(seed),
            files: Default::default(),
        };
        Spec::new("job.toml", &job, "experiment.toml", &files).map_err(|e| e.to_string())
    }

    /// Names of the parameters that are calibrated.
    pub fn parameters(&self) -> Result<Vec<String>, String> {
        let spec = self.spec(&[[0.0; 3]; 3], 1)?;
        Ok(spec.parameters.into_iter().map(|p| p.name).collect())
    }

    /// Every data set, on as many threads as the machine has; which of them does what changes nothing.
    pub fn run(&self) -> Result<Vec<Fate>, String> {
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let next = AtomicUsize::new(0);
        let work = || {
            let mut done = Vec::new();
            loop {
                let set = next.fetch_add(1, Ordering::Relaxed);
                if set >= self.sets {
                    return Ok(done);
                }
                done.push((set, self.one(set as u64)?));
            }
        };
        let parts = std::thread::scope(|scope| {
            let started: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
            let joined = started.into_iter().map(|thread| thread.join());
            joined.collect::<Vec<Result<Result<Vec<_>, String>, _>>>()
        });
        let mut fates = Vec::new();
        for part in parts {
            fates.extend(part.map_err(|_| "a thread panicked".to_owned())??);
        }
        fates.sort_by_key(|(set, _)| *set);
        Ok(fates.into_iter().map(|(_, fate)| fate).collect())
    }

    /// Draws a truth, measures it, calibrates.
    fn one(&self, set: u64) -> Result<Fate, String> {
        let blank = self.spec(&[[0.0; 3]; 3], 1)?;
        let model = Evaluate::new(&blank.fit_variant)?;
        let Case {
            truth,
            measured,
            refused,
        } = self.measure(&blank, &model, set)?;
        let spec = self.spec(&measured, self.seed + 1 + set)?;
        let identity = CalibrationIdentity {
            id: 0,
            name: "sbc".into(),
            study: 0,
            experiment: 0,
        };
        let mut calibration = Calibration::new(identity, Arc::new(spec)).map_err(|e| e.to_string())?;
        loop {
            match calibration.engine().finding() {
                None => {}
                Some(CalibrationResult::Estimate(_) | CalibrationResult::Discovery(_)) => {
                    return Err("what was found is no posterior".into());
                }
                Some(CalibrationResult::Posterior(posterior)) => {
                    let draws = |parameter: usize| -> Vec<f64> {
                        posterior.particles.iter().map(|p| p.theta[parameter]).collect()
                    };
                    let (ranks, covered) = truth
                        .iter()
                        .enumerate()
                        .map(|(parameter, &x)| {
                            let draws = draws(parameter);
                            (rank(&draws, x), covered(&draws, x))
                        })
                        .unzip();
                    return Ok(Fate {
                        ranks,
                        covered,
                        equilibrated: posterior.equilibrated,
                        refused,
                    });
                }
            }
            if let Some(message) = &calibration.message {
                return Err(format!("data set {set}: {message}"));
            }
            for evaluation in calibration.queue.asked() {
                let Some(question) = calibration.question(evaluation) else {
                    break;
                };
                let outcome = model.evaluate(question.theta);
                SimulationResult::new(Some(outcome), None)
                    .and_then(|computed| calibration.complete(evaluation, computed, "sbc"))
                    .map_err(|e| e.to_string())?;
            }
        }
    }

    /// A truth that the model takes, its noisy measurements, and how many vectors the model refused before.
    fn measure(&self, spec: &Spec, model: &Evaluate, set: u64) -> Result<Case, String> {
        for refused in 0..MAX_REFUSED {
            let truth = spec
                .prior()
                .sample(&mut Stream::new(self.seed, STAGE, set, refused));
            let Outcome::Evaluated(seen) = model.evaluate(spec.model_theta(&truth)) else {
                continue;
            };
            let [pull_sd] = truth[spec.fit_variant.parameters.len()..] else {
                return Err("one noise sd is unknown".into());
            };
            let noise = Stream::new(self.seed, STAGE + 1, set, 0).normals(3 * CONDITIONS.len());
            let measured = (0..CONDITIONS.len()).map(|run| {
                let mut k = 3 * run;
                MEASURED.map(|channel| {
                    let sd = match channel {
                        Channel::DrawbarPull => pull_sd,
                        Channel::Torque => 0.3,
                        _ => 0.0008,
                    };
                    k += 1;
                    seen.channel(channel)[run] + self.noise_factor * sd * noise[k - 1]
                })
            });
            return Ok(Case {
                measured: measured.collect(),
                truth,
                refused,
            });
        }
        Err(format!(
            "the model refused {MAX_REFUSED} draws of the prior in a row"
        ))
    }
}

/// How many of [`RANKED`] evenly spaced draws lie below a value.
fn rank(draws: &[f64], value: f64) -> usize {
    let spaced = (0..RANKED).map(|k| draws[(2 * k + 1) * draws.len() / (2 * RANKED)]);
    spaced.filter(|draw| *draw < value).count()
}

/// Whether a value lies between the 5 % and the 95 % quantile of the draws.
fn covered(draws: &[f64], value: f64) -> bool {
    let at = |p: f64| quantile(draws, p);
    at(0.05).is_some_and(|low| low <= value) && at(0.95).is_some_and(|high| value <= high)
}

/// What one parameter's ranks and intervals say.
#[derive(Debug, Clone)]
pub struct Verdict {
    /// Name of the parameter.
    pub parameter: String,
    /// How many ranks fall into each of equal bins.
    pub counts: Vec<usize>,
    /// Probability of a chi-square as large, were the ranks uniform.
    pub p: f64,
    /// Share of the data sets whose 90 % interval holds the truth.
    pub coverage: f64,
    /// Probability of a share as far from 90 %, both sides, were the intervals exact.
    pub coverage_p: f64,
}

/// Judges every parameter by its ranks in so many bins, a divisor of `RANKED + 1`.
pub fn judge(parameters: &[String], fates: &[Fate], bins: usize) -> Vec<Verdict> {
    let judge = |(k, parameter): (usize, &String)| {
        let mut counts = vec![0; bins];
        for fate in fates {
            counts[fate.ranks[k] * bins / (RANKED + 1)] += 1;
        }
        let expected = fates.len() as f64 / bins as f64;
        let chi_square: f64 = counts
            .iter()
            .map(|&n| (n as f64 - expected).powi(2) / expected)
            .sum();
        let covered = fates.iter().filter(|f| f.covered[k]).count();
        Verdict {
            parameter: parameter.clone(),
            counts,
            p: chi_square_tail(chi_square, (bins - 1) as f64).unwrap_or(1.0),
            coverage: covered as f64 / fates.len() as f64,
            coverage_p: binomial_p(covered, fates.len(), 0.9),
        }
    };
    parameters.iter().enumerate().map(judge).collect()
}

/// Probability of a count at least as unlikely, of n tries that succeed with probability `q`.
pub fn binomial_p(count: usize, n: usize, q: f64) -> f64 {
    let log_p = |k: usize| {
        let (n, k) = (n as f64, k as f64);
        libm::lgamma(n + 1.0) - libm::lgamma(k + 1.0) - libm::lgamma(n - k + 1.0)
            + k * libm::log(q)
            + (n - k) * libm::log(1.0 - q)
    };
    let own = log_p(count) + 1e-9;
    let p: f64 = (0..=n).map(log_p).filter(|p| *p <= own).map(libm::exp).sum();
    p.min(1.0)
}
