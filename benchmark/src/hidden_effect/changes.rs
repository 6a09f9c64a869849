//! The three-dimensional model as an unknown rig: its soil is calibrated, and then a parameter changes that the job holds fixed.

use record::{ChiSquare, Discovery, JudgedEffect, NONE, Verdict};
use search::candidate::extended;
use shared::file::FileSet;
use statistics::rng::Stream;

use crate::error::StudyError;
use crate::hidden_effect::study::case::{blank, run as measured, spec};
use crate::hidden_effect::study::design::{Plan, experiment};
use crate::hidden_effect::study::noise::{add_noise, noise_sds};
use crate::hidden_effect::study::noise_free::{MIN_SEPARATION, job_shortfall};
use crate::hidden_effect::study::posterior::{PosteriorSample, sample};
use crate::hidden_effect::study::rate::Rate;
use crate::hidden_effect::study::record::{class, is_right, record};
use crate::parallel::threads;
use crate::process::cpu_s;

/// The first random stream of truths and noise.
const STAGE: u64 = 1 << 49;
/// Noise sd of a channel over the root mean square of its values in the reference. The pulls of a good rig repeat to a hundredth, and
/// with a noise of three hundredths few soils show a cohesion of 500 Pa.
const NOISE: f64 = 0.01;
/// The largest number of draws of the prior until the model accepts all campaigns and each change is detectable.
const MAX_DRAWN: u64 = 100;
/// The largest number of effects in a combination of the search.
const MAX_EFFECTS: usize = 2;
/// On a coarse grid a run may jump between two ruts as the soil changes by a thousandth. A fit may end on either side of the jump, and a
/// sampler covers both.
const SAMPLER: &str = "[sampler]\nparticles = 500\n";
const FILE: &str = "reference.csv";
/// Factor of the covariance of the reference's posterior when it becomes the prior of the next campaigns. It doubles the sds, because the
/// soil was prepared anew and the model scatters.
const TRANSFER: f64 = 4.0;
/// The largest number of explanations that are printed.
const PRINTED: usize = 3;

/// The parameters of a campaign's soil that the job holds fixed.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Soil {
    name: &'static str,
    cohesion_pa: f64,
    flow_fraction: f64,
    /// The effects that the search should name.
    changed: &'static [&'static str],
}

const REFERENCE: Soil = Soil {
    name: "reference",
    cohesion_pa: 0.0,
    flow_fraction: 0.0,
    changed: &[],
};

const COHESIVE: Soil = Soil {
    name: "cohesion",
    cohesion_pa: 500.0,
    changed: &["cohesion_pa"],
    ..REFERENCE
};

/// The fraction that flows is the default of the model.
const FLOWING: Soil = Soil {
    name: "flow",
    flow_fraction: 0.25,
    changed: &["flow_fraction"],
    ..REFERENCE
};

const BOTH: Soil = Soil {
    name: "both",
    cohesion_pa: COHESIVE.cohesion_pa,
    flow_fraction: FLOWING.flow_fraction,
    changed: &["cohesion_pa", "flow_fraction"],
};

const CAMPAIGNS: [Soil; 4] = [REFERENCE, COHESIVE, FLOWING, BOTH];

/// The measurements of a rig on each soil.
struct Rig {
    truth: Vec<f64>,
    experiments: Vec<FileSet>,
    /// Nats by which the job falls short of each campaign except the first, for noise-free data.
    shortfalls: Vec<f64>,
    /// Chi-square of the noise of each campaign.
    chi_squares: Vec<f64>,
}

/// The verdict on the search of a campaign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Answer {
    /// The class of a change leads and the best set has all changes, or nothing is claimed for an unchanged soil.
    Right,
    /// The class of a change leads, and the best set lacks another change.
    Part,
    /// No claim is made.
    Open,
    /// Another class leads.
    Wrong,
}

/// Searches the four campaigns of a number of rigs one after another, each on all threads.
pub fn run(plan: Plan, count: u64, seed: u64) -> Result<(), StudyError> {
    let mut answers = vec![Vec::new(); CAMPAIGNS.len()];
    for number in 0..count {
        let rig = Rig::new(plan, seed, number)?;
        let base = job(plan, REFERENCE);
        let posterior = sample(&base, &rig.experiments[0], SAMPLER, seed)?;
        println!("changes {number}: {}", calibrated(&posterior, &rig));
        let next = after(&base, &posterior)?;
        for (k, (soil, answers)) in CAMPAIGNS.iter().zip(&mut answers).enumerate() {
            let job = if *soil == REFERENCE { &base } else { &next };
            let (name, experiment) = (format!("{number} {}", soil.name), &rig.experiments[k]);
            let (record, answer) = searched(job, experiment, soil.changed, &name)?;
            // As in a study, the named effect is added and the search is repeated.
            if let (Answer::Part, Some(added)) = (answer, &record.extension) {
                let mut rest = soil.changed.to_vec();
                rest.retain(|name| *name != record.effects[0].name);
                let job = extended("job.toml", job, &[added])?;
                searched(&job, experiment, &rest, &format!("{name} with it"))?;
            }
            answers.push(answer);
        }
    }
    for (soil, answers) in CAMPAIGNS.iter().zip(&answers) {
        let rate = |wanted| Rate::new(answers.iter().map(|answer| *answer == wanted));
        let (right, part, wrong) = (rate(Answer::Right), rate(Answer::Part), rate(Answer::Wrong));
        println!(
            "{}: right {right}, part {part}, wrong {wrong} (goal 0)",
            soil.name
        );
    }
    Ok(())
}

/// Searches a campaign, and prints the result.
fn searched(
    job: &FileSet,
    experiment: &FileSet,
    changed: &[&str],
    name: &str,
) -> Result<(Discovery, Answer), StudyError> {
    let cpu_before_s = cpu_s("self")?;
    let record = record(job, experiment, MAX_EFFECTS, threads())?;
    let answer = answer(&record, changed);
    println!(
        "changes {name}: {answer:?}, {:?}, {:.1} CPU-s, {}",
        record.verdict,
        cpu_s("self")? - cpu_before_s,
        summary(&record, changed)
    );
    Ok((record, answer))
}

/// Returns the job of a plan with the parameters of a soil and the radius of the experiment's wheel.
fn job(plan: Plan, soil: Soil) -> FileSet {
    let mut job = plan.job();
    let lines = job
        .toml
        .lines()
        .filter(|line| !line.starts_with("wheel_radius_m"));
    let (cohesion_pa, flow_fraction) = (soil.cohesion_pa, soil.flow_fraction);
    let priors = format!("cohesion_pa = {cohesion_pa:?}\nflow_fraction = {flow_fraction:?}\n[priors]");
    let lines = lines.map(|line| if line == "[priors]" { &priors } else { line });
    job.toml = lines.flat_map(|line| [line, "\n"]).collect();
    job
}

/// Returns the job with a posterior as its prior.
fn after(job: &FileSet, posterior: &PosteriorSample) -> Result<FileSet, StudyError> {
    let (model, _) = job.toml.split_once("[priors]").ok_or("the job has no priors")?;
    Ok(FileSet {
        toml: format!("{model}[priors]\nkappa = 0.0\nposterior = \"{FILE}\"\ntransfer = {TRANSFER:?}\n"),
        files: [(FILE.to_owned(), posterior.csv())].into(),
    })
}

impl Rig {
    /// Draws a truth from the priors until each change is detectable, and measures it.
    ///
    /// The noise sds are the same in all campaigns.
    fn new(plan: Plan, seed: u64, number: u64) -> Result<Self, StudyError> {
        let mut rows = plan.rows();
        rows.retain(|row| !row.is_holdout);
        let base = job(plan, REFERENCE);
        let prior = spec(&base, &blank(&rows))?.prior();
        'draws: for drawn in 0..MAX_DRAWN {
            let truth = prior.sample(&mut Stream::new(seed, STAGE, number, drawn));
            let (mut sds, mut experiments) = (None, Vec::new());
            let (mut shortfalls, mut chi_squares) = (Vec::new(), Vec::new());
            for (k, soil) in (0..).zip(CAMPAIGNS) {
                let Some(mut values) = measured(&job(plan, soil), &rows, &truth)? else {
                    continue 'draws;
                };
                let sds = *sds.get_or_insert_with(|| noise_sds(NOISE, values.iter()));
                if soil != REFERENCE {
                    let noise_free = experiment(&rows, &values, sds);
                    let nats = job_shortfall(&base, &noise_free, truth.clone())?;
                    if nats < MIN_SEPARATION {
                        continue 'draws;
                    }
                    shortfalls.push(nats);
                }
                let noise = || Stream::new(seed, STAGE + 1, number, k);
                let normals = noise().normals(values.as_flattened().len());
                chi_squares.push(normals.iter().map(|z| z * z).sum());
                add_noise(&mut values, sds, &mut noise());
                experiments.push(experiment(&rows, &values, sds));
            }
            return Ok(Self {
                truth,
                experiments,
                shortfalls,
                chi_squares,
            });
        }
        Err(format!(
            "with {MAX_DRAWN} draws of the prior the model rejects a soil, or a change is not detectable"
        )
        .into())
    }
}

/// Returns a posterior beside the truth, and the nats by which the job falls short after each change.
fn calibrated(posterior: &PosteriorSample, rig: &Rig) -> String {
    let parameters = posterior.moments().zip(&rig.truth);
    let parameters =
        parameters.map(|((name, mean, sd), truth)| format!("{name} {mean:.4} ± {sd:.4} (truth {truth:.4})"));
    let shortfalls = rig.shortfalls.iter().map(|nats| format!("{nats:.0}"));
    let chi_squares = rig.chi_squares.iter().map(|value| format!("{value:.0}"));
    format!(
        "calibrated: {}; without noise the job then falls short by {} nats; chi-square of the noise {}",
        parameters.collect::<Vec<_>>().join(", "),
        shortfalls.collect::<Vec<_>>().join(", "),
        chi_squares.collect::<Vec<_>>().join(", ")
    )
}

/// Returns the verdict on a search, given the changes between the campaigns.
fn answer(record: &Discovery, changed: &[&str]) -> Answer {
    let claims: Vec<Option<bool>> = match changed {
        [] => vec![is_right(record, None)],
        _ => changed.iter().map(|name| is_right(record, Some(name))).collect(),
    };
    if claims.contains(&Some(true)) {
        let best = record.sets.iter().find(|set| set.members != [NONE]);
        let members = best.iter().flat_map(|set| &set.members);
        let named: Vec<_> = members.map(|name| class(record, name)).collect();
        let has_all = changed.iter().all(|name| named.contains(&class(record, name)));
        if has_all { Answer::Right } else { Answer::Part }
    } else if claims.contains(&Some(false)) {
        Answer::Wrong
    } else if changed.is_empty() && record.verdict == Verdict::NothingDetectable {
        Answer::Right
    } else {
        Answer::Open
    }
}

/// Returns the best explanations, those of the changes, and the misfit.
fn summary(record: &Discovery, changed: &[&str]) -> String {
    let effects = record.effects.iter();
    let is_changed = |effect: &&JudgedEffect| changed.contains(&effect.name.as_str());
    let changes = effects
        .clone()
        .filter(is_changed)
        .map(|effect| ("changed: ", effect));
    let best = effects.take(PRINTED).map(|effect| ("", effect));
    let judged = best.chain(changes).map(|(label, effect)| {
        let values = effect
            .parameters
            .iter()
            .map(|(name, value)| format!("{name} {value:.3e}"));
        format!(
            "{label}{} P {:.4} ln BF {:.1} c{} [{}]",
            effect.name,
            effect.probability,
            effect.log_bayes_factor,
            effect.class,
            values.collect::<Vec<_>>().join(" ")
        )
    });
    let sets = record.sets.iter().take(PRINTED).map(|set| {
        let left_out = set
            .predictive
            .map_or(String::new(), |nats| format!(" left out {nats:.1}"));
        format!(
            "{} P {:.4} ln BF {:.1}{left_out}",
            set.members.join(" + "),
            set.probability,
            set.log_bayes_factor
        )
    });
    let scatter = record.numerical_noise.iter();
    let scatter: Vec<String> = scatter
        .map(|(channel, sd)| format!("{channel} {sd:.1e}"))
        .collect();
    let fit = |chi: &ChiSquare| {
        let [value, p] = [chi.value, chi.p].map(|value| value.unwrap_or(f64::NAN));
        format!("{value:.1} of {:.0} (p {p:.1e})", chi.degrees_of_freedom)
    };
    format!(
        "{} evaluations; {}; sets {}; chi-square {}, with the best {}; scatter of the model [{}]; {}",
        record.evaluations,
        judged.collect::<Vec<_>>().join(", "),
        sets.collect::<Vec<_>>().join(", "),
        fit(&record.chi2),
        fit(&record.chi2_best),
        scatter.join(", "),
        record.text
    )
}
