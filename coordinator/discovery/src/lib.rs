//! Find the effect that a model is missing: compare it with itself plus one effect at a time, asked and told from outside.
//!
//! [`Engine`] never runs a model. It lists [`Request`]s of a round, each the base or the base with one candidate, and is told
//! their predicted values in any order:
//! 1. Base: the most probable parameters, from starts that fill the prior, by descent.
//! 2. Screen: each candidate once, at one standard deviation of its strength's prior, projected out of what the base absorbs.
//! 3. Extensions: each candidate fitted together with the base, by steps that teach their own derivatives.
//! 4. Polish: the best three again with derivatives taken afresh. Now the effect has a name.
//! 5. Confirmation: the best four from several starts; where two are close or at a bound, their evidence by draws.
//!
//! The evidence of a model is Laplace's, in coordinates in which every prior is a standard normal or, for a strength that has one
//! sign, its upper half: there the integral over the half is exact too.
//!
//! # Layout
//! - `candidate`: an effect and what is asked about it. `coordinate`: parameters as standard normal numbers.
//! - `descent`: a fit of one model. `fleet`: several side by side.
//! - `base`, `screen`, `extension`, `polish`, `confirm`, `importance`: one step each.
//! - `depth`: how deep a search goes. `chi_square`: how well a fit does. `noise`: sds that are inferred.
//! - `block`: the screen of a curve.
//! - `evidence`: the integral over a parabola. `classes`: effects that the data cannot tell apart. `finding`: what is said in the end.
//! - `settings`. `engine`: the state of a search; `rounds`: what each leads to; `verdict`: what is kept and what is said.

mod base;
mod block;
mod candidate;
mod chi_square;
mod classes;
mod confirm;
mod coordinate;
mod depth;
mod descent;
mod engine;
mod evidence;
mod extension;
mod finding;
mod fleet;
mod importance;
pub mod inquiry;
mod noise;
mod polish;
mod rounds;
mod screen;
mod settings;
mod verdict;

pub use candidate::{Candidate, CandidateError, Request};
pub use chi_square::ChiSquare;
pub use engine::Engine;
pub use finding::{Finding, Judged, Method, Spent};
pub use settings::{Settings, Starts};
