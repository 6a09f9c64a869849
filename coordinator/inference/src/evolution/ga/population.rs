//! The population of a genetic algorithm: the choice of survivors and of parents.

use super::mating::{MatingPair, children};
use super::settings::GaSettings;
use crate::evolution::individual::Individual;
use crate::evolution::next_generation::NextGeneration;
use crate::evolution::prior_space::PriorSpace;
use crate::point_estimate::StopReason;
use statistics::rng::Stream;

/// Individuals of a tournament; the best of them becomes a parent.
const TOURNAMENT: usize = 3;

/// The members that survive and have children, with the progress of the evolution.
#[derive(Debug, Clone)]
pub(crate) struct Population {
    settings: GaSettings,
    /// The best first; empty before the first generation.
    members: Vec<Individual>,
    generation: usize,
    /// The best log-posterior at the last improvement by more than the tolerance.
    mark: f64,
    /// Number of generations since that improvement.
    idle: usize,
}

impl Population {
    pub(crate) fn new(settings: GaSettings) -> Self {
        Self {
            settings,
            members: Vec::new(),
            generation: 0,
            mark: f64::NEG_INFINITY,
            idle: 0,
        }
    }

    /// Returns the positions of the next generation: prior draws as long as the model has accepted none, then children.
    pub(crate) fn next(&self, space: &PriorSpace) -> NextGeneration {
        let GaSettings {
            population,
            generations,
            elite,
            seed,
            ..
        } = self.settings;
        if self.generation > 0 && self.idle >= self.settings.patience {
            return NextGeneration::End(StopReason::Stagnation);
        }
        if self.generation >= generations {
            return NextGeneration::End(StopReason::Generations);
        }
        let stream = |k: usize| Stream::new(seed, self.generation as u64, k as u64, 0);
        if self.members.is_empty() {
            return NextGeneration::Ask((0..population).map(|k| space.draw(&mut stream(k))).collect());
        }
        let count = population - elite;
        let pairs = (0..count.div_ceil(2)).flat_map(|pair| {
            let mut stream = stream(pair);
            let [first, second] = [0, 1].map(|_| self.parent(&mut stream));
            let difference = [0, 1].map(|_| &*self.members[stream.below(self.members.len())].position);
            let pair = MatingPair {
                first: &first.position,
                second: &second.position,
                drift_pair: difference,
            };
            children(&pair, &mut stream)
        });
        NextGeneration::Ask(pairs.take(count).map(|child| space.inside(&child)).collect())
    }

    /// Returns the best of some drawn members.
    fn parent(&self, stream: &mut Stream) -> &Individual {
        let drawn = (0..TOURNAMENT).map(|_| stream.below(self.members.len())).min();
        &self.members[drawn.unwrap_or(0)]
    }

    /// Takes an evaluated generation; those that the model rejected are the worst.
    pub(crate) fn accept(&mut self, generation: Vec<Individual>) {
        self.members.truncate(self.settings.elite);
        self.members.extend(generation);
        // The sort is stable: among equals the elder stays first, then the one listed first.
        self.members.sort_by(Individual::rank);
        self.generation += 1;
        match self.members.first() {
            Some(best) if best.is_possible() => {
                if best.log_posterior() > self.mark + self.settings.tolerance {
                    self.mark = best.log_posterior();
                    self.idle = 0;
                } else {
                    self.idle += 1;
                }
            }
            _ => self.members.clear(),
        }
    }
}
