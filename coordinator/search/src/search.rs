//! A search in progress: its queries as leases take them, and their answers.

use discovery::DiscoverySearch;
use inference::{Proposal, TellProgress};
use shared::api::{SearchLeader, SearchProgress};
use shared::file::FileError;
use shared::model::ModelVariant;
use shared::outcome::Observables;

use super::discovery_record::discovery_record;
use super::models::SearchModels;
use record::Discovery;

/// A search in progress.
#[derive(Debug)]
pub struct RunningDiscovery {
    models: SearchModels,
    search: DiscoverySearch,
    /// Of each query of the round: the hash of its variant, and the parameters in the variant's order.
    leases: Vec<(String, Vec<f64>)>,
}

/// The error with which a search cannot begin or continue.
#[derive(Debug, thiserror::Error)]
pub enum DiscoveryError {
    /// A model cannot be made.
    #[error(transparent)]
    File(#[from] FileError),
    /// A candidate is malformed.
    #[error(transparent)]
    Candidate(#[from] discovery::CandidateError),
    /// A result does not fit its query.
    #[error(transparent)]
    Tell(#[from] inference::TellError),
}

impl RunningDiscovery {
    /// Begins a search; its first round is pending.
    ///
    /// # Errors
    /// [`DiscoveryError`].
    pub fn new(models: SearchModels) -> Result<Self, DiscoveryError> {
        let mut running = Self {
            search: DiscoverySearch::new(models.task())?,
            models,
            leases: Vec::new(),
        };
        running.prepare()?;
        Ok(running)
    }

    /// Makes the variants of the round, and its leases.
    fn prepare(&mut self) -> Result<(), FileError> {
        let queries = || (0..self.search.pending().len()).filter_map(|index| self.search.query(index));
        self.models.make(queries())?;
        let lease = |query| {
            let (hash, variant) = self.models.made(query)?;
            Some((hash.clone(), self.models.model_theta(query, variant)))
        };
        self.leases = queries().filter_map(lease).collect();
        Ok(())
    }

    /// Returns the number of completed rounds.
    pub fn round(&self) -> u64 {
        self.search.round()
    }

    /// Returns what the search is doing, and the most probable explanations so far.
    pub fn progress(&self) -> SearchProgress {
        let leader = |leader: discovery::Leader| SearchLeader {
            effects: leader.effects.iter().map(|&k| self.models.name(k)).collect(),
            probability: leader.probability,
        };
        SearchProgress {
            doing: self.search.doing().to_owned(),
            leaders: self.search.leaders().into_iter().map(leader).collect(),
        }
    }

    /// Returns the queries of this round.
    pub fn pending(&self) -> &[Proposal] {
        self.search.pending()
    }

    /// Returns the hash of a query's variant, and its parameters.
    pub fn lease(&self, particle: usize) -> Option<(&str, &[f64])> {
        let (hash, theta) = self.leases.get(particle)?;
        Some((hash, theta))
    }

    /// Returns the variant of a hash.
    pub fn variant(&self, hash: &str) -> Option<&ModelVariant> {
        self.models.of_hash(hash)
    }

    /// Returns the values that answer a query of this round.
    pub fn values(&self, particle: usize, observables: &Observables) -> Option<Vec<f64>> {
        let query = self.search.query(particle)?;
        Some(self.models.values(query, observables))
    }

    /// Takes the values that answer a query; `None` where the model rejected the parameters.
    ///
    /// # Errors
    /// [`DiscoveryError`].
    pub fn tell(&mut self, particle: usize, values: Option<&[f64]>) -> Result<TellProgress, DiscoveryError> {
        let progress = self.search.tell(particle, values)?;
        if progress == TellProgress::NextRound {
            self.prepare()?;
        }
        Ok(progress)
    }

    /// Returns the result; `None` while the search is running.
    pub fn record(&self) -> Option<Discovery> {
        let conclusion = self.search.conclusion()?;
        Some(discovery_record(&self.models, conclusion))
    }
}
