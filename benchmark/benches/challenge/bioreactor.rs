//! Campaigns of the bioreactor, and how often Monod's law is named.

use std::time::Instant;

use benchmark::challenge::bioreactor::{self, Campaign};
use benchmark::error::StudyError;
use benchmark::parallel::each;
use equation::FormulaLibrary;

fn transcript(seed: u64, campaign: &Campaign) {
    for (number, (feed, finding)) in campaign.steps.iter().enumerate() {
        let feed: Vec<String> = feed.iter().map(|q| format!("{q:.1}")).collect();
        println!(
            "seed {seed}, experiment {}: feed {} L/h",
            number + 1,
            feed.join(" ")
        );
        let knots = finding.law.knots.iter().zip(&finding.law.values);
        let knots: Vec<String> = knots
            .map(|(x, y)| format!("{y:.3} ± {:.3} at {x:.2} g/L", finding.law.curve.sd(*x)))
            .collect();
        println!("  growth rate [1/h]: {}", knots.join(", "));
        for (class, probability) in finding.classes.iter().enumerate().take(4) {
            if let Some(best) = finding.formulas.iter().find(|f| f.class == class) {
                let mark = if finding.is_true[class] { " (Monod)" } else { "" };
                println!(
                    "  P {probability:.3}{mark}: {}; yield {:.3}, maintenance {:.3} 1/h",
                    best.text,
                    libm::exp(best.parameters()[0]),
                    best.parameters()[1]
                );
            }
        }
    }
}

/// Prints how often the law is named.
pub(crate) fn run(seeds: u64, first: u64, is_shown: bool) -> Result<(), StudyError> {
    let library = FormulaLibrary::new(7, false);
    let begin = Instant::now();
    let campaigns = each(seeds, |k| {
        Ok::<_, StudyError>(bioreactor::campaign(first + k, &library))
    })?;
    let mut after = [0_usize; bioreactor::DESIGNED + 1];
    let (mut wrong, mut undecided) = (0, 0);
    for (k, campaign) in campaigns.iter().enumerate() {
        let campaign = campaign.as_ref().ok_or("a curve has no fit")?;
        if is_shown {
            transcript(first + k as u64, campaign);
        }
        match campaign.named() {
            Some((designed, true)) => after[designed] += 1,
            Some((_, false)) => wrong += 1,
            None => undecided += 1,
        }
    }
    println!(
        "Monod's class has P >= {} in {} of {seeds} (after 1, 2, 3 designed experiments: {:?}), another in {wrong}, none in {undecided}; {:.0} s",
        bioreactor::NAMED,
        after.iter().sum::<usize>(),
        &after[1..],
        begin.elapsed().as_secs_f64()
    );
    let claims = each(seeds, |k| {
        bioreactor::claim_beyond_the_truth(first + k).ok_or("a growth rate has no fit")
    })?;
    let claimed = claims
        .iter()
        .filter(|log_bayes_factor| bioreactor::is_claimed(**log_bayes_factor))
        .count();
    println!("with the growth rate given: a further law is claimed in {claimed} of {seeds}");
    Ok(())
}
