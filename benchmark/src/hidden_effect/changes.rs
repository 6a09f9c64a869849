//! The three-dimensional model as an unknown rig: its soil is calibrated, then something changes that the job holds still.

use record::{ChiSquare, Discovery, NONE, Verdict};
use search::candidate::extended;
use shared::file::FileSet;
use statistics::rng::Stream;

use crate::hidden_effect::study::case::{blank, run as measured, spec};
use crate::hidden_effect::study::cpu::cpu_s;
use crate::hidden_effect::study::design::{CHANNELS, Plan, experiment};
use crate::hidden_effect::study::error::StudyError;
use crate::hidden_effect::study::noise_free::{MIN_SEPARATION, shortfall_of};
use crate::hidden_effect::study::parallel::threads;
use crate::hidden_effect::study::posterior::{PosteriorSample, sample};
use crate::hidden_effect::study::rate::Rate;
use crate::hidden_effect::study::record::{is_right, record};

/// Random streams of truths and noise.
const STAGE: u64 = 1 << 49;
/// Noise sd of a channel over the root mean square of its values in the reference. Pulls of a good rig repeat to a hundredth,
/// and at three hundredths few soils show a cohesion of 500 Pa.
const NOISE: f64 = 0.01;
/// Draws of the prior until the model takes all campaigns and each change is detectable.
const MAX_DRAWN: u64 = 100;
/// Most effects in a combination of the search.
const MAX_EFFECTS: usize = 2;
/// On a coarse grid a run may jump between two ruts as the soil changes by a thousandth: a fit ends on either side, a sample on the right one.
const SAMPLER: &str = "[sampler]\nparticles = 500\n";
const FILE: &str = "reference.csv";
/// Factor of the covariance of the reference's posterior as the prior of the next campaigns: twice the sds, because the soil was
/// prepared anew and the model scatters.
const TRANSFER: f64 = 4.0;
/// Most explanations that are printed.
const PRINTED: usize = 3;

/// The soil of a campaign, as far as the job holds it still.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Soil {
    name: &'static str,
    cohesion_pa: f64,
    flow_fraction: f64,
    /// What the search should name.
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

/// The share that flows is the model's own.
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
    /// Nats by which the job falls short of each but the first, without noise.
    shortfalls: Vec<f64>,
    /// Chi-square of the noise of each.
    chi_squares: Vec<f64>,
}

/// What a search says of a campaign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Answer {
    /// What changed or its class leads, and the best set has all of it; or that nothing is missing where nothing is.
    Right,
    /// What leads is a part of what changed, and the best set has not all of it.
    Part,
    /// No claim is made.
    Open,
    /// Something else leads.
    Wrong,
}

/// Searches the four campaigns of so many rigs one after the other, each on all threads.
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
            let (record, answer) = searched(
                job,
                &rig.experiments[k],
                soil.changed,
                &format!("{number} {}", soil.name),
            )?;
            // As a study goes on: what is named is added, and the rest is looked for.
            if let (Answer::Part, Some(added)) = (answer, &record.extension) {
                let rest: Vec<&str> = soil
                    .changed
                    .iter()
                    .copied()
                    .filter(|name| *name != record.effects[0].name)
                    .collect();
                let job = extended("job.toml", job, &[added])?;
                searched(
                    &job,
                    &rig.experiments[k],
                    &rest,
                    &format!("{number} {} with it", soil.name),
                )?;
            }
            answers.push(answer);
        }
    }
    for (soil, answers) in CAMPAIGNS.iter().zip(&answers) {
        let rate = |wanted| Rate::new(answers.iter().map(|own| *own == wanted));
        println!(
            "{}: right {}, part {}, wrong {} (goal 0)",
            soil.name,
            rate(Answer::Right),
            rate(Answer::Part),
            rate(Answer::Wrong)
        );
    }
    Ok(())
}

/// Searches a campaign, and prints what comes out.
fn searched(
    job: &FileSet,
    experiment: &FileSet,
    changed: &[&str],
    name: &str,
) -> Result<(Discovery, Answer), StudyError> {
    let cpu = cpu_s();
    let record = record(job, experiment, MAX_EFFECTS, threads())?;
    let answer = answer(&record, changed);
    println!(
        "changes {name}: {answer:?}, {:?}, {:.1} CPU-s, {}",
        record.verdict,
        cpu_s() - cpu,
        said(&record, changed)
    );
    Ok((record, answer))
}

/// The job of a model that has a soil's values; the wheel is what the experiment says.
fn job(plan: Plan, soil: Soil) -> FileSet {
    let mut job = plan.job();
    let lines = job
        .toml
        .lines()
        .filter(|line| !line.starts_with("wheel_radius_m"));
    let of_soil = format!(
        "cohesion_pa = {:?}\nflow_fraction = {:?}\n[priors]",
        soil.cohesion_pa, soil.flow_fraction
    );
    let lines = lines.map(|line| if line == "[priors]" { &of_soil } else { line });
    job.toml = lines.flat_map(|line| [line, "\n"]).collect();
    job
}

/// The job with a posterior as its prior.
fn after(job: &FileSet, posterior: &PosteriorSample) -> Result<FileSet, StudyError> {
    let (model, _) = job.toml.split_once("[priors]").ok_or("the job has no priors")?;
    Ok(FileSet {
        toml: format!("{model}[priors]\nkappa = 0.0\nposterior = \"{FILE}\"\ntransfer = {TRANSFER:?}\n"),
        files: [(FILE.to_owned(), posterior.csv())].into(),
    })
}

impl Rig {
    /// Draws a truth from the priors with which each change is detectable, and measures it.
    ///
    /// The noise of a channel is a share of its root mean square in the reference, the same in all campaigns.
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
                let sds = *sds.get_or_insert_with(|| noise_sds(&values));
                if soil != REFERENCE {
                    let noise_free = experiment(&rows, &values, sds);
                    let nats = shortfall_of(&base, &noise_free, truth.clone())?;
                    if nats < MIN_SEPARATION {
                        continue 'draws;
                    }
                    shortfalls.push(nats);
                }
                let normals = Stream::new(seed, STAGE + 1, number, k).normals(CHANNELS * rows.len());
                chi_squares.push(normals.iter().map(|z| z * z).sum());
                let sd = sds.into_iter().cycle();
                for ((x, sd), z) in values.as_flattened_mut().iter_mut().zip(sd).zip(normals) {
                    *x += sd * z;
                }
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

fn noise_sds(values: &[[f64; CHANNELS]]) -> [f64; CHANNELS] {
    std::array::from_fn(|channel| {
        let squares: f64 = values.iter().map(|own| own[channel] * own[channel]).sum();
        NOISE * (squares / values.len() as f64).sqrt()
    })
}

/// A posterior beside the truth, and what the changes are worth.
fn calibrated(posterior: &PosteriorSample, rig: &Rig) -> String {
    let parameters = posterior.moments().zip(&rig.truth);
    let parameters =
        parameters.map(|((name, mean, sd), truth)| format!("{name} {mean:.4} ± {sd:.4} (truth {truth:.4})"));
    let shortfalls = rig.shortfalls.iter().map(|nats| format!("{nats:.0}"));
    let chi_squares = rig.chi_squares.iter().map(|own| format!("{own:.0}"));
    format!(
        "calibrated: {}; without noise the job then falls short by {} nats; chi-square of the noise {}",
        parameters.collect::<Vec<_>>().join(", "),
        shortfalls.collect::<Vec<_>>().join(", "),
        chi_squares.collect::<Vec<_>>().join(", ")
    )
}

/// What a search says, of what changed between the campaigns.
fn answer(record: &Discovery, changed: &[&str]) -> Answer {
    let class = |name: &str| record.effects.iter().find(|e| e.name == name).map(|e| e.class);
    let claims: Vec<Option<bool>> = match changed {
        [] => vec![is_right(record, None)],
        _ => changed.iter().map(|name| is_right(record, Some(name))).collect(),
    };
    if claims.contains(&Some(true)) {
        let best = record.sets.iter().find(|set| set.members != [NONE]);
        let named: Vec<_> = best
            .iter()
            .flat_map(|set| set.members.iter().map(|name| class(name)))
            .collect();
        match changed.iter().all(|name| named.contains(&class(name))) {
            true => Answer::Right,
            false => Answer::Part,
        }
    } else if claims.contains(&Some(false)) {
        Answer::Wrong
    } else if changed.is_empty() && record.verdict == Verdict::NothingDetectable {
        Answer::Right
    } else {
        Answer::Open
    }
}

/// The best explanations, what is said of what changed, and how well all that fits.
fn said(record: &Discovery, changed: &[&str]) -> String {
    let best = record.effects.iter().take(PRINTED).map(|own| (own, ""));
    let own = record
        .effects
        .iter()
        .filter(|own| changed.contains(&own.name.as_str()));
    let judged = best.chain(own.map(|own| (own, "changed: "))).map(|(own, what)| {
        let values: Vec<String> = own
            .parameters
            .iter()
            .map(|(name, value)| format!("{name} {value:.3e}"))
            .collect();
        format!(
            "{what}{} P {:.4} ln BF {:.1} c{} [{}]",
            own.name,
            own.probability,
            own.log_bayes_factor,
            own.class,
            values.join(" ")
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
        let [value, p] = [chi.value, chi.p].map(|own| own.unwrap_or(f64::NAN));
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
