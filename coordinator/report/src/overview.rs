//! A study as the page shows it: its members, its error ledger, its flags.

use std::collections::BTreeMap;

use record::Verdict;
use shared::api::{CalibrationState, Progress};

use crate::flag::study::flags_by_calibration;
use crate::story::{AddedEffect, Story, added};
use crate::summary::calibration::CalibrationSummary;
use crate::summary::study::combined_summary;
use crate::summary::study::ledger_summaries;
use crate::summary::study::point_estimate_summaries;
use result::diagnostics::trends::TrendVariable;
use result::error_summary::{CombinedSummary, ErrorSummary};
use result::flag::{Flag, FlagKind};
use result::model_comparison::ModelComparison;
use result::point_estimate::PointEstimate;
use result::study::Study;
use result::study_failure::StudyFailure;
use result::study_member::StudyMember;
use result::table::fixed_sigma::FixedSigma;
use result::words::campaign::CampaignWords;
use result::words::data_channel::DataChannel;

/// A study: what is finished of it, and what is still computed.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StudyOverview {
    /// Its id.
    pub id: i64,
    /// Its name: that of the submitted calibration.
    pub name: String,
    /// The experiment of the submitted calibration.
    pub experiment: i64,
    /// Where its measurements come from; null where the experiment does not say it, and without a finished calibration.
    pub campaign: Option<CampaignWords>,
    /// `finished` where no further step follows, else the state of its first unfinished member.
    pub state: CalibrationState,
    /// Whether it is archived.
    pub archived: bool,
    /// Model of the submitted calibration; null where this version does not understand its job.
    pub model_kind: Option<String>,
    /// The calibration of the current model: the line of the ledger with the most evidence on the newest measurements; null without a line.
    pub current: Option<i64>,
    /// Ids of the members, oldest first.
    pub calibrations: Vec<i64>,
    /// The members, oldest first.
    pub members: Vec<MemberOverview>,
    /// The error ledger: base first, then each extension.
    pub ledger: Vec<CalibrationSummary>,
    /// What the ledger's models predict together; null where nothing is corrected.
    pub combined: Option<CombinedSummary>,
    /// The noise sd of each channel that `rmse_fixed_sigma` is in, by name.
    pub fixed_sigma: BTreeMap<String, FixedSigma>,
    /// Deterministic fits.
    pub point_estimates: Vec<PointEstimate>,
    /// The models that the job compares; null where it has one, and until all are finished.
    pub models: Option<ModelComparison>,
    /// The flags.
    pub flags: Vec<StudyFlag>,
    /// The verdict of the search of the current model, else of the last search; null where none is finished.
    pub verdict: Option<StudyVerdict>,
    /// Why the study failed and what to do; null where no member failed.
    pub failure: Option<StudyFailure>,
}

/// A member of a study with its story.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct MemberOverview {
    /// The member.
    #[serde(flatten)]
    pub member: StudyMember,
    /// What is wrong, what is missing, what to do next; null of a search, and of what is not finished.
    pub story: Option<Story>,
}

/// A flag of a study.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StudyFlag {
    /// The calibration that it is about; null where it compares several.
    pub calibration: Option<i64>,
    /// Its kind.
    #[schema(value_type = String)]
    pub kind: FlagKind,
    /// The channel it is about.
    #[schema(value_type = Option<String>)]
    pub channel: Option<DataChannel>,
    /// The condition it varies with.
    #[schema(value_type = Option<String>)]
    pub against: Option<TrendVariable>,
    /// Probability of the observation if nothing were wrong.
    pub p: Option<f64>,
    /// Its meaning.
    pub text: String,
}

/// The verdict of a search.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StudyVerdict {
    /// The calibration whose model was searched.
    pub calibration: i64,
    /// The verdict.
    pub verdict: Verdict,
    /// The verdict in a sentence, with what it leaves open.
    pub text: String,
    /// What the data do not exclude in place of the effects that were added, and the run that would tell; null where that is nothing.
    pub open: Option<String>,
}

/// A study in a list.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StudyListItem {
    /// Its id.
    pub id: i64,
    /// Its name: that of the submitted calibration.
    pub name: String,
    /// The experiment of the submitted calibration.
    pub experiment: i64,
    /// `finished` where no further step follows, else the state of its first unfinished member.
    pub state: CalibrationState,
    /// Whether it is archived.
    pub archived: bool,
    /// Ids of the members, oldest first.
    pub calibrations: Vec<i64>,
    /// Model of the submitted calibration; null where this version does not understand its job.
    pub model_kind: Option<String>,
    /// Effects and freed parameters of the current model beyond the submitted job's.
    pub effects: Vec<String>,
    /// Errors of the current model; null without a line in the ledger, or while they are computed.
    pub error: Option<ErrorSummary>,
    /// Live figures of the member that is computed; null where none is.
    pub progress: Option<Progress>,
    /// The verdict of the search of the current model, else of the last search; null where none is finished.
    pub verdict: Option<StudyVerdict>,
    /// Why it failed and what to do; null where no member failed.
    pub failure: Option<StudyFailure>,
}

impl StudyOverview {
    /// A study without a finished calibration. There is at least one member.
    pub fn begun(id: i64, experiment: i64, model_kind: Option<String>, members: Vec<StudyMember>) -> Self {
        let unfinished = members.iter().find(|m| m.state != CalibrationState::Finished);
        StudyOverview {
            id,
            name: members.first().map(|m| m.name.clone()).unwrap_or_default(),
            experiment,
            campaign: None,
            state: unfinished.map_or(CalibrationState::Finished, |m| m.state),
            archived: false,
            model_kind,
            current: None,
            failure: StudyFailure::from_members(members.iter()),
            calibrations: members.iter().map(|m| m.id).collect(),
            members: members
                .into_iter()
                .map(|member| MemberOverview { member, story: None })
                .collect(),
            ledger: Vec::new(),
            combined: None,
            fixed_sigma: BTreeMap::new(),
            point_estimates: Vec::new(),
            models: None,
            flags: Vec::new(),
            verdict: None,
        }
    }

    /// Its line in a list, with the live figures of the member that is computed.
    pub fn list_item(&self, progress: Option<Progress>) -> StudyListItem {
        let current = self
            .ledger
            .iter()
            .find(|line| Some(line.calibration) == self.current);
        let member = self
            .members
            .iter()
            .map(|m| &m.member)
            .find(|m| Some(m.id) == self.current);
        StudyListItem {
            id: self.id,
            name: self.name.clone(),
            experiment: self.experiment,
            state: self.state,
            archived: self.archived,
            calibrations: self.calibrations.clone(),
            model_kind: self.model_kind.clone(),
            effects: member.map(|m| m.effects.clone()).unwrap_or_default(),
            error: current.map(|line| line.error.clone()),
            progress,
            verdict: self.verdict.clone(),
            failure: self.failure.clone(),
        }
    }
}

/// The study as the page shows it. Whether it is archived is not known here.
pub fn overview(study: &Study) -> StudyOverview {
    let sigmas = study.fixed_sigmas();
    let current = study.current().map(|calibration| calibration.row.id);
    let kind = study.lead.spec.model.kind.name().to_owned();
    let (id, experiment) = (study.lead.row.study, study.lead.row.experiment);
    StudyOverview {
        campaign: study
            .lead
            .spec
            .experiment
            .campaign
            .as_ref()
            .map(CampaignWords::from),
        state: study.state,
        current,
        ledger: ledger_summaries(study, &sigmas),
        point_estimates: point_estimate_summaries(study, &sigmas),
        combined: combined_summary(study, &sigmas),
        fixed_sigma: sigmas.by_name(),
        models: study.model_comparison(),
        flags: flags_by_calibration(study)
            .into_iter()
            .map(StudyFlag::from)
            .collect(),
        verdict: verdict(study),
        members: members_with_stories(study),
        ..StudyOverview::begun(id, experiment, Some(kind), study.members.clone())
    }
}

/// The verdict of the last search of the current model, else of the last search, with what was left open before.
fn verdict(study: &Study) -> Option<StudyVerdict> {
    let current = study.current();
    let mut rounds = study.rounds.iter().rev();
    let of_current =
        rounds.find(|round| current.is_some_and(|calibration| calibration.row.id == round.calibration));
    let round = of_current.or(study.rounds.last())?;
    let added = current.map_or_else(Vec::new, |calibration| added(study, calibration));
    let questions: Vec<String> = added.iter().filter_map(AddedEffect::open_question).collect();
    let open = (!questions.is_empty()).then(|| questions.join("; "));
    Some(StudyVerdict {
        calibration: round.calibration,
        verdict: round.record.verdict,
        text: [Some(&round.record.text), open.as_ref()]
            .into_iter()
            .flatten()
            .map(|text| text.trim_end_matches('.'))
            .collect::<Vec<_>>()
            .join("; "),
        open,
    })
}

/// The members, each finished calibration with its story.
fn members_with_stories(study: &Study) -> Vec<MemberOverview> {
    let with_story = |member: &StudyMember| {
        let calibration = study.calibrations().find(|finished| finished.row.id == member.id);
        MemberOverview {
            member: member.clone(),
            story: calibration.map(|finished| Story::new(study, finished)),
        }
    };
    study.members.iter().map(with_story).collect()
}

impl From<(Option<i64>, Flag)> for StudyFlag {
    fn from((calibration, flag): (Option<i64>, Flag)) -> Self {
        StudyFlag {
            calibration,
            kind: flag.kind,
            channel: flag.channel,
            against: flag.against,
            p: flag.p,
            text: flag.text,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn a_study_comes_back_from_json_and_its_list_item_says_the_current_model_s_errors() {
        let overview = overview(&fixture::grown());
        let json = serde_json::to_string(&overview).unwrap();
        let read: StudyOverview = serde_json::from_str(&json).unwrap();
        assert_eq!(serde_json::to_string(&read).unwrap(), json);
        let current = overview.current.unwrap();
        let line = overview.ledger.iter().find(|l| l.calibration == current).unwrap();
        let item = overview.list_item(None);
        assert_eq!(item.error.unwrap().fit, line.error.fit);
        assert_eq!(item.verdict.unwrap().calibration, 1);
    }

    #[test]
    fn every_flag_of_a_calibration_names_it() {
        let study = fixture::grown();
        let overview = overview(&study);
        assert_eq!(overview.flags.len(), crate::flag::study::flags(&study).len());
        let of_extension = overview
            .flags
            .iter()
            .filter(|f| f.text.contains("slip_sinkage: "));
        let calibrations: Vec<_> = of_extension.map(|f| f.calibration).collect();
        assert!(!calibrations.is_empty() && calibrations.iter().all(|c| *c == Some(3)));
    }
}
