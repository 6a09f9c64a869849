//! The origin of an experiment's measurements: `[campaign]`. It is stored and shown; nothing is computed from it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::check::ValueError;

/// A measuring campaign as its publication describes it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Campaign {
    /// Title: the subject of the measurements.
    pub title: String,
    /// Names of those who measured.
    #[serde(default)]
    pub authors: Vec<String>,
    /// Institution that measured.
    pub institution: Option<String>,
    /// Date of the measurements, else of publication: `2025`, `2025-04` or `2025-04-30`.
    pub date: Option<String>,
    /// Licence of the rows in words, or an SPDX identifier; for digitised rows, the owner of each part.
    pub licence: Option<String>,
    /// DOI of the publication, without a resolver.
    pub doi: Option<String>,
    /// The file, table or figure that the rows come from, with its version.
    pub source: Option<String>,
    /// True if the rows were read off figures; results then call them digitised.
    #[serde(default)]
    pub digitised: bool,
    /// Preparation of the soil before a run.
    pub preparation: Option<String>,
    /// Material and surface of the wheels.
    pub wheel: Option<String>,
    /// Method of setting or measuring slip, with its radius.
    pub slip: Option<String>,
    /// Method of measuring sinkage, with its zero.
    pub sinkage: Option<String>,
    /// Method of measuring forces and torque: sensor, sampling, tare, signs as recorded.
    pub forces: Option<String>,
    /// The averaged part of a run.
    pub averaging: Option<String>,
    /// Origin of the standard deviations under `[noise]`.
    pub noise: Option<String>,
    /// Uncertainties of the measurements and of this description.
    #[serde(default)]
    pub doubts: Vec<String>,
}

impl Campaign {
    /// Validates the campaign and joins each text into one line.
    ///
    /// Refused are a blank text, a control character, a malformed date or DOI, digitised rows without a source. Checked by
    /// `tests::a_wrong_campaign_is_refused_with_its_mistake`.
    pub(super) fn checked(mut self) -> Result<Campaign, ValueError> {
        self.title = text("title", &self.title)?;
        for (key, list) in [("authors", &mut self.authors), ("doubts", &mut self.doubts)] {
            for entry in list {
                *entry = text(key, entry)?;
            }
        }
        for (key, value) in [
            ("institution", &mut self.institution),
            ("date", &mut self.date),
            ("licence", &mut self.licence),
            ("doi", &mut self.doi),
            ("source", &mut self.source),
            ("preparation", &mut self.preparation),
            ("wheel", &mut self.wheel),
            ("slip", &mut self.slip),
            ("sinkage", &mut self.sinkage),
            ("forces", &mut self.forces),
            ("averaging", &mut self.averaging),
            ("noise", &mut self.noise),
        ] {
            if let Some(value) = value {
                *value = text(key, value)?;
            }
        }
        if let Some(date) = self.date.as_deref().filter(|date| !is_date(date)) {
            return Err(ValueError::Rule(format!(
                "date \"{date}\" must be a year, YYYY-MM or YYYY-MM-DD"
            )));
        }
        if let Some(doi) = self.doi.as_deref().filter(|doi| !is_doi(doi)) {
            return Err(ValueError::Rule(format!(
                "doi \"{doi}\" must be of the form 10.1016/j.jterra.2010.08.001, without https://doi.org/"
            )));
        }
        if self.digitised && self.source.is_none() {
            return Err(ValueError::Rule(
                "digitised = true needs source: the figures that the rows were read off, and who read them"
                    .into(),
            ));
        }
        Ok(self)
    }
}

/// Joins a text into one line.
fn text(key: &str, text: &str) -> Result<String, ValueError> {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.is_empty() {
        return Err(ValueError::Blank(key.to_owned()));
    }
    if line.contains(char::is_control) {
        return Err(ValueError::Rule(format!(
            "{key} \"{line}\" has a control character"
        )));
    }
    Ok(line)
}

/// Returns whether the text is a year, a month or a day.
fn is_date(text: &str) -> bool {
    let parts: Vec<&str> = text.split('-').collect();
    let within = |part: &str, digits: usize, max: u32| {
        part.len() == digits
            && part.bytes().all(|b| b.is_ascii_digit())
            && part.parse().is_ok_and(|number: u32| (1..=max).contains(&number))
    };
    let bounds = [(4, 9999), (2, 12), (2, 31)];
    parts.len() <= bounds.len()
        && parts
            .iter()
            .zip(bounds)
            .all(|(part, (digits, max))| within(part, digits, max))
}

/// Returns whether the text is a registrant's prefix and a suffix.
fn is_doi(text: &str) -> bool {
    let suffix = text.strip_prefix("10.").and_then(|rest| rest.split_once('/'));
    suffix.is_some_and(|(registrant, suffix)| {
        !registrant.is_empty()
            && registrant.bytes().all(|b| b.is_ascii_digit() || b == b'.')
            && !suffix.is_empty()
            && !suffix.contains(' ')
    })
}

#[cfg(test)]
mod tests {
    use super::Campaign;
    use crate::case_table::cases;
    use crate::file::parse_toml;

    /// Reads a campaign with these lines.
    fn read(lines: &str) -> Result<Campaign, String> {
        let campaign: Campaign = parse_toml("campaign.toml", lines).map_err(|e| e.to_string())?;
        campaign.checked().map_err(|e| e.to_string())
    }

    #[test]
    fn texts_of_several_lines_are_one_line() {
        let campaign = read("title = \"\"\"\nWheels\n  in sand\"\"\"\ndoubts = [\"a\\nb\"]").unwrap();
        assert_eq!(campaign.title, "Wheels in sand");
        assert_eq!(campaign.doubts, ["a b"]);
        assert!(!campaign.digitised && campaign.authors.is_empty() && campaign.doi.is_none());
    }

    #[test]
    fn a_wrong_campaign_is_refused_with_its_mistake() {
        assert_eq!(read("title = \" \"").unwrap_err(), "title is blank");
        for (line, message) in cases(
            r#"
            authors = [""] => authors is blank
            noise = "\u001b[31m" => noise "ESC[31m" has a control character
            date = "30.4.2025" => date "30.4.2025" must be a year, YYYY-MM or YYYY-MM-DD
            date = "2025-13" => date "2025-13" must be a year, YYYY-MM or YYYY-MM-DD
            doi = "https://doi.org/10.1/x" => doi "https://doi.org/10.1/x" must be of the form 10.1016/j.jterra.2010.08.001, without https://doi.org/
            digitised = true => digitised = true needs source: the figures that the rows were read off, and who read them"#,
        ) {
            let refused = read(&format!("title = \"a\"\n{line}")).unwrap_err();
            assert_eq!(refused.replace('\u{1b}', "ESC"), message);
        }
        let unknown = read("title = \"a\"\nlicense = \"MIT\"").unwrap_err();
        let expected = "unknown key \"license\"";
        assert!(
            unknown.contains(expected) && unknown.contains("licence"),
            "{unknown}"
        );
    }
}
