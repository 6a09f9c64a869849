//! Whether the runs that are proposed tell apart what the first could not.

use coordinator::missing_effect::SearchModels;
use discovery::{Conclusion, QueriedModel, Query, SearchVerdict};
use statistics::rng::Stream;

use crate::study::case::{SyntheticCase, run as run_truth};
use crate::study::design::{CHANNELS, Plan, PlannedRun};
use crate::study::error::StudyError;
use crate::study::parallel::each;

use crate::study::local_search::LocalSearch;
use crate::study::rate::Rate;
use crate::study::trial::draw_detectable;

/// Most proposed runs that are made.
const MOST: usize = 2;
/// The truths are others than those of the other kinds.
const FIRST: u64 = 1_000_000;

/// Streams of the noise of further runs.
const STAGE: u64 = 1 << 45;

/// How the search for one effect went on.
struct Story {
    /// Something is missing, and what was open after the first runs.
    is_open: bool,
    /// After so many further runs the truth's class was named, or another's.
    right_after: Option<usize>,
    is_wrong: bool,
    line: String,
}

/// Runs so many experiments and prints how many were resolved.
pub(crate) fn run(count: u64, seed: u64) -> Result<(), StudyError> {
    let stories = each(count, |number| {
        let story = one(seed, number);
        match &story {
            Ok(story) => println!("{}", story.line),
            Err(message) => println!("failed: ambiguous {number}: {message}"),
        }
        story
    })?;
    let stories: Vec<Story> = stories.into_iter().collect::<Result<_, StudyError>>()?;
    let open: Vec<&Story> = stories.iter().filter(|s| s.is_open).collect();
    println!("open after the first runs: {} of {}", open.len(), stories.len());
    for most in 1..=MOST {
        let resolved = open
            .iter()
            .map(|s| s.right_after.is_some_and(|after| after <= most));
        println!(
            "resolved by {most} proposed: {} (floor .70, aim .85 of 2)",
            Rate::new(resolved)
        );
    }
    println!(
        "wrongly named in the end: {}",
        Rate::new(open.iter().map(|s| s.is_wrong))
    );
    Ok(())
}

/// The named candidate's class, where something is named.
fn named(conclusion: &Conclusion) -> Option<usize> {
    let class = |k: usize| {
        let own = conclusion.ranking.effects.iter().find(|j| j.candidate == Some(k));
        own.map(|j| j.class)
    };
    match conclusion.verdict {
        SearchVerdict::Named(k) => class(k),
        SearchVerdict::Class(class) => Some(class),
        _ => None,
    }
}

/// The run that the rig is to make first.
fn proposed(models: &mut SearchModels, conclusion: &Conclusion) -> Result<Option<PlannedRun>, StudyError> {
    let Some(next) = conclusion.next_runs.first() else {
        return Ok(None);
    };
    let asked = Query {
        model: QueriedModel::With(Vec::new()),
        is_proposed: true,
        theta: Vec::new(),
    };
    let (_, variant) = models.variant(&asked)?;
    let condition = &variant.conditions[next.run];
    Ok(Some(PlannedRun {
        wheel: "wide",
        slip: condition.slip,
        wheel_load_n: condition.wheel_load_n,
        sled_speed_m_s: condition.sled_speed_m_s,
        pass: condition.pass,
        is_holdout: false,
    }))
}

/// Makes one more run and measures it; `false` where the truth refuses it.
fn measure(case: &mut SyntheticCase, row: PlannedRun, seed: u64, number: u64) -> Result<bool, StudyError> {
    let made = run_truth(&case.truth_job, std::slice::from_ref(&row), &case.theta)?;
    let Some(&[noise_free]) = made.as_deref() else {
        return Ok(false);
    };
    let noise = Stream::new(seed, STAGE, number, case.rows.len() as u64).normals(CHANNELS);
    let mut measured = noise_free;
    for (k, x) in measured.iter_mut().enumerate() {
        *x += case.sds[k] * noise[k];
    }
    case.rows.push(row);
    case.noise_free.push(noise_free);
    case.measured.push(measured);
    Ok(true)
}

fn one(seed: u64, number: u64) -> Result<Story, StudyError> {
    let mut case = draw_detectable(Plan::Narrow, 1, seed, FIRST + number)?;
    let mut line = format!("ambiguous {number} {}:", case.hidden[0]);
    let mut story = Story {
        is_open: false,
        right_after: None,
        is_wrong: false,
        line: String::new(),
    };
    for further in 0..=MOST {
        let mut local = LocalSearch::new(&case.plan.job(), &case.experiment(), 1)?;
        let conclusion = local.run()?;
        let task = local.models.task();
        let truth = conclusion.ranking.effects.iter().find(|j| {
            j.candidate
                .is_some_and(|k| task.library[k].name == case.hidden[0])
        });
        let named = named(&conclusion);
        line += &format!(
            " {:?} (truth {:.1} P {:.3})",
            conclusion.verdict,
            truth.map_or(f64::NAN, |j| j.log_bayes_factor),
            truth.map_or(0.0, |j| j.probability)
        );
        if further == 0 {
            story.is_open =
                conclusion.verdict == SearchVerdict::Undecided && !conclusion.next_runs.is_empty();
            if !story.is_open {
                break;
            }
        }
        if named.is_some() {
            let is_right = named == truth.map(|j| j.class);
            story.right_after = is_right.then_some(further);
            story.is_wrong = !is_right;
            break;
        }
        if further == MOST {
            break;
        }
        let Some(row) = proposed(&mut local.models, &conclusion)? else {
            break;
        };
        line += &format!(
            " -> slip {} load {} N sled {:.4} m/s",
            row.slip, row.wheel_load_n, row.sled_speed_m_s
        );
        if !measure(&mut case, row, seed, number)? {
            line += " refused by the truth";
            break;
        }
    }
    story.line = line;
    Ok(story)
}
