//! What is known of an engine while a step of it is being taken on another thread.

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
