//! The numbers of leases: they grow, over restarts too.

/// Leases of one epoch before its numbers run into those of the next second.
const BITS: u32 = 25;

/// Gives out lease numbers.
#[derive(Debug)]
pub(super) struct LeaseNumbers {
    epoch: u64,
    given: u64,
}

impl LeaseNumbers {
    /// The numbers of a start of the coordinator (see the table `epochs`).
    pub(super) fn new(epoch: u64) -> Self {
        LeaseNumbers { epoch, given: 0 }
    }

    /// The next number: larger than every one before.
    pub(super) fn next_number(&mut self) -> u64 {
        self.given += 1;
        (self.epoch << BITS) + self.given
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_grow_over_restarts() {
        let mut before = LeaseNumbers::new(700);
        let old = [before.next_number(), before.next_number()];
        let new = LeaseNumbers::new(701).next_number();
        assert!(old[0] < old[1] && old[1] < new);
    }
}
