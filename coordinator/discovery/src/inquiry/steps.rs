//! From one step of an inquiry to the next.

use super::Inquiry;
use super::answer::Answer;
use super::asked::Asked;
use super::found::{Law, Set};
use super::left_out::LeftOut;
use super::next_run::NextRuns;
use super::search::Search;
use crate::chi_square::WRONG;
use crate::coordinate::Frame;
use crate::depth::{ALL_CURVES, CURVES, FORMS, QUICK};
use crate::engine::Engine;
use crate::evidence::log_sum_exp;
use crate::settings::{Settings, Starts};
use inference::InferenceFailure;

/// A log Bayes factor above this is a detection \[nats\].
pub(super) const DETECTED: f64 = 3.0;
/// From so many sets one more effect is looked for.
const BEAM: usize = 3;
/// A fit with less chance than this leaves room for a further effect, and for a law outside the library.
const MISFIT: [f64; 2] = [0.5, 0.05];
/// The simple forms of so many pairs are fitted.
const PAIRS: usize = 3;
/// A curve is kept where it beats the best simple form by more \[nats\].
const CURVE_BEATS_FORM: f64 = 5.0;
/// Where an inquiry stands.
#[derive(Debug, Clone)]
pub(super) enum Step {
    Singles(Search),
    Reductions(Vec<Search>),
    /// Beyond sets of so many effects.
    Beyond(usize, Vec<Search>),
    /// The best set without each of its effects.
    Without(Vec<Search>),
    Curves(Search),
    Forms(Search),
    /// Of the law of that place.
    LeftOut(usize, LeftOut),
    Next(NextRuns),
    Done(Box<Answer>),
    Failed(InferenceFailure),
}

impl Inquiry {
    /// What the step in progress asks for.
    pub(super) fn wanted(&mut self) -> Vec<Asked> {
        match &mut self.step {
            Step::Singles(search) | Step::Curves(search) | Step::Forms(search) => search.wanted(),
            Step::Reductions(searches) | Step::Beyond(_, searches) | Step::Without(searches) => {
                searches.iter().flat_map(Search::wanted).collect()
            }
            Step::LeftOut(_, left_out) => left_out.wanted(),
            Step::Next(runs) => runs.wanted(),
            Step::Done(_) | Step::Failed(_) => Vec::new(),
        }
    }

    /// Hands the answers of a round to the step that asked.
    pub(super) fn take(&mut self, answers: Vec<Option<Vec<f64>>>) {
        match &mut self.step {
            Step::Singles(search) | Step::Curves(search) | Step::Forms(search) => search.take(answers),
            Step::Reductions(searches) | Step::Beyond(_, searches) | Step::Without(searches) => {
                let mut answers = answers.into_iter();
                for search in searches {
                    let count = search.wanted().len();
                    search.take(answers.by_ref().take(count).collect());
                }
            }
            Step::LeftOut(_, left_out) => left_out.take(answers),
            Step::Next(runs) => runs.take(answers),
            Step::Done(_) | Step::Failed(_) => {}
        }
    }

    /// What follows a step that wants nothing more.
    pub(super) fn next_step(&mut self) {
        let step = std::mem::replace(
            &mut self.step,
            Step::Failed(InferenceFailure::AllImpossible { draws: 0 }),
        );
        self.step = match step {
            Step::Singles(search) => self.after_singles(&search),
            Step::Reductions(searches) => self.after_reductions(&searches),
            Step::Beyond(size, searches) => self.after_beyond(size, &searches),
            Step::Without(searches) => self.after_without(&searches),
            Step::Curves(search) => self.after_curves(&search),
            Step::Forms(search) => self.after_forms(&search),
            Step::LeftOut(law, left_out) => self.after_left_out(law, &left_out),
            Step::Next(runs) => self.done(runs.best()),
            over @ (Step::Done(_) | Step::Failed(_)) => over,
        };
    }

    fn after_singles(&mut self, search: &Search) -> Step {
        if let Some(failure) = search.engine.failure() {
            return Step::Failed(failure);
        }
        self.found.base = search
            .engine
            .base_fit()
            .map(|(fit, evidence)| (fit.clone(), evidence));
        self.found.singles = search.engine.finding().cloned();
        self.found.to_name = search.engine.finding().map_or(0, |f| f.spent.to_name());
        self.add_sets(search, 0.0);
        let Some((base, _)) = self.found.base.clone() else {
            return Step::Failed(InferenceFailure::AllImpossible {
                draws: self.evaluations,
            });
        };
        let theta = base.frame.theta(&base.point.position);
        let reduced = self
            .task
            .reductions
            .iter()
            .enumerate()
            .filter_map(|(k, reduction)| {
                let kept = reduction.parameters.iter();
                let prior: Vec<_> = kept.clone().map(|&i| self.task.prior[i].clone()).collect();
                let settings = Settings {
                    starts: Starts::Draws(vec![kept.map(|&i| theta[i]).collect()]),
                    ..self.task.settings.clone()
                };
                let engine = Engine::new(&prior, self.task.likelihood.clone(), Vec::new(), &settings).ok()?;
                Some(Search::without(k, engine))
            });
        Step::Reductions(reduced.collect())
    }

    fn after_reductions(&mut self, searches: &[Search]) -> Step {
        let base = self.found.base.as_ref().map_or(0.0, |(_, evidence)| *evidence);
        let mut gains = vec![None; self.task.reductions.len()];
        for search in searches {
            if let (Some(k), Some((_, evidence))) = (search.reduction, search.engine.base_fit()) {
                gains[k] = Some(base - evidence);
            }
        }
        self.found.gains = gains;
        self.beyond(1)
    }

    /// Looks for one more effect beyond the best sets of a size, where they leave room for it.
    fn beyond(&mut self, size: usize) -> Step {
        let best: Vec<&Set> = self
            .found
            .sets
            .iter()
            .filter(|set| set.effects.len() == size && set.log_bayes_factor > DETECTED)
            .take(BEAM)
            .collect();
        let leaves_room = self
            .found
            .best_chi_square(&self.task.likelihood, DETECTED)
            .is_none_or(|chi| chi.p() < MISFIT[0]);
        if size >= self.task.max_effects || best.is_empty() || !leaves_room {
            return self.without();
        }
        let evidence = self.found.base.as_ref().map_or(0.0, |(_, evidence)| *evidence);
        let searches = best.into_iter().map(|set| {
            let others: Vec<usize> = (0..self.task.library.len())
                .filter(|k| !set.effects.contains(k))
                .collect();
            let candidates = others.iter().map(|&k| self.task.library[k].clone()).collect();
            let engine = Engine::beyond(
                set.fit.clone(),
                evidence + set.log_bayes_factor,
                self.task.likelihood.clone(),
                candidates,
                &QUICK,
                self.task.settings.seed,
            );
            Search::new(set.effects.clone(), others, engine)
        });
        Step::Beyond(size, searches.collect())
    }

    fn after_beyond(&mut self, size: usize, searches: &[Search]) -> Step {
        for search in searches {
            let evidence = self.found.base.as_ref().map_or(0.0, |(_, evidence)| *evidence);
            let begun = search.engine.base_fit().map_or(0.0, |(_, own)| own - evidence);
            self.add_sets(search, begun);
        }
        let grown = self.found.best_set().is_some_and(|set| set.effects.len() > size);
        if grown {
            self.beyond(size + 1)
        } else {
            self.without()
        }
    }

    /// Fits the best set again without each of its effects, from where it stands: the way up may have gone over one that the others
    /// do not need.
    fn without(&mut self) -> Step {
        let Some(best) = self.found.best_set().filter(|set| set.effects.len() > 1) else {
            return self.curves();
        };
        let searches = best.effects.iter().map(|&dropped| {
            let mut frame = Frame::base(&self.task.prior, self.task.settings.least_difference);
            let (own, mut rest) = best.fit.point.position.split_at(self.task.prior.len());
            let mut start = own.to_vec();
            let mut effects = Vec::new();
            for &k in &best.effects {
                let candidate = &self.found.candidates[k];
                let (its, others) = rest.split_at(candidate.parameters.len());
                rest = others;
                if k != dropped {
                    frame = frame.with(candidate);
                    start.extend_from_slice(its);
                    effects.push(k);
                }
            }
            let seed = self.task.settings.seed;
            let engine = Engine::refit(frame, start, self.task.likelihood.clone(), seed);
            Search::new(effects, Vec::new(), engine)
        });
        Step::Without(searches.collect())
    }

    fn after_without(&mut self, searches: &[Search]) -> Step {
        let base = self.found.base.as_ref().map_or(0.0, |(_, evidence)| *evidence);
        for search in searches {
            if let Some((fit, evidence)) = search.engine.base_fit() {
                self.found.add(Set {
                    effects: search.set.clone(),
                    log_bayes_factor: evidence - base,
                    fit: fit.clone(),
                });
            }
        }
        self.curves()
    }

    /// Keeps what a search found: every effect of the first, of the others those that are worth their choice.
    fn add_sets(&mut self, search: &Search, begun: f64) {
        for (candidate, judged) in search.ranked() {
            let worth = search.set.is_empty() || judged.log_bayes_factor > DETECTED;
            let own = judged.candidate.and_then(|k| search.engine.fit_of(k));
            if let (true, Some(fit)) = (worth, own) {
                let mut effects = search.set.clone();
                effects.push(candidate);
                self.found.add(Set {
                    effects,
                    log_bayes_factor: begun + judged.log_bayes_factor,
                    fit: fit.clone(),
                });
            }
        }
    }

    /// Looks outside the library where it leaves misfit.
    fn curves(&mut self) -> Step {
        let likelihood = &self.task.likelihood;
        let detected = self
            .found
            .best_set()
            .is_some_and(|set| set.log_bayes_factor > DETECTED);
        let p = self
            .found
            .best_chi_square(likelihood, DETECTED)
            .map(|chi| chi.p());
        let misfit = p.map_or(detected, |p| p < MISFIT[1]);
        let depth = if p.is_some_and(|p| p < WRONG) {
            &ALL_CURVES
        } else {
            &CURVES
        };
        let Some((base, evidence)) = self
            .found
            .base
            .clone()
            .filter(|_| misfit && !self.task.pairs.is_empty())
        else {
            return self.next_runs();
        };
        let candidates = self.task.pairs.iter().map(|pair| pair.curve.clone()).collect();
        let positions = (0..self.task.pairs.len()).map(|pair| self.task.curve(pair));
        let engine = Engine::beyond(
            base,
            evidence,
            likelihood.clone(),
            candidates,
            depth,
            self.task.settings.seed,
        );
        Step::Curves(Search::new(Vec::new(), positions.collect(), engine))
    }

    fn after_curves(&mut self, search: &Search) -> Step {
        let pair_of =
            |candidate: usize| (0..self.task.pairs.len()).find(|&p| self.task.curve(p) == candidate);
        let laws = search.ranked().into_iter().filter_map(|(candidate, judged)| {
            Some(Law {
                pair: pair_of(candidate)?,
                candidate,
                log_bayes_factor: judged.log_bayes_factor,
                mean_log_bayes_factor: judged.log_bayes_factor,
                fit: search.engine.fit_of(judged.candidate?)?.clone(),
                left_out: None,
            })
        });
        let laws: Vec<Law> = laws.collect();
        let best: Vec<usize> = laws.iter().take(PAIRS).map(|law| law.pair).collect();
        self.found.laws = Some(laws);
        let Some((base, evidence)) = self.found.base.clone() else {
            return self.next_runs();
        };
        let forms: Vec<usize> = best
            .iter()
            .flat_map(|&pair| {
                let first = self.task.curve(pair) + 1;
                first..first + self.task.pairs[pair].forms.len()
            })
            .collect();
        let candidates = forms.iter().map(|&k| self.found.candidates[k].clone()).collect();
        let seed = self.task.settings.seed;
        let engine = Engine::beyond(
            base,
            evidence,
            self.task.likelihood.clone(),
            candidates,
            &FORMS,
            seed,
        );
        Step::Forms(Search::new(Vec::new(), forms, engine))
    }

    fn after_forms(&mut self, search: &Search) -> Step {
        let ranked = search.ranked();
        let curves: Vec<usize> = (0..self.task.pairs.len())
            .map(|pair| self.task.curve(pair))
            .collect();
        for law in self.found.laws.iter_mut().flatten() {
            let first = curves[law.pair] + 1;
            let own = first..first + self.task.pairs[law.pair].forms.len();
            let of_pair: Vec<_> = ranked.iter().filter(|(k, _)| own.contains(k)).collect();
            let factors = of_pair.iter().map(|(_, judged)| judged.log_bayes_factor);
            let all = factors.chain([law.log_bayes_factor]);
            let count = 1.0 + self.task.pairs[law.pair].forms.len() as f64;
            law.mean_log_bayes_factor = log_sum_exp(all) - libm::log(count);
            let best = of_pair.first().and_then(|(k, judged)| {
                let fit = search.engine.fit_of(judged.candidate?)?;
                Some((*k, judged.log_bayes_factor, fit))
            });
            if let Some((candidate, factor, fit)) = best
                && factor > law.log_bayes_factor - CURVE_BEATS_FORM
            {
                (law.candidate, law.log_bayes_factor, law.fit) = (candidate, factor, fit.clone());
            }
        }
        let handicap = |law: &Law| f64::from(u8::from(self.task.pairs[law.pair].is_description)) * DETECTED;
        let score = |law: &Law| law.log_bayes_factor - handicap(law);
        if let Some(laws) = &mut self.found.laws {
            laws.sort_by(|a, b| score(b).total_cmp(&score(a)));
        }
        self.leave_out(0)
    }

    /// Leaves levels out for the law of a place, if there is one to be confirmed.
    fn leave_out(&mut self, law: usize) -> Step {
        let laws = self.found.laws.as_deref().unwrap_or_default();
        let (Some(own), Some(base)) = (laws.get(law).filter(|_| law < PAIRS), self.found.fit()) else {
            return self.next_runs();
        };
        if own.log_bayes_factor <= DETECTED {
            return self.next_runs();
        }
        let best = self.found.best_set();
        let parameters = |k: usize| self.found.candidates[k].parameters.len();
        let library = best.map_or((Vec::new(), 0, base), |set| {
            let last = set.effects.last().map_or(0, |&k| parameters(k));
            (set.effects.clone(), last, &set.fit)
        });
        let law_fit = (vec![own.candidate], parameters(own.candidate), &own.fit);
        let fits = [(Vec::new(), 0, base), library, law_fit];
        Step::LeftOut(law, LeftOut::new(&self.task.likelihood, &self.task.levels, &fits))
    }

    fn after_left_out(&mut self, place: usize, left_out: &LeftOut) -> Step {
        let gains = left_out.gains();
        if let Some(law) = self.found.laws.as_mut().and_then(|laws| laws.get_mut(place)) {
            law.left_out = gains;
        }
        let holds = gains.is_some_and(|[over_base, over_library]| over_base > DETECTED && over_library > 0.0);
        if holds {
            self.found.confirmed = Some(place);
            return self.next_runs();
        }
        self.leave_out(place + 1)
    }

    fn next_runs(&mut self) -> Step {
        let explanations = Answer::open(&self.task, &self.found);
        match NextRuns::new(&self.task, explanations) {
            Some(runs) => Step::Next(runs),
            None => self.done(Vec::new()),
        }
    }

    fn done(&mut self, next_runs: Vec<super::NextRun>) -> Step {
        Step::Done(Box::new(Answer::new(
            &self.task,
            &self.found,
            next_runs,
            self.evaluations,
        )))
    }
}
