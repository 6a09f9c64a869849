//! Terramechanics: forces, torque and sinkage of a wheel that rolls, spins or skids on soil.
//!
//! # Layout
//! Constitutive laws, each usable for a single point of the contact:
//! - [`soil`]: the parameters of a soil, their bounds, and the sampled form of Bekker's moduli.
//! - [`pressure_sinkage`]: normal pressure from sinkage (Bekker).
//! - [`pressure_distribution`]: gamma, the weight that takes the pressure to zero at the border.
//! - [`footprint`]: the effective width `2 A / L` of a footprint.
//! - [`wong_reece`]: the peak of the pressure under a driven wheel, and its shear by displacement.
//! - [`shear`]: the Mohr–Coulomb limit and the share that a slip velocity or a displacement mobilises.
//!
//! Boundary of the crate:
//! - [`wheel`], [`condition`]: the rigid wheel and one run of the rig.
//! - [`averages`]: the result of a run.
//! - [`rejection`]: the reasons why a parameter vector has no solution.
//!
//! Between them and the models:
//! - [`effects`]: formulas and mechanisms that replace quantities of the base.
//!
//! Models:
//! - [`quasi_static`]: a smooth wheel in steady motion, integrated along the rim.
//! - [`spatial`]: a wheel with grousers, or any surface, that rolls over a terrain it deforms.
//! - [`rft`]: a wheel in granular soil by resistive force theory, without the laws above.
//! - [`outside`]: effects around a model that is not of this crate.
//! - [`bevameter`]: a plate pressed into the soil and a ring turned on it, by the same laws as the wheel.
//!
//! Numerics:
//! - [`elementary`], of the crate `formula`: `exp`, `ln` and powers that vectorise and give the same bits on every machine.
//! - `quadrature`: the Gauss rule of the rim.
//!
//! Everything is pure: no clock, no random numbers, no input or output. Units are SI. Results depend on
//! the arguments alone, bit for bit: only `+ - * /`, square roots, this crate's [`elementary`] functions
//! and the pure-Rust `libm` are used, and every sum has a fixed order.
//!
//! # Literature
//! - Bekker, M. G. 1969, *Introduction to Terrain-Vehicle Systems*, University of Michigan Press: pressure–sinkage.
//! - Janosi, Z. & Hanamoto, B. 1961, 1st International Conference on the Mechanics of Soil–Vehicle Systems, Turin: shear
//!   stress and displacement.
//! - Wong, J.-Y. & Reece, A. R. 1967, J. Terramechanics 4(1):81, <https://doi.org/10.1016/0022-4898(67)90105-X>: stresses
//!   along a driven rigid wheel.
//! - Krenn, R. & Hirzinger, G. 2008, ASTRA, Noordwijk; 2009, 11th European Regional Conference of the ISTVS, Bremen: the
//!   soil contact model (SCM).
//! - Ishigami, G. et al. 2007, J. Field Robotics 24(3), <https://doi.org/10.1002/rob.20187>: lateral forces and
//!   bulldozing.

pub mod averages;
pub mod bevameter;
pub mod condition;
pub mod effects;
#[cfg(test)]
mod fixture;
pub mod footprint;
pub mod outside;
pub mod pressure_distribution;
pub mod pressure_sinkage;
mod quadrature;
pub mod quasi_static;
pub mod rejection;
pub mod rft;
pub mod shear;
pub mod soil;
pub mod spatial;
pub mod wheel;
pub mod wong_reece;

pub use formula::elementary;

pub use averages::Averages;
pub use condition::Condition;
pub use effects::CompiledEffects;
pub use rejection::Rejection;
pub use soil::{Soil, bekker_moduli};
pub use wheel::Wheel;
pub use wong_reece::WongReece;

/// Identifies the equations and numerics; bumped when any number changes.
pub const MODEL_VERSION: &str = "scm-7";
