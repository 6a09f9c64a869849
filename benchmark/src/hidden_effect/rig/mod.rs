//! Rigs that are not as a model has them: whether the search claims physics that is not there.
//!
//! # Layout
//! - `flaw`: what is wrong with the rig. `campaign`: its measurements. `tally`: false claims.
//! - `untryable`: an effect acts that needs what the experiment does not state.

pub mod campaign;
pub mod flaw;
pub mod tally;
pub mod untryable;

use std::ops::Range;

use campaign::RigCampaign;
pub use flaw::Flaw;
use tally::{Tally, line};

use super::study::error::StudyError;
use super::study::parallel::each;
use super::study::record::record;

/// Most effects in a combination of the search.
const MAX_EFFECTS: usize = 3;

/// Draws so many campaigns in which nothing is missing but the rig has one of these flaws, and prints how often something is claimed.
pub fn run(flaws: &[Flaw], count: u64, seed: u64) -> Result<(), StudyError> {
    for &flaw in flaws {
        print!("{}", tally(flaw, 0..count, seed, flaw.statements())?);
    }
    Ok(())
}

/// The claims on campaigns of these numbers, with the flaw stated if it can be.
pub fn stated(flaw: Flaw, numbers: Range<u64>, seed: u64) -> Result<Tally, StudyError> {
    tally(flaw, numbers, seed, &flaw.statements()[..1])
}

fn tally(
    flaw: Flaw,
    numbers: Range<u64>,
    seed: u64,
    statements: &'static [bool],
) -> Result<Tally, StudyError> {
    let records = each(numbers.end - numbers.start, |place| {
        let number = numbers.start + place;
        let campaign = RigCampaign::new(flaw, seed, number)?;
        let mut records = Vec::new();
        for &is_stated in statements {
            let record = record(&campaign.job(), &campaign.experiment(is_stated), MAX_EFFECTS, 1)?;
            println!("{}", line(flaw, number, is_stated, &record));
            records.push(record);
        }
        Ok::<_, StudyError>(records)
    })?;
    let records: Result<Vec<_>, StudyError> = records.into_iter().collect();
    Ok(Tally::new(flaw, statements, &records?))
}
