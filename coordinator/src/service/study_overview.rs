//! Overviews of studies for the page, and the list of all studies.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

use shared::api::{CalibrationState, CalibrationStatus};

use super::error::ServiceError;
use super::handle::Service;
use super::results::members_stamp;
use super::study_members::study_members;
use job::model_kind;
use record::CalibrationRow;
use report::{StudyFile, StudyListItem, StudyOverview};
use store::{IdPage, Stamp, StoreError, is_of_members};

impl Service {
    /// Returns the overview of a study.
    pub async fn study_overview(&self, id: i64) -> Result<StudyOverview, ServiceError> {
        let reader = self.store().reader();
        let (stamp, rows) = self.stamped_members(id).await?;
        if rows.is_empty() {
            return Err(ServiceError::not_found("study", id));
        }
        let mut overview = self.overview_of_ended(id, &rows, stamp).await?;
        // States and messages change also while the kept text stays valid.
        for (member, row) in overview.members.iter_mut().zip(&rows) {
            let status = self.status_of(row).await?;
            (member.member.state, member.member.message) = (status.state, status.message);
        }
        let unfinished = overview
            .members
            .iter()
            .find(|m| m.member.state != CalibrationState::Finished);
        overview.state = unfinished.map_or(overview.state, |member| member.member.state);
        if let Some(details) = reader.study_details(&(id..=id)).await?.remove(&id) {
            overview.describe(details);
        }
        overview.archived = reader.archived().await?.iter().any(|&(study, _)| study == id);
        Ok(overview)
    }

    async fn status_of(&self, row: &CalibrationRow) -> Result<CalibrationStatus, ServiceError> {
        match row.state.is_final() {
            true => Ok(super::stored_calibration::stored_status(row.id, &Ok(row.clone()))),
            false => self.status(row.id).await,
        }
    }

    /// Returns the part of a study's overview that changes only when a member begins or ends.
    async fn overview_of_ended(
        &self,
        id: i64,
        rows: &[CalibrationRow],
        stamp: Stamp,
    ) -> Result<StudyOverview, ServiceError> {
        let is_finished =
            |row: &&CalibrationRow| row.state == CalibrationState::Finished && !row.membership.is_search();
        let text = match rows.iter().find(is_finished) {
            Some(row) => Some(
                self.text_of_study(row, rows, stamp.clone(), StudyFile::Overview)
                    .await?,
            ),
            None => {
                let name = StudyFile::Overview.name();
                self.results.text(id, &name, &stamp).await?
            }
        };
        if let Some(text) = text {
            let corrupt = |e| StoreError::Corrupt(format!("overview of study {id}: {e}"));
            return Ok(serde_json::from_str(&text).map_err(corrupt)?);
        }
        let lead = rows.first().expect("a study has a member");
        let kind = model_kind(&lead.job.toml).map(|kind| kind.name().to_owned());
        let members = study_members(&self.store().reader(), rows).await?;
        let overview = StudyOverview {
            created_ms: Some(lead.created_ms),
            ..StudyOverview::begun(id, lead.experiment, kind, members)
        };
        self.keep_overview(&overview, stamp).await?;
        Ok(overview)
    }

    /// Lists studies, oldest first; archived ones on request. Errors and verdict of a study that has just changed are left out until they
    /// are computed.
    pub async fn studies(
        &self,
        with_archived: bool,
        page: IdPage,
    ) -> Result<Vec<StudyListItem>, ServiceError> {
        let mut items = Vec::new();
        let mut rest = Some(page);
        // Archived studies are in the way of a full page.
        while let Some(part) = rest {
            let ids = self.store().reader().study_ids(part).await?;
            let (Some(&first), Some(&last)) = (ids.first(), ids.last()) else {
                break;
            };
            items.extend(self.studies_in(first..=last, with_archived).await?);
            if (ids.len() as i64) < part.limit {
                break;
            }
            rest = page.rest(last, items.len());
        }
        items.truncate(usize::try_from(page.limit).unwrap_or(usize::MAX));
        Ok(items)
    }

    async fn studies_in(
        &self,
        ids: RangeInclusive<i64>,
        with_archived: bool,
    ) -> Result<Vec<StudyListItem>, ServiceError> {
        let reader = self.store().reader();
        let archived: BTreeSet<i64> = reader.archived().await?.into_iter().map(|(id, _)| id).collect();
        let withdrawn = reader.withdrawn().await?;
        let mut details = reader.study_details(&ids).await?;
        let mut studies: BTreeMap<i64, Vec<CalibrationStatus>> = BTreeMap::new();
        // A calibration whose row cannot be read belongs to no known study.
        let is_member = |s: &CalibrationStatus| s.study != 0 && !withdrawn.contains(&s.id);
        let rows = reader.calibrations_of(&ids).await?;
        for status in self.statuses(rows).await?.into_iter().filter(is_member) {
            studies.entry(status.study).or_default().push(status);
        }
        let mut listed = self.results.texts(&StudyFile::ListItem.name(), &ids).await?;
        let item = |(id, members): (i64, Vec<CalibrationStatus>)| {
            let stamp = members_stamp(members.iter().map(|member| (member.id, member.state)));
            let lead = members.first()?;
            let unfinished = members.iter().find(|m| m.state != CalibrationState::Finished);
            let kept = listed
                .remove(&id)
                .filter(|(list_stamp, _)| is_of_members(list_stamp, &stamp));
            let kept = kept.and_then(|(_, text)| serde_json::from_str::<StudyListItem>(&text).ok());
            let mut item = kept.unwrap_or_else(|| {
                let kind = lead.model_kind.clone();
                StudyOverview::begun(id, lead.experiment, kind, Vec::new()).list_item(None)
            });
            item.progress = members.iter().find_map(|member| member.progress.clone());
            item.name.clone_from(&lead.name);
            item.calibrations = members.iter().map(|member| member.id).collect();
            item.state = unfinished.map_or(item.state, |member| member.state);
            item.archived = archived.contains(&id);
            if let Some(details) = details.remove(&id) {
                item.describe(details);
            }
            Some(item)
        };
        let items = studies.into_iter().filter_map(item);
        Ok(items.filter(|item| with_archived || !item.archived).collect())
    }

    /// Computes the overviews of studies as their members begin and end, until the service ends.
    pub async fn keep_overviews(&self) {
        // The stamps of the studies whose overview could not be computed.
        let mut failed: BTreeMap<i64, String> = BTreeMap::new();
        let mut changes = self.study_changes();
        loop {
            changes.next().await;
            match self.studies_without_overview().await {
                Ok(studies) => {
                    for (study, stamp) in studies {
                        if failed.get(&study) == Some(&stamp) {
                            continue;
                        }
                        if let Err(error) = self.study_overview(study).await {
                            tracing::warn!(study, %error, "no overview of the study");
                            failed.insert(study, stamp);
                        }
                    }
                }
                Err(error) => {
                    tracing::error!(%error, "failed to read the studies");
                    changes.look_again();
                }
            }
        }
    }

    /// Returns the studies whose present members have no overview yet, each with the part of the stamp that the members determine.
    async fn studies_without_overview(&self) -> Result<BTreeMap<i64, String>, ServiceError> {
        let all = i64::MIN..=i64::MAX;
        let listed = self.results.texts(&StudyFile::ListItem.name(), &all).await?;
        // Results of a study that is deleted in parts are not stored.
        let deleted = self.store().reader().half_deleted().await?;
        let mut studies: BTreeMap<i64, Vec<(i64, CalibrationState)>> = BTreeMap::new();
        for (study, id, state) in self.store().reader().member_states().await? {
            studies.entry(study).or_default().push((id, state));
        }
        self.results.forget_deleted(|study| studies.contains_key(&study));
        let mut stamps: BTreeMap<i64, String> = BTreeMap::new();
        stamps.extend(
            studies
                .into_iter()
                .map(|(study, members)| (study, members_stamp(members.into_iter()))),
        );
        stamps.retain(|study, stamp| {
            let is_listed = listed
                .get(study)
                .is_some_and(|(list_stamp, _)| is_of_members(list_stamp, stamp));
            !is_listed && !deleted.contains(study)
        });
        Ok(stamps)
    }
}
