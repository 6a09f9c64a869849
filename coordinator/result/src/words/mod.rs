//! Numbers and probabilities as people read them.

pub(crate) mod number;
pub(crate) mod probability;
