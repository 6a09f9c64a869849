//! A search in progress: what it asks for as leases take it, and what it is told.

use discovery::inquiry::Inquiry;
use inference::{Proposal, TellProgress};
use shared::file::FileError;
use shared::model::ModelVariant;
use shared::outcome::Observables;

use super::models::Models;
use super::told::told;
use record::Discovery;

/// A search in progress.
#[derive(Debug)]
pub struct Investigation {
    models: Models,
    inquiry: Inquiry,
    /// Of each question of the round: the hash of its variant, and the parameters in the variant's order.
    leases: Vec<(String, Vec<f64>)>,
}

/// Why a search cannot begin or go on.
#[derive(Debug, thiserror::Error)]
pub enum InvestigationError {
    /// A model cannot be made.
    #[error(transparent)]
    File(#[from] FileError),
    /// A candidate cannot be looked for.
    #[error(transparent)]
    Candidate(#[from] discovery::CandidateError),
    /// A result does not fit.
    #[error(transparent)]
    Tell(#[from] inference::TellError),
}

impl Investigation {
    /// A search whose first round is pending.
    ///
    /// # Errors
    /// [`InvestigationError`].
    pub fn new(models: Models) -> Result<Self, InvestigationError> {
        let mut investigation = Self {
            inquiry: Inquiry::new(models.task())?,
            models,
            leases: Vec::new(),
        };
        investigation.prepare()?;
        Ok(investigation)
    }

    fn prepare(&mut self) -> Result<(), FileError> {
        self.leases.clear();
        for index in 0..self.inquiry.pending().len() {
            let Some(asked) = self.inquiry.asked(index) else {
                continue;
            };
            let (hash, variant) = self.models.variant(asked)?.clone();
            let theta = self.models.model_theta(asked, &variant);
            self.leases.push((hash, theta));
        }
        Ok(())
    }

    /// Number of completed rounds.
    pub fn round(&self) -> u64 {
        self.inquiry.round()
    }

    /// This round's questions.
    pub fn pending(&self) -> &[Proposal] {
        self.inquiry.pending()
    }

    /// What a question of this round is leased with: the hash of its variant, and the parameters.
    pub fn lease(&self, particle: usize) -> Option<(&str, &[f64])> {
        let (hash, theta) = self.leases.get(particle)?;
        Some((hash, theta))
    }

    /// The variant of a hash.
    pub fn variant(&self, hash: &str) -> Option<&ModelVariant> {
        self.models.of_hash(hash)
    }

    /// The values that answer a question of this round.
    pub fn values(&self, particle: usize, observables: &Observables) -> Option<Vec<f64>> {
        let asked = self.inquiry.asked(particle)?;
        Some(self.models.values(asked, observables))
    }

    /// Takes the values that answer a question; `None` where the model refused.
    ///
    /// # Errors
    /// [`InvestigationError`].
    pub fn tell(
        &mut self,
        particle: usize,
        values: Option<&[f64]>,
    ) -> Result<TellProgress, InvestigationError> {
        let progress = self.inquiry.tell(particle, values)?;
        if progress == TellProgress::NextRound {
            self.prepare()?;
        }
        Ok(progress)
    }

    /// What was found; `None` while the search goes on.
    pub fn record(&self) -> Option<Discovery> {
        self.inquiry.answer().map(|answer| told(&self.models, answer))
    }
}
