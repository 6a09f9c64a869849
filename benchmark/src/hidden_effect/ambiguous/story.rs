//! The story of one campaign, continued by one strategy until the search makes a claim.

use super::campaign::{Answer, Campaign};
use super::strategy::Strategy;
use crate::error::StudyError;

/// The course of a campaign.
pub struct Story {
    /// The number of further runs after which the class of the truth was named.
    pub right_after: Option<usize>,
    /// Whether something else was named.
    pub is_wrong: bool,
    pub line: String,
}

impl Story {
    /// Continues a campaign after its first search.
    pub fn new(strategy: Strategy, campaign: &Campaign, first: &Answer) -> Result<Self, StudyError> {
        let mut campaign = campaign.clone();
        let mut story = Self {
            right_after: None,
            is_wrong: false,
            line: String::new(),
        };
        let mut order = strategy.order(&campaign, &first.possible, first);
        for count in strategy.counts() {
            let mut made = 0;
            for condition in order {
                if made == strategy.at_once() {
                    break;
                }
                if campaign.measure(&condition)? {
                    made += 1;
                    story.line += &format!(
                        " -> slip {} load {} N sled {:.4} m/s",
                        condition.slip, condition.wheel_load_n, condition.sled_speed_m_s
                    );
                }
            }
            if made == 0 {
                break;
            }
            let answer = campaign.search()?;
            story.line += &format!(" {answer}");
            if let Some(is_right) = answer.is_right() {
                story.right_after = is_right.then_some(count);
                story.is_wrong = !is_right;
                break;
            }
            order = strategy.order(&campaign, &first.possible, &answer);
        }
        Ok(story)
    }
}
