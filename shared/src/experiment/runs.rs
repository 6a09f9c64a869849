//! The rows of `runs.csv`.

use std::collections::BTreeMap;

use super::settings::Soil;
use super::table::{self, Columns, Row};
use super::wheel::Wheel;
use crate::channel::Channel;
use crate::file::FileError;

/// One run of the rig: its condition and what was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct TestRun {
    /// Name, unique in the experiment.
    pub name: String,
    /// Which wheel.
    pub wheel: String,
    /// Which soil.
    pub soil: String,
    /// `(omega R_s - v) / max(omega R_s, v)`, in [-1, 1); `R_s` is the rig's radius.
    pub slip: f64,
    /// Vertical load on the wheel `[N]`.
    pub wheel_load_n: f64,
    /// Sled speed along travel `[m/s]`.
    pub sled_speed_m_s: f64,
    /// From wheel heading to travel `[deg]`.
    pub slip_angle_deg: f64,
    /// How often the wheel passes; the last pass is measured.
    pub pass: u32,
    /// Measured value by channel [channel's unit]; `None` = unmeasured.
    pub measured: [Option<f64>; 4],
    /// Standard deviation that wins over the experiment's, by channel.
    pub sd: [Option<f64>; 4],
    /// Fitted, or kept to judge the fit.
    pub usage: RunUse,
}

/// What a run is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunUse {
    /// Enters the likelihood.
    Fit,
    /// Never fitted; scores the prediction.
    Holdout,
}

impl RunUse {
    /// Word in the column `use` and in results.
    pub fn name(self) -> &'static str {
        match self {
            RunUse::Fit => "fit",
            RunUse::Holdout => "holdout",
        }
    }
}

/// The columns of `runs.csv` that state a run's condition, in the order of the file.
pub const CONDITION_COLUMNS: [&str; 8] = [
    "run",
    "wheel",
    "soil",
    "slip",
    "wheel_load_n",
    "sled_speed_m_s",
    "slip_angle_deg",
    "pass",
];
const REQUIRED: usize = 6;

/// Parses `runs.csv` against the wheels and soils of its experiment.
pub(super) fn parse(
    file: &str,
    text: &str,
    wheels: &BTreeMap<String, Wheel>,
    soils: &BTreeMap<String, Soil>,
) -> Result<Vec<TestRun>, FileError> {
    let sd_columns = Channel::ALL.map(|c| format!("{}_sd", c.column()));
    let mut known: Vec<&str> = CONDITION_COLUMNS.to_vec();
    known.extend(Channel::ALL.iter().map(|c| c.column()));
    known.extend(sd_columns.iter().map(String::as_str));
    known.push("use");
    let columns = Columns {
        known,
        required: &CONDITION_COLUMNS[..REQUIRED],
        later: &[(
            "history",
            "averaging time histories is not available in this version",
        )],
    };
    let mut first_line: BTreeMap<String, usize> = BTreeMap::new();
    let runs = table::rows(file, text, &columns, |row, line| {
        let run = row.test_run(wheels, soils)?;
        match first_line.insert(run.name.clone(), line) {
            Some(first) => Err(format!(
                "run \"{}\" stands twice (first on line {first})",
                run.name
            )),
            None => Ok(run),
        }
    })?;
    if runs.is_empty() {
        return Err(FileError::whole(file, "no test run stands in the file"));
    }
    Ok(runs)
}

impl Row<'_> {
    fn test_run(
        &self,
        wheels: &BTreeMap<String, Wheel>,
        soils: &BTreeMap<String, Soil>,
    ) -> Result<TestRun, String> {
        let wheel = self.named("wheel", wheels)?;
        let slip = self.required("slip")?;
        if !(-1.0..1.0).contains(&slip) {
            return Err(format!("slip {slip} must lie in [-1, 1)"));
        }
        let wheel_load_n = self.positive("wheel_load_n", "N")?;
        let sled_speed_m_s = self.positive("sled_speed_m_s", "m/s")?;
        let slip_angle_deg = self.number("slip_angle_deg")?.unwrap_or(0.0);
        if slip_angle_deg.abs() > 90.0 {
            return Err(format!(
                "slip_angle_deg {slip_angle_deg} deg must lie in [-90, 90] deg"
            ));
        }
        let pass = match self.text("pass") {
            None => 1,
            Some(text) => match text.parse::<u32>() {
                Ok(pass) if pass >= 1 => pass,
                _ => return Err(format!("pass \"{text}\" must be a whole number >= 1")),
            },
        };
        let usage = match self.text("use") {
            None | Some("fit") => RunUse::Fit,
            Some("holdout") => RunUse::Holdout,
            Some(word) => return Err(format!("use \"{word}\" must be fit or holdout")),
        };
        let (mut measured, mut sd) = ([None; 4], [None; 4]);
        for channel in Channel::ALL {
            measured[channel.index()] = self.number(channel.column())?;
            let sd_column = format!("{}_sd", channel.column());
            if self.text(&sd_column).is_some() {
                sd[channel.index()] = Some(self.positive(&sd_column, channel.unit())?);
            }
        }
        let diameter = 2.0 * wheels[&wheel].radius_m;
        if let Some(z) = measured[Channel::Sinkage.index()].filter(|z| z.abs() > diameter) {
            return Err(format!(
                "sinkage_m {z} m is more than the wheel's diameter {diameter} m: metres are expected, were these millimetres?"
            ));
        }
        Ok(TestRun {
            name: self.word("run")?.to_owned(),
            wheel,
            soil: self.named("soil", soils)?,
            slip,
            wheel_load_n,
            sled_speed_m_s,
            slip_angle_deg,
            pass,
            measured,
            sd,
            usage,
        })
    }
}
