//! The sampler of the model itself, when the emulator is given up.

use super::round::{EmulatedRound, Outputs};
use super::sampler::EmulatedSampler;
use crate::phase::RunPhase;
use crate::round::Proposal;
use crate::tell::InferenceFailure;
use crate::tmcmc::{Sampler, StageMethod, TmcmcSettings};

impl EmulatedSampler {
    /// Samples the model itself from here on.
    pub(super) fn give_up(&mut self) {
        self.record.fell_back = true;
        self.likelihood.clone_from(&self.stated);
        self.record.numerical_noise.clear();
        self.is_rough = false;
        self.emulated_stages.clear();
        let settings = TmcmcSettings {
            stages: StageMethod::Draws,
            ..self.settings
        };
        match Sampler::new(self.prior.clone(), settings) {
            Ok(sampler) => self.ask_fallback(Box::new(sampler)),
            // The settings were checked when this sampler was made.
            Err(_) => self.phase = RunPhase::Failed(InferenceFailure::AllImpossible { draws: 0 }),
        }
    }

    pub(super) fn continue_fallback(
        &mut self,
        mut sampler: Box<Sampler>,
        proposals: &[Proposal],
        outputs: &[Outputs],
    ) {
        let particles: Vec<usize> = sampler.round().pending().iter().map(|p| p.particle).collect();
        for ((particle, proposal), outputs) in particles.into_iter().zip(proposals).zip(outputs) {
            let value = self.score(outputs.as_deref(), &proposal.theta);
            // Every pending proposal is told once.
            let _ = sampler.tell(particle, value);
        }
        self.stages = sampler.stages().to_vec();
        if let Some(failure) = sampler.failure() {
            self.phase = RunPhase::Failed(failure);
        } else if let Some(posterior) = sampler.posterior() {
            let mut posterior = posterior.clone();
            posterior.evaluations = self.count.evaluations as u64;
            posterior.rejected = self.count.rejected as u64;
            self.phase = RunPhase::Done(Box::new(posterior));
        } else {
            self.ask_fallback(sampler);
        }
    }

    /// Asks for the pending evaluations of the sampler of the model itself.
    fn ask_fallback(&mut self, sampler: Box<Sampler>) {
        let pending = sampler.round().pending().iter();
        self.ask(pending.map(|proposal| proposal.theta.clone()).collect());
        self.phase = RunPhase::Waiting(EmulatedRound::Fallback(sampler));
    }
}
