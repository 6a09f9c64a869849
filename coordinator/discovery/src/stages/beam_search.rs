//! Step 8, the beam search: beyond each of the best combinations, one more effect is searched while misfit remains.

use crate::chi_square::FURTHER_EFFECT;
use crate::effect_search::depth::{Depth, GLANCE};
use crate::probability::DETECTED;
use crate::settings::Smoothness;
use crate::stages::branch::SearchBranch;
use crate::stages::hypotheses::{EffectCombination, candidate_set};
use crate::stages::stage::Stage;
use crate::stages::state::SearchState;

/// Beam width: number of combinations beyond which a further effect is searched.
const BEAM: usize = 3;
/// Number of single effects beyond which a further effect is searched if the best explanation contradicts the data: two effects
/// that explain much together may explain little alone.
const WIDE_BEAM: usize = 6;

impl SearchState {
    /// Searches one more effect beyond the best combinations of a size, unless the library fits already.
    pub(super) fn beam_search(&mut self, size: usize) -> Stage {
        let hypotheses = &self.hypotheses;
        let is_wide = size == 1 && self.searches_widely();
        let combinations = hypotheses.combinations.iter();
        let eligible = combinations
            .filter(|c| c.effects.len() == size && (c.log_bayes_factor > DETECTED || is_wide))
            // A model with another setting may lack effects that the others have.
            .filter(|c| !c.effects.iter().any(|k| self.task.library[*k].is_switch()));
        let mut best: Vec<&EffectCombination> = eligible.collect();
        let width = if is_wide { WIDE_BEAM } else { BEAM };
        // Keep each family's best set in the beam even if it ranks low: an effect not added yet may make it the winner.
        let is_of_family =
            |c: &&EffectCombination| hypotheses.family_sets.contains(&candidate_set(&c.effects));
        let family = best.iter().position(is_of_family).filter(|place| *place >= width);
        let family = family.map(|place| best[place]);
        best.truncate(width);
        best.extend(family);
        let leaves_misfit = hypotheses
            .chi_square(&self.task.likelihood)
            .is_none_or(|chi| chi.p() < FURTHER_EFFECT);
        if size >= self.task.max_effects || best.is_empty() || !leaves_misfit {
            return self.backward_elimination();
        }
        let branches = best.into_iter().enumerate().filter_map(|(rank, combination)| {
            let effects = &combination.effects;
            let depth = match self.task.settings.smoothness {
                Smoothness::Smooth if rank >= BEAM => &GLANCE,
                smoothness => Depth::beyond(smoothness),
            };
            self.branch(effects.clone(), self.further_effects(effects), depth)
        });
        Stage::BeamSearch(size, branches.collect())
    }

    /// Keeps the extended combinations, and extends them once more if the best has grown.
    pub(super) fn after_beam_search(&mut self, size: usize, branches: &[SearchBranch]) -> Stage {
        for branch in branches {
            self.add_combinations(branch);
        }
        let has_grown = self
            .hypotheses
            .best()
            .is_some_and(|best| best.effects.len() > size);
        if has_grown {
            self.beam_search(size + 1)
        } else {
            self.backward_elimination()
        }
    }
}
