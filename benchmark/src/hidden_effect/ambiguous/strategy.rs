//! The choice of further runs.

use std::ops::RangeInclusive;

use shared::model::RunCondition;

use super::campaign::{Answer, Campaign};
use super::space::Space;

/// The largest number of further runs.
pub const MAX_STRATEGY_RUNS: usize = 4;

/// A strategy to choose further runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strategy {
    /// The first proposed run is made before the next search.
    Proposed,
    /// The first two proposed runs are made before the next search.
    Batch,
    /// A random run of the same grid is made.
    Random,
    /// The run of the same grid that is farthest from all earlier runs is made.
    SpaceFilling,
}

impl Strategy {
    pub const ALL: [Self; 4] = [Self::Proposed, Self::Batch, Self::Random, Self::SpaceFilling];

    pub fn name(self) -> &'static str {
        match self {
            Self::Proposed => "proposed, one at a time",
            Self::Batch => "proposed, two at once",
            Self::Random => "random",
            Self::SpaceFilling => "space-filling",
        }
    }

    pub fn is_proposed(self) -> bool {
        matches!(self, Self::Proposed | Self::Batch)
    }

    /// Returns the number of runs that are made before each search.
    pub fn at_once(self) -> usize {
        if self == Self::Batch { 2 } else { 1 }
    }

    /// Returns the numbers of runs after which a search is made.
    pub fn counts(self) -> RangeInclusive<usize> {
        if self == Self::Batch {
            2..=2
        } else {
            1..=MAX_STRATEGY_RUNS
        }
    }

    /// Returns the runs to make, the next one first.
    ///
    /// # Arguments
    /// - `possible`: the runs among which the first search could choose. `answer`: the conclusion of the last search.
    pub fn order(self, campaign: &Campaign, possible: &[RunCondition], answer: &Answer) -> Vec<RunCondition> {
        match self {
            Self::Proposed | Self::Batch => answer.proposed(),
            Self::Random => campaign.at_random(possible, 0),
            Self::SpaceFilling => {
                let order = Space::new(possible).filling(campaign.made());
                order.into_iter().map(|k| possible[k].clone()).collect()
            }
        }
    }
}
