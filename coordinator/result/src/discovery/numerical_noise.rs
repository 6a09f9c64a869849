//! A sentence on the numerical noise of the model that a search measured.

use record::Discovery;
use shared::channel::Channel;

use crate::words::data_channel::ShownUnit;

/// Returns a sentence on the scatter of each channel and the settings that lower it; `None` if the scatter is negligible.
pub fn numerical_noise(record: &Discovery) -> Option<String> {
    let size = |channel: &Channel| {
        let sd = *record.numerical_noise.get(channel.column())?;
        Some(format!(
            "{} {}",
            channel.words(),
            ShownUnit::new(*channel).size(sd)
        ))
    };
    let sizes: Vec<String> = Channel::ALL.iter().filter_map(size).collect();
    (!sizes.is_empty()).then(|| {
        format!(
            "the model itself scatters with its parameters, which counts as noise here: {}; smaller dem_spacing_m and travel_step_m lower it",
            sizes.join(", ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scatter_is_said_in_the_units_of_the_tables() {
        let mut record: Discovery =
            serde_json::from_str(include_str!("../../../record/discovery.json")).unwrap();
        assert_eq!(numerical_noise(&record), None);
        record.numerical_noise = [
            ("drawbar_pull_n".to_owned(), 1.5),
            ("sinkage_m".to_owned(), 1.2e-4),
        ]
        .into();
        let sentence = numerical_noise(&record).unwrap();
        assert!(
            sentence.contains("drawbar pull 1.5 N, sinkage 0.12 mm;"),
            "{sentence}"
        );
    }
}
