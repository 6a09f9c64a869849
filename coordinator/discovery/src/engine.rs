//! Hold the state of a search: list requests, take their predicted values, and say when it is over.

use crate::base;
use crate::candidate::{Candidate, CandidateError, Request};
use crate::coordinate::Frame;
use crate::depth::{Depth, WHOLE};
use crate::descent::Descent;
use crate::finding::{Finding, Method, Spent};
use crate::fleet::Fleet;
use crate::importance::Importance;
use crate::screen::Screened;
use crate::settings::{Settings, Starts};
use inference::{InferenceFailure, Proposal, ProposalRound, TellError, TellProgress};
use statistics::likelihood::Likelihood;
use statistics::prior::Marginal;

/// An ask/tell search for the missing effect.
///
/// Its state is a function of priors, likelihood, candidates, starts and the told values, whatever their order within a round.
#[derive(Debug, Clone)]
pub struct Engine {
    pub(crate) likelihood: Likelihood,
    pub(crate) candidates: Vec<Candidate>,
    /// Of the base, then of each candidate.
    pub(crate) base_frame: Frame,
    pub(crate) frames: Vec<Frame>,
    pub(crate) round: ProposalRound<Option<Vec<f64>>>,
    /// Whose each request of the round is, and where.
    pub(crate) asked: Vec<(Option<usize>, Vec<f64>)>,
    pub(crate) phase: Phase,
    pub(crate) seed: u64,
    pub(crate) depth: &'static Depth,
    pub(crate) base: Option<(Descent, f64)>,
    pub(crate) screened: Vec<Option<Screened>>,
    pub(crate) judgements: Vec<Option<Judgement>>,
    pub(crate) spent: Spent,
    /// Evaluations of each candidate.
    pub(crate) own: Vec<usize>,
}

/// What is known of a candidate so far.
#[derive(Debug, Clone)]
pub(crate) struct Judgement {
    pub(crate) log_bayes_factor: f64,
    pub(crate) method: Method,
    pub(crate) fitted: Option<Descent>,
}

#[derive(Debug, Clone)]
pub(crate) enum Phase {
    Starts,
    Base(Fleet),
    /// Which of the screen's strengths is tried.
    Screen(usize),
    Extensions(Fleet),
    Polish(Fleet),
    ConfirmStarts,
    Confirm(Fleet),
    /// The models that are drawn from, and how many draws each waits for.
    Sample(Vec<(Option<usize>, Importance)>, Vec<usize>),
    Done(Box<Finding>),
    Failed(InferenceFailure),
}

impl Engine {
    /// A search whose first round holds the starts of the base's fit.
    ///
    /// # Arguments
    /// - `prior`: of the base's parameters, independent; noise sds that are inferred among them. `likelihood`: the data.
    ///
    /// # Errors
    /// [`CandidateError`] names the candidate or the datum.
    pub fn new(
        prior: &[Marginal],
        likelihood: Likelihood,
        candidates: Vec<Candidate>,
        settings: &Settings,
    ) -> Result<Self, CandidateError> {
        if prior.is_empty() {
            return Err(CandidateError::NoBase);
        }
        candidates.iter().try_for_each(Candidate::check)?;
        let mut engine = Self::unasked(
            Frame::base(prior, settings.least_difference),
            likelihood,
            candidates,
            settings.seed,
        );
        let positions = match &settings.starts {
            Starts::Draws(draws) => draws
                .iter()
                .map(|theta| engine.base_frame.position(theta))
                .collect(),
            Starts::Even(count) => base::starts(&engine.base_frame, *count),
        };
        engine.ask(positions.into_iter().map(|position| (None, position)).collect());
        Ok(engine)
    }

    /// A quick search beyond a model that is fitted already: the most promising of the screen are fitted and polished, nothing is
    /// confirmed. Without candidates it is done at once.
    pub(crate) fn beyond(
        fitted: Descent,
        log_evidence: f64,
        likelihood: Likelihood,
        candidates: Vec<Candidate>,
        depth: &'static Depth,
        seed: u64,
    ) -> Self {
        let count = candidates.len();
        let mut engine = Self::unasked(fitted.frame.clone(), likelihood, candidates, seed);
        engine.depth = depth;
        engine.base = Some((fitted, log_evidence));
        engine.screen(0, (0..count).collect());
        engine
    }

    /// A fit of one model from one start; there is nothing to search for.
    pub(crate) fn refit(frame: Frame, start: Vec<f64>, likelihood: Likelihood, seed: u64) -> Self {
        let mut engine = Self::unasked(frame, likelihood, Vec::new(), seed);
        engine.ask(vec![(None, start)]);
        engine
    }

    fn unasked(base_frame: Frame, likelihood: Likelihood, candidates: Vec<Candidate>, seed: u64) -> Self {
        let count = candidates.len();
        Self {
            likelihood,
            frames: candidates.iter().map(|c| base_frame.with(c)).collect(),
            candidates,
            base_frame,
            round: ProposalRound::default(),
            asked: Vec::new(),
            phase: Phase::Starts,
            seed,
            depth: &WHOLE,
            base: None,
            screened: vec![None; count],
            judgements: vec![None; count],
            spent: Spent::default(),
            own: vec![0; count],
        }
    }

    /// The fit of the base and its log-evidence, once there is one.
    pub(crate) fn base_fit(&self) -> Option<(&Descent, f64)> {
        self.base.as_ref().map(|(descent, evidence)| (descent, *evidence))
    }

    /// The best fit of a candidate so far.
    pub(crate) fn fit_of(&self, candidate: usize) -> Option<&Descent> {
        self.judgements[candidate].as_ref()?.fitted.as_ref()
    }

    /// What is asked of the model in this round; its position here is its index.
    pub fn pending(&self) -> impl Iterator<Item = Request> {
        let pairs = self.asked.iter().zip(self.round.pending());
        pairs.map(|((candidate, _), proposal)| Request {
            candidate: *candidate,
            theta: proposal.theta.clone(),
        })
    }

    /// Takes the predicted values of a request; the last one of a round advances the search.
    ///
    /// # Arguments
    /// - `values`: as [`Likelihood::log_likelihood`] takes them; `None` where the model refused.
    ///
    /// # Errors
    /// [`TellError`]: told before, never asked for, not as many finite values as the likelihood takes. Nothing is changed then.
    pub fn tell(&mut self, index: usize, values: Option<&[f64]>) -> Result<TellProgress, TellError> {
        if let Some(values) = values {
            let (expected, given) = (self.likelihood.values(), values.len());
            if expected != given {
                return Err(TellError::Length { expected, given });
            }
            self.likelihood.check_values(values)?;
        }
        let complete = self.round.tell(index, values.map(<[f64]>::to_vec))?;
        if complete {
            let (_, answers) = self.round.complete();
            self.advance(answers);
        }
        Ok(match &self.phase {
            Phase::Done(_) => TellProgress::Finished,
            Phase::Failed(failure) => TellProgress::Failed(*failure),
            _ if complete => TellProgress::NextRound,
            _ => TellProgress::Waiting,
        })
    }

    /// Why the search failed, if it did.
    #[must_use]
    pub fn failure(&self) -> Option<InferenceFailure> {
        match self.phase {
            Phase::Failed(failure) => Some(failure),
            _ => None,
        }
    }

    /// What was found; `None` while the search goes on, and where it failed.
    #[must_use]
    pub fn finding(&self) -> Option<&Finding> {
        match &self.phase {
            Phase::Done(finding) => Some(finding),
            _ => None,
        }
    }

    pub(crate) fn frame(&self, candidate: Option<usize>) -> &Frame {
        candidate.map_or(&self.base_frame, |k| &self.frames[k])
    }

    pub(crate) fn ask(&mut self, asked: Vec<(Option<usize>, Vec<f64>)>) {
        for candidate in asked.iter().filter_map(|(candidate, _)| *candidate) {
            self.own[candidate] += 1;
        }
        let proposals = asked.iter().enumerate().map(|(index, (candidate, position))| {
            Proposal::plain(index, self.frame(*candidate).theta(position))
        });
        let proposals = proposals.collect();
        self.round.ask(proposals);
        self.asked = asked;
    }
}
