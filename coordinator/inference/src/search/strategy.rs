//! Choose between the strategies.

use super::settings::Settings;
use crate::cma_es::Restarts;
use crate::ga::Population;
use crate::point::{Individual, Space, Stop};

/// What a strategy wants next.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Next {
    /// A generation at these positions, all within the bounds.
    Ask(Vec<Vec<f64>>),
    /// Nothing any more.
    End(Stop),
}

/// A strategy with its state.
#[derive(Debug, Clone)]
pub(super) enum Strategy {
    Ga(Population),
    CmaEs(Box<Restarts>),
}

impl Strategy {
    pub(super) fn new(settings: Settings, space: &Space) -> Self {
        match settings {
            Settings::Ga(settings) => Self::Ga(Population::new(settings)),
            Settings::CmaEs(settings) => Self::CmaEs(Box::new(Restarts::new(settings, space))),
        }
    }

    /// The next generation, for as many evaluations as remain.
    pub(super) fn next(&mut self, space: &Space, remaining: usize) -> Next {
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
