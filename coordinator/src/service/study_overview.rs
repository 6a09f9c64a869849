//! Studies as the page shows them: finished ones from their stored files, others from what is kept in memory.

use std::collections::BTreeMap;
use std::sync::Arc;

use shared::api::{CalibrationState, CalibrationStatus};

use super::error::ServiceError;
use super::handle::Service;
use super::overview_cache::{KeptOverview, MemberKey, member_key};
use super::study_members::study_members;
use super::study_results::study_file;
use job::model_kind;
use record::CalibrationRow;
use report::{StudyFile, StudyListItem, StudyOverview};
use store::StoreError;

impl Service {
    /// A study as the page shows it.
    ///
    /// # Errors
    /// [`ServiceError::NotFound`] and others.
    pub async fn study_overview(&self, id: i64) -> Result<StudyOverview, ServiceError> {
        let reader = self.store().reader();
        let rows = reader.study(id).await?;
        if rows.is_empty() {
            return Err(ServiceError::not_found("study", id));
        }
        let mut overview = self.computed_overview(id, &rows).await?;
        // What changes without a member beginning or ending.
        for (member, row) in overview.members.iter_mut().zip(&rows) {
            let status = self.status_of(row).await?;
            (member.member.state, member.member.message) = (status.state, status.message);
        }
        let unfinished = overview
            .members
            .iter()
            .find(|m| m.member.state != CalibrationState::Finished);
        overview.state = unfinished.map_or(overview.state, |member| member.member.state);
        overview.archived = reader.archived().await?.iter().any(|&(study, _)| study == id);
        Ok(overview)
    }

    async fn status_of(&self, row: &CalibrationRow) -> Result<CalibrationStatus, ServiceError> {
        match row.state.is_final() {
            true => Ok(super::stored_status(row.id, &Ok(row.clone()))),
            false => self.status(row.id).await,
        }
    }

    /// The part of a study's overview that changes as members begin and end.
    async fn computed_overview(
        &self,
        id: i64,
        rows: &[CalibrationRow],
    ) -> Result<StudyOverview, ServiceError> {
        let reader = self.store().reader();
        let members = member_key(rows.iter().map(|row| (row.id, row.state)));
        // Before the rows: what is found out while they are read makes it out of date.
        let doubts = reader.doubts().await?;
        let kept = self.overviews.get(id, &members);
        if let Some(kept) = kept.filter(|kept| kept.doubts == doubts) {
            return Ok((*kept.overview).clone());
        }
        let is_finished =
            |row: &&CalibrationRow| row.state == CalibrationState::Finished && !row.membership.is_search();
        let overview = match rows.iter().find(is_finished) {
            Some(row) => {
                let text = study_file(&reader, self.results_writer(), row, StudyFile::Overview).await?;
                let corrupt = |e| StoreError::Corrupt(format!("overview of study {id}: {e}"));
                serde_json::from_str(&text).map_err(corrupt)?
            }
            None => {
                let lead = rows.first().expect("a study has a member");
                let kind = model_kind(&lead.job.toml).map(|kind| kind.name().to_owned());
                StudyOverview::begun(id, lead.experiment, kind, study_members(&reader, rows).await?)
            }
        };
        let kept = KeptOverview {
            members,
            doubts,
            overview: Arc::new(overview.clone()),
        };
        self.overviews.keep(id, kept);
        Ok(overview)
    }

    /// Every study, oldest first; archived ones only where that is asked for. The errors and the verdict of a study that has just
    /// changed are left out until they are computed.
    ///
    /// # Errors
    /// [`ServiceError`].
    pub async fn studies(&self, with_archived: bool) -> Result<Vec<StudyListItem>, ServiceError> {
        let reader = self.store().reader();
        let archived = reader.archived().await?;
        let mut studies: BTreeMap<i64, Vec<CalibrationStatus>> = BTreeMap::new();
        // A calibration whose row cannot be read belongs to no study that is known.
        for status in self.list(true).await?.into_iter().filter(|s| s.study != 0) {
            studies.entry(status.study).or_default().push(status);
        }
        let item = |(id, members): (i64, Vec<CalibrationStatus>)| {
            let key = member_key(members.iter().map(|member| (member.id, member.state)));
            let lead = members.first()?;
            let unfinished = members.iter().find(|m| m.state != CalibrationState::Finished);
            let progress = members.iter().find_map(|member| member.progress.clone());
            let kept = self.overviews.get(id, &key);
            let mut item = match &kept {
                Some(kept) => kept.overview.list_item(progress),
                None => StudyOverview::begun(id, lead.experiment, lead.model_kind.clone(), Vec::new())
                    .list_item(progress),
            };
            item.name.clone_from(&lead.name);
            item.calibrations = members.iter().map(|member| member.id).collect();
            item.state = unfinished.map_or(item.state, |member| member.state);
            item.archived = archived.iter().any(|&(study, _)| study == id);
            Some(item)
        };
        let items = studies.into_iter().filter_map(item);
        Ok(items.filter(|item| with_archived || !item.archived).collect())
    }

    /// Computes the overviews of studies as their members begin and end, until the service ends.
    pub async fn keep_overviews(&self) {
        let mut seen: BTreeMap<i64, MemberKey> = BTreeMap::new();
        let mut changes = self.study_changes();
        loop {
            changes.next().await;
            match self.store().reader().member_states().await {
                Ok(states) => {
                    let mut studies: BTreeMap<i64, Vec<(i64, CalibrationState)>> = BTreeMap::new();
                    for (study, id, state) in states {
                        studies.entry(study).or_default().push((id, state));
                    }
                    let keys = studies
                        .into_iter()
                        .map(|(study, members)| (study, member_key(members.into_iter())));
                    let keys: BTreeMap<i64, MemberKey> = keys.collect();
                    self.overviews.forget_all_but(&keys);
                    for (study, key) in &keys {
                        if seen.get(study) == Some(key) {
                            continue;
                        }
                        if let Err(error) = self.study_overview(*study).await {
                            tracing::warn!(study, %error, "no overview of the study");
                        }
                    }
                    seen = keys;
                }
                Err(error) => {
                    tracing::error!(%error, "failed to read the studies");
                    changes.look_again();
                }
            }
        }
    }
}
