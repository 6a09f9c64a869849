//! The source of the measurements, as text.

use shared::experiment::Campaign;

use super::column::labelled;
use result::words::campaign::CampaignWords;

/// Citation, whether the rows were digitised, how they were measured, doubts.
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

/// Says that the rows were digitised; empty if they were not.
pub(super) fn digitised(campaign: &Campaign) -> String {
    let digitised = CampaignWords::from(campaign).digitised;
    digitised.map_or_else(String::new, |words| labelled("data:", &words))
}
