//! The genetic algorithm.
//!
//! Individuals are real vectors, in units of the prior's width along every axis. The first generation is drawn from
//! the prior. From then on the best stay (elitism), and the others are children: parents are picked by tournaments,
//! crossed (simulated binary crossover) and mutated (normal steps of many lengths). Children beyond a bound are put on
//! it. The evolution ends after a number of generations, or when many passed without an improvement.
//!
//! # Layout
//! - `settings`: population, generations. `population`: who survives and who has children. `mating`: the children of a pair.
//!
//! # Source
//! Deb & Agrawal 1995, Complex Systems 9:115 (crossover); Eiben & Smith 2015, Introduction to Evolutionary Computing.

mod mating;
mod population;
mod settings;

pub(crate) use population::Population;
pub use settings::GaSettings;
