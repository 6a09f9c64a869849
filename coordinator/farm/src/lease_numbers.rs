//! The numbers of leases, which grow also over restarts.

/// The number of bits for leases of one epoch. More leases would run into the numbers of the next second.
const BITS: u32 = 25;

/// A generator of lease numbers.
#[derive(Debug)]
pub(super) struct LeaseNumbers {
    epoch: u64,
    given: u64,
}

impl LeaseNumbers {
    /// Makes the generator of a start of the coordinator (see the table `epochs`).
    pub(super) fn new(epoch: u64) -> Self {
        LeaseNumbers { epoch, given: 0 }
    }

    /// Returns the next number, which is larger than every earlier one.
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
