//! The question about effects that change the model at their neutral values.

use shared::model::EffectSet;

use super::question::{NEUTRAL, Question};
use crate::Spec;

/// Returns the question about the first effect that changes the model at its neutral value.
pub(super) fn questions(spec: &Spec) -> Option<Question> {
    // The texts were read when the specification was made, so they can be read again.
    let effects = EffectSet::read(&spec.fit_variant.effects).unwrap_or_default();
    let words = effects.iter().find_map(|effect| effect.change_at_neutral())?;
    Some(Question::new(NEUTRAL, words))
}
