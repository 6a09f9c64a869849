//! The missing-term version of `ODEBench`: from each of its 63 systems of ordinary differential equations a term is removed.
//!
//! The seed draws the term among all summands of the right-hand sides but a rate that is another state by definition. The data are both
//! trajectories of the whole system, 150 measurements of every state at equal distances of time, with normal noise of 1 % of the state's
//! root mean square; initial states and noise are given. The search is told the system without the term, and values of its parameters that
//! are 20 % too high or too low, as log-normal priors with an sd of 0.5. Whether a term is missing, in which equation, on which
//! states it depends and its formula are to be found. Claims in whole systems are false.
//!
//! Terms are products of up to three functions of a state, of 1 less a state, or of a sum, difference or linear combination of two, of at most
//! eight nodes and three constants. The functions were chosen so that every removable term is among the products: the challenge is to
//! find a term among thousands, and not to write one that no library has.
//! Every formula is screened in the weak form, where only the remaining parameters are linearised; the best are fitted in the weak form,
//! and the best of these through the equations of motion, where Laplace's approximation gives their evidence. A removed term that the data
//! do not show, because other parameters stand in for it, counts as undecidable: the log Bayes factor of the whole system over the one
//! without the term is then at most 3. Terms whose predictions differ by at most three nats from those of the most probable one are its
//! class; a member counts as listed if it has a tenth of the best's probability. A part of the bench is the test
//! `challenge::a_term_that_is_removed_from_a_system_is_in_the_class`.
//!
//! # Layout
//! - [`system`]: a system as a sum of terms. [`one_state`], [`two_states`], [`more_states`]: the systems.
//! - [`measured`]: both trajectories with noise. [`smoothing`]: a smooth curve through them.
//! - [`factor`], [`term_formula`]: the formulas of a term. [`hypothesis`]: a model with unknown parameters and a formula.
//! - [`weak_form`]: the equations of motion without derivatives. [`screening`]: the formulas that explain best what they leave.
//! - [`problem`]: the fit of a hypothesis to the weak form and through the equations of motion. [`search`]: the search of the term.
//!   [`answer`]: what it says. [`judgement`]: whether that is right.

pub mod answer;
pub mod factor;
pub mod hypothesis;
pub mod judgement;
pub mod measured;
pub mod more_states;
pub mod one_state;
pub mod problem;
pub mod screening;
pub mod search;
pub mod smoothing;
pub mod system;
pub mod term_formula;
pub mod two_states;
pub mod weak_form;

use statistics::rng::Stream;

use system::OdeSystem;

/// Returns the systems, by their numbers.
pub fn systems() -> impl Iterator<Item = &'static OdeSystem> {
    let first = one_state::SYSTEMS.iter().chain(&two_states::SYSTEMS);
    first.chain(&more_states::SYSTEMS)
}

/// Returns the index of the term that a seed removes from a system.
pub fn removed(system: &OdeSystem, seed: u64) -> Option<usize> {
    let removable = system.removable();
    let index = Stream::new(seed, 5, system.number as u64, 0).below(removable.len());
    removable.get(index).copied()
}
