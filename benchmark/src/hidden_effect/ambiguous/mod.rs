//! How many further runs identify the missing effect, if the search chooses them, or at random, or to fill the space of conditions.
//!
//! # Layout
//! - `campaign`: an experiment that gets further runs. `strategy`: the choice of the runs; `space`: the conditions that a rig can set.
//! - `factorial`: campaigns that begin with six runs, against the factorial of 24.
//! - `story`: one campaign, continued by one strategy.

pub mod campaign;
pub mod factorial;
pub mod space;
pub mod story;
pub mod strategy;

use campaign::{Answer, Campaign};
use story::Story;
use strategy::{MAX_STRATEGY_RUNS, Strategy};

use crate::error::StudyError;
use crate::hidden_effect::study::rate::{Rate, mean};
use crate::parallel::each;

/// The number of random pairs of runs that are tried if the two proposed runs leave the case open.
const PAIRS: u64 = 25;

/// The stories of one experiment, one for each strategy.
struct Case {
    stories: Vec<Story>,
    /// The share of random pairs of runs that resolve the case; `None` if the proposed pair resolves it.
    pairs: Option<Rate>,
}

/// Draws experiments, and prints how many runs each strategy needs for those that the search leaves undecided.
pub fn run(count: u64, seed: u64) -> Result<(), StudyError> {
    let cases = each(count, |number| {
        case(seed, number).inspect_err(|message| println!("failed: ambiguous {number}: {message}"))
    })?;
    let open: Vec<Case> = cases.into_iter().flatten().collect();
    println!("open after the first runs: {} of {count}", open.len());
    for (place, strategy) in Strategy::ALL.into_iter().enumerate() {
        let stories: Vec<&Story> = open.iter().map(|case| &case.stories[place]).collect();
        println!("{}", strategy.name());
        for runs in strategy.counts() {
            let right = stories
                .iter()
                .map(|s| s.right_after.is_some_and(|after| after <= runs));
            let has_goal = strategy.is_proposed() && runs == 2;
            let goal = if has_goal { " (goal .90)" } else { "" };
            println!("  resolved by {runs}: {}{goal}", Rate::new(right));
        }
        // A case that stays open counts as if one more run resolved it.
        let limit = MAX_STRATEGY_RUNS + 1;
        let needed = stories.iter().map(|s| s.right_after.unwrap_or(limit) as f64);
        let [average, error] = mean(&needed.collect::<Vec<f64>>());
        if strategy != Strategy::Batch {
            println!("  runs needed, at most {limit}: {average:.2} ± {error:.2}");
        }
        let wrong = Rate::new(stories.iter().map(|s| s.is_wrong));
        println!("  wrongly named: {wrong} (goal 0)");
    }
    let tried: Vec<Rate> = open.iter().filter_map(|case| case.pairs).collect();
    let possible = tried.iter().map(|rate| rate.count > 0);
    println!(
        "of those that two at once leave open, some of {PAIRS} random pairs resolves {}",
        Rate::new(possible)
    );
    let all: Rate = tried.into_iter().sum();
    println!("  resolved by a random pair there: {all}");
    Ok(())
}

/// Returns the case of a number; `None` if the first runs decide.
fn case(seed: u64, number: u64) -> Result<Option<Case>, StudyError> {
    let campaign = Campaign::new(seed, number)?;
    let first = campaign.search()?;
    if !first.is_open() {
        return Ok(None);
    }
    let mut stories = Vec::new();
    let mut pairs = None;
    let mut lines = format!("ambiguous {number} {}: {first}", campaign.hidden());
    for strategy in Strategy::ALL {
        let story = Story::new(strategy, &campaign, &first)?;
        lines += &format!("\n  {}:{}", strategy.name(), story.line);
        if strategy == Strategy::Batch && story.right_after.is_none() {
            let rate = pairs_at_random(&campaign, &first)?;
            lines += &format!("; a random pair resolves it: {rate}");
            pairs = Some(rate);
        }
        stories.push(story);
    }
    println!("{lines}");
    Ok(Some(Case { stories, pairs }))
}

/// Returns the share of random pairs of runs after which the class of the truth is named.
fn pairs_at_random(campaign: &Campaign, first: &Answer) -> Result<Rate, StudyError> {
    let mut right = Vec::new();
    for pair in 0..PAIRS {
        let mut further = campaign.clone();
        let order = further.at_random(&first.possible, 1 + pair);
        for condition in order.iter().take(2) {
            further.measure(condition)?;
        }
        right.push(further.search()?.is_right() == Some(true));
    }
    Ok(Rate::new(right))
}
