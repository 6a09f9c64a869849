//! Response surfaces: polynomials of the model's outputs in whitened parameters, fitted to draws with their outputs.
//!
//! A posterior is narrow compared with its prior, so that a polynomial of degree 2 describes the outputs over it. The draws of a posterior
//! are correlated; in whitened coordinates the columns of the least-squares problem are nearly orthogonal, and the distance from the
//! origin tells whether a point lies among the draws.
//!
//! # Layout
//! - `whitening`: the coordinates. `degree`: the terms of the polynomial, and how many draws they need.
//! - `design`: the least-squares problem of a set of points, which many outputs share. `error`: reasons why there is no surface.

mod degree;
mod design;
mod error;
mod whitening;

pub use degree::Degree;
pub use design::{OutputSurface, SurfaceDesign};
pub use error::ResponseSurfaceError;
pub use whitening::Whitening;
