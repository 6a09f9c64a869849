//! The failure of a study: its reason, and advice on what to do.

use shared::api::CalibrationState;

use crate::study_member::{Rejections, StudyMember};

/// The failed member of a study.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StudyFailure {
    /// Id of the failed calibration.
    pub calibration: i64,
    /// Reason, with the counts of rejections.
    pub reason: String,
    /// Advice on what to do.
    pub advice: String,
    /// Reason and advice in a sentence.
    pub text: String,
}

impl StudyFailure {
    /// Describes the failure of the first failed member; `None` if none failed.
    pub fn from_members<'a>(mut members: impl Iterator<Item = &'a StudyMember>) -> Option<StudyFailure> {
        let failed = members.find(|member| member.state == CalibrationState::Failed)?;
        let message = failed.message.as_deref().unwrap_or("no reason is stored");
        let rejections = failed.rejections.as_ref();
        let reason = match rejections.and_then(Rejections::words) {
            Some(words) => format!("{message}: {words}"),
            None => message.to_owned(),
        };
        let advice = advice(rejections.and_then(Rejections::usual));
        Some(StudyFailure {
            calibration: failed.id,
            text: format!("calibration {} failed: {reason}; {advice}", failed.name),
            reason,
            advice: advice.to_owned(),
        })
    }
}

/// Returns advice for a study whose model rejected most parameter vectors for the reason `kind`.
fn advice(kind: Option<&str>) -> &'static str {
    match kind {
        Some("no_support") => {
            "check wheel loads, radius and width, or move the priors to a soil that carries the wheel (a larger log10_p_ref), and submit the corrected job as a new study"
        }
        Some("invalid_parameter") => {
            "give the priors bounds within which the model is defined, and submit the corrected job as a new study"
        }
        Some("formula") => {
            "correct the formula of the effect, or the priors of its parameters, and submit the corrected job as a new study"
        }
        Some("protocol") => {
            "check the travel and the sampling of the runs, and submit the corrected job as a new study"
        }
        Some("fault") => "read what the workers logged, and submit the job again",
        Some("model" | "model_error" | "time_limit") => {
            "read what the model's program says of these parameters, or narrow the priors, and submit the corrected job as a new study"
        }
        Some(_) => {
            "narrow the priors to parameters at which the model has a solution, and submit the corrected job as a new study"
        }
        None => "correct the job or the experiment accordingly, and submit it as a new study",
    }
}

#[cfg(test)]
mod tests {
    use record::Role;

    use super::*;

    fn member(state: CalibrationState, kinds: &[(&str, u64)]) -> StudyMember {
        StudyMember {
            id: 4,
            name: "sand".into(),
            state,
            kind: Role::Sample,
            effects: Vec::new(),
            searches: None,
            message: Some("all 1000 prior draws were rejected by the model".into()),
            rejections: Some(Rejections {
                kinds: kinds.iter().map(|&(kind, count)| (kind.into(), count)).collect(),
                first: Some("the soil carries at most 80 N of the 140 N wheel load".into()),
            }),
        }
    }

    #[test]
    fn a_failure_says_what_the_model_rejected_and_what_to_do() {
        let failed = member(
            CalibrationState::Failed,
            &[("not_finite", 10), ("no_support", 990)],
        );
        let failure = StudyFailure::from_members([&failed].into_iter()).unwrap();
        assert_eq!(
            failure.reason,
            "all 1000 prior draws were rejected by the model: the soil does not carry the load (no_support, 990) and a value is not finite (not_finite, 10), such as \"the soil carries at most 80 N of the 140 N wheel load\""
        );
        assert!(failure.advice.starts_with("check wheel loads"), "{failure:?}");
        assert!(
            failure.text.starts_with("calibration sand failed: all 1000"),
            "{failure:?}"
        );
    }

    #[test]
    fn what_has_not_failed_has_no_failure_and_what_failed_otherwise_has_its_message() {
        for &state in CalibrationState::ALL
            .iter()
            .filter(|state| **state != CalibrationState::Failed)
        {
            assert_eq!(
                StudyFailure::from_members([&member(state, &[])].into_iter()),
                None,
                "{state:?}"
            );
        }
        let mut failed = member(CalibrationState::Failed, &[]);
        failed.rejections = None;
        failed.message = Some("tempering exponent 0.1 cannot grow".into());
        let failure = StudyFailure::from_members([&failed].into_iter()).unwrap();
        assert_eq!(failure.reason, "tempering exponent 0.1 cannot grow");
        assert!(failure.advice.starts_with("correct the job"), "{failure:?}");
    }
}
