//! The table of the corrections of textbook laws.

use benchmark::challenge::correction::{Libraries, Said, Search};
use benchmark::challenge::scenario::SCENARIOS;
use benchmark::error::StudyError;
use benchmark::parallel::each;

/// The largest number of nodes of a formula of a correction: two laws have eight.
const NODES: usize = 8;
/// Noise over the value.
const NOISES: [f64; 4] = [0.0, 0.01, 0.05, 0.1];

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
    fn add(&mut self, said: &Said) {
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

/// Prints the table.
pub(crate) fn run(seeds: u64, first: u64) -> Result<(), StudyError> {
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
            let median = |count: &dyn Fn(&Said) -> usize| {
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
