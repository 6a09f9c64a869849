//! Simulation-based calibration: data sets are drawn from the prior, each is calibrated, and the truth is ranked among the draws.
//!
//! A parameter vector is drawn from the prior, three runs are simulated with it and noise is added. The calibration of these data has no
//! other information. If the whole chain is right (prior, likelihood, sampler, and model through the worker's evaluator), the truth has
//! the distribution of a draw of the posterior, so that its rank among independent draws is uniform in every problem.
//!
//! Vectors that the model rejects are drawn again, which conditions the prior on vectors that the model accepts. The sampler's prior is
//! conditioned in the same way, because a rejection has a likelihood of zero.
//!
//! # Source
//! Talts, Betancourt, Simpson, Vehtari, Gelman 2018, "Validating Bayesian inference algorithms with simulation-based
//! calibration", arXiv:1804.06788.

use coordinator::embedded::Evaluate;
use farm::calibration::CalibrationResult;
use inference::diagnostics::{chi_square_tail, quantile};
use job::Spec;
use shared::channel::Channel;
use shared::file::FileSet;
use shared::outcome::Outcome;
use statistics::rng::Stream;

use super::calibration::calibrate;
use super::error::StudyError;
use super::parallel::each;

/// The number of draws of a posterior among which the truth is ranked. They are evenly spaced, because adjacent particles may be copies.
pub const RANKED: usize = 19;
/// The largest number of consecutive draws of the prior that the model may reject.
const MAX_REJECTED: u64 = 1000;
/// The first random stream of this study, which no sampler uses.
const STAGE: u64 = 1 << 40;

const EXPERIMENT: &str = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\n[soil.s]\n[noise]\ndrawbar_pull_n = \"unknown\"\ntorque_n_m = 0.3\nsinkage_m = 0.0008\n";
const CONDITIONS: [&str; 3] = ["a,w,s,0.1,80,0.01", "b,w,s,0.3,120,0.01", "c,w,s,0.6,100,0.01"];
/// The measured channels of `runs.csv`, in the order of their columns.
const MEASURED: [Channel; 3] = [Channel::DrawbarPull, Channel::Torque, Channel::Sinkage];

/// A study of a number of data sets.
#[derive(Debug, Clone, Copy)]
pub struct Study {
    /// Number of data sets.
    pub sets: usize,
    /// Particles of each calibration.
    pub particles: usize,
    /// Seed of data and calibrations.
    pub seed: u64,
    /// Factor of the added noise, which the calibration takes as 1: another value is a mistake that the study should find.
    pub noise_factor: f64,
    /// Whether the stages are emulated.
    pub is_emulated: bool,
}

/// The rank of one truth in the posterior of its data.
#[derive(Debug, Clone)]
pub struct Ranking {
    /// For each parameter, the number of the [`RANKED`] draws that lie below the truth.
    pub ranks: Vec<usize>,
    /// For each parameter, whether the truth lies between the 5 % and the 95 % quantile of all draws.
    pub covered: Vec<bool>,
    /// Whether every stage reached equilibrium.
    pub equilibrated: bool,
    /// The number of draws of the prior that the model rejected before it accepted one.
    pub rejected: u64,
}

/// A data set and its truth.
struct Case {
    truth: Vec<f64>,
    /// Drawbar pull, torque and sinkage of each run.
    measured: Vec<[f64; 3]>,
    /// The number of draws of the prior that the model rejected before this truth.
    rejected: u64,
}

impl Study {
    fn job(&self, seed: u64) -> String {
        let particles = self.particles;
        let stages = if self.is_emulated {
            "stages = \"emulated\"\n"
        } else {
            ""
        };
        format!(
            "[model]\nkind = \"quasi_static\"\n[priors]\nlog10_p_ref = {{ uniform = [4.0, 5.6] }}\nkappa = 0.0\nn = {{ normal = [1.1, 0.2], bounds = [0.8, 2.0] }}\nfriction_angle_deg = {{ normal = [30.0, 5.7], bounds = [11.5, 45.0] }}\nwheel_radius_m = {{ uniform = [0.125, 0.155] }}\n\"noise.drawbar_pull_n\" = {{ lognormal = [2.0, 1.5] }}\n[sampler]\nparticles = {particles}\nseed = {seed}\n{stages}"
        )
    }

    /// Returns the specification of a calibration of measured rows.
    fn spec(&self, rows: &[[f64; 3]], seed: u64) -> Result<Spec, StudyError> {
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
        Ok(Spec::new("job.toml", &job, "experiment.toml", &files)?)
    }

    /// Names of the parameters that are calibrated.
    pub fn parameters(&self) -> Result<Vec<String>, StudyError> {
        let spec = self.spec(&[[0.0; 3]; 3], 1)?;
        Ok(spec.parameters.into_iter().map(|p| p.name).collect())
    }

    /// Ranks the truth of every data set, on all threads of the machine.
    pub fn run(&self) -> Result<Vec<Ranking>, StudyError> {
        each(self.sets as u64, |set| self.rank(set))
    }

    /// Draws a truth, measures it, calibrates the measurements and ranks the truth.
    fn rank(&self, set: u64) -> Result<Ranking, StudyError> {
        let case = self.measure(set)?;
        let spec = self.spec(&case.measured, self.seed + 1 + set)?;
        let calibration = calibrate(spec).map_err(|e| format!("data set {set}: {e}"))?;
        let Some(CalibrationResult::Posterior(posterior)) = calibration.engine().finding() else {
            return Err("the result of a calibration is not a posterior".into());
        };
        let judged = case.truth.iter().enumerate().map(|(parameter, &x)| {
            let particles = posterior.particles.iter();
            let draws: Vec<f64> = particles.map(|particle| particle.theta[parameter]).collect();
            (rank(&draws, x), covered(&draws, x))
        });
        let (ranks, covered) = judged.unzip();
        Ok(Ranking {
            ranks,
            covered,
            equilibrated: posterior.equilibrated,
            rejected: case.rejected,
        })
    }

    /// Draws a truth that the model accepts, and measures it with noise.
    fn measure(&self, set: u64) -> Result<Case, StudyError> {
        let spec = self.spec(&[[0.0; 3]; 3], 1)?;
        let model = Evaluate::new(&spec.fit_variant)?;
        for rejected in 0..MAX_REJECTED {
            let mut stream = Stream::new(self.seed, STAGE, set, rejected);
            let truth = spec.prior().sample(&mut stream);
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
                rejected,
            });
        }
        Err(format!("the model rejected {MAX_REJECTED} draws of the prior in a row").into())
    }
}

/// Returns the number of the [`RANKED`] evenly spaced draws that lie below a value.
fn rank(draws: &[f64], value: f64) -> usize {
    let spaced = (0..RANKED).map(|k| draws[(2 * k + 1) * draws.len() / (2 * RANKED)]);
    spaced.filter(|draw| *draw < value).count()
}

/// Returns whether a value lies between the 5 % and the 95 % quantile of the draws.
fn covered(draws: &[f64], value: f64) -> bool {
    let at = |p: f64| quantile(draws, p);
    at(0.05).is_some_and(|low| low <= value) && at(0.95).is_some_and(|high| value <= high)
}

/// The verdict on the ranks and intervals of one parameter.
#[derive(Debug, Clone)]
pub struct Verdict {
    /// Name of the parameter.
    pub parameter: String,
    /// The number of ranks in each of the equal bins.
    pub counts: Vec<usize>,
    /// Probability of a chi-square at least as large if the ranks are uniform.
    pub p: f64,
    /// Share of the data sets whose 90 % interval contains the truth.
    pub coverage: f64,
    /// Two-sided probability of a share at least as far from 90 % if the intervals are exact.
    pub coverage_p: f64,
}

/// Judges every parameter by its ranks in a number of bins, which divides `RANKED + 1`.
pub fn judge(parameters: &[String], rankings: &[Ranking], bins: usize) -> Vec<Verdict> {
    let judge = |(k, parameter): (usize, &String)| {
        let mut counts = vec![0; bins];
        for ranking in rankings {
            counts[ranking.ranks[k] * bins / (RANKED + 1)] += 1;
        }
        let expected = rankings.len() as f64 / bins as f64;
        let squares = counts.iter().map(|&n| (n as f64 - expected).powi(2) / expected);
        let chi_square: f64 = squares.sum();
        let covered = rankings.iter().filter(|f| f.covered[k]).count();
        Verdict {
            parameter: parameter.clone(),
            counts,
            p: chi_square_tail(chi_square, (bins - 1) as f64).unwrap_or(1.0),
            coverage: covered as f64 / rankings.len() as f64,
            coverage_p: binomial_p(covered, rankings.len(), 0.9),
        }
    };
    parameters.iter().enumerate().map(judge).collect()
}

/// Probability of a count of successes at most as probable as `count`, in `n` tries that succeed with probability `q`.
pub fn binomial_p(count: usize, n: usize, q: f64) -> f64 {
    let log_p = |k: usize| {
        let (n, k) = (n as f64, k as f64);
        libm::lgamma(n + 1.0) - libm::lgamma(k + 1.0) - libm::lgamma(n - k + 1.0)
            + k * libm::log(q)
            + (n - k) * libm::log(1.0 - q)
    };
    let bound = log_p(count) + 1e-9;
    let p: f64 = (0..=n).map(log_p).filter(|p| *p <= bound).map(libm::exp).sum();
    p.min(1.0)
}
