//! How further runs are chosen.

use std::ops::RangeInclusive;

use shared::model::RunCondition;

use super::campaign::{Answer, Campaign};
use super::space::Space;

/// Most further runs.
pub const MAX_STRATEGY_RUNS: usize = 4;

/// How further runs are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strategy {
    /// The first proposed run is made, then the search is asked again.
    Proposed,
    /// The two first proposed runs are made together.
    Batch,
    /// Any run of the same grid.
    Random,
    /// The run of the same grid that is farthest from all others.
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

    /// Runs that are made before each search.
    pub fn at_once(self) -> usize {
        if self == Self::Batch { 2 } else { 1 }
    }

    /// The numbers of runs after which a search is made.
    pub fn counts(self) -> RangeInclusive<usize> {
        if self == Self::Batch {
            2..=2
        } else {
            1..=MAX_STRATEGY_RUNS
        }
    }

    /// The runs to make, the next one first.
    ///
    /// # Arguments
    /// - `possible`: the runs among which the first search could choose. `answer`: what the last one says.
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
