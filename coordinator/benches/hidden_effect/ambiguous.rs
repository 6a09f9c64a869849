//! Whether the runs that are proposed tell apart what the first could not.

use coordinator::missing_effect::Models;
use discovery::inquiry::{Answer, Asked, Model, Verdict};
use statistics::rng::Stream;

use crate::study::case::{Case, run as run_truth};
use crate::study::design::{CHANNELS, Plan, Row};
use crate::study::each;
use crate::study::kind::draw_clear;
use crate::study::pipeline::Asking;
use crate::study::rate::Rate;

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
pub(crate) fn run(count: u64, seed: u64) -> Result<(), String> {
    let stories = each(count, |number| {
        let story = one(seed, number);
        match &story {
            Ok(story) => println!("{}", story.line),
            Err(message) => println!("failed: ambiguous {number}: {message}"),
        }
        story
    })?;
    let stories: Vec<Story> = stories.into_iter().collect::<Result<_, String>>()?;
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
fn named(answer: &Answer) -> Option<usize> {
    let class = |k: usize| {
        let own = answer.judged.iter().find(|j| j.candidate == Some(k));
        own.map(|j| j.class)
    };
    match answer.verdict {
        Verdict::Named(k) => class(k),
        Verdict::Class(class) => Some(class),
        _ => None,
    }
}

/// The run that the rig is to make first.
fn proposed(models: &mut Models, answer: &Answer) -> Result<Option<Row>, String> {
    let Some(next) = answer.next_runs.first() else {
        return Ok(None);
    };
    let asked = Asked {
        model: Model::With(Vec::new()),
        is_proposed: true,
        theta: Vec::new(),
    };
    let (_, variant) = models.variant(&asked).map_err(|e| e.to_string())?;
    let condition = &variant.conditions[next.run];
    Ok(Some(Row {
        wheel: "wide",
        slip: condition.slip,
        wheel_load_n: condition.wheel_load_n,
        sled_speed_m_s: condition.sled_speed_m_s,
        pass: condition.pass,
        is_holdout: false,
    }))
}

/// Makes one more run and measures it; `false` where the truth refuses it.
fn measure(case: &mut Case, row: Row, seed: u64, number: u64) -> Result<bool, String> {
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

fn one(seed: u64, number: u64) -> Result<Story, String> {
    let mut case = draw_clear(Plan::Narrow, 1, seed, FIRST + number)?;
    let mut line = format!("ambiguous {number} {}:", case.hidden[0]);
    let mut story = Story {
        is_open: false,
        right_after: None,
        is_wrong: false,
        line: String::new(),
    };
    for further in 0..=MOST {
        let mut asking = Asking::new(&case.plan.job(), &case.experiment(), 1)?;
        let answer = asking.inquire()?;
        let task = asking.models.task();
        let truth = answer.judged.iter().find(|j| {
            j.candidate
                .is_some_and(|k| task.library[k].name == case.hidden[0])
        });
        let named = named(&answer);
        line += &format!(
            " {:?} (truth {:.1} P {:.3})",
            answer.verdict,
            truth.map_or(f64::NAN, |j| j.log_bayes_factor),
            truth.map_or(0.0, |j| j.probability)
        );
        if further == 0 {
            story.is_open = answer.verdict == Verdict::Undecided && !answer.next_runs.is_empty();
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
        let Some(row) = proposed(&mut asking.models, &answer)? else {
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
