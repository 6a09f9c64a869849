//! Runs until the missing effect is named: a campaign that begins with six runs and is continued by proposals or at random, against the
//! factorial of 24 runs.

use shared::model::RunCondition;

use super::campaign::{Answer, Campaign};
use super::space::Space;
use crate::error::StudyError;
use crate::hidden_effect::study::rate::{Rate, mean};
use crate::parallel::each;

/// Runs that a campaign begins with, and the most that it gets: those of the factorial.
pub const FIRST_RUNS: usize = 6;
pub const ALL_RUNS: usize = 24;

/// How the next run is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Choice {
    /// The run that the search proposes; where it compares no explanations, the one farthest from all earlier ones.
    Adaptive,
    /// A random run of the same grid.
    Random,
}

/// The end of a campaign.
struct Course {
    /// The number of runs after which the class of the truth was named; `None` if it was not.
    right_after: Option<usize>,
    is_wrong: bool,
}

/// The campaigns of one truth.
struct Trial {
    adaptive: Course,
    random: Course,
    factorial: Course,
}

/// A way of choosing the runs of a campaign.
type Way = fn(&Trial) -> &Course;

/// Draws truths that the factorial can show, and prints how many runs each way needs to name them.
pub fn run(count: u64, seed: u64) -> Result<(), StudyError> {
    let trials = each(count, |number| {
        trial(seed, number).inspect_err(|message| println!("failed: campaign {number}: {message}"))
    })?;
    println!("campaigns: {count}");
    let ways: [(&str, Way); 3] = [
        ("adaptive from 6", |trial| &trial.adaptive),
        ("random from 6", |trial| &trial.random),
        ("factorial of 24", |trial| &trial.factorial),
    ];
    for (name, course) in ways {
        let courses: Vec<&Course> = trials.iter().map(course).collect();
        // A campaign that does not name the truth counts as if one more run did.
        let needed = |course: &&Course| course.right_after.unwrap_or(ALL_RUNS + 1) as f64;
        let mut runs: Vec<f64> = courses.iter().map(needed).collect();
        runs.sort_by(f64::total_cmp);
        let [average, error] = mean(&runs);
        let right = Rate::new(courses.iter().map(|course| course.right_after.is_some()));
        let wrong = Rate::new(courses.iter().map(|course| course.is_wrong));
        println!(
            "{name}: runs until the right name, at most 25: median {}, mean {average:.1} ± {error:.1}",
            runs[runs.len() / 2]
        );
        println!("  right by 24: {right}; wrongly named: {wrong}");
    }
    // The runs of the two ways where the factorial names the truth.
    let fair: Vec<&Trial> = trials
        .iter()
        .filter(|trial| trial.factorial.right_after.is_some())
        .collect();
    let share = Rate::new(fair.iter().map(|trial| {
        trial
            .adaptive
            .right_after
            .is_some_and(|runs| runs <= ALL_RUNS / 2)
    }));
    println!("where the factorial names the truth, adaptive campaigns name it by 12 runs: {share} (goal .5)");
    Ok(())
}

fn trial(seed: u64, number: u64) -> Result<Trial, StudyError> {
    let whole = Campaign::factorial(seed, number)?;
    let answer = whole.search()?;
    let factorial = Course::ended(&answer, ALL_RUNS);
    let first = whole.first_runs();
    let adaptive = Course::new(Choice::Adaptive, &first)?;
    let random = Course::new(Choice::Random, &first)?;
    let shown = |course: &Course| match (course.right_after, course.is_wrong) {
        (Some(runs), _) => format!("right after {runs}"),
        (None, true) => "wrong".to_owned(),
        (None, false) => "open".to_owned(),
    };
    println!(
        "campaign {number} {}: adaptive {}, random {}, factorial {}",
        whole.hidden(),
        shown(&adaptive),
        shown(&random),
        shown(&factorial)
    );
    Ok(Trial {
        adaptive,
        random,
        factorial,
    })
}

impl Course {
    fn ended(answer: &Answer, runs: usize) -> Self {
        let is_right = answer.is_right();
        Course {
            right_after: (is_right == Some(true)).then_some(runs),
            is_wrong: is_right == Some(false),
        }
    }

    /// Continues a campaign until the search makes a claim, or it has as many runs as the factorial.
    fn new(choice: Choice, first: &Campaign) -> Result<Self, StudyError> {
        let mut campaign = first.clone();
        loop {
            let answer = campaign.search()?;
            let course = Course::ended(&answer, campaign.made().len());
            let is_over = campaign.made().len() >= ALL_RUNS;
            if answer.is_right().is_some()
                || is_over
                || !campaign.make_one(&choice.order(&campaign, &answer))?
            {
                return Ok(course);
            }
        }
    }
}

impl Choice {
    /// Returns the runs to make, the next one first.
    fn order(self, campaign: &Campaign, answer: &Answer) -> Vec<RunCondition> {
        match self {
            Choice::Random => campaign.at_random(&answer.possible, 0),
            Choice::Adaptive => {
                let filling = Space::new(&answer.possible).filling(campaign.made());
                let rest = filling.into_iter().map(|k| answer.possible[k].clone());
                answer.proposed().into_iter().chain(rest).collect()
            }
        }
    }
}
