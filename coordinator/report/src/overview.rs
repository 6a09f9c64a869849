//! Overview of a study for the page: its members, error ledger and flags, and its entry in a list.

use std::collections::BTreeMap;

use record::{StudyDetails, Verdict};
use shared::api::{CalibrationState, Progress};

use crate::flag::study::flags_by_calibration;
use crate::story::{AddedEffect, Story, added, rig_sentences, short_verdict};
use crate::summary::calibration::CalibrationSummary;
use crate::summary::study::{combined_summary, ledger_summaries, point_estimate_summaries, study_rig};
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

/// A study with its finished results and its unfinished members.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StudyOverview {
    /// Id of the study.
    pub id: i64,
    /// Name of the study: that of its details, else that of the submitted calibration.
    pub name: String,
    /// What people say of the study.
    pub details: StudyDetails,
    /// Time of the submission, since the beginning of 1970 \[ms\].
    pub created_ms: Option<i64>,
    /// The experiment of the submitted calibration.
    pub experiment: i64,
    /// Source of the measurements; null if the experiment does not state it, and without a finished calibration.
    pub campaign: Option<CampaignWords>,
    /// `finished` if no further step follows, else the state of the first unfinished member.
    pub state: CalibrationState,
    /// Whether the study is archived.
    pub archived: bool,
    /// Kind of the submitted model; null if this version cannot read its job.
    pub model_kind: Option<String>,
    /// The calibration of the current model, which has the most evidence on the newest measurements; null if the ledger is empty.
    pub current: Option<i64>,
    /// Ids of the members, oldest first.
    pub calibrations: Vec<i64>,
    /// The members, oldest first.
    pub members: Vec<MemberOverview>,
    /// The error ledger: base first, then each extension.
    pub ledger: Vec<CalibrationSummary>,
    /// Errors of the combined predictions of the models; null if no prediction is corrected.
    pub combined: Option<CombinedSummary>,
    /// Noise standard deviation of `rmse_fixed_sigma`, by channel.
    pub fixed_sigma: BTreeMap<String, FixedSigma>,
    /// Results of fits and searches by generations.
    pub point_estimates: Vec<PointEstimate>,
    /// Comparison of the job's models; null if the job has one model, and until all are finished.
    pub models: Option<ModelComparison>,
    /// What the rig did in the fitted runs of the current model, in sentences; empty if no run states a session, a taring or an operator.
    pub rig: Vec<String>,
    /// Flags of the study.
    pub flags: Vec<StudyFlag>,
    /// Verdict of the search of the current model, else of the last search; null if no search is finished.
    pub verdict: Option<StudyVerdict>,
    /// Reason of the failure and advice; null if no member failed.
    pub failure: Option<StudyFailure>,
}

/// A member of a study with its story.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct MemberOverview {
    /// Member of the study.
    #[serde(flatten)]
    pub member: StudyMember,
    /// The story says what is wrong, what is missing and what to do next; null for a search and for an unfinished member.
    pub story: Option<Story>,
}

/// A flag of a study.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StudyFlag {
    /// Calibration that the flag is about; null if it is about several.
    pub calibration: Option<i64>,
    /// Kind of the flag.
    #[schema(value_type = String)]
    pub kind: FlagKind,
    /// Channel that the flag is about.
    #[schema(value_type = Option<String>)]
    pub channel: Option<DataChannel>,
    /// Condition that the residuals follow.
    #[schema(value_type = Option<String>)]
    pub against: Option<TrendVariable>,
    /// Probability of the observation if nothing were wrong.
    pub p: Option<f64>,
    /// Meaning of the flag in words.
    pub text: String,
}

/// The verdict of a search.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StudyVerdict {
    /// The calibration whose model was searched.
    pub calibration: i64,
    /// The verdict.
    pub verdict: Verdict,
    /// The verdict in a few words, with the names of what is missing and without the open questions.
    pub short: String,
    /// The verdict and the open questions in a sentence.
    pub text: String,
    /// Alternatives to the added effects that the data do not exclude, with the run that would distinguish them; null if there are none.
    pub open: Option<String>,
}

/// A study in a list.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StudyListItem {
    /// Id of the study.
    pub id: i64,
    /// Name of the study: that of its details, else that of the submitted calibration.
    pub name: String,
    /// What people say of the study.
    pub details: StudyDetails,
    /// Time of the submission, since the beginning of 1970 \[ms\].
    pub created_ms: Option<i64>,
    /// The experiment of the submitted calibration.
    pub experiment: i64,
    /// `finished` if no further step follows, else the state of the first unfinished member.
    pub state: CalibrationState,
    /// Whether the study is archived.
    pub archived: bool,
    /// Ids of the members, oldest first.
    pub calibrations: Vec<i64>,
    /// Kind of the submitted model; null if this version cannot read its job.
    pub model_kind: Option<String>,
    /// Effects and freed parameters of the current model that the submitted job does not have.
    pub effects: Vec<String>,
    /// Errors of the current model; null if the ledger is empty, or while they are computed.
    pub error: Option<ErrorSummary>,
    /// Progress of the running member; null if none is running.
    pub progress: Option<Progress>,
    /// Verdict of the search of the current model, else of the last search; null if no search is finished.
    pub verdict: Option<StudyVerdict>,
    /// A sentence on the comparison of the job's models; null if the job has one model, and until all are finished.
    pub models: Option<String>,
    /// Reason of the failure and advice; null if no member failed.
    pub failure: Option<StudyFailure>,
}

impl StudyOverview {
    /// Describes a study without a finished calibration. It has at least one member.
    pub fn begun(id: i64, experiment: i64, model_kind: Option<String>, members: Vec<StudyMember>) -> Self {
        let unfinished = members.iter().find(|m| m.state != CalibrationState::Finished);
        StudyOverview {
            id,
            name: members.first().map(|m| m.name.clone()).unwrap_or_default(),
            details: StudyDetails::default(),
            created_ms: None,
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
            rig: Vec::new(),
            flags: Vec::new(),
            verdict: None,
        }
    }

    /// Takes in what people say of the study, which is not stored with its results.
    pub fn describe(&mut self, details: StudyDetails) {
        if let Some(name) = &details.name {
            self.name.clone_from(name);
        }
        self.details = details;
    }

    /// Returns the line of the study in a list, with the progress of the running member.
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
            details: self.details.clone(),
            created_ms: self.created_ms,
            experiment: self.experiment,
            state: self.state,
            archived: self.archived,
            calibrations: self.calibrations.clone(),
            model_kind: self.model_kind.clone(),
            effects: member.map(|m| m.effects.clone()).unwrap_or_default(),
            error: current.map(|line| line.error.clone()),
            progress,
            verdict: self.verdict.clone(),
            models: self.models.as_ref().map(|comparison| comparison.text.clone()),
            failure: self.failure.clone(),
        }
    }
}

impl StudyListItem {
    /// Takes in what people say of the study, which is not stored with its results.
    pub fn describe(&mut self, details: StudyDetails) {
        if let Some(name) = &details.name {
            self.name.clone_from(name);
        }
        self.details = details;
    }
}

/// Describes a study as the page shows it. The caller sets `archived` and the details, which are not stored with the results.
pub fn overview(study: &Study) -> StudyOverview {
    let sigmas = study.fixed_sigmas();
    let current = study.current().map(|calibration| calibration.row.id);
    let kind = study.lead.spec.model.kind.name().to_owned();
    let (id, experiment) = (study.lead.row.study, study.lead.row.experiment);
    StudyOverview {
        created_ms: Some(study.lead.row.created_ms),
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
        rig: rig_sentences(&study_rig(study).unwrap_or_default()),
        flags: flags_by_calibration(study)
            .into_iter()
            .map(StudyFlag::from)
            .collect(),
        verdict: verdict(study),
        members: members_with_stories(study),
        ..StudyOverview::begun(id, experiment, Some(kind), study.members.clone())
    }
}

/// Returns the verdict of the last search of the current model, else of the last search, with the questions that earlier searches left
/// open.
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
        short: short_verdict(&round.record, &added),
        text: [Some(&round.record.text), open.as_ref()]
            .into_iter()
            .flatten()
            .map(|text| text.trim_end_matches('.'))
            .collect::<Vec<_>>()
            .join("; "),
        open,
    })
}

/// Returns the members with the story of each finished calibration.
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
