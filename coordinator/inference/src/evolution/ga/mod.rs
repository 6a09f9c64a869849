//! Search the most probable parameters by a genetic algorithm.
//!
//! Individuals are real vectors, in units of the prior's width along every axis. The first generation is drawn from
//! the prior. From then on the best stay (elitism), and the others are children: parents are picked by tournaments,
//! crossed (simulated binary crossover) and mutated (normal steps of many lengths). Children that step over a bound
//! are put on it. The search ends after a number of generations, or when many passed without a better best.
//!
//! [`crate::evolution::Evolution`] asks for the individuals and is told their log-likelihoods.
//!
//! # Layout
//! - `settings`: population, generations. `population`: who survives and who has children. `mating`: one pair's.
//!
//! # Source
//! Deb & Agrawal 1995, Complex Systems 9:115 (crossover); Eiben & Smith 2015, Introduction to Evolutionary Computing.

mod mating;
mod population;
mod settings;

pub(crate) use population::Population;
pub use settings::GaSettings;
