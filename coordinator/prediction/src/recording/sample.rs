//! Rows of a recording.

use std::io::Read;

use job::{ConditionDefaults, PlannedCondition, PlannedRun};
use shared::channel::Channel;
use shared::file::{FileError, unknown_word};

use crate::error::PredictionError;

/// The name of a recording in messages.
const FILE: &str = "recording.csv";
/// Columns of a recording beside its channels.
const CONDITIONS: [&str; 5] = ["t_s", "slip", "wheel_load_n", "sled_speed_m_s", "slip_angle_deg"];

/// A sample of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Time `[s]`.
    pub t_s: f64,
    /// Its condition.
    pub planned: PlannedRun,
    /// Measured channels, in the order of [`Channel::ALL`].
    pub measured: [Option<f64>; 4],
}

/// Reads the samples of a recording as they come: CSV with `t_s`, `slip` and the measured channels; `wheel_load_n`, `sled_speed_m_s` and
/// `slip_angle_deg` may be left out. Lines with `#` are comments.
///
/// # Arguments
/// - `wheel`: the wheel, where the fitted runs have several.
///
/// # Errors
/// [`FileError`] names the line, the quantity, its value, its unit and its bound; no sample follows it.
/// Checked by `tests::a_row_is_a_sample` and `tests::malformed_recordings_name_their_lines`.
pub fn read_samples<'a>(
    source: impl Read + 'a,
    wheel: Option<&'a String>,
    defaults: &'a ConditionDefaults<'a>,
) -> Result<impl Iterator<Item = Result<Sample, PredictionError>> + 'a, PredictionError> {
    let fail = |error: csv::Error| PredictionError::from(FileError::whole(FILE, error.to_string()));
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(source);
    let header = reader.headers().map_err(fail)?.clone();
    let known = || CONDITIONS.into_iter().chain(Channel::ALL.map(Channel::column));
    if let Some(unknown) = header.iter().find(|name| !known().any(|known| known == *name)) {
        let message = unknown_word("column", unknown, known());
        return Err(FileError::at(FILE, 1, message).into());
    }
    let has = |name: &str| header.iter().any(|title| title == name);
    if let Some(missing) = CONDITIONS[..2].iter().find(|name| !has(name)) {
        return Err(FileError::at(FILE, 1, format!("the column {missing} is missing")).into());
    }
    if !Channel::ALL.iter().any(|channel| has(channel.column())) {
        return Err(FileError::at(FILE, 1, "there is no measured channel").into());
    }
    let mut last_s = f64::NEG_INFINITY;
    Ok(reader.into_records().map(move |record| {
        let record = record.map_err(fail)?;
        let line = record
            .position()
            .map_or(1, |place| usize::try_from(place.line()).unwrap_or(1));
        let sample = sample(&header, &record, wheel, defaults);
        let sample = sample.and_then(|sample| match sample.t_s > last_s {
            true => Ok(sample),
            false => Err(format!(
                "t_s {} s must be above that of the row before, {last_s} s",
                sample.t_s
            )),
        });
        let sample = sample.map_err(|message| FileError::at(FILE, line, message))?;
        last_s = sample.t_s;
        Ok(sample)
    }))
}

fn sample(
    header: &csv::StringRecord,
    record: &csv::StringRecord,
    wheel: Option<&String>,
    defaults: &ConditionDefaults<'_>,
) -> Result<Sample, String> {
    let number = |name: &str| -> Result<Option<f64>, String> {
        let column = header.iter().position(|title| title == name);
        let field = column
            .and_then(|column| record.get(column))
            .filter(|field| !field.is_empty());
        let Some(field) = field else {
            return Ok(None);
        };
        let value = field.parse::<f64>().ok().filter(|value| value.is_finite());
        value
            .map(Some)
            .ok_or_else(|| format!("{name} \"{field}\" is not a finite number"))
    };
    let stated = PlannedCondition {
        wheel: wheel.cloned(),
        slip: number("slip")?,
        wheel_load_n: number("wheel_load_n")?,
        sled_speed_m_s: number("sled_speed_m_s")?,
        slip_angle_deg: number("slip_angle_deg")?,
        ..PlannedCondition::default()
    };
    let mut measured = [None; 4];
    for channel in Channel::ALL {
        measured[channel.index()] = number(channel.column())?;
    }
    Ok(Sample {
        t_s: number("t_s")?.ok_or("t_s is not stated")?,
        planned: defaults.run(&stated, "sample", None)?,
        measured,
    })
}

#[cfg(test)]
mod tests {
    use shared::experiment::Experiment;
    use shared::file::FileSet;

    use super::*;

    fn read(text: &str) -> Result<Vec<Sample>, String> {
        let toml = "runs = \"runs.csv\"\n[wheel.a]\nradius_m = 0.1\nwidth_m = 0.05\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n";
        let runs =
            "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,use\n1,a,s,0.2,60,0.01,1,fit\n";
        let files = FileSet {
            toml: toml.into(),
            files: [("runs.csv".to_owned(), runs.to_owned())].into(),
        };
        let experiment = Experiment::parse("experiment.toml", &files).unwrap();
        let defaults = ConditionDefaults::new(&experiment, &experiment.wheels);
        let samples = read_samples(text.as_bytes(), None, &defaults).map_err(|e| e.to_string())?;
        samples.collect::<Result<Vec<_>, _>>().map_err(|e| e.to_string())
    }

    #[test]
    fn a_row_is_a_sample() {
        let samples =
            read("# rig 3\nt_s,slip,drawbar_pull_n,torque_n_m\n0.0,0.1,5.5,\n0.1,0.2,6,2\n").unwrap();
        assert_eq!(samples[0].measured, [Some(5.5), None, None, None]);
        assert_eq!(samples[1].measured, [Some(6.0), Some(2.0), None, None]);
        let run = &samples[1].planned.run;
        assert!((run.slip - 0.2).abs() < 1e-12 && (run.wheel_load_n - 60.0).abs() < 1e-12);
    }

    #[test]
    fn malformed_recordings_name_their_lines() {
        for (text, reason) in [
            ("t_s,slipp,torque_n_m\n", "the nearest known is \"slip\""),
            ("t_s,torque_n_m\n", "the column slip is missing"),
            ("t_s,slip\n", "no measured channel"),
            (
                "t_s,slip,torque_n_m\n0,0.1,x\n",
                "line 2: torque_n_m \"x\" is not a finite number",
            ),
            (
                "t_s,slip,torque_n_m\n0,1.1,1\n",
                "line 2: slip 1.1 must lie in [-1, 1)",
            ),
            (
                "t_s,slip,torque_n_m\n1,0.1,1\n1,0.1,1\n",
                "line 3: t_s 1 s must be above",
            ),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains(reason), "{error}");
        }
    }
}
