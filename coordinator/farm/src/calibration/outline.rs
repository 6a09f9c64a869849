//! The outline of an engine, which answers questions about it while a compute thread takes a step of it.

use shared::api::{Position, SearchProgress};

/// The progress of an engine at the end of a round.
#[derive(Debug, Clone)]
pub struct EngineOutline {
    /// The number of completed rounds.
    pub(super) round: u64,
    pub(super) position: Position,
    /// The tempering exponents of the finished stages.
    pub(super) exponents: Vec<f64>,
    pub(super) search: Option<SearchProgress>,
}
