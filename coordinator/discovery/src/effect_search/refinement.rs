//! Phase 4, the refinement: the best few candidates are fitted again with new derivatives.

use crate::effect_search::ranking::EvidenceMethod;
use crate::effect_search::state::EffectSearch;
use crate::laplace::batch::FitBatch;

impl EffectSearch {
    /// Keeps the refined fits, and begins the confirmation of the best.
    pub(super) fn take_refinement(&mut self, batch: FitBatch) {
        self.evaluations.refinement += batch.evaluations();
        self.take(batch, EvidenceMethod::Refined);
        let Some(confirmation) = self.confirmation() else {
            return self.finish();
        };
        let best = self.best(confirmation.min_count);
        self.begin_confirmation(best);
    }
}
