//! The transients that a variant asks for, by run.

use std::ops::Range;

use shared::model::{ModelVariant, TransientCondition};

use super::error::CompileError;

/// The transients that a variant asks for.
#[derive(Debug)]
pub(super) struct Transients {
    /// The transients of each run, with the places of their points among the predicted ones.
    by_run: Vec<Vec<(Range<usize>, TransientCondition)>>,
    count: usize,
}

impl Transients {
    /// Sorts the transients of a variant by run.
    ///
    /// # Errors
    /// [`CompileError`]: the model has no transients, or one names a run that does not exist.
    pub(super) fn new(variant: &ModelVariant) -> Result<Self, CompileError> {
        if !variant.transients.is_empty() && !variant.kind.has_transients() {
            return Err(CompileError::NoTransients(variant.kind.name()));
        }
        let runs = variant.conditions.len();
        let mut by_run = vec![Vec::new(); runs];
        let mut count = 0;
        for transient in &variant.transients {
            let run = transient.run;
            let transients = by_run
                .get_mut(run)
                .ok_or(CompileError::UnknownRun { run, runs })?;
            let places = count..count + transient.travel_m.len();
            count = places.end;
            transients.push((places, transient.clone()));
        }
        Ok(Transients { by_run, count })
    }

    /// Returns the number of points.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Returns the transients of a run, with the places of their points among the predicted ones.
    pub(super) fn of_run(&self, run: usize) -> &[(Range<usize>, TransientCondition)] {
        &self.by_run[run]
    }
}
