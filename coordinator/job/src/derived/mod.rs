//! The jobs that follow from a job: point estimates beside it, the search of its model, extensions of it.

pub(crate) mod discovery_job;
pub(crate) mod extended_job;
pub(crate) mod point_job;
