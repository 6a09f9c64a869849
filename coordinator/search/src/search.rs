//! A search in progress: its queries as leases take them, and their answers.

use std::collections::BTreeMap;

use discovery::{DiscoverySearch, Smoothness};
use inference::{Proposal, TellProgress};
use shared::api::{SearchLeader, SearchProgress};
use shared::file::FileError;
use shared::model::ModelVariant;
use shared::outcome::Observables;

use super::answers::{Answer, Answers, EvaluationKey};
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
    /// The queries of the round that ask for the same evaluation as a pending one.
    twins: BTreeMap<usize, Vec<usize>>,
    /// The answers of the model itself; `None` where an evaluation costs less than the memory of its answer.
    answers: Option<Answers>,
    /// Number of queries to the model itself that were answered without an evaluation of their own.
    spared: usize,
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
            twins: BTreeMap::new(),
            answers: (!is_cheap).then(Answers::default),
            spared: 0,
        };
        running.begin_round()?;
        Ok(running)
    }

    /// Begins rounds until one has a query without a known answer, or the search ends.
    fn begin_round(&mut self) -> Result<TellProgress, DiscoveryError> {
        loop {
            if let Some(request) = self.search.wanted_formulas().cloned() {
                let progress = self.search.offer_formulas(self.models.offer(&request))?;
                if !matches!(progress, TellProgress::NextRound) {
                    return Ok(self.ended(progress));
                }
            }
            self.prepare()?;
            let known = self.sort_queries();
            self.spared += known.len();
            let mut progress = TellProgress::Waiting;
            for (index, values) in &known {
                progress = self.search.tell(*index, values.as_deref())?;
            }
            match progress {
                TellProgress::Waiting => return Ok(TellProgress::NextRound),
                TellProgress::NextRound => {}
                over => return Ok(self.ended(over)),
            }
        }
    }

    /// Leaves no query pending.
    fn ended(&mut self, progress: TellProgress) -> TellProgress {
        self.pending.clear();
        self.leases.clear();
        progress
    }

    /// Returns the evaluation of a query, if its answer is remembered.
    fn remembered(&self, particle: usize) -> Option<EvaluationKey> {
        let (hash, theta) = self.leases.get(particle)?;
        let query = self.search.query(particle)?;
        (self.answers.is_some() && !query.is_low_fidelity).then(|| EvaluationKey::new(hash, theta))
    }

    /// Sorts the queries of the round: those whose answers are known, with these; of the others the first of each evaluation, which are
    /// pending, and its twins.
    fn sort_queries(&mut self) -> Vec<(usize, Answer)> {
        let mut known = Vec::new();
        let mut first: BTreeMap<EvaluationKey, usize> = BTreeMap::new();
        self.pending.clear();
        self.twins.clear();
        for proposal in self.search.pending() {
            let particle = proposal.particle;
            let evaluation = self.remembered(particle);
            let answer = self.answers.as_ref().zip(evaluation.as_ref());
            if let Some(values) = answer.and_then(|(answers, evaluation)| answers.find(evaluation)) {
                known.push((particle, values.clone()));
                continue;
            }
            match evaluation.map(|evaluation| *first.entry(evaluation).or_insert(particle)) {
                Some(first) if first != particle => self.twins.entry(first).or_default().push(particle),
                _ => self.pending.push(proposal.clone()),
            }
        }
        known
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
        let evaluation = self.remembered(particle);
        let progress = self.tell_twins(particle, values)?;
        if let (Some(answers), Some(evaluation)) = (&mut self.answers, evaluation) {
            answers.insert(evaluation, values);
        }
        self.proceed(progress)
    }

    /// Takes the place of an answer that no machine could give. It counts as a rejection in this round, and is asked for again in a
    /// later one.
    ///
    /// # Errors
    /// [`DiscoveryError`].
    pub fn give_up(&mut self, particle: usize) -> Result<TellProgress, DiscoveryError> {
        let progress = self.tell_twins(particle, None)?;
        self.proceed(progress)
    }

    /// Answers a query, and the others of the round that ask for the same evaluation.
    fn tell_twins(
        &mut self,
        particle: usize,
        values: Option<&[f64]>,
    ) -> Result<TellProgress, DiscoveryError> {
        let mut progress = self.search.tell(particle, values)?;
        for twin in self.twins.remove(&particle).unwrap_or_default() {
            self.spared += 1;
            progress = self.search.tell(twin, values)?;
        }
        Ok(progress)
    }

    /// Begins the next round where one is complete.
    fn proceed(&mut self, progress: TellProgress) -> Result<TellProgress, DiscoveryError> {
        match progress {
            TellProgress::NextRound => self.begin_round(),
            TellProgress::Finished | TellProgress::Failed(_) => Ok(self.ended(progress)),
            TellProgress::Waiting | TellProgress::StageFinished => Ok(progress),
        }
    }

    /// Returns the result; `None` while the search is running.
    pub fn record(&self) -> Option<Discovery> {
        let conclusion = self.search.conclusion()?;
        let evaluations = conclusion.evaluations - self.spared;
        Some(discovery_record(&self.models, conclusion, evaluations))
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
                let evaluation = EvaluationKey::new(hash, theta);
                let is_of_model = search
                    .search
                    .query(proposal.particle)
                    .is_some_and(|q| !q.is_low_fidelity);
                if is_of_model {
                    evaluations.insert(evaluation);
                    asked += 1;
                }
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
