//! Small finished calibrations and studies for the tests of `result` and `report`; their names contain markup, which output must escape.

use std::collections::BTreeMap;

use inference::Particle;
use inference::evolution::{EvolutionSettings, GaSettings};
use inference::point_estimate::{Generation, StopReason};
use job::{AlgorithmSettings, Spec};
use record::{
    CalibrationRow, Discovery, EstimateRow, Extension, FittedForm, JudgedEffect, Membership, NONE, Outside,
    Prediction, PriorDraw, RejectionReason, Repeats, Role, StageRow, Verdict, Verified,
};
use shared::api::CalibrationState;
use shared::experiment::Campaign;
use shared::file::{FileSet, parse_toml};
use shared::outcome::Observables;
use statistics::LogLikelihood;

use result::discovery::DiscoveryRound;
use result::finished_calibration::{FinishedCalibration, Outcome, SampledPosterior};
use result::study::Study;
use result::study_member::StudyMember;

const JOB: &str = r#"
# <i>bold & brave</i>
experiment = "experiment.toml"
[model]
kind = "quasi_static"
cohesion_pa = 0.0
shear_velocity_m_s = 0.001
[priors]
log10_p_ref = { normal = [3.9, 0.2] }
kappa = 0.0
n = { uniform = [0.8, 1.6] }
friction_angle_deg = { normal = [31.0, 4.0], bounds = [15.0, 45.0] }
"noise.sinkage_m" = { lognormal = [0.002, 2.5] }
[sampler]
particles = 40
"#;

const EXPERIMENT: &str = r#"
runs = "runs.csv"
[wheel.a]
radius_m = 0.1
width_m = 0.05
[soil.sand]
[noise]
drawbar_pull_n = 1.0
sinkage_m = "unknown"
"#;

const RUNS: &str = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,sinkage_m,use
<script>alert(1)</script>,a,sand,-0.2,25,0.01,-7.0,0.015,fit
b&c,a,sand,0.2,25,0.01,0.5,0.020,fit
d,a,sand,0.5,25,0.01,1.5,,fit
e,a,sand,0.4,25,0.01,1.2,0.022,LAST
";

/// Returns a campaign whose rows were digitised.
pub fn campaign() -> Campaign {
    let toml = "title = \"Wheels in <i>sand</i>\"\nauthors = [\"A. Author\", \"B. Author\"]\ndate = \"2025\"\n\
                licence = \"CC-BY-4.0\"\ndoi = \"10.1000/182\"\nsource = \"figure 5\"\ndigitised = true\n\
                noise = \"guessed\"\ndoubts = [\"few rows\"]\n";
    parse_toml("campaign.toml", toml).expect("a campaign")
}

/// Returns a calibration with a holdout run.
pub fn calibration() -> FinishedCalibration {
    build(&RUNS.replace("LAST", "holdout"))
}

/// Returns the calibration with every run fitted.
pub fn without_holdout() -> FinishedCalibration {
    build(&RUNS.replace("LAST", "fit"))
}

/// Returns a calibration with `count` holdout runs, whose pull lies on a line through the fitted ones; the model errs by `error` `[N]`.
pub fn with_held_out_runs(count: usize, error: f64) -> FinishedCalibration {
    let mut runs = RUNS.replace("LAST", "fit");
    for k in 0..count {
        let slip = 0.21 + 0.28 * k as f64 / count as f64;
        let pull = 0.5 + (slip - 0.2) / 0.3;
        runs += &format!("h{k},a,sand,{slip},25,0.01,{pull},,holdout\n");
    }
    let mut calibration = build(&runs);
    let experiment = &calibration.spec.experiment;
    let measured = calibration
        .spec
        .holdout_runs
        .iter()
        .map(|&i| experiment.runs[i].measured[0]);
    let predicted: Vec<f64> = measured.flatten().map(|pull| pull + error).collect();
    for prediction in &mut calibration.predictions {
        if let Some(Ok(observables)) = prediction.holdout.as_mut().map(|h| &mut h.together) {
            observables.drawbar_pull_n.clone_from(&predicted);
        }
    }
    calibration
}

/// Returns a calibration with nine fitted runs over slip, two holdout runs between them and one at another speed.
///
/// The model misses the pull by `3 sin(3 slip)` `[N]`; the draws lie alternately 1 N above and below that in every run.
pub fn with_smooth_misfit() -> FinishedCalibration {
    let mut runs =
        "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,sinkage_m,use\n".to_owned();
    let row = |name: &str, slip: f64, speed: f64, usage: &str| {
        format!("{name},a,sand,{slip},25,{speed},{},0.02,{usage}\n", 10.0 * slip)
    };
    for k in 0..9 {
        runs += &row(&format!("f{k}"), -0.3 + 0.1 * f64::from(k), 0.01, "fit");
    }
    for (name, slip, speed) in [("h0", -0.05, 0.01), ("h1", 0.35, 0.01), ("fast", 0.35, 0.05)] {
        runs += &row(name, slip, speed, "holdout");
    }
    let mut calibration = build(&runs);
    let spec = &calibration.spec;
    let values = |runs: &[usize], shift: f64| -> Vec<f64> {
        let slips = runs.iter().map(|&i| spec.experiment.runs[i].slip);
        slips
            .map(|slip| 10.0 * slip - 3.0 * libm::sin(3.0 * slip) + shift)
            .collect()
    };
    for (k, prediction) in calibration.predictions.iter_mut().enumerate() {
        let shift = if k % 2 == 0 { 1.0 } else { -1.0 };
        if let Ok(observables) = &mut prediction.fit {
            observables.drawbar_pull_n = values(&spec.fit_runs, shift);
        }
        if let Some(Ok(observables)) = prediction.holdout.as_mut().map(|h| &mut h.together) {
            observables.drawbar_pull_n = values(&spec.holdout_runs, shift);
        }
    }
    calibration
}

/// Returns a calibration with twenty fitted runs, five slips at each of four slip angles, whose pull the model misses by what is given
/// for the numbers of the slip and of the angle `[N]`.
pub fn over_angles(misfit: impl Fn(usize, usize) -> f64) -> FinishedCalibration {
    let mut runs =
        "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,slip_angle_deg,drawbar_pull_n,sinkage_m,use\n"
            .to_owned();
    let mut predicted = Vec::new();
    for (i, angle) in [0.0, 20.0, 40.0, 60.0].into_iter().enumerate() {
        for (k, slip) in [-0.3, -0.1, 0.1, 0.3, 0.5].into_iter().enumerate() {
            let pull = 10.0 * slip;
            runs += &format!("s{k}a{i},a,sand,{slip},25,0.01,{angle},{pull},0.02,fit\n");
            predicted.push(pull - misfit(k, i));
        }
    }
    let mut calibration = build(&runs);
    for prediction in &mut calibration.predictions {
        if let Ok(observables) = &mut prediction.fit {
            observables.drawbar_pull_n.clone_from(&predicted);
        }
    }
    calibration
}

/// Returns the sample of a calibration, so that a test can change it.
pub fn sampled(calibration: &mut FinishedCalibration) -> &mut SampledPosterior {
    match &mut calibration.outcome {
        Outcome::Sampled(sampled) => sampled,
        other => panic!("{other:?} is no sample"),
    }
}

/// Returns the position of a run in the experiment of a calibration.
pub fn position(calibration: &FinishedCalibration, run: &str) -> usize {
    let mut runs = calibration.spec.experiment.runs.iter();
    runs.position(|candidate| candidate.name == run)
        .expect("a run of the fixture")
}

/// Returns a calibration whose model rejected all final draws, whose sampler drifted, and which has no evidence.
pub fn all_rejected() -> FinishedCalibration {
    let mut calibration = calibration();
    for prediction in &mut calibration.predictions {
        prediction.fit = Err(RejectionReason("no_support".into()));
        let refused = |_| Err(RejectionReason("no_support".into())).into();
        prediction.holdout = prediction.holdout.take().map(refused);
    }
    for stage in &mut sampled(&mut calibration).stages {
        (stage.equilibrated, stage.drift_z, stage.tempering_exponent) = (false, 1e6, 0.0);
    }
    calibration.row.equilibrated = Some(false);
    calibration.row.log_evidence = None;
    calibration
}

/// Returns a calibration with four holdout runs; the model refuses one at every draw, one at every second and one at every fourth draw.
pub fn with_refused_runs() -> FinishedCalibration {
    let mut calibration = with_held_out_runs(4, 0.5);
    let draws = calibration.predictions.iter_mut().skip(1).enumerate();
    for (draw, prediction) in draws {
        let Some(holdout) = prediction.holdout.as_mut() else {
            continue;
        };
        let reason =
            |condition: &str| RejectionReason(format!("no_support: condition {condition}: z = 0.11 m"));
        let together = std::mem::replace(&mut holdout.together, Err(reason("1")));
        for run in 0..4 {
            let of_run = |all: &Observables| Observables {
                drawbar_pull_n: vec![all.drawbar_pull_n[run]],
                sinkage_m: vec![all.sinkage_m[run]],
                ..Observables::default()
            };
            let is_refused = run == 1 || run == 2 && draw % 2 == 0 || run == 3 && draw % 4 == 0;
            let alone = match &together {
                Ok(all) if !is_refused => Ok(of_run(all)),
                _ => Err(reason("0")),
            };
            holdout.alone.insert(run, alone);
        }
    }
    calibration
}

/// Returns a fit of the same job with one parameter at a bound.
pub fn fit() -> FinishedCalibration {
    let mut calibration = calibration();
    calibration.spec.algorithm = AlgorithmSettings::Fit(inference::lm::LmSettings::default());
    let first = calibration.predictions.remove(0);
    let mut sd: Vec<Option<f64>> = first.theta.iter().map(|x| Some(0.1 * x)).collect();
    let mut at_bound = vec![false; sd.len()];
    (sd[1], at_bound[1]) = (None, true);
    calibration.outcome = Outcome::Estimated(EstimateRow {
        theta: first.theta.clone(),
        log_likelihood: -20.0,
        log_prior: -1.0,
        sd: Some(sd),
        at_bound,
        stop: StopReason::Decrease,
        history: Vec::new(),
    });
    calibration.predictions = vec![first];
    calibration.likeliest_values = None;
    calibration.row.log_evidence = None;
    calibration.row.log_evidence_se = None;
    calibration.row.equilibrated = None;
    calibration
}

/// Returns a search of the same job that ended after its last generation.
pub fn search() -> FinishedCalibration {
    let mut calibration = fit();
    calibration.spec.algorithm = AlgorithmSettings::Evolve(EvolutionSettings::Ga(GaSettings::default()));
    if let Outcome::Estimated(estimate) = &mut calibration.outcome {
        estimate.sd = None;
        estimate.stop = StopReason::Generations;
        estimate.history = vec![Generation {
            evaluations: 100,
            best: Some(-21.0),
            mean: None,
        }];
    }
    calibration
}

/// Returns a study of a sample and a search for the optimum.
pub fn study() -> Study {
    let mut beside = search();
    beside.row.id = 2;
    Study {
        point_estimates: vec![beside],
        ..Study::from(calibration())
    }
}

/// Returns a study of a sample that was searched for a missing effect and extended.
pub fn grown() -> Study {
    let mut extension = calibration();
    (extension.row.id, extension.experiment) = (3, "<script>sand+slip_sinkage".into());
    let mut record =
        serde_json::from_str::<record::Discovery>(include_str!("../../record/discovery.json")).unwrap();
    let form = |form: &str, formula: &str, log_bayes_factor: f64, probability: f64, class: u32| FittedForm {
        form: form.into(),
        formula: formula.into(),
        log_bayes_factor,
        probability,
        class,
    };
    record.outside = Some(Outside {
        acts_on: "shear".into(),
        depends_on: "slip".into(),
        places: Vec::new(),
        form: "step".into(),
        log_bayes_factor: 12.0,
        effect_file: "name = \"<script>\"\n".into(),
        curve: vec![[0.0, 1.0], [0.3, 1.0], [0.31, 1.2], [0.6, 1.2]],
        left_out_nats: [8.0, 3.0],
        formulas: None,
        forms: vec![
            form("step", "if(slip > 0.3, 1.2 * tau, tau)", 12.0, 0.711, 1),
            form("linear", "tau * (1 + 0.4 * slip)", 11.1, 0.289, 1),
        ],
    });
    let member = |id: i64, kind: Role, searches: Option<i64>| StudyMember {
        id,
        name: format!("member {id}"),
        state: CalibrationState::Finished,
        kind,
        effects: Vec::new(),
        searches,
        message: None,
        rejections: None,
    };
    Study {
        members: vec![
            member(1, Role::Sample, None),
            member(2, Role::Search, Some(1)),
            member(3, Role::Sample, None),
        ],
        extensions: vec![extension],
        rounds: vec![DiscoveryRound {
            calibration: 1,
            record,
        }],
        ..study()
    }
}

/// Returns a study whose search found a class of two effects. One was added, and a second search found nothing.
pub fn of_a_class() -> Study {
    let mut study = grown();
    let extension = &mut study.extensions[0];
    *extension = build_with("effects = [\"slip_sinkage\"]\n", &RUNS.replace("LAST", "holdout"));
    extension.row.id = 3;
    extension.row.log_evidence = Some(-20.0);
    let record = &mut study.rounds[0].record;
    record.verdict = Verdict::Class;
    record.extension = None;
    record.text = "one of slip_sinkage (0.68), slip_softened_pressure (0.30) is missing".into();
    for (effect, (name, probability)) in record.effects.iter_mut().zip([
        ("slip_sinkage", 0.68),
        ("slip_softened_pressure", 0.30),
        ("bulldozing", 0.02),
        (NONE, 0.0),
    ]) {
        (effect.name, effect.probability) = (name.into(), probability);
        effect.in_credible_set = probability > 0.1;
        effect.class = u32::from(name != NONE) + u32::from(probability < 0.1 && name != NONE);
    }
    let after = Discovery {
        given: vec!["slip_sinkage".into()],
        verdict: Verdict::NothingDetectable,
        next_runs: Vec::new(),
        other_tests: Vec::new(),
        effects: vec![JudgedEffect {
            probability: 0.9,
            ..record.effects[3].clone()
        }],
        ..record.clone()
    };
    study.rounds.push(DiscoveryRound {
        calibration: 3,
        record: after,
    });
    study
}

/// Returns a study of the model of a rolling wheel, extended by the effect that a search named: displacement stored on the nodes of the
/// soil.
pub fn on_the_nodes() -> Study {
    let rolling = |more: &str| {
        let job = JOB.replace("\"quasi_static\"\n", &format!("\"scm\"\n{more}"));
        of_job(&job, &RUNS.replace("LAST", "holdout"))
    };
    let mut extension = rolling("displacement = \"node\"\neffects = [\"janosi_hanamoto\"]\n");
    extension.row.id = 3;
    let mut study = Study {
        lead: rolling(""),
        extensions: vec![extension],
        ..grown()
    };
    let record = &mut study.rounds[0].record;
    record.extension = Some(Extension::Effect("janosi_hanamoto_node".into()));
    record.effects[0].name = "janosi_hanamoto_node".into();
    study
}

fn build(runs: &str) -> FinishedCalibration {
    build_with("", runs)
}

/// Builds the calibration of the job with `more` lines under `[model]`.
fn build_with(more: &str, runs: &str) -> FinishedCalibration {
    let kind = "kind = \"quasi_static\"\n";
    of_job(&JOB.replace(kind, &format!("{kind}{more}")), runs)
}

fn of_job(job: &str, runs: &str) -> FinishedCalibration {
    let files = FileSet {
        toml: EXPERIMENT.into(),
        files: BTreeMap::from([("runs.csv".into(), runs.to_owned())]),
    };
    let job = FileSet {
        toml: job.into(),
        files: BTreeMap::new(),
    };
    of_files(job, &files)
}

/// Returns a calibration of the given files with draws spread over the prior.
pub fn of_files(job: FileSet, files: &FileSet) -> FinishedCalibration {
    let spec = Spec::new("job.toml", &job, "experiment.toml", files).expect("the fixture's files are valid");
    // Multiples of the golden ratio modulo 1 are spread evenly.
    let share = |k: usize, i: usize| (0.5 + 0.618_033_988_75 * (k * (i + 1)) as f64) % 1.0;
    let theta = |k: usize| -> Vec<f64> {
        spec.parameters
            .iter()
            .enumerate()
            .map(|(i, p)| p.marginal.quantile(share(k, i)))
            .collect()
    };
    let posterior: Vec<Particle> = (0..40)
        .map(|k| Particle {
            theta: theta(k),
            log_likelihood: LogLikelihood::new(-20.0 - share(k, 0)).unwrap(),
            log_prior: -1.0,
        })
        .collect();
    let predicted = |k: usize, runs: &[usize]| {
        let values = |base: f64, step: f64| {
            runs.iter()
                .map(|&r| base + step * (r as f64 + share(k, r)))
                .collect()
        };
        Observables {
            drawbar_pull_n: values(-6.0, 2.0),
            torque_n_m: values(0.1, 0.1),
            sinkage_m: values(0.014, 0.002),
            lateral_force_n: values(0.0, 0.0),
            plate_pressure_pa: vec![1e4; spec.bevameter.plates.len()],
            ..Observables::default()
        }
    };
    // The model rejects the two draws with the smallest n.
    let prior_draws = (0..40)
        .map(|k| PriorDraw {
            theta: theta(k),
            result: match share(k, 1) < 0.075 {
                true => Err(RejectionReason("no_support: condition 0: k* = -2 Pa".into())),
                false => Ok(spec.predicted_values(&predicted(k, &spec.fit_runs))),
            },
            faults: u64::from(k == 7),
        })
        .collect();
    let predictions = (0..20)
        .map(|k| Prediction {
            theta: theta(k),
            fit: Ok(predicted(k, &spec.fit_runs)),
            holdout: (!spec.holdout_runs.is_empty()).then(|| Ok(predicted(k, &spec.holdout_runs)).into()),
        })
        .collect();
    let likeliest_values = spec.predicted_values(&predicted(0, &spec.fit_runs));
    let stage = |stage: u32, tempering_exponent: f64| StageRow {
        stage,
        tempering_exponent,
        acceptance: 0.3,
        drift_z: -0.4,
        correlation: 0.1,
        steps: 12,
        log_evidence_increment: -3.0,
        weight_cov: 1.0,
        ess: 20.0,
        scale: 0.5,
        evaluations: 480,
        equilibrated: true,
    };
    let row = CalibrationRow {
        job,
        model_version: Some("1".into()),
        busy_ms: 1500,
        log_evidence: Some(-25.0),
        log_evidence_se: Some(0.2),
        equilibrated: Some(true),
        evaluations: Some(1000),
        rejected: Some(3),
        name: "<script>sand".into(),
        ..CalibrationRow::finished(1, Membership::submitted(Role::Sample))
    };
    FinishedCalibration {
        experiment: row.name.clone(),
        row,
        outcome: Outcome::Sampled(SampledPosterior {
            stages: vec![stage(1, 0.001), stage(2, 0.1), stage(3, 1.0)],
            populations: vec![posterior.clone(); 3],
            draws: posterior,
            prior_draws,
        }),
        emulator: None,
        likeliest_values: Some(likeliest_values),
        predictions,
        simulated_histories: None,
        rejections: BTreeMap::from([("no_support".into(), 3)]),
        faults: BTreeMap::from([("the lease expired".into(), 1)]),
        given_up: 0,
        disputes: Vec::new(),
        verified: Verified::default(),
        repeats: Repeats::default(),
        interpolations: Default::default(),
        comparison: Default::default(),
        spec,
    }
}
