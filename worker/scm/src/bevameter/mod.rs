//! The bevameter: a plate pressed into the soil, and a ring turned on it.
//!
//! # Layout
//! - [`plate`]: pressure and load of a plate during loading, unloading and reloading.
//! - [`ring`]: shear stress under a ring, and its conversion from torque and angle.
//!
//! Both use the laws of the wheel ([`pressure_sinkage`](crate::pressure_sinkage), [`shear`](crate::shear)), so one
//! parameter vector describes wheel and bevameter alike.

pub mod plate;
pub mod ring;

pub use plate::{Plate, Unloading};
pub use ring::Ring;
