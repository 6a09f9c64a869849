//! Replay of a calibration from the store.

use std::mem::discriminant;

use shared::api::CalibrationState;

use super::Calibration;
use super::engine::log_likelihood;
use super::phase::Phase;
use super::second_answer::Answer;
use job::EffectsChanged;
use record::{EvaluationRow, Fact, Stored};

/// The reason why a stored calibration cannot be resumed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReplayError {
    /// The proposed parameter vector differs from the stored one.
    #[error(
        "evaluation {evaluation} was stored at {stored:?}, but this version proposes {proposed:?}: the calibration was started by another version of the sampler"
    )]
    OtherTheta {
        /// Number of the evaluation.
        evaluation: u64,
        /// The stored parameter vector.
        stored: Vec<f64>,
        /// The proposed parameter vector.
        proposed: Vec<f64>,
    },
    /// The effects of the catalogue have changed.
    #[error(transparent)]
    Effects(#[from] EffectsChanged),
    /// The stored log-likelihood is not a number.
    #[error("evaluation {evaluation} was stored with a log-likelihood that is no number")]
    NotANumber {
        /// Number of the evaluation.
        evaluation: u64,
    },
}

impl Calibration {
    /// Replays the stored evaluations, round by round, as if they had just arrived.
    ///
    /// Returns facts that may have been lost because a crash came between the last evaluation and its consequences.
    ///
    /// # Errors
    /// [`ReplayError`] where the stored and the proposed evaluations differ.
    pub fn replay(&mut self, stored: Stored) -> Result<Vec<Fact>, ReplayError> {
        if let Some(pinned) = &stored.model_version {
            self.spec.check_effects(pinned)?;
        }
        self.model_version = stored.model_version;
        self.cost.busy_ms = stored.busy_ms;
        self.witness.is_rewound = stored.is_rewound;
        self.witness.is_doubted = stored.is_doubted;
        self.failed = stored.failed;
        self.ask();
        let mut facts = Vec::new();
        loop {
            let (round, phase) = (self.engine.round(), discriminant(&self.phase));
            for evaluation in self.queue.asked() {
                if let Some(row) = stored.evaluations.get(&evaluation) {
                    self.tell_again(row, stored.confirmed.get(&evaluation), &mut facts)?;
                }
            }
            let has_moved = self.engine.round() != round || discriminant(&self.phase) != phase;
            if !has_moved || matches!(self.phase, Phase::Comparing(_)) || self.state.is_final() {
                break;
            }
        }
        if !self.state.is_final() {
            self.state = match stored.state {
                Some(CalibrationState::Paused) => CalibrationState::Paused,
                _ if self.cost.evaluations == 0 => CalibrationState::Queued,
                _ => CalibrationState::Running,
            };
            self.message = stored.message;
        }
        Ok(facts)
    }

    fn tell_again(
        &mut self,
        row: &EvaluationRow,
        confirmed_by: Option<&String>,
        facts: &mut Vec<Fact>,
    ) -> Result<(), ReplayError> {
        let evaluation = row.evaluation;
        let proposed = self.theta(evaluation).unwrap_or_default().to_vec();
        if !same_bits(&proposed, &row.theta) {
            return Err(ReplayError::OtherTheta {
                evaluation,
                stored: row.theta.clone(),
                proposed,
            });
        }
        log_likelihood(row).map_err(|_| ReplayError::NotANumber { evaluation })?;
        let answer = Answer {
            worker: row.worker.clone(),
            fingerprint: row.fingerprint,
        };
        self.queue.complete(evaluation);
        self.answered_before(answer, evaluation, confirmed_by);
        self.advance(row, facts);
        facts.extend(self.step());
        Ok(())
    }
}

/// Returns whether two vectors agree to the bit.
fn same_bits(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use shared::file::FileSet;
    use shared::outcome::{Observables, SimulatedHistory};

    use super::super::{CalibrationIdentity, SimulationResult};
    use super::*;
    use job::Spec;
    use record::{EvaluationKey, HOLDOUT_RUNS_FROM, Kept, LIKELIEST, PREDICTIONS_FROM, RejectionReason};

    const JOB: &str = "[model]\nkind = \"quasi_static\"\n[priors]\nlog10_p_ref = { uniform = [4.0, 5.6] }\nkappa = 0.0\nn = { uniform = [0.8, 1.4] }\nfriction_angle_deg = 30.0\n[sampler]\nparticles = 20\nmoves = [2, 4]\n";
    const EXPERIMENT: &str = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\n[soil.s]\n[noise]\ndrawbar_pull_n = 0.05\n";
    const RUNS: &str = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,use\na,w,s,0.2,100,0.008,5.0,fit\nb,w,s,0.4,100,0.008,5.1,holdout\n";

    const FITS: [&str; 3] = [
        "algorithm = \"lm\"\nparticles = 0\nstarts = 3\nmax_evaluations = 60\n",
        "algorithm = \"ga\"\npopulation = 9\ngenerations = 6\n",
        "algorithm = \"cma-es\"\nmax_evaluations = 60\n",
    ];

    fn fresh() -> Calibration {
        calibration(JOB)
    }

    fn fresh_fit(sampler: &str) -> Calibration {
        calibration(&JOB.replace("particles = 20\nmoves = [2, 4]\n", sampler))
    }

    fn calibration(job: &str) -> Calibration {
        with_runs(job, RUNS)
    }

    /// Makes the same calibration with two more holdout runs, the first of which the model rejects.
    fn with_a_refused_run() -> Calibration {
        let more = "c,w,s,0.9,100,0.008,5.2,holdout\nd,w,s,0.3,100,0.008,5.0,holdout\n";
        with_runs(JOB, &format!("{RUNS}{more}"))
    }

    fn with_runs(job: &str, runs: &str) -> Calibration {
        let files = FileSet {
            toml: EXPERIMENT.into(),
            files: [("runs.csv".into(), runs.into())].into(),
        };
        let job = FileSet {
            toml: job.into(),
            files: Default::default(),
        };
        let spec = Spec::new("job.toml", &job, "experiment.toml", &files).unwrap();
        let identity = CalibrationIdentity {
            id: 1,
            name: "toy".into(),
            study: 1,
            experiment: 1,
        };
        Calibration::new(identity, Arc::new(spec)).unwrap()
    }

    #[test]
    fn a_calibration_begun_with_other_files_of_its_effects_does_not_go_on() {
        let job = JOB.replace("[priors]", "effects = [\"sled_tare\"]\n[priors]");
        let begun = |version: String| Stored {
            model_version: Some(version),
            ..Stored::default()
        };
        let now = calibration(&job).spec.fit_variant.model_version("scm-4");
        assert!(calibration(&job).replay(begun(now.clone())).is_ok());
        assert!(fresh().replay(begun("scm-4".into())).is_ok());
        let error = calibration(&job)
            .replay(begun("scm-4+effects.00000000".into()))
            .unwrap_err();
        assert_eq!(
            error.to_string(),
            format!(
                "the effect files have changed: the calibration was started with model version scm-4+effects.00000000, this program has {now}"
            )
        );
    }

    /// The slip above which the toy model rejects a run.
    const TOO_STEEP: f64 = 0.8;

    /// Evaluates a linear model that rejects a corner of the prior.
    fn toy(theta: &[f64], runs: usize) -> Result<Observables, RejectionReason> {
        if theta[1] > 1.35 {
            return Err(RejectionReason("no_support: condition 0: toy".into()));
        }
        let values = vec![theta[0] + 0.1 * theta[1]; runs];
        Ok(Observables {
            drawbar_pull_n: values.clone(),
            torque_n_m: values.clone(),
            sinkage_m: values.clone(),
            lateral_force_n: values.clone(),
            b_eff_m: values.clone(),
            contact_length_m: values.clone(),
            residual_load_n: values.clone(),
            nodes_in_contact: vec![1; runs],
            simulated_travel_m: values,
            ..Observables::default()
        })
    }

    fn computed(outcome: Result<Observables, RejectionReason>) -> SimulationResult {
        SimulationResult(outcome)
    }

    /// Completes up to `max` evaluations; the last one first if `backwards`.
    fn work(calibration: &mut Calibration, max: usize, backwards: bool) -> Vec<Fact> {
        let mut facts = Vec::new();
        let mut done = 0;
        while !calibration.state.is_final() {
            let mut asked = calibration.queue.asked();
            if backwards {
                asked.reverse();
            }
            for evaluation in asked {
                let Some(question) = calibration.question(evaluation) else {
                    break;
                };
                let conditions = &calibration.variant(question.variant).unwrap().conditions;
                let timed = calibration.variants.has_histories();
                let mut outcome = toy(question.theta, conditions.len());
                if let Some(steep) = conditions.iter().position(|c| c.slip > TOO_STEEP) {
                    outcome = Err(RejectionReason(format!("no_support: condition {steep}: toy")));
                }
                if let (Ok(observables), true) = (&mut outcome, evaluation == LIKELIEST && timed) {
                    let samples = vec![0.25; 3];
                    observables.histories = vec![SimulatedHistory {
                        drawbar_pull_n: samples.clone(),
                        torque_n_m: samples.clone(),
                        sinkage_m: samples.clone(),
                        lateral_force_n: samples,
                    }];
                }
                let computed = computed(outcome);
                let (mut new, counted) = calibration.complete(evaluation, computed, "toy").unwrap();
                new.extend(calibration.step());
                facts.extend(new);
                done += usize::from(counted);
                if done == max {
                    return facts;
                }
            }
        }
        facts
    }

    fn rows(facts: &[Fact]) -> Vec<&EvaluationRow> {
        facts
            .iter()
            .filter_map(|f| {
                if let Fact::Evaluated { row, .. } = f {
                    Some(row)
                } else {
                    None
                }
            })
            .collect()
    }

    fn stored(facts: &[Fact]) -> Stored {
        let rows = rows(facts).into_iter();
        let evaluations = rows.map(|row| (row.evaluation, row.clone())).collect();
        Stored {
            evaluations,
            ..Stored::default()
        }
    }

    /// Counts the rows of fitted runs.
    fn vectors(facts: &[Fact]) -> u64 {
        let keys = rows(facts)
            .into_iter()
            .map(|row| EvaluationKey::from_number(row.evaluation, 20));
        keys.filter(|key| !key.is_of_holdout()).count() as u64
    }

    fn sorted(facts: &[Fact]) -> Vec<EvaluationRow> {
        let mut rows: Vec<EvaluationRow> = rows(facts).into_iter().cloned().collect();
        rows.sort_by_key(|r| r.evaluation);
        rows
    }

    #[test]
    fn the_order_of_results_does_not_matter() {
        let forwards = work(&mut fresh(), usize::MAX, false);
        let backwards = work(&mut fresh(), usize::MAX, true);
        assert_eq!(sorted(&forwards), sorted(&backwards));
        assert!(forwards.iter().any(|f| matches!(f, Fact::Posterior { .. })));
    }

    #[test]
    fn a_replay_from_any_point_ends_with_the_same_evaluations() {
        let whole = sorted(&work(&mut fresh(), usize::MAX, false));
        for cut in [1, 19, 20, 33, whole.len() - 10, whole.len() - 1] {
            let first = work(&mut fresh(), cut, false);
            let mut again = fresh();
            again.replay(stored(&first)).unwrap();
            assert_eq!(again.cost.evaluations, vectors(&first));
            let mut all = first;
            all.extend(work(&mut again, usize::MAX, true));
            assert_eq!(sorted(&all), whole, "cut after {cut}");
            assert_eq!(again.state, CalibrationState::Finished);
        }
    }

    #[test]
    fn an_emulated_sampler_is_told_again_from_what_is_stored_and_ends_with_the_same_posterior() {
        let emulated = || fresh_fit("stages = \"emulated\"\nparticles = 20\nbatch = 6\n");
        let results = |facts: &[Fact]| -> Vec<String> {
            let result = |f: &Fact| match f {
                Fact::Posterior {
                    posterior, emulator, ..
                } => Some(format!("{posterior:?} {emulator:?}")),
                _ => None,
            };
            facts.iter().filter_map(result).collect()
        };
        let mut finished = emulated();
        let first = work(&mut finished, usize::MAX, false);
        let whole = sorted(&first);
        assert_eq!(results(&first).len(), 1);
        // Diagnostics read the draws from the prior. Nothing reads the later values that the emulator was told.
        let width = finished.spec.algorithm.width() as u64;
        assert!(matches!(first.last(), Some(Fact::ValuesExpired { from, .. }) if *from == width));
        // The fitted runs of the final draws were simulated while sampling, and are no further simulations.
        let is_fitted = |r: &&EvaluationRow| {
            let key = EvaluationKey::from_number(r.evaluation, 1);
            matches!(key, EvaluationKey::Prediction { holdout: false, .. })
        };
        let fitted: Vec<&EvaluationRow> = whole.iter().filter(is_fitted).collect();
        assert!(fitted.len() > 20 && fitted.iter().all(|r| matches!(r.kept, Kept::Whole(_))));
        assert_eq!(finished.cost.simulations, (whole.len() - fitted.len()) as u64);
        let sampled = whole.iter().filter(|r| r.evaluation < PREDICTIONS_FROM).count();
        for cut in [1, 13, 17, sampled / 2, sampled - 1, sampled, whole.len() - 1] {
            let begun = work(&mut emulated(), cut, true);
            let mut again = emulated();
            let lost = again.replay(stored(&begun)).unwrap();
            let rest = work(&mut again, usize::MAX, false);
            let all: Vec<Fact> = begun.iter().chain(&rest).cloned().collect();
            assert_eq!(sorted(&all), whole, "cut after {cut}");
            let restarted: Vec<String> = [lost, rest].iter().flat_map(|f| results(f)).collect();
            assert_eq!(restarted, results(&first), "cut after {cut}");
        }
    }

    #[test]
    fn a_fit_or_search_is_told_again_from_what_is_stored_and_ends_with_the_same_estimate() {
        let estimates = |facts: &[Fact]| -> Vec<String> {
            let estimate = |f: &Fact| match f {
                Fact::Estimate { estimate, .. } => Some(format!("{estimate:?}")),
                _ => None,
            };
            facts.iter().filter_map(estimate).collect()
        };
        for sampler in FITS {
            let first = work(&mut fresh_fit(sampler), usize::MAX, false);
            let whole = sorted(&first);
            assert_eq!(estimates(&first).len(), 1);
            // The fitted runs of the estimate and its holdout runs come last.
            let sampled = whole.iter().filter(|r| r.evaluation < PREDICTIONS_FROM).count();
            assert_eq!(whole.len(), sampled + 2);
            assert!(sampled <= 60);
            for cut in 1..whole.len() {
                let begun = work(&mut fresh_fit(sampler), cut, true);
                let mut again = fresh_fit(sampler);
                let lost = again.replay(stored(&begun)).unwrap();
                assert_eq!(again.cost.evaluations, vectors(&begun));
                let rest = work(&mut again, usize::MAX, false);
                let all: Vec<Fact> = begun.iter().chain(&rest).cloned().collect();
                assert_eq!(sorted(&all), whole, "cut after {cut}");
                let restarted: Vec<String> = [lost, rest].iter().flat_map(|f| estimates(f)).collect();
                assert_eq!(restarted, estimates(&first), "cut after {cut}");
            }
        }
    }

    #[test]
    fn a_model_that_knows_time_ends_with_the_histories_of_the_likeliest_draw() {
        let rolling = || calibration(&JOB.replace("quasi_static", "scm"));
        let facts = work(&mut rolling(), usize::MAX, false);
        let whole = sorted(&facts);
        let last = whole.last().unwrap();
        assert_eq!(last.evaluation, LIKELIEST);
        let kept = match &last.kept {
            Kept::Whole(observables) => observables,
            other => panic!("{other:?}"),
        };
        assert_eq!(kept.histories[0].sinkage_m.len(), 3);
        let posterior = facts.iter().find_map(|f| match f {
            Fact::Posterior { posterior, .. } => Some(posterior),
            _ => None,
        });
        let particles = &posterior.unwrap().particles;
        let likeliest = particles
            .iter()
            .map(|p| p.log_likelihood.value())
            .fold(f64::MIN, f64::max);
        let of = particles.iter().find(|p| p.theta == last.theta).unwrap();
        assert!(of.log_likelihood.value() >= likeliest);
        // all other rows are as without
        assert!(whole[..whole.len() - 1].iter().all(|r| match &r.kept {
            Kept::Whole(o) => o.histories.is_empty(),
            _ => true,
        }));
        for cut in [20, whole.len() - 2, whole.len() - 1] {
            let begun = work(&mut rolling(), cut, true);
            let mut again = rolling();
            again.replay(stored(&begun)).unwrap();
            let mut all = begun;
            all.extend(work(&mut again, usize::MAX, false));
            assert_eq!(sorted(&all), whole, "cut after {cut}");
        }
        // Of a model that knows no time the same draw is simulated without.
        let timeless = sorted(&work(&mut fresh(), usize::MAX, false));
        let last = timeless.last().unwrap();
        assert_eq!(last.evaluation, LIKELIEST);
        assert!(matches!(&last.kept, Kept::Whole(o) if o.histories.is_empty()));
    }

    #[test]
    fn a_stored_theta_that_differs_by_a_bit_stops_the_replay() {
        let mut stored = stored(&work(&mut fresh(), 5, false));
        let theta = &mut stored.evaluations.get_mut(&3).unwrap().theta;
        theta[0] = f64::from_bits(theta[0].to_bits() + 1);
        assert!(matches!(
            fresh().replay(stored),
            Err(ReplayError::OtherTheta { evaluation: 3, .. })
        ));
    }

    #[test]
    fn final_draws_see_the_holdout_and_sampling_does_not() {
        let facts = work(&mut fresh(), usize::MAX, false);
        for row in rows(&facts) {
            let whole = matches!(&row.kept, Kept::Whole(o) if o.sinkage_m.len() == 1);
            // The draws from the prior keep their values, later ones their score.
            let fitted = match &row.kept {
                Kept::Fitted(values) => values.len() == 1 && row.evaluation < 20,
                kept => *kept == Kept::Scored && row.evaluation >= 20,
            };
            let refused = matches!(row.kept, Kept::Rejected(_));
            assert!(
                refused
                    || if row.evaluation >= PREDICTIONS_FROM {
                        whole
                    } else {
                        fitted
                    }
            );
        }
    }

    #[test]
    fn where_a_holdout_run_is_refused_each_is_asked_for_alone() {
        let facts = work(&mut with_a_refused_run(), usize::MAX, false);
        let whole = sorted(&facts);
        let outcome = |evaluation| &whole.iter().find(|r| r.evaluation == evaluation).unwrap().kept;
        for draw in 0..21 {
            let together = EvaluationKey::Prediction { draw, holdout: true }.number(20);
            assert!(matches!(outcome(together), Kept::Rejected(_)));
            let alone = |run| outcome(EvaluationKey::HoldoutRun { draw, run }.number(20));
            let answers = |kept: &Kept| matches!(kept, Kept::Whole(o) if o.sinkage_m.len() == 1);
            assert!(answers(alone(0)) && answers(alone(2)));
            assert_eq!(*alone(1), Kept::Rejected("no_support: condition 0: toy".into()));
        }
        let alone = whole.iter().filter(|r| r.evaluation >= HOLDOUT_RUNS_FROM);
        assert_eq!(alone.count(), 3 * 21);
        // Neither they nor the 21 draws whose held-out runs are refused together count as parameter vectors.
        let mut counted = with_a_refused_run();
        let facts = work(&mut counted, usize::MAX, false);
        let refused =
            |row: &&EvaluationRow| row.evaluation < PREDICTIONS_FROM && matches!(row.kept, Kept::Rejected(_));
        let refused = rows(&facts).into_iter().filter(refused).count() as u64;
        assert_eq!(
            (counted.cost.evaluations, counted.cost.rejected),
            (vectors(&facts), refused)
        );
        assert_eq!(counted.cost.simulations, rows(&facts).len() as u64);
        assert_eq!(sorted(&work(&mut with_a_refused_run(), usize::MAX, true)), whole);
        for cut in [30, whole.len() - 63, whole.len() - 62, whole.len() - 1] {
            let begun = work(&mut with_a_refused_run(), cut, true);
            let mut again = with_a_refused_run();
            again.replay(stored(&begun)).unwrap();
            let mut all = begun;
            all.extend(work(&mut again, usize::MAX, false));
            assert_eq!(sorted(&all), whole, "cut after {cut}");
            assert_eq!(again.state, CalibrationState::Finished);
        }
    }

    #[test]
    fn a_refused_holdout_run_takes_no_fitted_one_along() {
        let mut calibration = fresh();
        let mut facts = Vec::new();
        while !calibration.state.is_final() {
            for evaluation in calibration.queue.asked() {
                let Some(question) = calibration.question(evaluation) else {
                    break;
                };
                let holdout = evaluation >= PREDICTIONS_FROM && evaluation % 2 == 1;
                let computed = match holdout {
                    true => SimulationResult::refused("no_support: condition 0: toy"),
                    false => computed(toy(question.theta, 1)),
                };
                facts.extend(calibration.complete(evaluation, computed, "toy").unwrap().0);
                facts.extend(calibration.step());
            }
        }
        let drawn = |r: &&&EvaluationRow| r.evaluation >= PREDICTIONS_FROM;
        let rows = rows(&facts);
        let refused = rows
            .iter()
            .filter(drawn)
            .filter(|r| matches!(r.kept, Kept::Rejected(_)))
            .count();
        let whole = rows
            .iter()
            .filter(drawn)
            .filter(|r| matches!(r.kept, Kept::Whole(_)))
            .count();
        assert_eq!(
            (refused, whole),
            (21, 22),
            "20 particles and the most probable one; and the fitted runs of the likeliest"
        );
    }
}
