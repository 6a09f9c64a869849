//! Counts of the events and of their consequences.

use std::collections::BTreeMap;
use std::fmt::{Display, Formatter, Result};

/// Counts of one run of the chaos.
#[derive(Debug, Default)]
pub struct Tally {
    /// Events by fault.
    pub events: BTreeMap<&'static str, u64>,
    /// The number of studies whose outcome had the bits of an undisturbed study, by job.
    pub compared: BTreeMap<&'static str, u64>,
    /// The number of pauses by reason; each was resumed.
    pub pauses: BTreeMap<String, u64>,
    /// How often the coordinator ended because its disk was full.
    pub ends_on_full_disk: u64,
    /// The largest value of each quantity, by its unit and name.
    pub largest: BTreeMap<String, f64>,
}

impl Tally {
    /// Notes a value of a quantity.
    pub(super) fn note(&mut self, quantity: &str, value: f64) {
        let largest = self.largest.entry(quantity.to_owned()).or_default();
        *largest = value.max(*largest);
    }
}

impl Display for Tally {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        for (fault, number) in &self.events {
            writeln!(f, "{number:7}  {fault}")?;
        }
        let ends = self.ends_on_full_disk;
        writeln!(f, "{ends:7}  times the coordinator ended on a full disk")?;
        for (job, number) in &self.compared {
            writeln!(f, "{number:7}  studies {job} finished, compared and deleted")?;
        }
        writeln!(f, "{:7}  pauses", self.pauses.values().sum::<u64>())?;
        for (reason, number) in &self.pauses {
            writeln!(f, "{number:7}    {reason}")?;
        }
        for (quantity, value) in &self.largest {
            writeln!(f, "{value:7.1}  {quantity}")?;
        }
        Ok(())
    }
}
