//! The simulated calibrations, each with its results in a run without faults.

use std::collections::BTreeMap;
use std::sync::Arc;

use farm::calibration::{Calibration, CalibrationIdentity, SimulationResult};
use inference::{Particle, PosteriorSample, StageRecord};
use job::Spec;
use record::{EvaluationRow, Fact};
use shared::file::FileSet;
use shared::model::ModelVariant;
use shared::outcome::{Observables, Outcome, ParameterRejection, SimulatedHistory};

/// The version of the equations that calibrations are pinned to.
pub(crate) const EQUATIONS: &str = "scm-7";

const EXPERIMENT: &str = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\n[soil.s]\n[noise]\ndrawbar_pull_n = 0.15\n";
const HEAD: &str = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,use\n";
const FITTED: &str = "a,w,s,0.2,100,0.008,5.1,fit\n";
const HELD_OUT: &str = "b,w,s,0.4,100,0.008,5.2,holdout\n";
/// A run that is held out as well; the refusing model rejects it at some draws.
const STEEP: &str = "c,w,s,0.9,100,0.008,5.2,holdout\n";
/// The number of jobs of each kind, which differ in their seeds.
const SEEDS: u64 = 3;
/// The numbers of the poisonous evaluation, for kinds that have one: a draw from the prior, and one of a later round.
const POISON: [u64; 2] = [2, 55];

/// The kind of a calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// TMCMC by moves, with a run held out.
    Sample,
    /// The same with a model that rejects a part of the prior, and at further parameters one of two held-out runs.
    Refusing,
    /// The same with an evaluation that kills every worker: the calibration pauses, and a user skips the evaluation.
    Poisoned,
    /// Fifty particles, so that a poisonous evaluation is given up without a pause.
    Crowded,
    /// A fit by steps, which uses predicted values.
    Fit,
    /// Two hundred particles, for tests with several workers that compute wrongly. It is part of no schedule.
    Large,
}

/// An evaluation of a job, with its answer.
#[derive(Debug)]
pub(crate) struct Answered {
    pub(crate) variant: String,
    pub(crate) theta: Vec<f64>,
    pub(crate) outcome: Outcome,
    /// The row that the store keeps.
    pub(crate) row: EvaluationRow,
}

/// A job with its results in a run without faults.
#[derive(Debug)]
pub(crate) struct Case {
    pub(crate) kind: Kind,
    pub(crate) spec: Arc<Spec>,
    pub(crate) answers: BTreeMap<u64, Answered>,
    /// The evaluation that kills every worker.
    pub(crate) poison: Option<u64>,
    /// The bits of each stage.
    pub(crate) stages: Vec<Vec<u64>>,
    /// The bits of the posterior, or the text of the estimate.
    pub(crate) result: CaseResult,
}

/// The result of a calibration, to the bit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum CaseResult {
    Posterior(Vec<u64>),
    Estimate(String),
}

impl Kind {
    /// The kinds with their shares of the schedules `[%]`.
    pub(crate) const SHARES: [(Kind, usize); 6] = [
        (Kind::Sample, 46),
        (Kind::Refusing, 20),
        (Kind::Poisoned, 16),
        (Kind::Crowded, 2),
        (Kind::Fit, 16),
        (Kind::Large, 0),
    ];

    fn job(self, seed: u64) -> String {
        let sampler = match self {
            Kind::Sample | Kind::Poisoned => "particles = 5\nstages = \"moves\"\nmoves = [1, 2]",
            Kind::Refusing => "particles = 8\nstages = \"moves\"\nmoves = [1, 2]",
            Kind::Large => "particles = 200\nstages = \"moves\"\nmoves = [2, 4]",
            Kind::Crowded => "particles = 50\nstages = \"moves\"\nmoves = [1, 2]",
            Kind::Fit => "algorithm = \"lm\"\nparticles = 0\nstarts = 2\nmax_evaluations = 30",
        };
        format!(
            "[model]\nkind = \"quasi_static\"\n[priors]\nlog10_p_ref = 5.0\nkappa = 0.0\nn = {{ uniform = [0.8, 1.4] }}\nfriction_angle_deg = 30.0\n[sampler]\nseed = {seed}\n{sampler}\n"
        )
    }

    fn poison(self) -> Option<u64> {
        match self {
            Kind::Poisoned => Some(POISON[0]),
            Kind::Crowded => Some(POISON[1]),
            Kind::Sample | Kind::Refusing | Kind::Fit | Kind::Large => None,
        }
    }

    /// Evaluates a linear model; the refusing model rejects some parameters.
    pub(crate) fn evaluate(self, variant: &ModelVariant, theta: &[f64]) -> Outcome {
        let is_steep = variant.conditions.iter().any(|condition| condition.slip > 0.8);
        if self == Kind::Refusing && theta[0] > if is_steep { 1.0 } else { 1.25 } {
            return Outcome::Rejected(ParameterRejection {
                kind: "no_support".into(),
                condition: 0,
                message: "simulated".into(),
            });
        }
        let runs = variant.conditions.len();
        let values = vec![4.0 + theta[0]; runs];
        let samples = vec![0.25; 2];
        let history = SimulatedHistory {
            drawbar_pull_n: samples.clone(),
            torque_n_m: samples.clone(),
            sinkage_m: samples.clone(),
            lateral_force_n: samples,
        };
        let mut observables = Observables {
            drawbar_pull_n: values.clone(),
            torque_n_m: values.clone(),
            sinkage_m: values.clone(),
            lateral_force_n: values.clone(),
            b_eff_m: values.clone(),
            contact_length_m: values.clone(),
            residual_load_n: values.clone(),
            nodes_in_contact: vec![1; runs],
            simulated_travel_m: values.clone(),
            histories: vec![history; if variant.histories { runs } else { 0 }],
            ..Observables::default()
        };
        if !variant.channels.is_empty() {
            observables.keep_only(&variant.channels);
        }
        Outcome::Evaluated(observables)
    }
}

impl Case {
    /// Makes every job of the schedules, by kind.
    ///
    /// # Errors
    /// The error in a job.
    pub(crate) fn all() -> Result<Vec<Vec<Case>>, String> {
        let of_kind = |(kind, _)| (1..=SEEDS).map(|seed| Case::new(kind, seed)).collect();
        Kind::SHARES.into_iter().map(of_kind).collect()
    }

    /// Makes a job of a kind.
    ///
    /// # Errors
    /// The error in the job.
    pub(crate) fn new(kind: Kind, seed: u64) -> Result<Case, String> {
        let held_out = match kind {
            Kind::Sample | Kind::Large => HELD_OUT.to_owned(),
            Kind::Refusing => format!("{HELD_OUT}{STEEP}"),
            Kind::Poisoned | Kind::Crowded | Kind::Fit => String::new(),
        };
        let files = FileSet {
            toml: EXPERIMENT.into(),
            files: [("runs.csv".into(), format!("{HEAD}{FITTED}{held_out}"))].into(),
        };
        let job = FileSet {
            toml: kind.job(seed),
            files: BTreeMap::new(),
        };
        let spec = Spec::new("job.toml", &job, "experiment.toml", &files).map_err(|e| e.to_string())?;
        Case::run(kind, Arc::new(spec))
    }

    /// Runs a job without a farm.
    fn run(kind: Kind, spec: Arc<Spec>) -> Result<Case, String> {
        let poison = kind.poison();
        let mut calibration = begin(0, &spec)?;
        let (mut answers, mut stages, mut result) = (BTreeMap::new(), Vec::new(), None);
        while !calibration.state.is_final() {
            for evaluation in calibration.queue.asked() {
                let question = calibration
                    .question(evaluation)
                    .ok_or("an evaluation asks nothing")?;
                let variant = calibration
                    .variant(question.variant)
                    .ok_or("a variant is missing")?;
                let outcome = kind.evaluate(variant, question.theta);
                let mut answered = (question.variant.to_owned(), question.theta.to_vec());
                let (computed, worker) = if poison == Some(evaluation) {
                    (SimulationResult::refused("fault: given up"), "")
                } else {
                    let computed = SimulationResult::new(outcome.clone());
                    (computed.map_err(|e| e.to_string())?, "w")
                };
                let (mut facts, _) = calibration
                    .complete(evaluation, computed, worker)
                    .map_err(|e| e.to_string())?;
                facts.extend(calibration.step());
                for fact in facts {
                    match fact {
                        Fact::Evaluated { row, .. } => {
                            let (variant, theta) = std::mem::take(&mut answered);
                            let answered = Answered {
                                variant,
                                theta,
                                outcome: outcome.clone(),
                                row,
                            };
                            answers.insert(evaluation, answered);
                        }
                        Fact::Stage { record, .. } => stages.push(stage_bits(&record)),
                        Fact::Posterior { posterior, .. } => {
                            result = Some(CaseResult::Posterior(posterior_bits(&posterior)));
                        }
                        Fact::Estimate { estimate, .. } => {
                            result = Some(CaseResult::Estimate(format!("{estimate:?}")));
                        }
                        _ => {}
                    }
                }
                if calibration.state.is_final() {
                    break;
                }
            }
        }
        Ok(Case {
            kind,
            spec,
            answers,
            poison,
            stages,
            result: result.ok_or_else(|| format!("{kind:?} ended as {:?}", calibration.message))?,
        })
    }

    /// Makes the calibration before its first lease.
    ///
    /// # Errors
    /// The error in the job.
    pub(crate) fn begin(&self, id: i64) -> Result<Calibration, String> {
        begin(id, &self.spec)
    }
}

fn begin(id: i64, spec: &Arc<Spec>) -> Result<Calibration, String> {
    let identity = CalibrationIdentity {
        id,
        name: String::new(),
        study: id,
        experiment: 1,
    };
    Calibration::new(identity, spec.clone()).map_err(|e| e.to_string())
}

fn particle_bits(particles: &[Particle]) -> impl Iterator<Item = u64> {
    particles.iter().flat_map(|p| {
        let numbers = [p.log_likelihood.value(), p.log_prior];
        p.theta.iter().copied().chain(numbers).map(f64::to_bits)
    })
}

/// Returns all numbers of a stage as bits.
pub(crate) fn stage_bits(s: &StageRecord) -> Vec<u64> {
    let numbers = [
        s.tempering_exponent,
        s.acceptance,
        s.drift_z,
        s.weight_drift_z,
        s.correlation,
        s.log_evidence_increment,
        s.weight_cov,
        s.ess,
        s.scale,
    ];
    let counts = [
        s.stage as u64,
        s.steps as u64,
        s.evaluations,
        u64::from(s.equilibrated),
    ];
    let numbers = numbers.into_iter().map(f64::to_bits);
    numbers
        .chain(counts)
        .chain(particle_bits(&s.population))
        .collect()
}

/// Returns all numbers of a posterior as bits.
pub(crate) fn posterior_bits(p: &PosteriorSample) -> Vec<u64> {
    let numbers = [p.log_evidence, p.log_evidence_se, p.drift_z, p.weight_drift_z];
    let counts = [u64::from(p.equilibrated), p.evaluations, p.rejected];
    let numbers = numbers.into_iter().map(f64::to_bits);
    numbers.chain(counts).chain(particle_bits(&p.particles)).collect()
}

/// Returns whether two rows agree to the bit, except for their workers.
pub(crate) fn same_row(a: &EvaluationRow, b: &EvaluationRow) -> bool {
    let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    bits(&a.theta) == bits(&b.theta)
        && a.log_likelihood.map(f64::to_bits) == b.log_likelihood.map(f64::to_bits)
        && a.fingerprint == b.fingerprint
        && a.kept == b.kept
}
