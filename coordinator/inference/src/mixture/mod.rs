//! Mixtures of multivariate t-densities, fitted to weighted points: the proposals of independent draws.
//!
//! A mixture is `q(x) = sum_k a_k t_5(x; m_k, C_k)`. The t-density has polynomial tails, so that the weight
//! target / q of a draw stays bounded where the target's tails are normal or lighter.
//!
//! # Layout
//! - `density`: [`Mixture`], its density and its draws. `component`: one t-density. `points`: weighted points.
//! - `fit`: expectation-maximisation. `size`: the number of components, by cross-validation.

mod component;
mod density;
mod fit;
mod points;
mod size;

pub(crate) use density::Mixture;
pub(crate) use points::WeightedPoints;
pub(crate) use size::fitted;
