//! Fit models without some of the data, and ask how well they predict these.

use super::asked::{Asked, Model};
use crate::descent::{Descent, Point, Step as Plan};
use statistics::likelihood::Likelihood;

/// Refits begin at the fit to all data: a few steps suffice.
const PLAN: [Plan; 2] = [Plan::Differences, Plan::Trials(6)];

/// Models that are compared: the base, the best of the library, a law outside it.
const MODELS: usize = 3;

/// One model fitted without one level.
#[derive(Debug, Clone)]
struct Refit {
    model: usize,
    effects: Vec<usize>,
    part: Likelihood,
    /// The place of each of the part's values among all.
    places: Vec<usize>,
    descent: Descent,
    /// What the whole model said where the descent was; the last that it took is the fit's.
    all_values: Vec<f64>,
    waiting: Vec<Vec<f64>>,
}

/// The data of one level.
#[derive(Debug, Clone)]
struct Level {
    left: Likelihood,
    places: Vec<usize>,
    /// Of each model; `None` where it cannot be fitted without the level.
    refits: Vec<Option<Refit>>,
}

/// All levels.
#[derive(Debug, Clone)]
pub(super) struct LeftOut(Vec<Level>);

impl LeftOut {
    /// Levels that hold all data, or that leave models without any, say nothing.
    ///
    /// # Arguments
    /// - `fits`: of each model its effects, how many parameters its last one has, and the fit to all data.
    pub(super) fn new(
        likelihood: &Likelihood,
        levels: &[Vec<usize>],
        fits: &[(Vec<usize>, usize, &Descent); MODELS],
    ) -> Self {
        let count = likelihood.data().len();
        let level = |left: &Vec<usize>| {
            let kept: Vec<usize> = (0..count).filter(|i| !left.contains(i)).collect();
            if kept.is_empty() || left.is_empty() {
                return None;
            }
            let (part, places) = likelihood.subset(&kept).ok()?;
            let refit = |(model, (effects, own, fit)): (usize, &(Vec<usize>, usize, &Descent))| {
                let taken = |values: &[f64]| places.iter().map(|&i| values[i]).collect::<Vec<f64>>();
                let point = Point::new(
                    &fit.frame,
                    &part,
                    fit.point.position.clone(),
                    taken(&fit.point.values),
                )?;
                let columns = fit.columns.iter().map(|column| taken(column)).collect();
                let mut descent = Descent::new(fit.frame.clone(), point, columns, &PLAN);
                // Shapes are what is tested: a law whose threshold moves with every level is none.
                let first = fit.frame.dimension() - own;
                let is_strength = |k: &usize| fit.frame.strengths.iter().any(|(s, _)| s == k);
                descent.hold((first..fit.frame.dimension()).filter(|k| !is_strength(k)));
                Some(Refit {
                    model,
                    effects: effects.clone(),
                    descent,
                    part: part.clone(),
                    places: places.clone(),
                    all_values: fit.point.values.clone(),
                    waiting: Vec::new(),
                })
            };
            let refits = fits.iter().enumerate().map(refit).collect();
            let (left, places) = likelihood.subset(left).ok()?;
            Some(Level { left, places, refits })
        };
        Self(levels.iter().filter_map(level).collect())
    }

    fn refits(&mut self) -> impl Iterator<Item = &mut Refit> {
        self.0
            .iter_mut()
            .flat_map(|level| level.refits.iter_mut().flatten())
    }

    pub(super) fn wanted(&mut self) -> Vec<Asked> {
        let mut asked = Vec::new();
        for refit in self.refits() {
            refit.waiting = refit.descent.ask(&refit.part);
            asked.extend(refit.waiting.iter().map(|position| Asked {
                model: Model::With(refit.effects.clone()),
                is_proposed: false,
                theta: refit.descent.frame.theta(position),
            }));
        }
        asked
    }

    pub(super) fn take(&mut self, answers: Vec<Option<Vec<f64>>>) {
        let mut answers = answers.into_iter();
        for refit in self.refits() {
            let waiting = std::mem::take(&mut refit.waiting);
            if waiting.is_empty() {
                continue;
            }
            let all: Vec<Option<Vec<f64>>> = answers.by_ref().take(waiting.len()).collect();
            let taken = |values: &Vec<f64>| refit.places.iter().map(|&i| values[i]).collect::<Vec<f64>>();
            let parts = all.iter().map(|values| values.as_ref().map(taken)).collect();
            refit.descent.tell(&refit.part, parts);
            let at = waiting.iter().position(|w| *w == refit.descent.point.position);
            if let Some(Some(values)) = at.map(|i| &all[i]) {
                refit.all_values.clone_from(values);
            }
        }
    }

    /// The log predictive density of the law over that of the base and of the library's best, over the levels that all three
    /// predict; `None` without such a level.
    pub(super) fn gains(&self) -> Option<[f64; 2]> {
        let mut sums = [0.0; MODELS];
        let mut levels = 0;
        for level in &self.0 {
            let density = |refit: &Option<Refit>| {
                let refit = refit.as_ref()?;
                let theta = refit.descent.frame.theta(&refit.descent.point.position);
                let values: Vec<f64> = level.places.iter().map(|&i| refit.all_values[i]).collect();
                let scored = level.left.log_likelihood(&values, &theta).ok()?.value();
                scored.is_finite().then_some((refit.model, scored))
            };
            let densities: Option<Vec<(usize, f64)>> = level.refits.iter().map(density).collect();
            if let Some(densities) = densities {
                levels += 1;
                for (model, scored) in densities {
                    sums[model] += scored;
                }
            }
        }
        let [base, library, law] = sums;
        (levels > 0).then_some([law - base, law - library])
    }
}
