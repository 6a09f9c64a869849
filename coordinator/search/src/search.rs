//! A search in progress: its queries as leases take them, and their answers.

use discovery::{DiscoverySearch, Smoothness};
use inference::{Proposal, TellProgress};
use shared::api::{SearchLeader, SearchProgress};
use shared::file::FileError;
use shared::model::ModelVariant;
use shared::outcome::Observables;

use super::answers::{Answer, Answers};
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
    /// The queries of the round that wait for the model.
    pending: Vec<Proposal>,
    /// `None` where an evaluation costs less than its answer's memory.
    answers: Option<Answers>,
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
        let task = models.task();
        let is_cheap = task.settings.smoothness == Smoothness::Smooth;
        let mut running = Self {
            search: DiscoverySearch::new(task)?,
            models,
            leases: Vec::new(),
            pending: Vec::new(),
            answers: (!is_cheap).then(Answers::default),
        };
        running.begin_round()?;
        Ok(running)
    }

    /// Begins rounds until one has a query without a known answer, or the search ends.
    fn begin_round(&mut self) -> Result<TellProgress, DiscoveryError> {
        loop {
            self.prepare()?;
            let (known, unknown) = self.known_and_unknown();
            self.pending = unknown;
            let mut progress = TellProgress::Waiting;
            for (index, values) in &known {
                progress = self.search.tell(*index, values.as_deref())?;
            }
            match progress {
                TellProgress::Waiting => return Ok(TellProgress::NextRound),
                TellProgress::NextRound => {}
                over => return Ok(over),
            }
        }
    }

    /// Returns the queries of the round whose answers are known, and of the others the first of each evaluation.
    fn known_and_unknown(&self) -> (Vec<(usize, Answer)>, Vec<Proposal>) {
        let Some(answers) = &self.answers else {
            return (Vec::new(), self.search.pending().to_vec());
        };
        let (mut known, mut unknown) = (Vec::new(), Vec::new());
        for (proposal, lease) in self.search.pending().iter().zip(&self.leases) {
            match answers.find(lease) {
                Some(values) => known.push((proposal.particle, values.clone())),
                None if self.leases[..proposal.particle].contains(lease) => {}
                None => unknown.push(proposal.clone()),
            }
        }
        (known, unknown)
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

    /// Returns the queries of this round that wait for the model.
    pub fn pending(&self) -> &[Proposal] {
        &self.pending
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
        let mut progress = self.search.tell(particle, values)?;
        if let (Some(answers), Some(lease)) = (&mut self.answers, self.leases.get(particle)) {
            answers.insert(lease, values);
            let queries = self.leases.iter().enumerate();
            for (twin, _) in queries.filter(|(index, other)| *index != particle && *other == lease) {
                progress = self.search.tell(twin, values)?;
            }
        }
        if progress == TellProgress::NextRound {
            return self.begin_round();
        }
        Ok(progress)
    }

    /// Returns the result; `None` while the search is running.
    pub fn record(&self) -> Option<Discovery> {
        let conclusion = self.search.conclusion()?;
        Some(discovery_record(&self.models, conclusion))
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::fixture::read;

    /// Runs rounds of a search whose model is a function of its parameters; returns the number of evaluations, and of those that were
    /// asked before.
    fn evaluated(kind: &str, rounds: u64) -> (usize, usize) {
        let (mut job, files, _) = read("examples/cmu-sand");
        let kind = format!("kind = \"{kind}\"");
        job.toml = job.toml.replacen("kind = \"quasi_static\"", &kind, 1);
        let mut search = RunningDiscovery::new(SearchModels::new(&job, &files, 2).unwrap()).unwrap();
        let values = search.models.task().likelihood.values();
        let mut evaluations = BTreeSet::new();
        let mut asked = 0;
        while search.round() < rounds && search.record().is_none() {
            for proposal in search.pending().to_vec() {
                let (hash, theta) = search.lease(proposal.particle).unwrap();
                let sum: f64 = theta.iter().sum();
                let predicted: Vec<f64> = (0..values).map(|i| libm::sin(sum + i as f64)).collect();
                let bits: Vec<u64> = theta.iter().map(|value| value.to_bits()).collect();
                evaluations.insert((hash.to_owned(), bits));
                asked += 1;
                search.tell(proposal.particle, Some(&predicted)).unwrap();
            }
        }
        (asked, asked - evaluations.len())
    }

    #[test]
    fn a_search_of_an_expensive_model_asks_for_no_evaluation_twice() {
        let (asked, repeated) = evaluated("scm", 60);
        assert!(asked > 300, "{asked}");
        assert_eq!(repeated, 0);
        // The same rounds of a cheap model repeat some.
        assert!(evaluated("quasi_static", 60).1 > 0);
    }
}
