//! The footing of a wheel: its rim on the soil, with or without effects.

use super::reaction::Reaction;
use super::reshaped::Reshaping;
use super::rim::Rim;
use crate::Rejection;

/// A rim, and the effects on its run.
#[derive(Debug)]
pub(super) struct Footing<'r, 'e> {
    pub(super) rim: Rim,
    /// Effects that reshape the stresses; `None` for the base model.
    pub(super) reshaping: Option<Reshaping<'r, 'e>>,
}

impl Footing<'_, '_> {
    /// Returns the soil's force on the rim when the contact reaches a length of 0 < l ≤ R ahead of the axle;
    /// [`Rejection::Formula`] if a formula gives an inadmissible value.
    pub(super) fn react(&mut self, contact_length: f64) -> Result<Reaction, Rejection> {
        let Some(reshaping) = &mut self.reshaping else {
            return Ok(self.rim.react(contact_length));
        };
        let reaction = if self.rim.peaked.is_some() || reshaping.changes_stresses() {
            reshaping.react(&self.rim, contact_length)?
        } else {
            self.rim.react(contact_length)
        };
        let extra_load = reshaping.extra_load(&reaction)?;
        Ok(Reaction {
            extra_load,
            ..reaction
        })
    }

    /// Returns whether the load may jump: when a jump of a law passes a node, or at the footprint where a negative `k_c`
    /// makes k* zero, from which rebound or a law that hardly depends on k* may carry the whole load within the last bit of
    /// the contact's length.
    pub(super) fn may_jump(&self) -> bool {
        let negative = self.rim.soil.k_c < 0.0;
        self.reshaping
            .as_ref()
            .is_some_and(|reshaping| reshaping.may_jump() || negative && reshaping.changes_stresses())
    }
}
