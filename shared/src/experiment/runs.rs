//! The rows of `runs.csv`.

use std::collections::{BTreeMap, BTreeSet};

use super::check::{ValueError, possible};
use super::history::{MeasuredHistory, averaged};
use super::recording_file::RecordingFile;
use super::rig_column::RigColumn;
use super::settings::{AveragingProtocol, SoilProperties};
use super::table::{self, Columns, Row};
use super::wheel::WheelGeometry;
use crate::channel::Channel;
use crate::file::{FileError, FileSet};

/// One run of the rig: its condition and its measurements.
#[derive(Debug, Clone, PartialEq)]
pub struct TestRun {
    /// Name, unique in the experiment.
    pub name: String,
    /// Name of the wheel.
    pub wheel: String,
    /// Name of the soil.
    pub soil: String,
    /// `(omega R_s - v) / max(omega R_s, v)`, in [-1, 1); `R_s` is the rig's radius.
    pub slip: f64,
    /// Vertical load on the wheel `[N]`.
    pub wheel_load_n: f64,
    /// Sled speed along travel `[m/s]`.
    pub sled_speed_m_s: f64,
    /// From wheel heading to travel `[deg]`.
    pub slip_angle_deg: f64,
    /// Number of passes; the last one is measured.
    pub pass: u32,
    /// Number in the series of the campaign; later runs have larger numbers.
    pub order: Option<i32>,
    /// Id of the soil's preparation; runs of one preparation share its error.
    pub prepared: Option<String>,
    /// Id of the session on the rig: a day, or a mounting of the wheel.
    pub session: Option<String>,
    /// Id of the taring of the sensors that the measurements rest on.
    pub zero: Option<String>,
    /// Id of the person who ran the rig.
    pub operator: Option<String>,
    /// Measured value by channel [channel's unit], stated or averaged from the history; `None` = unmeasured.
    pub measured: [Option<f64>; 4],
    /// The recorded history from which some of the measured values are averaged.
    pub history: Option<MeasuredHistory>,
    /// Standard deviation by channel, in place of the experiment's.
    pub sd: [Option<f64>; 4],
    /// The use of the run: fitted, or held out to judge the fit. A run whose recording is not steady is held out, whatever its row says.
    pub usage: RunUse,
}

impl RigColumn {
    /// Returns the id that a run states.
    pub fn id(self, run: &TestRun) -> Option<&str> {
        match self {
            RigColumn::Session => run.session.as_deref(),
            RigColumn::Zero => run.zero.as_deref(),
            RigColumn::Operator => run.operator.as_deref(),
        }
    }
}

/// The use of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize, strum::IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum RunUse {
    /// The run enters the likelihood.
    Fit,
    /// Never fitted; scores the prediction.
    Holdout,
}

impl RunUse {
    /// Returns the word in the column `use` and in results.
    pub fn name(self) -> &'static str {
        self.into()
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
/// The column that names a run's history.
const HISTORY: &str = "history";
/// The column of the run numbers in time.
const ORDER: &str = "order";
/// The column of the preparations.
const PREPARED: &str = "prepared";

/// Returns the known columns of `runs.csv`.
fn columns<'a>(sd_columns: &'a [String; 4]) -> Columns<'a> {
    let mut allowed: Vec<&str> = CONDITION_COLUMNS.to_vec();
    allowed.extend(Channel::ALL.iter().map(|c| c.column()));
    allowed.extend(sd_columns.iter().map(String::as_str));
    allowed.extend([ORDER, PREPARED]);
    allowed.extend(RigColumn::ALL.map(RigColumn::name));
    allowed.extend([HISTORY, "use"]);
    Columns {
        allowed,
        required: &CONDITION_COLUMNS[..REQUIRED],
        max_rows: table::MAX_ROWS,
    }
}

fn sd_columns() -> [String; 4] {
    Channel::ALL.map(|c| format!("{}_sd", c.column()))
}

/// Returns the files of histories that the runs name, each once.
pub(super) fn named_histories(file: &str, text: &str) -> Result<BTreeSet<String>, FileError> {
    let names = table::rows(file, text, &columns(&sd_columns()), |row, _| {
        Ok(row.text(HISTORY).map(str::to_owned))
    })?;
    Ok(names.into_iter().flatten().collect())
}

/// Parses `runs.csv` against the wheels and soils of its experiment, whose `files` hold the histories.
pub(super) fn parse(
    file: &str,
    files: &FileSet,
    wheels: &BTreeMap<String, WheelGeometry>,
    soils: &BTreeMap<String, SoilProperties>,
    protocol: &AveragingProtocol,
) -> Result<Vec<TestRun>, FileError> {
    let text = files.named(file, file)?;
    let mut first_line: BTreeMap<String, usize> = BTreeMap::new();
    let rows = table::rows(file, text, &columns(&sd_columns()), |row, line| {
        let run = row.test_run(wheels, soils)?;
        let history = row.text(HISTORY).map(str::to_owned);
        match first_line.insert(run.name.clone(), line) {
            Some(first) => Err(ValueError::Rule(format!(
                "run \"{}\" appears twice (first on line {first})",
                run.name
            ))),
            None => Ok((run, history, line)),
        }
    })?;
    if rows.is_empty() {
        return Err(FileError::whole(file, "the file has no test run"));
    }
    let ordered = |(run, _, _): &&(TestRun, Option<String>, usize)| run.order.is_some();
    if let (Some((first, _, _)), Some((run, _, line))) =
        (rows.iter().find(ordered), rows.iter().find(|row| !ordered(row)))
    {
        let message = format!(
            "run \"{}\" has no {ORDER}, but run \"{}\" has one: a drift over the series needs the numbers of all",
            run.name, first.name
        );
        return Err(FileError::at(file, *line, message));
    }
    let mut recordings: BTreeMap<String, RecordingFile> = BTreeMap::new();
    for named in rows.iter().filter_map(|(_, history, _)| history.as_ref()) {
        if !recordings.contains_key(named) {
            let recording = RecordingFile::parse(named, files.named(file, named)?)?;
            recordings.insert(named.clone(), recording);
        }
    }
    let average = |(mut run, history, line): (TestRun, Option<String>, usize)| {
        if let Some(named) = history {
            let (recording, wheel) = (&recordings[&named], &wheels[&run.wheel]);
            let history = averaged(
                recording,
                &run.name,
                wheel,
                protocol,
                (run.slip, run.sled_speed_m_s),
            )?;
            for (channel, recorded) in history.channels() {
                if let Some(stated) = run.measured[channel.index()].replace(recorded.average) {
                    let message = format!(
                        "run \"{}\": {} is stated as {stated} {} and recorded in {named}: leave one of them out",
                        run.name,
                        channel.column(),
                        channel.unit()
                    );
                    return Err(FileError::at(file, line, message));
                }
            }
            if !history.is_steady() {
                run.usage = RunUse::Holdout;
            }
            run.history = Some(history);
        }
        Ok(run)
    };
    rows.into_iter().map(average).collect()
}

impl Row<'_> {
    fn test_run(
        &self,
        wheels: &BTreeMap<String, WheelGeometry>,
        soils: &BTreeMap<String, SoilProperties>,
    ) -> Result<TestRun, ValueError> {
        let rule = |message: String| Err(ValueError::Rule(message));
        let wheel = self.named("wheel", wheels)?;
        let slip = self.required("slip")?;
        possible("slip", slip)?;
        if !(-1.0..1.0).contains(&slip) {
            return rule(format!("slip {slip} must lie in [-1, 1)"));
        }
        let wheel_load_n = self.positive("wheel_load_n", "N")?;
        let sled_speed_m_s = self.positive("sled_speed_m_s", "m/s")?;
        let slip_angle_deg = self.number("slip_angle_deg")?.unwrap_or(0.0);
        if slip_angle_deg.abs() > 90.0 {
            return rule(format!(
                "slip_angle_deg {slip_angle_deg} deg must lie in [-90, 90] deg"
            ));
        }
        let pass = match self.text("pass") {
            None => 1,
            Some(text) => match text.parse::<u32>() {
                Ok(pass) if pass >= 1 => pass,
                _ => return rule(format!("pass \"{text}\" must be a whole number >= 1")),
            },
        };
        let order = match self.text(ORDER).map(|text| (text, text.parse::<i32>())) {
            None => None,
            Some((_, Ok(number))) => Some(number),
            Some((text, Err(_))) => {
                return rule(format!(
                    "{ORDER} \"{text}\" must be a whole number: that of the run in time"
                ));
            }
        };
        let usage = match self.text("use") {
            None | Some("fit") => RunUse::Fit,
            Some("holdout") => RunUse::Holdout,
            Some(word) => return rule(format!("use \"{word}\" must be fit or holdout")),
        };
        let (mut measured, mut sd) = ([None; 4], [None; 4]);
        for channel in Channel::ALL {
            measured[channel.index()] = self.number(channel.column())?;
            let sd_column = format!("{}_sd", channel.column());
            if self.text(&sd_column).is_some() {
                sd[channel.index()] = Some(self.positive(&sd_column, channel.unit())?);
            }
        }
        if let Some(z) = measured[Channel::Sinkage.index()] {
            wheels[&wheel].check_sinkage(z)?;
        }
        let id = |column: &str| self.text(column).map(str::to_owned);
        Ok(TestRun {
            name: self.word("run")?.to_owned(),
            wheel,
            soil: self.named("soil", soils)?,
            slip,
            wheel_load_n,
            sled_speed_m_s,
            slip_angle_deg,
            pass,
            order,
            prepared: id(PREPARED),
            session: id(RigColumn::Session.name()),
            zero: id(RigColumn::Zero.name()),
            operator: id(RigColumn::Operator.name()),
            measured,
            history: None,
            sd,
            usage,
        })
    }
}
