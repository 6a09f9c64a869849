//! Phase 2, the screen: each candidate is evaluated at a few strengths and shapes about the base's fit, and at a smaller step if the
//! model rejects these.

use crate::effect_search::depth::ScreenDepth;
use crate::effect_search::screen_result::{Evaluated, Screened, screened};
use crate::effect_search::state::{EffectSearch, Phase};
use crate::laplace::batch::PositionRequest;
use crate::laplace::coordinate::NormalFrame;
use crate::settings::Smoothness;

/// Steps of each of several strengths; the next one is tried if the model rejects the last. A single strength has the steps of the
/// [`ScreenDepth`], and then the last of these; where it was screened without the model, the best and the longest of that screen, and then
/// all but the first of these.
pub(super) const STEPS: [f64; 4] = [1.0, 0.3, 0.1, 0.03];

/// Returns the positions to evaluate: every strength at the first shape and the first strength at the other shapes; a step along
/// each of several strengths; or, for a switch, the base's fit.
///
/// # Arguments
/// - `screened`: the result of a screen without the model, if there is one. It knows the best shape, and the best of the strengths, so that
///   that one and the longest are evaluated; if the model rejects these, shorter ones.
pub(super) fn positions(
    frame: &NormalFrame,
    base: &[f64],
    depth: &ScreenDepth,
    screened: Option<&Screened>,
    step_index: usize,
) -> Vec<Vec<f64>> {
    if frame.is_switch() {
        return if step_index == 0 {
            vec![base.to_vec()]
        } else {
            Vec::new()
        };
    }
    let Some((k, neutral)) = frame.strength() else {
        let mut absent = base.to_vec();
        absent.resize(frame.dimension(), 0.0);
        let absent = frame.without(&absent);
        let along = |&(k, neutral): &(usize, f64)| {
            let mut position = absent.clone();
            position[k] = neutral + STEPS[step_index];
            position
        };
        return frame.strengths.iter().map(along).collect();
    };
    let shapes = depth.of_shapes(frame.dimension() - base.len() - 1);
    let at = |shape: &[f64], strength: f64| {
        let mut position = [base, shape].concat();
        position.insert(k, neutral + strength);
        position
    };
    let last = STEPS.len() - 1;
    if let Some(screened) = screened {
        let shape = screened.shape(frame, base.len());
        let best = screened.point.position[k] - neutral;
        let mut strengths = match step_index {
            0 => vec![screened.longest_step, best],
            index => vec![STEPS[index]],
        };
        strengths.dedup();
        return strengths
            .into_iter()
            .map(|strength| at(&shape, strength))
            .collect();
    }
    match step_index {
        0 => {
            let strengths = depth.strengths.iter().map(|&strength| at(&shapes[0], strength));
            let shapes = shapes[1..].iter().map(|shape| at(shape, depth.strengths[0]));
            strengths.chain(shapes).collect()
        }
        index if index == last => vec![at(&shapes[0], STEPS[last])],
        _ => Vec::new(),
    }
}

impl ScreenDepth {
    /// Returns the coordinates of a candidate's shapes, the usual ones first.
    ///
    /// # Arguments
    /// - `count`: number of the shapes.
    fn of_shapes(&self, count: usize) -> Vec<Vec<f64>> {
        let shapes = self.shapes.iter();
        match count {
            0 => vec![Vec::new()],
            2 if !self.second_shapes.is_empty() => shapes
                .flat_map(|first| self.second_shapes.iter().map(|second| vec![*first, *second]))
                .collect(),
            _ => shapes.map(|shape| vec![*shape; count]).collect(),
        }
    }
}

impl EffectSearch {
    /// Evaluates candidates at the strengths of a step.
    pub(super) fn screen(&mut self, step_index: usize, candidates: Vec<usize>) {
        let Some(base) = &self.base else { return };
        let is_smooth = self.smoothness() == Smoothness::Smooth;
        let mut requests = Vec::new();
        for &k in &candidates {
            let state = &mut self.candidates[k];
            if is_smooth {
                // Its evaluations are cheap: the screen without the model has only chosen the candidate.
                state.low_fidelity = None;
            }
            let base = &base.fit.point.position;
            let screened = state.low_fidelity.as_ref();
            let positions = positions(&state.frame, base, &self.depth.screen, screened, step_index);
            requests.extend(PositionRequest::all_for_model(Some(k), positions));
        }
        if requests.is_empty() && step_index + 1 < STEPS.len() {
            return self.screen(step_index + 1, candidates);
        }
        if requests.is_empty() {
            return self.begin_extensions();
        }
        self.ask(requests);
        self.phase = Phase::Screen(step_index);
    }

    /// Keeps the results of a step; candidates that the model rejected there are evaluated at the next, smaller step.
    pub(super) fn take_screen(&mut self, step_index: usize, answers: Vec<Option<Vec<f64>>>) {
        let Some(base) = &self.base else { return };
        self.evaluations.screen += answers.len();
        let mut evaluated: Vec<Vec<Evaluated>> = vec![Vec::new(); self.candidates.len()];
        for (request, values) in std::mem::take(&mut self.requests).into_iter().zip(answers) {
            if let Some(k) = request.candidate {
                evaluated[k].push((request.position, values));
            }
        }
        let mut refused = Vec::new();
        for (k, (state, evaluated)) in self.candidates.iter_mut().zip(evaluated).enumerate() {
            if evaluated.is_empty() {
                continue;
            }
            let screened = screened(&state.frame, base, &self.likelihood, &evaluated);
            state.take_screened(screened, base.fit.point.position.len());
            if state.screened.is_none() {
                refused.push(k);
            }
        }
        // The model may accept the shortest step at the usual shape.
        if step_index + 2 == STEPS.len() {
            for &k in &refused {
                self.candidates[k].low_fidelity = None;
            }
        }
        if step_index + 1 < STEPS.len() && !refused.is_empty() {
            self.screen(step_index + 1, refused);
        } else {
            self.begin_extensions();
        }
    }
}
