//! A plan: the rows of a file, or the condition of the fitted runs, with one quantity swept.

use job::{ConditionDefaults, PlannedCondition, PlannedRun};
use shared::file::{FileError, unknown_word};

use crate::error::PredictionError;

/// Columns of a plan; `soil` and `use` may stand there because they do in runs.csv.
const COLUMNS: [&str; 11] = [
    "run",
    "wheel",
    "soil",
    "slip",
    "wheel_load_n",
    "sled_speed_m_s",
    "slip_angle_deg",
    "pass",
    "use",
    "gravity_m_s2",
    "slope_deg",
];
/// Quantities that can be swept.
const SWEPT: [&str; 6] = [
    "slip",
    "wheel_load_n",
    "sled_speed_m_s",
    "slip_angle_deg",
    "gravity_m_s2",
    "slope_deg",
];
/// Largest number of planned runs.
pub const MAX_RUNS: usize = 10_000;
/// The name of a plan in messages.
const FILE: &str = "plan.csv";

/// Evenly spaced values of one quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    name: String,
    values: Vec<f64>,
}

impl Sweep {
    /// Reads `NAME=FROM:TO:COUNT`.
    ///
    /// # Errors
    /// A sentence with the form, or with the nearest quantity that can be swept.
    /// Checked by `tests::a_sweep_takes_evenly_spaced_values`.
    pub fn read(text: &str) -> Result<Sweep, PredictionError> {
        let form = || {
            PredictionError::Request(format!(
                "sweep \"{text}\" must have the form NAME=FROM:TO:COUNT, as in slip=0:0.8:41"
            ))
        };
        let (name, range) = text.split_once('=').ok_or_else(form)?;
        let name = name.trim();
        if !SWEPT.contains(&name) {
            let message = unknown_word("quantity of a sweep", name, SWEPT);
            return Err(PredictionError::Request(message));
        }
        let parts: Vec<&str> = range.split(':').map(str::trim).collect();
        let [from, to, count] = parts[..] else {
            return Err(form());
        };
        let number = |text: &str| text.parse::<f64>().ok().filter(|x| x.is_finite());
        let (from, to) = number(from).zip(number(to)).ok_or_else(form)?;
        let count: usize = count.parse().map_err(|_| form())?;
        if !(2..=MAX_RUNS).contains(&count) {
            let message = format!("sweep: count {count} must lie in [2, {MAX_RUNS}]");
            return Err(PredictionError::Request(message));
        }
        let step = (to - from) / (count - 1) as f64;
        Ok(Sweep {
            name: name.to_owned(),
            values: (0..count).map(|i| from + i as f64 * step).collect(),
        })
    }

    /// Returns the name of the quantity.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns its values, in the order of the text.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    fn is_of_slip(&self) -> bool {
        self.name == "slip"
    }

    fn set(&self, condition: &mut PlannedCondition, value: f64) {
        let value = Some(value);
        match self.name.as_str() {
            "slip" => condition.slip = value,
            "wheel_load_n" => condition.wheel_load_n = value,
            "sled_speed_m_s" => condition.sled_speed_m_s = value,
            "slip_angle_deg" => condition.slip_angle_deg = value,
            "gravity_m_s2" => condition.gravity_m_s2 = value,
            _ => condition.slope_deg = value,
        }
    }
}

/// Returns the runs of a plan. Without a file it is one row that states nothing; each row is repeated for every value of a sweep.
///
/// # Errors
/// [`FileError`] names the line, the quantity, its value, its unit and its bound; [`PredictionError::Request`] has the number of the runs
/// and its bound. Checked by `tests::rows_and_sweep_multiply` and `tests::runs_are_counted_before_they_are_made`.
pub fn planned_runs(
    csv: Option<&str>,
    sweep: Option<&Sweep>,
    defaults: &ConditionDefaults<'_>,
) -> Result<Vec<PlannedRun>, PredictionError> {
    let rows = match csv {
        Some(text) => read(text)?,
        None if sweep.is_some() => vec![(0, PlannedCondition::default())],
        None => {
            let message = "there is neither a plan nor a sweep: state which conditions to predict";
            return Err(PredictionError::Request(message.into()));
        }
    };
    // A short request can ask for more runs than memory holds, so they are counted before they are made.
    let values = sweep.map_or(1, |sweep| sweep.values.len());
    let count = rows.len().saturating_mul(values);
    if count > MAX_RUNS {
        let message = format!("{count} planned runs must be at most {MAX_RUNS}");
        return Err(PredictionError::Request(message));
    }
    let mut runs = Vec::with_capacity(count);
    for (number, (line, row)) in rows.iter().enumerate() {
        let name = format!("p{}", number + 1);
        let fail = |message: String| match line {
            0 => PredictionError::Request(message),
            line => FileError::at(FILE, *line, message).into(),
        };
        let Some(sweep) = sweep else {
            runs.push(defaults.run(row, &name, None).map_err(fail)?);
            continue;
        };
        if sweep.is_of_slip() && row.slip.is_some() {
            return Err(fail("slip is stated and swept: leave one of them out".into()));
        }
        for (i, value) in sweep.values.iter().enumerate() {
            let mut swept = row.clone();
            sweep.set(&mut swept, *value);
            let mut planned = defaults.run(&swept, &name, None).map_err(fail)?;
            planned.run.name = format!("{}-{}", planned.run.name, i + 1);
            runs.push(planned);
        }
    }
    Ok(runs)
}

/// Reads the rows of a plan with their lines.
fn read(text: &str) -> Result<Vec<(usize, PlannedCondition)>, FileError> {
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let fail = |e: csv::Error| FileError::whole(FILE, e.to_string());
    let header = reader.headers().map_err(fail)?.clone();
    if let Some(unknown) = header.iter().find(|name| !COLUMNS.contains(name)) {
        let message = unknown_word("column", unknown, COLUMNS);
        return Err(FileError::at(FILE, 1, message));
    }
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(fail)?;
        let line = record
            .position()
            .map_or(1, |place| usize::try_from(place.line()).unwrap_or(1));
        let row = condition(&header, &record).map_err(|message| FileError::at(FILE, line, message))?;
        rows.push((line, row));
    }
    match rows.is_empty() {
        true => Err(FileError::whole(FILE, "the plan has no row")),
        false => Ok(rows),
    }
}

fn condition(header: &csv::StringRecord, record: &csv::StringRecord) -> Result<PlannedCondition, String> {
    let text = |name: &str| {
        let column = header.iter().position(|title| title == name)?;
        record.get(column).filter(|field| !field.is_empty())
    };
    let number = |name: &str| match text(name) {
        None => Ok(None),
        Some(field) => match field.parse::<f64>() {
            Ok(value) => Ok(Some(value)),
            Err(_) => Err(format!("{name} \"{field}\" is not a number")),
        },
    };
    let pass = match text("pass") {
        None => None,
        Some(field) => match field.parse::<u32>() {
            Ok(pass) => Some(pass),
            Err(_) => return Err(format!("pass \"{field}\" must be a whole number >= 1")),
        },
    };
    Ok(PlannedCondition {
        run: text("run").map(str::to_owned),
        wheel: text("wheel").map(str::to_owned),
        slip: number("slip")?,
        wheel_load_n: number("wheel_load_n")?,
        sled_speed_m_s: number("sled_speed_m_s")?,
        slip_angle_deg: number("slip_angle_deg")?,
        pass,
        gravity_m_s2: number("gravity_m_s2")?,
        slope_deg: number("slope_deg")?,
    })
}

#[cfg(test)]
mod tests {
    use shared::experiment::Experiment;
    use shared::file::FileSet;

    use super::*;

    fn experiment() -> Experiment {
        let toml = "runs = \"runs.csv\"\n[wheel.a]\nradius_m = 0.1\nwidth_m = 0.05\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n";
        let runs =
            "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,use\n1,a,s,0.2,60,0.01,1,fit\n";
        let files = FileSet {
            toml: toml.into(),
            files: [("runs.csv".to_owned(), runs.to_owned())].into(),
        };
        Experiment::parse("experiment.toml", &files).unwrap()
    }

    fn planned(csv: Option<&str>, sweep: Option<&str>) -> Result<Vec<PlannedRun>, String> {
        let experiment = experiment();
        let defaults = ConditionDefaults::new(&experiment, &experiment.wheels);
        let sweep = sweep.map(Sweep::read).transpose().map_err(|e| e.to_string())?;
        planned_runs(csv, sweep.as_ref(), &defaults).map_err(|e| e.to_string())
    }

    #[test]
    fn a_sweep_takes_evenly_spaced_values() {
        let slips: Vec<f64> = planned(None, Some("slip=0:0.8:5"))
            .unwrap()
            .iter()
            .map(|planned| planned.run.slip)
            .collect();
        let even = [0.0, 0.2, 0.4, 0.6, 0.8];
        assert!(
            slips.iter().zip(even).all(|(a, b)| (a - b).abs() < 1e-12),
            "{slips:?}"
        );
        for (text, reason) in [
            ("slip", "must have the form"),
            ("slip=0:1", "must have the form"),
            ("slipp=0:0.5:3", "the nearest known is \"slip\""),
            ("slip=0:0.5:1", "count 1 must lie in [2, 10000]"),
            ("slip=0:1.5:3", "slip 1.5 must lie in [-1, 1)"),
        ] {
            let error = planned(None, Some(text)).unwrap_err();
            assert!(error.contains(reason), "{error}");
        }
    }

    #[test]
    fn runs_are_counted_before_they_are_made() {
        // As many runs as this fill the memory of a computer.
        let rows = format!("soil\n{}", "s\n".repeat(300_000));
        let error = planned(Some(&rows), Some("slip=0:0.8:10000")).unwrap_err();
        assert_eq!(error, "3000000000 planned runs must be at most 10000");
        let error = planned(Some(&rows), None).unwrap_err();
        assert!(error.contains("300000 planned runs"), "{error}");
    }

    #[test]
    fn rows_and_sweep_multiply() {
        let rows = "run,wheel_load_n,soil\n# heavy\nheavy,120,s\nlight,,s\n";
        let runs = planned(Some(rows), Some("slip=0.1:0.2:2")).unwrap();
        let shown: Vec<(&str, f64)> = runs
            .iter()
            .map(|planned| (planned.run.name.as_str(), planned.weight_n))
            .collect();
        assert_eq!(
            shown,
            [
                ("heavy-1", 120.0),
                ("heavy-2", 120.0),
                ("light-1", 60.0),
                ("light-2", 60.0)
            ]
        );
        let refused = |csv: &str, sweep: Option<&str>| planned(Some(csv), sweep).unwrap_err();
        assert_eq!(
            refused("slip\nx\n", None),
            "plan.csv line 2: slip \"x\" is not a number"
        );
        assert!(refused("slipp\n0.1\n", None).contains("the nearest known is \"slip\""));
        assert!(refused("slip\n0.1\n", Some("slip=0:0.5:3")).contains("stated and swept"));
        assert!(refused("slip\n", None).contains("has no row"));
        assert!(
            planned(None, None)
                .unwrap_err()
                .contains("neither a plan nor a sweep")
        );
    }
}
