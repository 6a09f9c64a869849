//! Predict what a bevameter measures: a plate pressed into the soil, and a ring turned on it.
//!
//! # Layout
//! - [`plate`]: pressure and load of a plate, while it sinks and while it is lifted and pressed again.
//! - [`ring`]: shear stress under a ring, and what a torque and an angle of the ring mean.
//!
//! Both take the laws of the wheel ([`pressure_sinkage`](crate::pressure_sinkage), [`shear`](crate::shear)), so
//! one parameter vector speaks of wheel and bevameter alike.

pub mod plate;
pub mod ring;

pub use plate::{Plate, Unloading};
pub use ring::Ring;
