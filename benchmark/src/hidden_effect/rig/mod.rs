//! Rigs with a flaw, on which the search must not claim missing physics.
//!
//! # Layout
//! - `flaw`: the flaw of a rig. `campaign`: its measurements. `tally`: false claims.
//! - `untryable`: an effect acts that needs a property which the experiment does not state.

pub mod campaign;
pub mod flaw;
pub mod tally;
pub mod untryable;

use std::ops::Range;

use campaign::RigCampaign;
pub use flaw::Flaw;
use tally::{Tally, line};

use super::study::record::record;
use crate::error::StudyError;
use crate::parallel::each;

/// The largest number of effects in a combination of the search.
const MAX_EFFECTS: usize = 3;

/// Draws campaigns without a missing effect on rigs with each of these flaws, and prints how often an effect is claimed.
pub fn run(flaws: &[Flaw], count: u64, seed: u64) -> Result<(), StudyError> {
    for &flaw in flaws {
        print!("{}", tally(flaw, 0..count, seed, flaw.statements())?);
    }
    Ok(())
}

/// Returns the claims on campaigns of these numbers, whose experiments state the flaw if they can.
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
    Ok(Tally::new(flaw, statements, &records))
}
