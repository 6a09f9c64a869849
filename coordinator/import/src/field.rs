//! The columns of runs.csv that an import fills.

use serde::Serialize;
use shared::channel::Channel;

use crate::unit::Quantity;

/// The content of a column of runs.csv.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Text that names something.
    Name,
    /// A whole number with this minimum.
    Whole(i64),
    /// Use of a run: `fit` or `holdout`.
    Use,
    /// A quantity; the column is in its SI unit, angles in degrees.
    Measured(Quantity),
}

/// The use of a row, by a word of one of its columns.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Serialize,
    utoipa::ToSchema,
    strum::EnumString,
    strum::IntoStaticStr,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum RowUse {
    /// The run is fitted.
    Fit,
    /// The run is not fitted, and judges the prediction.
    Holdout,
    /// The row is no run, and is left out.
    Skip,
}

impl RowUse {
    /// Returns the word in a map; `fit` and `holdout` are also words of runs.csv.
    pub(crate) fn name(self) -> &'static str {
        self.into()
    }
}

/// A column of runs.csv.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Field {
    pub(crate) name: String,
    /// Description for users.
    pub(crate) words: String,
    pub(crate) kind: Kind,
    pub(crate) is_needed: bool,
    /// Words with which the title of the column begins, or which it contains, in lower case.
    pub(crate) titles: Vec<String>,
}

impl Field {
    /// Returns the SI value of one of the column's unit.
    pub(crate) fn si_per_unit(&self) -> f64 {
        match self.kind {
            Kind::Measured(Quantity::Angle) => std::f64::consts::PI / 180.0,
            _ => 1.0,
        }
    }

    pub(crate) fn quantity(&self) -> Option<Quantity> {
        match self.kind {
            Kind::Measured(quantity) => Some(quantity),
            _ => None,
        }
    }
}

/// Name, description, kind, whether it is needed, titles.
type Entry = (&'static str, &'static str, Kind, bool, &'static [&'static str]);

const CONDITIONS: [Entry; 8] = [
    (
        "run",
        "run",
        Kind::Name,
        false,
        &[
            "run", "test", "versuch", "id", "nr", "no", "name", "lauf", "trial",
        ],
    ),
    ("wheel", "wheel", Kind::Name, true, &["wheel", "rad"]),
    ("soil", "soil", Kind::Name, true, &["soil", "sand", "boden"]),
    (
        "slip",
        "slip",
        Kind::Measured(Quantity::Ratio),
        true,
        &["slip", "schlupf", "slip ratio"],
    ),
    (
        "wheel_load_n",
        "wheel load",
        Kind::Measured(Quantity::Force),
        true,
        &[
            "load",
            "wheel load",
            "radlast",
            "last",
            "vertical load",
            "normal load",
            "normal force",
            "normalkraft",
        ],
    ),
    (
        "sled_speed_m_s",
        "sled speed",
        Kind::Measured(Quantity::Speed),
        true,
        &[
            "speed",
            "sled speed",
            "velocity",
            "geschwindigkeit",
            "fahrgeschwindigkeit",
            "vorschub",
            "v",
            "vx",
        ],
    ),
    (
        "slip_angle_deg",
        "slip angle",
        Kind::Measured(Quantity::Angle),
        false,
        &[
            "slip angle",
            "angle",
            "schraeglaufwinkel",
            "winkel",
            "steering angle",
            "beta",
        ],
    ),
    ("pass", "pass", Kind::Whole(1), false, &["pass", "ueberfahrt"]),
];

const OTHERS: [Entry; 7] = [
    (
        "order",
        "order in time",
        Kind::Whole(i32::MIN as i64),
        false,
        &["order", "reihenfolge"],
    ),
    (
        "prepared",
        "soil preparation",
        Kind::Name,
        false,
        &["prepared", "preparation", "aufbereitung"],
    ),
    (
        "session",
        "session (day or mounting)",
        Kind::Name,
        false,
        &["session", "day", "mounting", "sitzung", "tag", "messtag"],
    ),
    (
        "zero",
        "taring of the sensors",
        Kind::Name,
        false,
        &["zero", "tare", "taring", "nullung", "tara"],
    ),
    (
        "operator",
        "operator",
        Kind::Name,
        false,
        &["operator", "bediener", "pruefer"],
    ),
    ("history", "recording", Kind::Name, false, &["history"]),
    (
        "use",
        "use (fit or holdout)",
        Kind::Use,
        false,
        &[
            "use",
            "verwendung",
            "holdout",
            "held out",
            "kontrolle",
            "validation",
            "validierung",
        ],
    ),
];

/// Titles of a channel's column, in the order of [`Channel::ALL`].
const CHANNEL_TITLES: [&[&str]; 4] = [
    &["drawbar pull", "drawbar", "pull", "zugkraft", "dp"],
    &["torque", "wheel torque", "drehmoment", "moment", "antriebsmoment"],
    &["sinkage", "depth", "einsinkung", "einsinktiefe", "eindringtiefe"],
    &[
        "lateral force",
        "lateral",
        "side force",
        "seitenkraft",
        "querkraft",
    ],
];

/// Returns the name and description of each column of runs.csv that a map may fill, in the order of the file.
pub fn columns() -> impl Iterator<Item = (String, String)> {
    fields().into_iter().map(|field| (field.name, field.words))
}

/// Returns the columns of runs.csv that a map may fill, in the order of the file.
pub(crate) fn fields() -> Vec<Field> {
    let entry = |&(name, words, kind, is_needed, titles): &Entry| Field {
        name: name.into(),
        words: words.into(),
        kind,
        is_needed,
        titles: titles.iter().map(|&title| title.to_owned()).collect(),
    };
    let quantity = |channel| match channel {
        Channel::DrawbarPull | Channel::LateralForce => Quantity::Force,
        Channel::Torque => Quantity::Torque,
        Channel::Sinkage => Quantity::Length,
    };
    let channel = |channel: Channel| Field {
        name: channel.column().into(),
        words: channel.words().into(),
        kind: Kind::Measured(quantity(channel)),
        is_needed: false,
        titles: CHANNEL_TITLES[channel.index()]
            .iter()
            .map(|&title| title.to_owned())
            .collect(),
    };
    let sd = |channel: Channel| {
        let about = |title: &&str| {
            ["sd", "std", "sigma", "stdabw"]
                .map(|word| [format!("{title} {word}"), format!("{word} {title}")])
        };
        Field {
            name: format!("{}_sd", channel.column()),
            words: format!("sd of the {}", channel.words()),
            kind: Kind::Measured(quantity(channel)),
            is_needed: false,
            titles: CHANNEL_TITLES[channel.index()]
                .iter()
                .flat_map(about)
                .flatten()
                .collect(),
        }
    };
    let channels = Channel::ALL.map(channel).into_iter().chain(Channel::ALL.map(sd));
    CONDITIONS
        .iter()
        .map(entry)
        .chain(channels)
        .chain(OTHERS.iter().map(entry))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_is_a_column_of_runs_csv() {
        // A file with all these columns is accepted without a complaint.
        let header: Vec<String> = fields().into_iter().map(|field| field.name).collect();
        let files = shared::file::FileSet {
            toml: "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.1\nwidth_m = 0.1\n[soil.s]\n".into(),
            files: [("runs.csv".to_owned(), format!("{}\n", header.join(",")))].into(),
        };
        let error = shared::experiment::Experiment::parse("experiment.toml", &files).unwrap_err();
        assert_eq!(error.to_string(), "runs.csv: the file has no test run");
    }
}
