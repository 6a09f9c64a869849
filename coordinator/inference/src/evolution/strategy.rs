//! The strategy of an evolution, a genetic algorithm or CMA-ES, with its state.

use super::cma_es::Restarts;
use super::ga::Population;
use super::next_generation::NextGeneration;
use super::settings::EvolutionSettings;
use crate::evolution::individual::Individual;
use crate::evolution::prior_space::PriorSpace;

/// A strategy with its state.
#[derive(Debug, Clone)]
pub(super) enum Strategy {
    Ga(Population),
    CmaEs(Box<Restarts>),
}

impl Strategy {
    pub(super) fn new(settings: EvolutionSettings, space: &PriorSpace) -> Self {
        match settings {
            EvolutionSettings::Ga(settings) => Self::Ga(Population::new(settings)),
            EvolutionSettings::CmaEs(settings) => Self::CmaEs(Box::new(Restarts::new(settings, space))),
        }
    }

    /// Returns the next generation, for as many evaluations as remain.
    pub(super) fn next(&mut self, space: &PriorSpace, remaining: usize) -> NextGeneration {
        match self {
            Self::Ga(population) => population.next(space),
            Self::CmaEs(restarts) => restarts.next(space, remaining),
        }
    }

    /// Takes an evaluated generation, in the order in which it was asked for.
    pub(super) fn accept(&mut self, generation: Vec<Individual>) {
        match self {
            Self::Ga(population) => population.accept(generation),
            Self::CmaEs(restarts) => restarts.accept(&generation),
        }
    }
}
