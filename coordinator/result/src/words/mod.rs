//! Numbers, units and probabilities as people read them.

pub(crate) mod campaign;
pub(crate) mod data_channel;
pub mod number;
pub(crate) mod probability;
