//! The source of the measurements, as text.

use shared::experiment::Campaign;

use super::column::{LABEL, labelled};
use result::words::campaign::CampaignWords;

/// Lists the citation, whether the rows were digitised, the methods and the doubts.
pub(super) fn campaign(campaign: &Campaign) -> String {
    let words = CampaignWords::from(campaign);
    let mut text = labelled("data:", &words.citation);
    text.extend(
        words
            .digitised
            .iter()
            .chain(&words.method)
            .map(|line| labelled("", line)),
    );
    text.extend(words.doubts.iter().map(|doubt| labelled("doubt:", doubt)));
    text
}

/// Says in one line that the rows were digitised; empty if they were not.
pub(super) fn digitised(campaign: &Campaign) -> String {
    let digitised = CampaignWords::from(campaign).digitised;
    digitised.map_or_else(String::new, |words| format!("{:LABEL$}{words}\n", "data:"))
}
