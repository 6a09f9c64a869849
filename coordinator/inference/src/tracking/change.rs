//! From the weights of the bank to changes with their times.

/// Number of blocks within which a later time is the same change: the block of a change has samples of both soils.
const SAME: usize = 2;

/// A change of the parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// Number of the first block after the change, from 1.
    pub block: usize,
    /// Number of the block at which it was found.
    pub found: usize,
    /// Probability of a change when it was found.
    pub probability: f64,
}

/// The changes so far.
#[derive(Debug, Clone, Default)]
pub(super) struct Changes {
    /// Hypotheses that are born later than this block say that the parameters have changed again.
    pub(super) since: usize,
    pub(super) found: Vec<Change>,
}

impl Changes {
    /// Notes a change if its probability exceeds a bound. A change that follows within two blocks corrects the time of the one before.
    ///
    /// # Arguments
    /// - `now`: number of the block. `born`: births of the hypotheses with their weights.
    pub(super) fn note(&mut self, now: usize, born: &[(usize, f64)], bound: f64) {
        let later = || born.iter().filter(|(born, _)| *born > self.since);
        let probability: f64 = later().map(|(_, weight)| weight).sum();
        let best = later().fold((0, 0.0), |best, &of| if of.1 > best.1 { of } else { best });
        if probability <= bound || best.0 == 0 {
            return;
        }
        match self.found.last_mut() {
            Some(last) if best.0 <= last.found + SAME => last.block = best.0,
            _ => self.found.push(Change {
                block: best.0,
                found: now,
                probability,
            }),
        }
        self.since = now;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_is_noted_once_and_its_time_is_corrected() {
        let mut changes = Changes::default();
        changes.note(5, &[(0, 0.5), (5, 0.5)], 0.95);
        assert!(changes.found.is_empty());
        changes.note(6, &[(0, 0.01), (5, 0.2), (6, 0.79)], 0.95);
        changes.note(7, &[(5, 0.2), (6, 0.8)], 0.95);
        assert_eq!(changes.found.len(), 1);
        assert_eq!((changes.found[0].block, changes.found[0].found), (6, 6));
        changes.note(8, &[(6, 0.01), (8, 0.99)], 0.95);
        assert_eq!((changes.found.len(), changes.found[0].block), (1, 8));
        changes.note(20, &[(8, 0.01), (19, 0.99)], 0.95);
        assert_eq!((changes.found.len(), changes.found[1].block), (2, 19));
    }
}
