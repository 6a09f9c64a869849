//! The response surface of a calibration: its model's outputs at the measured runs as polynomials of the parameters, over the posterior.
//!
//! It is fitted to the final draws, which the model has evaluated on every run, so that it costs no evaluation and exists for every stored
//! calibration with draws.
//!
//! # Layout
//! - `surface`: the answer of the REST interface. `parameter`: a parameter with its range. `output`: the surface of a run and channel.
//! - `channel_error`: the error of the surfaces of a channel.
//! - `draws`: the coordinates of the posterior, and the distinct draws of a run with their outputs.

mod channel_error;
mod draws;
mod output;
mod parameter;
mod surface;

pub use channel_error::SurfaceError;
pub use output::RunSurface;
pub use parameter::SurfaceParameter;
pub use surface::{MAX_BYTES, ResponseSurface};
