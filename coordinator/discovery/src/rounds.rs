//! Go from round to round: what the results of one lead to.

use std::collections::BTreeMap;

use crate::descent::{Descent, Point};
use crate::engine::{Engine, Judgement, Phase};
use crate::finding::Method;
use crate::fleet::Fleet;
use crate::importance::Importance;
use crate::screen::STRENGTHS;
use crate::{base, confirm, extension, polish, screen};
use inference::InferenceFailure;

impl Engine {
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

    pub(crate) fn advance(&mut self, answers: Vec<Option<Vec<f64>>>) {
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
            Phase::Sample(models, waiting) => self.after_sample(models, &waiting, answers),
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
            self.phase = Phase::Failed(InferenceFailure::AllImpossible { draws });
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

    pub(crate) fn screen(&mut self, level: usize, wanted: Vec<usize>) {
        let Some((base, _)) = &self.base else { return };
        let mut asked = Vec::new();
        for k in wanted {
            let frame = &self.frames[k];
            let at = screen::positions(frame, &base.point.position, self.depth.shapes, STRENGTHS[level]);
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
        let descents = self.best(self.depth.most_extended).into_iter().filter_map(|k| {
            let screened = self.screened[k].as_ref()?;
            let descent = extension::descent(&self.frames[k], base, screened, &self.likelihood, self.depth)?;
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
        let descents = self.best(self.depth.polished).into_iter().filter_map(|k| {
            let fitted = self.judgements[k].as_ref()?.fitted.as_ref()?;
            Some((Some(k), polish::descent(fitted, self.depth.polish)))
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
        if !self.depth.confirms {
            return self.finish();
        }
        let Some((base, _)) = &self.base else { return };
        // A base that is far off was driven to an end of its prior, and is no place to begin.
        let is_wrong = self.leaves_misfit();
        let mut asked = Vec::new();
        for k in self.best(confirm::COUNT) {
            let starts = confirm::starts(&self.frames[k], base).into_iter();
            asked.extend(starts.map(|position| (Some(k), position)));
            if is_wrong {
                let anywhere = base::starts(&self.frames[k], confirm::ANYWHERE);
                asked.extend(anywhere.into_iter().map(|position| (Some(k), position)));
            }
            // Where an extension has found its way the base may find one, too: a factor compares their best.
            if let Some(fitted) = self.fit_of(k) {
                let own = fitted.point.position[..self.base_frame.dimension()].to_vec();
                asked.push((None, own));
            }
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
        let mut points: BTreeMap<Option<usize>, Vec<Point>> = BTreeMap::new();
        for ((candidate, position), values) in std::mem::take(&mut self.asked).into_iter().zip(answers) {
            let frame = self.frame(candidate);
            let point = values.and_then(|v| Point::new(frame, &self.likelihood, position, v));
            points.entry(candidate).or_default().extend(point);
        }
        let mut descents = Vec::new();
        for (candidate, mut points) in points {
            points.sort_by(|a, b| a.value.total_cmp(&b.value));
            points.truncate(confirm::MOST_STARTS);
            let frame = self.frame(candidate);
            for point in points {
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
        self.take_base(&fleet);
        self.take(fleet, Method::Confirmed);
        let models = self.to_be_sampled();
        self.sample(models);
    }

    fn sample(&mut self, mut models: Vec<(Option<usize>, Importance)>) {
        let mut asked = Vec::new();
        let mut waiting = Vec::new();
        for (candidate, model) in &mut models {
            let number = candidate.map_or(0, |k| k as u64 + 1);
            let positions = model.ask(self.seed, number);
            waiting.push(positions.len());
            asked.extend(positions.into_iter().map(|position| (*candidate, position)));
        }
        if asked.is_empty() {
            self.take_sampled(&models);
            return self.finish();
        }
        self.ask(asked);
        self.phase = Phase::Sample(models, waiting);
    }

    fn after_sample(
        &mut self,
        mut models: Vec<(Option<usize>, Importance)>,
        waiting: &[usize],
        answers: Vec<Option<Vec<f64>>>,
    ) {
        self.spent.confirm += answers.len();
        let mut answers = answers.into_iter();
        for ((_, model), count) in models.iter_mut().zip(waiting) {
            if *count > 0 {
                model.tell(&self.likelihood, answers.by_ref().take(*count).collect());
            }
        }
        self.sample(models);
    }
}
