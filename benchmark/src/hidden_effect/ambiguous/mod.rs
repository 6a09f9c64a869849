//! How many further runs tell what is missing, chosen by the search, at random, or to fill the space of conditions.
//!
//! # Layout
//! - `campaign`: an experiment that gets further runs. `strategy`: how they are chosen; `space`: the conditions that a rig can set.
//! - `story`: one campaign by one strategy.

pub mod campaign;
pub mod space;
pub mod story;
pub mod strategy;

use campaign::{Answer, Campaign};
use story::Story;
use strategy::{MAX_STRATEGY_RUNS, Strategy};

use crate::hidden_effect::study::error::StudyError;
use crate::hidden_effect::study::parallel::each;
use crate::hidden_effect::study::rate::{Rate, mean};

/// Pairs of runs that are tried at random where the two proposed ones leave the case open.
const PAIRS: u64 = 25;

/// The stories of one experiment, one by each strategy.
struct Case {
    stories: Vec<Story>,
    /// Of random pairs of runs, how many would have resolved it; `None` where the proposed pair did.
    pairs: Option<Rate>,
}

/// Draws so many experiments, and of those that the search leaves undecided prints how many runs each strategy needs.
pub fn run(count: u64, seed: u64) -> Result<(), StudyError> {
    let of_cases = each(count, |number| {
        let case = case(seed, number);
        if let Err(message) = &case {
            println!("failed: ambiguous {number}: {message}");
        }
        case
    })?;
    let of_cases: Vec<Option<Case>> = of_cases.into_iter().collect::<Result<_, StudyError>>()?;
    let open: Vec<Case> = of_cases.into_iter().flatten().collect();
    println!("open after the first runs: {} of {count}", open.len());
    for (place, strategy) in Strategy::ALL.into_iter().enumerate() {
        let stories: Vec<&Story> = open.iter().map(|case| &case.stories[place]).collect();
        println!("{}", strategy.name());
        for runs in strategy.counts() {
            let right = stories
                .iter()
                .map(|s| s.right_after.is_some_and(|after| after <= runs));
            let goal = if strategy.is_proposed() && runs == 2 {
                " (goal .90)"
            } else {
                ""
            };
            println!("  resolved by {runs}: {}{goal}", Rate::new(right));
        }
        // A case that stays open is counted as if one more run resolved it.
        let needed: Vec<f64> = stories
            .iter()
            .map(|s| s.right_after.unwrap_or(MAX_STRATEGY_RUNS + 1) as f64)
            .collect();
        let [average, error] = mean(&needed);
        if strategy != Strategy::Batch {
            println!(
                "  runs needed, at most {}: {average:.2} ± {error:.2}",
                MAX_STRATEGY_RUNS + 1
            );
        }
        println!(
            "  wrongly named: {} (goal 0)",
            Rate::new(stories.iter().map(|s| s.is_wrong))
        );
    }
    let tried: Vec<Rate> = open.iter().filter_map(|case| case.pairs).collect();
    let possible = tried.iter().map(|rate| rate.count > 0);
    println!(
        "of those that two at once leave open, some of {PAIRS} random pairs resolves {}",
        Rate::new(possible)
    );
    let all = tried.iter().fold(Rate { count: 0, of: 0 }, |sum, rate| Rate {
        count: sum.count + rate.count,
        of: sum.of + rate.of,
    });
    println!("  resolved by a random pair there: {all}");
    Ok(())
}

/// The case of a number; `None` where the first runs decide.
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

/// How often a random pair of runs has the truth's class named.
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
