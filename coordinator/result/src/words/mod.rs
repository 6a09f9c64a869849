//! Numbers, units and probabilities as people read them.

pub mod campaign;
pub mod data_channel;
pub mod number;
pub mod probability;
