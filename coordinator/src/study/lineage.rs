//! The lineage of a study's calibrations, read from their stored membership alone.

use record::{CalibrationRow, Change, Extension, parts_of};

/// The calibrations of a study, oldest first.
#[derive(Debug, Clone, Copy)]
pub struct Lineage<'a> {
    rows: &'a [CalibrationRow],
}

impl<'a> Lineage<'a> {
    /// Makes the lineage of the calibrations of one study, oldest first.
    pub fn new(rows: &'a [CalibrationRow]) -> Self {
        Self { rows }
    }

    /// Returns the calibrations without the searches.
    pub fn calibrations(self) -> impl Iterator<Item = &'a CalibrationRow> {
        self.rows.iter().filter(|row| !row.membership.is_search())
    }

    /// Returns the calibrations of the models that the submitted job compares. They are the first members of the study; without a
    /// comparison there is one.
    pub fn compared(self) -> &'a [CalibrationRow] {
        let is_compared = |row: &&CalibrationRow| matches!(row.membership.change, Some(Change::Model(_)));
        let further = self.rows.iter().skip(1).take_while(is_compared);
        &self.rows[..self.rows.len().min(1 + further.count())]
    }

    /// Returns the first calibration with the same model on the same measurements. A calibration by another algorithm has the model of its
    /// parent.
    pub fn model_of(self, id: i64) -> i64 {
        self.ancestors(id)
            .find(|row| !matches!(row.membership.change, Some(Change::Algorithm(_))))
            .map_or(id, |row| row.id)
    }

    /// Returns the search of a calibration's model, if there is one. If there are several, because one failed, returns the last. For a
    /// search, returns the search itself.
    pub fn search_of(self, id: i64) -> Option<&'a CalibrationRow> {
        let model = self.model_of(id);
        self.rows.iter().rev().find(|row| {
            let searched = row.membership.parent.filter(|_| row.membership.is_search());
            row.id == id && row.membership.is_search()
                || searched.is_some_and(|of| self.model_of(of) == model)
        })
    }

    /// Returns the additions to the submitted model that a calibration has, in the order in which the study made them.
    pub fn additions(self, id: i64) -> Vec<&'a Extension> {
        let mut changes: Vec<&Change> = self
            .ancestors(id)
            .filter_map(|row| row.membership.change.as_ref())
            .collect();
        changes.reverse();
        let mut additions: Vec<&Extension> = Vec::new();
        for change in changes {
            match change {
                Change::Add(extension) => additions.push(extension),
                Change::Drop(effects) => {
                    additions.retain(|extension| !effects.iter().any(|effect| is_part(extension, effect)));
                }
                Change::Algorithm(_) | Change::Model(_) | Change::Runs(_) => {}
            }
        }
        additions
    }

    /// Returns whether a calibration has an effect that the study added.
    pub fn has_added(self, id: i64, effect: &str) -> bool {
        self.additions(id)
            .iter()
            .any(|extension| is_part(extension, effect))
    }

    /// Returns whether the study has dropped an effect.
    pub fn has_dropped(self, effect: &str) -> bool {
        self.calibrations().any(|row| match &row.membership.change {
            Some(Change::Drop(effects)) => effects.iter().any(|dropped| dropped == effect),
            _ => false,
        })
    }

    /// Returns the calibration that results from another one by a change, unless it ended without a result.
    pub fn existing(self, parent: i64, change: &Change) -> Option<&'a CalibrationRow> {
        use shared::api::CalibrationState::{Cancelled, Failed};
        self.calibrations().find(|row| {
            let is_same =
                row.membership.parent == Some(parent) && row.membership.change.as_ref() == Some(change);
            is_same && !matches!(row.state, Failed | Cancelled)
        })
    }

    /// Returns a calibration and all that follow from it, oldest first.
    pub fn from(self, id: i64) -> impl Iterator<Item = &'a CalibrationRow> {
        let follows = move |row: &&CalibrationRow| self.ancestors(row.id).any(|ancestor| ancestor.id == id);
        self.rows.iter().filter(follows)
    }

    /// Returns a calibration and its ancestors, the nearest first.
    fn ancestors(self, id: i64) -> impl Iterator<Item = &'a CalibrationRow> {
        let find = move |id: i64| self.rows.iter().find(|row| row.id == id);
        // A parent is older than its child, so that a damaged store cannot cause an endless loop.
        std::iter::successors(find(id), move |row| {
            row.membership
                .parent
                .filter(|&parent| parent < row.id)
                .and_then(find)
        })
    }
}

/// Returns whether an addition adds this effect or setting.
pub(super) fn is_part(extension: &Extension, part: &str) -> bool {
    parts_of(extension).iter().any(|brought| brought == part)
}

#[cfg(test)]
mod tests {
    use record::{Membership, Role};
    use shared::api::CalibrationState;

    use super::*;

    fn changed(id: i64, parent: i64, change: Change) -> CalibrationRow {
        CalibrationRow::finished(id, Membership::changed(Role::Sample, parent, change))
    }

    fn effect(name: &str) -> Extension {
        Extension::Effect(name.into())
    }

    /// Makes a sample with a fit and a search; an extension with its search; the extension on more runs.
    fn study() -> Vec<CalibrationRow> {
        vec![
            CalibrationRow::finished(1, Membership::submitted(Role::Sample)),
            changed(2, 1, Change::Algorithm("lm".into())),
            CalibrationRow::finished(3, Membership::search_of(1)),
            changed(4, 1, Change::Add(effect("janosi_hanamoto"))),
            CalibrationRow::finished(5, Membership::search_of(4)),
            changed(6, 4, Change::Runs(3)),
        ]
    }

    #[test]
    fn a_search_is_found_by_what_is_stored_and_not_by_the_text_of_its_job() {
        let mut rows = study();
        // A later release may write the same job in another form.
        for (number, row) in rows.iter_mut().enumerate() {
            row.job.toml = format!("# written by release {number}\n");
        }
        let search_of = |id| Lineage::new(&rows).search_of(id).map(|row| row.id);
        let found: Vec<_> = [1, 2, 3, 4, 5, 6].map(search_of).into();
        assert_eq!(found, [Some(3), Some(3), Some(3), Some(5), Some(5), None]);
    }

    #[test]
    fn additions_are_kept_over_further_runs_and_go_with_what_is_dropped() {
        let mut rows = study();
        rows.push(changed(7, 6, Change::Add(effect("hard_pan"))));
        rows.push(changed(8, 7, Change::Drop(vec!["janosi_hanamoto".into()])));
        let lineage = Lineage::new(&rows);
        assert_eq!(lineage.additions(2), Vec::<&Extension>::new());
        assert_eq!(lineage.additions(6), [&effect("janosi_hanamoto")]);
        assert_eq!(lineage.additions(8), [&effect("hard_pan")]);
        assert!(lineage.has_dropped("janosi_hanamoto") && !lineage.has_dropped("hard_pan"));
    }

    #[test]
    fn an_effect_on_the_nodes_is_one_addition_and_goes_with_its_effect() {
        let mut rows = vec![CalibrationRow::finished(1, Membership::submitted(Role::Sample))];
        rows.push(changed(2, 1, Change::Add(effect("janosi_hanamoto_node"))));
        assert_eq!(Lineage::new(&rows).additions(2).len(), 1);
        assert!(Lineage::new(&rows).has_added(2, "janosi_hanamoto"));
        rows.push(changed(3, 2, Change::Drop(vec!["janosi_hanamoto".into()])));
        assert!(Lineage::new(&rows).additions(3).is_empty());
    }

    #[test]
    fn what_follows_from_a_calibration_is_its_searches_extensions_and_further_runs() {
        let rows = study();
        let from = |id| Lineage::new(&rows).from(id).map(|row| row.id).collect::<Vec<_>>();
        assert_eq!(from(4), [4, 5, 6]);
        assert_eq!(from(1), [1, 2, 3, 4, 5, 6]);
        assert_eq!(from(9), [0; 0]);
    }

    #[test]
    fn a_change_is_made_once_unless_it_ended_without_a_result() {
        let change = Change::Add(effect("janosi_hanamoto"));
        let mut rows = study();
        let existing =
            |rows: &[CalibrationRow], parent| Lineage::new(rows).existing(parent, &change).map(|row| row.id);
        assert_eq!(existing(&rows, 1), Some(4));
        assert_eq!(existing(&rows, 6), None);
        rows[3].state = CalibrationState::Failed;
        assert_eq!(existing(&rows, 1), None);
    }

    #[test]
    fn parents_in_a_circle_end() {
        let rows = [
            changed(1, 2, Change::Runs(1)),
            changed(2, 1, Change::Add(effect("a"))),
        ];
        assert_eq!(Lineage::new(&rows).additions(2), [&effect("a")]);
    }
}
