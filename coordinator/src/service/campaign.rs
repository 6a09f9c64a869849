//! The campaigns that are followed: the last answer of each, and those who wait for the next one.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use prediction::follow::Followed;
use tokio::sync::watch;

/// Number of campaigns whose last answer is remembered.
const MAX_CAMPAIGNS: usize = 100;

/// The answers of a campaign as they come; `None` before the first one.
pub(super) type Answers = watch::Receiver<Option<Arc<Followed>>>;

/// The other end of [`Answers`].
type Campaign = watch::Sender<Option<Arc<Followed>>>;

/// The last answer of each campaign by its calibration, in memory alone.
#[derive(Debug, Clone, Default)]
pub(super) struct Campaigns(Arc<Mutex<BTreeMap<i64, Campaign>>>);

impl Campaigns {
    /// Tells an answer to those who wait, and remembers it.
    pub(super) fn tell(&self, answer: Followed) {
        let id = answer.calibration;
        self.with(id, |sender| sender.send_replace(Some(Arc::new(answer))));
    }

    /// Returns the answers of a calibration's campaign from the last one on.
    pub(super) fn answers(&self, id: i64) -> Answers {
        self.with(id, watch::Sender::subscribe)
    }

    fn with<T>(&self, id: i64, act: impl FnOnce(&Campaign) -> T) -> T {
        let mut campaigns = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if campaigns.len() >= MAX_CAMPAIGNS {
            // Nobody waits for these.
            campaigns.retain(|other, sender| *other == id || sender.receiver_count() > 0);
        }
        act(campaigns.entry(id).or_default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(calibration: i64, run: &str) -> Followed {
        serde_json::from_value(serde_json::json!({
            "calibration": calibration, "runs": [run], "rows": "", "expectations": [], "models": [], "parameters": [], "verdict": "",
            "search": {"evaluations": 0, "max_evaluations": 1, "is_at_bound": false, "leaders": []}, "next_runs": [], "stop": null,
        }))
        .expect("an answer")
    }

    #[tokio::test]
    async fn who_comes_later_has_the_last_answer_and_the_next_ones() {
        let campaigns = Campaigns::default();
        let mut early = campaigns.answers(1);
        assert!(early.borrow_and_update().is_none());
        campaigns.tell(answer(1, "a"));
        early.changed().await.unwrap();
        let mut late = campaigns.answers(1);
        for answers in [&mut early, &mut late] {
            assert_eq!(answers.borrow_and_update().as_ref().unwrap().runs, ["a"]);
        }
        campaigns.tell(answer(2, "other"));
        assert!(!late.has_changed().unwrap());
    }

    #[test]
    fn campaigns_that_nobody_waits_for_are_forgotten_where_there_are_many() {
        let campaigns = Campaigns::default();
        let watched = campaigns.answers(0);
        for id in 0..=MAX_CAMPAIGNS as i64 {
            campaigns.tell(answer(id, "a"));
        }
        assert!(watched.borrow().is_some());
        let count = campaigns.0.lock().unwrap().len();
        assert!((2..MAX_CAMPAIGNS).contains(&count), "{count}");
    }
}
