//! The source of measurements (campaign) in words: citation, method, doubts.

use shared::experiment::Campaign;

/// A campaign in words, as it is shown beside its numbers.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct CampaignWords {
    /// Title, authors, institution, date, DOI and licence.
    pub citation: String,
    /// A note that the rows were read off figures, and which; null if the rig recorded them.
    pub digitised: Option<String>,
    /// Methods of measurement, one sentence each.
    pub method: Vec<String>,
    /// Doubts about the measurements.
    pub doubts: Vec<String>,
}

impl From<&Campaign> for CampaignWords {
    fn from(campaign: &Campaign) -> Self {
        let authors = (!campaign.authors.is_empty()).then(|| campaign.authors.join("; "));
        let doi = campaign.doi.as_ref().map(|doi| format!("doi:{doi}"));
        let licence = campaign.licence.as_ref().map(|id| format!("licence {id}"));
        let parts = [
            Some(campaign.title.clone()),
            authors,
            campaign.institution.clone(),
            campaign.date.clone(),
            doi,
            licence,
        ];
        let source = campaign.source.as_deref().unwrap_or_default();
        let recorded_in = campaign.source.as_ref().filter(|_| !campaign.digitised);
        let method = [
            ("source", recorded_in),
            ("preparation", campaign.preparation.as_ref()),
            ("wheel", campaign.wheel.as_ref()),
            ("slip", campaign.slip.as_ref()),
            ("sinkage", campaign.sinkage.as_ref()),
            ("forces", campaign.forces.as_ref()),
            ("averaging", campaign.averaging.as_ref()),
            ("noise", campaign.noise.as_ref()),
        ];
        let sentence = |(key, text): (&str, Option<&String>)| Some(format!("{key}: {}", text?));
        CampaignWords {
            citation: parts.into_iter().flatten().collect::<Vec<_>>().join(", "),
            digitised: campaign
                .digitised
                .then(|| format!("digitised, not as recorded by the rig: {source}")),
            method: method.into_iter().filter_map(sentence).collect(),
            doubts: campaign.doubts.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn a_campaign_is_cited_with_what_it_states_and_nothing_else() {
        let words = CampaignWords::from(&fixture::campaign());
        assert_eq!(
            words.citation,
            "Wheels in <i>sand</i>, A. Author; B. Author, 2025, doi:10.1000/182, licence CC-BY-4.0"
        );
        assert_eq!(
            words.digitised.unwrap(),
            "digitised, not as recorded by the rig: figure 5"
        );
        assert_eq!(words.method, ["noise: guessed"]);
        assert_eq!(words.doubts, ["few rows"]);
    }

    #[test]
    fn recorded_rows_are_not_called_digitised_and_name_their_source() {
        let recorded = Campaign {
            digitised: false,
            ..fixture::campaign()
        };
        let words = CampaignWords::from(&recorded);
        assert_eq!(words.digitised, None);
        assert_eq!(words.method, ["source: figure 5", "noise: guessed"]);
    }
}
