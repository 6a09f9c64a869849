//! The restarts of CMA-ES: a sequence of runs, each with twice the population of the last.

use super::run::{CmaEsRun, End};
use super::settings::CmaEsSettings;
use crate::evolution::individual::Individual;
use crate::evolution::next_generation::NextGeneration;
use crate::evolution::prior_space::PriorSpace;
use crate::point_estimate::StopReason;
use statistics::rng::Stream;

/// Stream of a restart's start; individuals never reach this number.
const START: u64 = u64::MAX;

/// The sequence of CMA-ES runs, each with twice the population of the last.
#[derive(Debug, Clone)]
pub(crate) struct Restarts {
    settings: CmaEsSettings,
    run: CmaEsRun,
    /// Restarts after runs that found a possible point.
    restarts: usize,
    /// Starts drawn from the prior.
    starts: u64,
    /// Generations asked for so far, over all runs.
    generation: u64,
    /// Best log-posterior of the earlier runs, and whether one of these runs converged there.
    earlier: (f64, bool),
}

impl Restarts {
    pub(crate) fn new(settings: CmaEsSettings, space: &PriorSpace) -> Self {
        let population = settings.first_population(space.dimension());
        Self {
            settings,
            run: CmaEsRun::new(&space.centre(), population),
            restarts: 0,
            starts: 0,
            generation: 0,
            earlier: (f64::NEG_INFINITY, false),
        }
    }

    /// Returns the positions of the next generation, for as many evaluations as remain.
    pub(crate) fn next(&mut self, space: &PriorSpace, remaining: usize) -> NextGeneration {
        let mut population = self.run.population();
        if self.run.end.is_some() {
            // A run that found no possible point does not count: another start replaces it.
            let is_possible = self.run.best > f64::NEG_INFINITY;
            population *= if is_possible { 2 } else { 1 };
            if (is_possible && self.restarts == self.settings.restarts) || population > remaining {
                return NextGeneration::End(self.stop());
            }
            self.restarts += usize::from(is_possible);
            self.earlier = self.best();
            self.starts += 1;
            let mut stream = Stream::new(self.settings.seed, self.starts, START, 1);
            self.run = CmaEsRun::new(&space.draw(&mut stream), population);
        }
        if population > remaining {
            return NextGeneration::End(self.stop());
        }
        let positions = self.run.draw(space, self.settings.seed, self.generation);
        self.generation += 1;
        NextGeneration::Ask(positions)
    }

    pub(crate) fn accept(&mut self, generation: &[Individual]) {
        self.run.accept(generation, self.settings.tolerance);
    }

    /// Returns the best so far, and whether a run converged there.
    fn best(&self) -> (f64, bool) {
        let (best, converged) = self.earlier;
        let now = self.run.end == Some(End::Converged);
        let tolerance = self.settings.tolerance;
        if self.run.best > best + tolerance {
            (self.run.best, now)
        } else {
            let same = self.run.best > best - tolerance;
            (best.max(self.run.best), converged || (same && now))
        }
    }

    fn stop(&self) -> StopReason {
        if self.best().1 {
            StopReason::Stagnation
        } else {
            StopReason::Budget
        }
    }
}
