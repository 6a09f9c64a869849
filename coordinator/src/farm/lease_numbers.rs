//! The numbers of leases: they grow over restarts, and no two stores give out the same.
//!
//! A worker keeps what the coordinator has not acknowledged and sends it again to whoever answers at the same
//! address. That may be the coordinator of another store, whose calibrations have the same small ids; so a
//! result counts only under a number that this store gave out.

use std::collections::BTreeSet;

/// Leases of one epoch before its numbers run into those of the next second.
const BITS: u32 = 25;

/// Gives out lease numbers and knows them again.
#[derive(Debug)]
pub(super) struct LeaseNumbers {
    past: BTreeSet<u64>,
    epoch: u64,
    given: u64,
}

impl LeaseNumbers {
    /// The numbers of a store whose starts, this one included, have these epochs (see the table `epochs`).
    pub(super) fn new(epochs: impl IntoIterator<Item = u64>) -> Self {
        let mut past: BTreeSet<u64> = epochs.into_iter().collect();
        let epoch = past.pop_last().unwrap_or_default();
        LeaseNumbers {
            past,
            epoch,
            given: 0,
        }
    }

    /// The next number: larger than every one before.
    pub(super) fn next_number(&mut self) -> u64 {
        self.given += 1;
        (self.epoch << BITS) + self.given
    }

    /// Whether this store gave out a number, now or before a restart.
    pub(super) fn is_ours(&self, number: u64) -> bool {
        let first = self.epoch << BITS;
        (number > first && number - first <= self.given) || self.past.contains(&(number >> BITS))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_grow_over_restarts_and_are_known_again() {
        let mut before = LeaseNumbers::new([700]);
        let old = [before.next_number(), before.next_number()];
        let mut after = LeaseNumbers::new([700, 701]);
        let new = after.next_number();
        assert!(old[0] < old[1] && old[1] < new);
        assert!(after.is_ours(old[1]) && after.is_ours(new));
        assert!(!after.is_ours(new + 1), "not given out yet");
        assert!(!LeaseNumbers::new([702]).is_ours(new), "another store's");
    }
}
