//! Run the rounds: base, screen, extensions, polish, confirmation.

use super::candidate::{Candidate, CandidateError, Request};
use super::classes::classes;
use super::coordinate::Frame;
use super::descent::{Descent, Point};
use super::finding::{Finding, Judged, Method, Spent};
use super::fleet::Fleet;
use super::screen::{Absorbed, STRENGTHS, Screened};
use super::{base, confirm, extension, polish, screen};
use crate::likelihood::{Likelihood, Sd};
use crate::prior::Marginal;
use crate::round::{Failure, Progress, Proposal, Round, TellError};

/// A change of the predictions shorter than this many standard deviations, after projection, cannot be seen (PHYSICS 4.1).
const LEAST_SEEN: f64 = 2.0;

/// Where the fit of the base begins.
#[derive(Debug, Clone, PartialEq)]
pub enum Starts {
    /// At the best of these parameter vectors, say draws of a posterior.
    Draws(Vec<Vec<f64>>),
    /// At the best of so many that fill the prior evenly.
    Even(usize),
}

/// An ask/tell search for the missing effect.
///
/// Its state is a function of priors, likelihood, candidates, starts and the told values, whatever their order within a round.
#[derive(Debug, Clone)]
pub struct Engine {
    likelihood: Likelihood,
    candidates: Vec<Candidate>,
    /// Of the base, then of each candidate.
    base_frame: Frame,
    frames: Vec<Frame>,
    round: Round<Option<Vec<f64>>>,
    /// Whose each request of the round is, and where.
    asked: Vec<(Option<usize>, Vec<f64>)>,
    phase: Phase,
    base: Option<(Descent, f64)>,
    screened: Vec<Option<Screened>>,
    judgements: Vec<Option<Judgement>>,
    spent: Spent,
    /// Evaluations of each candidate.
    own: Vec<usize>,
}

/// What is known of a candidate so far.
#[derive(Debug, Clone)]
struct Judgement {
    log_bayes_factor: f64,
    method: Method,
    fitted: Option<Descent>,
}

#[derive(Debug, Clone)]
enum Phase {
    Starts,
    Base(Fleet),
    /// Which of the screen's strengths is tried.
    Screen(usize),
    Extensions(Fleet),
    Polish(Fleet),
    ConfirmStarts,
    Confirm(Fleet),
    Done(Box<Finding>),
    Failed(Failure),
}

impl Engine {
    /// A search whose first round holds the starts of the base's fit.
    ///
    /// # Arguments
    /// - `prior`: of the base's parameters, independent. `likelihood`: the data, their noise known.
    ///
    /// # Errors
    /// [`CandidateError`] names the candidate or the datum.
    pub fn new(
        prior: &[Marginal],
        likelihood: Likelihood,
        candidates: Vec<Candidate>,
        starts: &Starts,
    ) -> Result<Self, CandidateError> {
        if prior.is_empty() {
            return Err(CandidateError::NoBase);
        }
        let is_inferred = |sd: Sd| matches!(sd, Sd::Inferred { .. });
        if let Some(datum) = likelihood.data().iter().position(|d| is_inferred(d.sd)) {
            return Err(CandidateError::InferredNoise { datum });
        }
        candidates.iter().try_for_each(Candidate::check)?;
        let base_frame = Frame::base(prior);
        let frames: Vec<Frame> = candidates.iter().map(|c| base_frame.with(c)).collect();
        let positions = match starts {
            Starts::Draws(draws) => draws.iter().map(|theta| base_frame.position(theta)).collect(),
            Starts::Even(count) => base::starts(&base_frame, *count),
        };
        let count = candidates.len();
        let mut engine = Self {
            likelihood,
            candidates,
            base_frame,
            frames,
            round: Round::default(),
            asked: Vec::new(),
            phase: Phase::Starts,
            base: None,
            screened: vec![None; count],
            judgements: vec![None; count],
            spent: Spent::default(),
            own: vec![0; count],
        };
        engine.ask(positions.into_iter().map(|position| (None, position)).collect());
        Ok(engine)
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
    pub fn tell(&mut self, index: usize, values: Option<&[f64]>) -> Result<Progress, TellError> {
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
            Phase::Done(_) => Progress::Finished,
            Phase::Failed(failure) => Progress::Failed(*failure),
            _ if complete => Progress::NextRound,
            _ => Progress::Waiting,
        })
    }

    /// What was found; `None` while the search goes on, and where it failed.
    #[must_use]
    pub fn finding(&self) -> Option<&Finding> {
        match &self.phase {
            Phase::Done(finding) => Some(finding),
            _ => None,
        }
    }

    fn frame(&self, candidate: Option<usize>) -> &Frame {
        candidate.map_or(&self.base_frame, |k| &self.frames[k])
    }

    fn ask(&mut self, asked: Vec<(Option<usize>, Vec<f64>)>) {
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

    /// Asks what the descents want; gives them back when they want nothing more.
    fn go_on(&mut self, mut fleet: Fleet, phase: fn(Fleet) -> Phase) -> Option<Fleet> {
        let asked = fleet.ask(&self.likelihood);
        if asked.is_empty() {
            return Some(fleet);
        }
        self.ask(asked);
        self.phase = phase(fleet);
        None
    }

    fn advance(&mut self, answers: Vec<Option<Vec<f64>>>) {
        match std::mem::replace(&mut self.phase, Phase::Starts) {
            Phase::Starts => self.after_starts(answers),
            Phase::Base(mut fleet) => {
                fleet.tell(&self.likelihood, answers);
                self.fit_base(fleet);
            }
            Phase::Screen(level) => self.after_screen(level, answers),
            Phase::Extensions(mut fleet) => {
                fleet.tell(&self.likelihood, answers);
                self.fit_extensions(fleet);
            }
            Phase::Polish(mut fleet) => {
                fleet.tell(&self.likelihood, answers);
                self.polish(fleet);
            }
            Phase::ConfirmStarts => self.after_confirm_starts(answers),
            Phase::Confirm(mut fleet) => {
                fleet.tell(&self.likelihood, answers);
                self.confirm(fleet);
            }
            ended @ (Phase::Done(_) | Phase::Failed(_)) => self.phase = ended,
        }
    }

    fn after_starts(&mut self, answers: Vec<Option<Vec<f64>>>) {
        let positions = std::mem::take(&mut self.asked)
            .into_iter()
            .map(|(_, position)| position);
        let draws = answers.len();
        self.spent.base += draws;
        let evaluated = positions.zip(answers).collect();
        let descents = base::descents(&self.base_frame, &self.likelihood, evaluated);
        if descents.is_empty() {
            self.phase = Phase::Failed(Failure::AllImpossible { draws });
        } else {
            self.fit_base(Fleet::new(descents.into_iter().map(|d| (None, d)).collect()));
        }
    }

    fn fit_base(&mut self, fleet: Fleet) {
        let Some(fleet) = self.go_on(fleet, Phase::Base) else {
            return;
        };
        self.spent.base += fleet.evaluations();
        let descents = fleet.descents.into_iter().map(|(_, descent)| descent);
        let best = descents.reduce(|a, b| if b.point.value < a.point.value { b } else { a });
        self.base = best.and_then(|descent| {
            let evidence = descent.log_evidence(&self.likelihood)?;
            Some((descent, evidence))
        });
        self.screen(0, (0..self.candidates.len()).collect());
    }

    fn screen(&mut self, level: usize, wanted: Vec<usize>) {
        let Some((base, _)) = &self.base else { return };
        let mut asked = Vec::new();
        for k in wanted {
            let frame = &self.frames[k];
            let at = screen::positions(frame, &base.point.position, &self.candidates[k], STRENGTHS[level]);
            asked.extend(at.into_iter().map(|position| (Some(k), position)));
        }
        if asked.is_empty() {
            return self.extend();
        }
        self.ask(asked);
        self.phase = Phase::Screen(level);
    }

    fn after_screen(&mut self, level: usize, answers: Vec<Option<Vec<f64>>>) {
        let Some((base, evidence)) = &self.base else {
            return;
        };
        self.spent.screen += answers.len();
        let mut evaluated: Vec<Vec<_>> = vec![Vec::new(); self.candidates.len()];
        for ((candidate, position), values) in std::mem::take(&mut self.asked).into_iter().zip(answers) {
            if let Some(k) = candidate {
                evaluated[k].push((position, values));
            }
        }
        let mut refused = Vec::new();
        for (k, evaluated) in evaluated.iter().enumerate() {
            if evaluated.is_empty() {
                continue;
            }
            let screened = screen::judge(&self.frames[k], base, *evidence, &self.likelihood, evaluated);
            match &screened {
                Some(screened) => {
                    self.judgements[k] = Some(Judgement {
                        log_bayes_factor: screened.log_bayes_factor,
                        method: Method::Screen,
                        fitted: None,
                    });
                }
                None => refused.push(k),
            }
            self.screened[k] = screened;
        }
        if level + 1 < STRENGTHS.len() && !refused.is_empty() {
            self.screen(level + 1, refused);
        } else {
            self.extend();
        }
    }

    fn extend(&mut self) {
        let Some((base, _)) = &self.base else { return };
        let descents = (0..self.candidates.len()).filter_map(|k| {
            let screened = self.screened[k].as_ref()?;
            let descent = extension::descent(&self.frames[k], base, screened, &self.likelihood)?;
            Some((Some(k), descent))
        });
        let fleet = Fleet::new(descents.collect());
        self.fit_extensions(fleet);
    }

    fn fit_extensions(&mut self, fleet: Fleet) {
        let Some(fleet) = self.go_on(fleet, Phase::Extensions) else {
            return;
        };
        self.spent.extension += fleet.evaluations();
        self.take(fleet, Method::RankOne);
        let descents = self.best(polish::COUNT).into_iter().filter_map(|k| {
            let fitted = self.judgements[k].as_ref()?.fitted.as_ref()?;
            Some((Some(k), polish::descent(fitted)))
        });
        let fleet = Fleet::new(descents.collect());
        self.polish(fleet);
    }

    fn polish(&mut self, fleet: Fleet) {
        let Some(fleet) = self.go_on(fleet, Phase::Polish) else {
            return;
        };
        self.spent.polish += fleet.evaluations();
        self.take(fleet, Method::Polished);
        let Some((base, _)) = &self.base else { return };
        let mut asked = Vec::new();
        for k in self.best(confirm::COUNT) {
            let starts = confirm::starts(&self.frames[k], base).into_iter();
            asked.extend(starts.map(|position| (Some(k), position)));
        }
        if asked.is_empty() {
            return self.finish();
        }
        self.ask(asked);
        self.phase = Phase::ConfirmStarts;
    }

    fn after_confirm_starts(&mut self, answers: Vec<Option<Vec<f64>>>) {
        let Some((base, _)) = &self.base else { return };
        self.spent.confirm += answers.len();
        let mut descents = Vec::new();
        for ((candidate, position), values) in std::mem::take(&mut self.asked).into_iter().zip(answers) {
            let Some(k) = candidate else { continue };
            let frame = &self.frames[k];
            let point = values.and_then(|v| Point::new(frame, &self.likelihood, position, v));
            if let Some(point) = point {
                let columns = vec![vec![0.0; base.point.values.len()]; frame.dimension()];
                let descent = Descent::new(frame.clone(), point, columns, &confirm::PLAN);
                descents.push((candidate, descent));
            }
        }
        for k in self.best(confirm::COUNT) {
            if let Some(fitted) = self.judgements[k].as_ref().and_then(|j| j.fitted.as_ref()) {
                descents.push((Some(k), confirm::descent(fitted)));
            }
        }
        self.confirm(Fleet::new(descents));
    }

    fn confirm(&mut self, fleet: Fleet) {
        let Some(fleet) = self.go_on(fleet, Phase::Confirm) else {
            return;
        };
        self.spent.confirm += fleet.evaluations();
        self.take(fleet, Method::Confirmed);
        self.finish();
    }

    /// Keeps of each candidate the most probable of its fits.
    fn take(&mut self, fleet: Fleet, method: Method) {
        let Some((_, base)) = &self.base else { return };
        let mut best: Vec<Option<Descent>> = vec![None; self.candidates.len()];
        for (candidate, descent) in fleet.descents {
            let Some(k) = candidate else { continue };
            let better = best[k]
                .as_ref()
                .is_none_or(|other| descent.point.value < other.point.value);
            if better {
                best[k] = Some(descent);
            }
        }
        for (k, fitted) in best.into_iter().enumerate() {
            let Some(fitted) = fitted else { continue };
            if let Some(evidence) = fitted.log_evidence(&self.likelihood) {
                self.judgements[k] = Some(Judgement {
                    log_bayes_factor: evidence - base,
                    method,
                    fitted: Some(fitted),
                });
            }
        }
    }

    /// The candidates with the highest Bayes factors.
    fn best(&self, count: usize) -> Vec<usize> {
        let factor = |k: &usize| self.judgements[*k].as_ref().map(|j| j.log_bayes_factor);
        let mut order: Vec<usize> = (0..self.candidates.len())
            .filter(|k| factor(k).is_some())
            .collect();
        order.sort_by(|a, b| {
            factor(b)
                .partial_cmp(&factor(a))
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        order.truncate(count);
        order
    }

    fn finish(&mut self) {
        let Some((base, _)) = &self.base else { return };
        let taken: Vec<usize> = (0..self.candidates.len())
            .filter(|k| self.screened[*k].is_some())
            .collect();
        let changes: Vec<Vec<f64>> = taken
            .iter()
            .filter_map(|k| Some(self.screened[*k].as_ref()?.change.clone()))
            .collect();
        let products = Absorbed::new(base, &self.likelihood).map(|absorbed| absorbed.products(&changes));
        let Some(products) = products else { return };
        let mut judged = vec![Judged {
            candidate: None,
            log_bayes_factor: 0.0,
            screen_log_bayes_factor: 0.0,
            log_likelihood: base.point.log_likelihood(),
            method: Method::Confirmed,
            probability: 0.0,
            class: 0,
            theta: self.base_frame.theta(&base.point.position),
            at_bound: self.base_frame.at_bound(&base.point.position),
            evaluations: self.spent.base,
        }];
        let mut cannot_exclude = Vec::new();
        for ((i, &k), class) in taken.iter().enumerate().zip(classes(&products)) {
            let (Some(judgement), Some(screened)) = (&self.judgements[k], &self.screened[k]) else {
                continue;
            };
            let fitted = judgement.fitted.as_ref();
            let point = fitted.map_or(&screened.point, |f| &f.point);
            let position = &point.position;
            judged.push(Judged {
                candidate: Some(k),
                log_bayes_factor: judgement.log_bayes_factor,
                screen_log_bayes_factor: screened.log_bayes_factor,
                log_likelihood: point.log_likelihood(),
                method: judgement.method,
                probability: 0.0,
                class: class + 1,
                theta: self.frames[k].theta(position),
                at_bound: self.frames[k].at_bound(position),
                evaluations: self.own[k],
            });
            if products[(i, i)] < LEAST_SEEN * LEAST_SEEN {
                cannot_exclude.push(k);
            }
        }
        let refused = (0..self.candidates.len()).filter(|k| self.screened[*k].is_none());
        let finding = Finding {
            judged,
            credible_set: Vec::new(),
            cannot_exclude,
            refused: refused.collect(),
            spent: self.spent,
        };
        self.phase = Phase::Done(Box::new(finding.weigh()));
    }
}
