//! Where the measurements of an experiment come from: `[campaign]`. Nothing is computed from it; it is kept and shown.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::check::ValueError;

/// A measuring campaign as its publication describes it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Campaign {
    /// What was measured, as a title.
    pub title: String,
    /// Who measured.
    #[serde(default)]
    pub authors: Vec<String>,
    /// Where.
    pub institution: Option<String>,
    /// When it was measured, else published: `2025`, `2025-04` or `2025-04-30`.
    pub date: Option<String>,
    /// Licence of the rows in words: an SPDX identifier where one says it all; of digitised rows, who owns what.
    pub licence: Option<String>,
    /// DOI of the publication, without a resolver.
    pub doi: Option<String>,
    /// The file, table or figure that the rows come from, with its version.
    pub source: Option<String>,
    /// Whether the rows were read off figures; they are then called digitised wherever they are shown.
    #[serde(default)]
    pub digitised: bool,
    /// How the soil was prepared before a run.
    pub preparation: Option<String>,
    /// Material and surface of the wheels.
    pub wheel: Option<String>,
    /// How slip was set or measured, and with which radius.
    pub slip: Option<String>,
    /// How sinkage was measured, and from which zero.
    pub sinkage: Option<String>,
    /// How forces and torque were measured: sensor, sampling, tare, signs as they were recorded.
    pub forces: Option<String>,
    /// Which part of a run was averaged.
    pub averaging: Option<String>,
    /// How the standard deviations under `[noise]` were found.
    pub noise: Option<String>,
    /// What is uncertain about all this.
    #[serde(default)]
    pub doubts: Vec<String>,
}

impl Campaign {
    /// The same with its texts in one line each.
    ///
    /// # Errors
    /// A blank text, a control character, a date or a DOI of another form, digitised rows without a source.
    /// Checked by `tests::a_wrong_campaign_says_what_is_wrong`.
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

/// A text in one line.
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

/// A year, or a month or a day of it.
fn is_date(text: &str) -> bool {
    let parts: Vec<&str> = text.split('-').collect();
    let within = |part: &str, digits: usize, most: u32| {
        part.len() == digits
            && part.bytes().all(|b| b.is_ascii_digit())
            && part.parse().is_ok_and(|number: u32| (1..=most).contains(&number))
    };
    let bounds = [(4, 9999), (2, 12), (2, 31)];
    parts.len() <= bounds.len()
        && parts
            .iter()
            .zip(bounds)
            .all(|(part, (digits, most))| within(part, digits, most))
}

/// A registrant's prefix and a suffix.
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
    fn a_wrong_campaign_says_what_is_wrong() {
        for (lines, message) in [
            ("title = \" \"", "title is blank"),
            ("title = \"a\"\nauthors = [\"\"]", "authors is blank"),
            (
                "title = \"a\"\nnoise = \"\\u001b[31m\"",
                "noise \"\u{1b}[31m\" has a control character",
            ),
            (
                "title = \"a\"\ndate = \"30.4.2025\"",
                "date \"30.4.2025\" must be a year, YYYY-MM or YYYY-MM-DD",
            ),
            (
                "title = \"a\"\ndate = \"2025-13\"",
                "date \"2025-13\" must be a year, YYYY-MM or YYYY-MM-DD",
            ),
            (
                "title = \"a\"\ndoi = \"https://doi.org/10.1/x\"",
                "doi \"https://doi.org/10.1/x\" must be of the form 10.1016/j.jterra.2010.08.001, without https://doi.org/",
            ),
            (
                "title = \"a\"\ndigitised = true",
                "digitised = true needs source: the figures that the rows were read off, and who read them",
            ),
        ] {
            assert_eq!(read(lines).unwrap_err(), message);
        }
        let unknown = read("title = \"a\"\nlicense = \"MIT\"").unwrap_err();
        assert!(
            unknown.contains("unknown key \"license\"") && unknown.contains("licence"),
            "{unknown}"
        );
    }
}
