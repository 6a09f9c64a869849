//! Challenges that others stated: missing laws of systems that have nothing to do with wheels.
//!
//! `cargo bench -p benchmark --bench challenge -- bioreactor [SEEDS [FIRST]] [--transcript]`
//! `cargo bench -p benchmark --bench challenge -- corrections [SEEDS [FIRST]]`
//! `cargo bench -p benchmark --bench challenge -- odebench [SEEDS [FIRST]]`

use std::process::ExitCode;
use std::time::Instant;

use benchmark::challenge::bioreactor::{self, Campaign};
use benchmark::challenge::correction::{self, Libraries, Search};
use benchmark::challenge::odebench::{self, judgement, system::OdeSystem, term_formula::TermLibrary};
use benchmark::challenge::scenario::SCENARIOS;
use benchmark::error::StudyError;
use benchmark::parallel::each;
use benchmark::process::cpu_s;
use equation::FormulaLibrary;

/// The largest number of nodes of a formula of a correction: two laws have eight.
const NODES: usize = 8;
/// Noise over the value.
const NOISES: [f64; 4] = [0.0, 0.01, 0.05, 0.1];

fn main() -> ExitCode {
    let all: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&String> = all.iter().filter(|a| !a.starts_with("--")).collect();
    let numbers: Result<Vec<u64>, _> = words.iter().skip(1).map(|word| word.parse()).collect();
    let Ok(numbers) = numbers else {
        eprintln!("error: SEEDS and FIRST are whole numbers");
        return ExitCode::FAILURE;
    };
    let seeds = |default: u64| numbers.first().copied().unwrap_or(default).max(1);
    let first = numbers.get(1).copied().unwrap_or(1);
    let result = match words.first().map(|word| word.as_str()) {
        Some("bioreactor") => bioreactors(seeds(50), first, all.iter().any(|a| a == "--transcript")),
        Some("corrections") => corrections(seeds(10), first),
        Some("odebench") => missing_terms(seeds(3), first),
        _ => Err("the first argument is bioreactor, corrections or odebench".into()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

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

fn bioreactors(seeds: u64, first: u64, is_shown: bool) -> Result<(), StudyError> {
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

/// Cases of corrections, and what their answers are.
#[derive(Default)]
struct Tally {
    cases: usize,
    in_class: usize,
    listed: usize,
    simplest: usize,
    credible: usize,
    certain: usize,
    decidable: usize,
    decidable_in_class: usize,
}

impl Tally {
    fn add(&mut self, said: &correction::Said) {
        self.cases += 1;
        self.in_class += usize::from(said.is_in_class);
        self.listed += usize::from(said.is_listed);
        self.simplest += usize::from(said.is_simplest);
        self.credible += usize::from(said.is_credible);
        self.certain += usize::from(said.probability > 0.9);
        self.decidable += usize::from(said.is_decidable);
        self.decidable_in_class += usize::from(said.is_decidable && said.is_in_class);
    }

    fn cells(&self) -> String {
        format!(
            "{}/{} | {} | {} | {} | {} | {}/{}",
            self.in_class,
            self.cases,
            self.listed,
            self.simplest,
            self.credible,
            self.certain,
            self.decidable_in_class,
            self.decidable
        )
    }
}

fn corrections(seeds: u64, first: u64) -> Result<(), StudyError> {
    let libraries = Libraries::new(NODES);
    println!(
        "| noise | correction | in the class | listed | simplest member | in the 95 % set | P > .9 | in the class, of decidable | classes of the set, members listed, median | the simplest, seed {first} |\n|---|---|---|---|---|---|---|---|---|---|"
    );
    for noise in NOISES {
        let mut all = Tally::default();
        for (number, scenario) in SCENARIOS.iter().enumerate() {
            let search = Search::new(scenario, &libraries);
            let said = each(seeds, |k| {
                search.said(noise, first + k, number as u64).ok_or("no curve")
            })?;
            let median = |count: &dyn Fn(&correction::Said) -> usize| {
                let mut counts: Vec<usize> = said.iter().map(count).collect();
                counts.sort_unstable();
                counts[counts.len() / 2]
            };
            let mut tally = Tally::default();
            said.iter().for_each(|said| tally.add(said));
            said.iter().for_each(|said| all.add(said));
            println!(
                "| {:.0} % | {} | {} | {}, {} | {} |",
                100.0 * noise,
                scenario.name,
                tally.cells(),
                median(&|said| said.credible),
                median(&|said| said.members),
                said[0].simplest
            );
        }
        println!("| {:.0} % | **all** | {} | | |", 100.0 * noise, all.cells());
    }
    Ok(())
}

/// What the search says of one system with a term removed, and of the whole one.
struct Judged {
    removed: usize,
    said: judgement::Said,
    said_of_whole: judgement::Said,
}

/// Counts over systems and seeds.
#[derive(Default)]
struct Tally {
    searches: usize,
    undecidable: usize,
    listed: usize,
    in_class: usize,
    best: usize,
    placed: usize,
    claimed: usize,
    false_claims: usize,
}

impl Tally {
    fn add(&mut self, judged: &Judged) {
        let said = &judged.said;
        self.searches += 1;
        self.false_claims += usize::from(judged.said_of_whole.is_claimed);
        if said.is_undecidable {
            self.undecidable += 1;
            return;
        }
        self.listed += usize::from(said.is_claimed && said.is_listed);
        self.in_class += usize::from(said.is_claimed && said.is_in_class);
        self.best += usize::from(said.is_claimed && said.is_best);
        self.placed += usize::from(said.is_claimed && said.is_placed);
        self.claimed += usize::from(said.is_claimed);
    }

    /// Returns the counts as cells: those after the number of undecidable searches are of the decidable ones.
    fn cells(&self) -> String {
        let decidable = self.searches - self.undecidable;
        format!(
            "{} | {}/{decidable} | {} | {} | {} | {} | {}/{}",
            self.undecidable,
            self.listed,
            self.in_class,
            self.best,
            self.placed,
            self.claimed,
            self.false_claims,
            self.searches
        )
    }
}

fn missing_terms(seeds: u64, first: u64) -> Result<(), StudyError> {
    let systems: Vec<&OdeSystem> = odebench::systems().collect();
    let libraries: Vec<TermLibrary> = (1..=4).map(TermLibrary::new).collect();
    let count = systems.len() as u64;
    let begin = cpu_s("self")?;
    let judged = each(seeds * count, |k| {
        let (system, seed) = (systems[(k % count) as usize], first + k / count);
        let library = &libraries[system.dimension() - 1];
        let removed = odebench::removed(system, seed).ok_or("a system has no term")?;
        let said = |removed| odebench::judgement::searched(system, removed, seed, library);
        Ok::<_, StudyError>(Judged {
            removed,
            said: said(Some(removed)).ok_or("a system has no answer")?,
            said_of_whole: said(None).ok_or("a system has no answer")?,
        })
    })?;
    let used = cpu_s("self")? - begin;
    println!(
        "| system | undecidable | in the class, of the decidable | unlisted too | as the best | right equation | claimed | false | removed, seed {first} | the best (P and listed members of the leading class), seed {first} |\n|---|---|---|---|---|---|---|---|---|---|"
    );
    let mut of_dimension: [Tally; 4] = Default::default();
    let mut all = Tally::default();
    for (number, system) in systems.iter().enumerate() {
        let mut of_system = Tally::default();
        for judged in judged.iter().skip(number).step_by(systems.len()) {
            for tally in [
                &mut of_system,
                &mut of_dimension[system.dimension() - 1],
                &mut all,
            ] {
                tally.add(judged);
            }
        }
        let Judged { removed, said, .. } = &judged[number];
        let term = &system.terms[*removed];
        println!(
            "| {} | {} | x{}': {} | {} (P {:.2}, {} listed) |",
            system.number,
            of_system.cells(),
            term.equation,
            term.text,
            said.text,
            said.probability,
            said.members
        );
    }
    for (index, tally) in of_dimension.iter().enumerate() {
        println!("| **{} states** | {} | | |", index + 1, tally.cells());
    }
    println!("| **all** | {} | | |", all.cells());
    println!(
        "{:.1} s of CPU time for each of {} searches",
        used / (2.0 * all.searches as f64),
        2 * all.searches
    );
    Ok(())
}
