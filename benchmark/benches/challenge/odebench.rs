//! The table of the terms that are removed from systems of ordinary differential equations.

use benchmark::challenge::odebench::{self, judgement::Said, system::OdeSystem, term_formula::TermLibrary};
use benchmark::error::StudyError;
use benchmark::parallel::each;
use benchmark::process::cpu_s;

/// What the search says of one system with a term removed, and of the whole one.
struct Judged {
    removed: usize,
    said: Said,
    said_of_whole: Said,
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

/// Prints the table.
pub(crate) fn run(seeds: u64, first: u64) -> Result<(), StudyError> {
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
