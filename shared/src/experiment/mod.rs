//! An experiment as its files describe it: wheels, rig, noise, protocol, test runs, bevameter readings.
//!
//! # Layout
//! - `settings`: the tables of `experiment.toml`; `wheel`: the tables of the wheels; `tread`: the arrangement of their
//!   grousers; `scatter`: relative noise; `campaign`: the origin of the measurements.
//! - `mesh`: a wheel given as a surface of triangles.
//! - `runs`: the rows of `runs.csv`; `rig_column`: the columns of ids of sessions, tarings and operators; `rig_error`: the errors that their runs share; `history`: the recorded
//!   time history of a run, and its averages; `recording_file`: its samples; `steadiness`: whether the wheel still sinks;
//!   `transient`: the part of it before the wheel is steady.
//! - `more_runs`: an experiment with further runs. `fewer_runs`: with fitted runs held out.
//! - `bevameter`: the rows of `plates.csv` and `shear.csv`.
//! - `check`: checks of single numbers.
//! - `table`: rows of a CSV file whose columns are known by name.

mod bevameter;
mod campaign;
mod check;
mod fewer_runs;
mod history;
mod mesh;
mod more_runs;
mod recording_file;
mod rig_column;
mod rig_error;
mod runs;
mod scatter;
mod settings;
mod steadiness;
mod table;
mod transient;
mod tread;
mod wheel;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

pub use bevameter::{PLATE_COLUMNS, PlateReading, SHEAR_COLUMNS, ShearReading};
pub use campaign::Campaign;
pub use history::{MeasuredHistory, Recorded};
pub use mesh::{MAX_BYTES, MAX_TRIANGLES, MeshError, WheelMesh};
pub use rig_column::RigColumn;
pub use rig_error::{RigError, RigQuantity};
pub use runs::{CONDITION_COLUMNS, RunUse, TestRun};
pub use scatter::{Scatter, ScatterSd};
pub use settings::{
    AveragingProtocol, ExperimentKeys, Noise, NoiseSd, ProtocolKind, Rig, SoilProperties, read_wheels,
};
pub use transient::Transient;
pub use tread::Tread;
pub use wheel::{WheelGeometry, rim_speed_m_s};

use crate::channel::Channel;
use crate::file::{FileError, FileSet};
use crate::text_file::{read_text, sibling};

/// A measured data set: the content of `experiment.toml` and of the files it names.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// The origin of the measurements, if the file states it.
    pub campaign: Option<Campaign>,
    /// Wheels by name.
    pub wheels: BTreeMap<String, WheelGeometry>,
    /// Soils by name.
    pub soils: BTreeMap<String, SoilProperties>,
    /// The test rig.
    pub rig: Rig,
    /// Standard deviation of the measurement noise by channel.
    pub noise: Noise,
    /// The protocol that turns histories into averages.
    pub protocol: AveragingProtocol,
    /// The test runs, in the order of `runs.csv`; empty if the experiment has bevameter readings alone.
    pub runs: Vec<TestRun>,
    /// Readings of plates, in the order of `plates.csv`; empty without such a file.
    pub plates: Vec<PlateReading>,
    /// Readings of rings, in the order of `shear.csv`; empty without such a file.
    pub shear: Vec<ShearReading>,
}

/// The runs of a campaign in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Series {
    first: i32,
    last: i32,
}

impl Series {
    /// Returns the position of a run in the series: −0.5 the first, 0.5 the last; `None` for a run without a number.
    pub fn position(self, run: &TestRun) -> Option<f64> {
        let [first, last] = [self.first, self.last].map(f64::from);
        run.order
            .map(|order| (f64::from(order) - first) / (last - first) - 0.5)
    }
}

impl Experiment {
    /// Reads an experiment's file and the files that it names, unparsed, except that binary STL becomes ASCII STL.
    /// [`FileError`] names the file that is missing or cannot be read.
    pub fn read_files(path: &Path) -> Result<FileSet, FileError> {
        let toml = read_text(path)?;
        let named = settings::parse(&path.display().to_string(), &toml)?;
        let mut files = BTreeMap::new();
        for file in [&named.runs, &named.plates, &named.shear].into_iter().flatten() {
            files.insert(file.clone(), read_text(&sibling(path, file))?);
        }
        if let Some(runs) = &named.runs {
            for file in runs::named_histories(runs, &files[runs])? {
                let text = read_text(&sibling(path, &file))?;
                files.insert(file, text);
            }
        }
        for file in named.meshes.into_values() {
            let text = mesh::read(&sibling(path, &file))?;
            files.insert(file, text);
        }
        Ok(FileSet { toml, files })
    }

    /// Parses and validates an experiment; `name` is the name of its TOML file in messages.
    ///
    /// # Errors
    /// [`FileError`] names the file, the line, the value, the unit and the bound.
    /// Checked by `tests::malformed_experiments_are_refused_with_their_mistake`.
    pub fn parse(name: &str, files: &FileSet) -> Result<Experiment, FileError> {
        let mut file = settings::parse(name, &files.toml)?;
        let text = |named: &str| files.named(name, named);
        for (wheel_name, named) in &file.meshes {
            let mesh = WheelMesh::parse(named, text(named)?)?;
            if let Some(wheel) = file.wheel.get_mut(wheel_name) {
                mesh.check_against(wheel.radius_m, wheel.width_m)
                    .map_err(|e| FileError::whole(named, e.to_string()))?;
                wheel.mesh = Some(mesh);
            }
        }
        let (mut runs, mut plates, mut shear) = (Vec::new(), Vec::new(), Vec::new());
        if let Some(named) = &file.runs {
            text(named)?;
            runs = runs::parse(named, files, &file.wheel, &file.soil, &file.protocol)?;
        }
        if let Some(named) = &file.plates {
            plates = bevameter::plates(named, text(named)?)?;
        }
        if let Some(named) = &file.shear {
            shear = bevameter::shear(named, text(named)?)?;
        }
        let used: BTreeSet<&str> = runs.iter().map(|r| r.soil.as_str()).collect();
        for scatter in [Scatter::Preparation, Scatter::PreparationStrength] {
            let states = matches!(file.noise.scatter(scatter), ScatterSd::Known(sd) if sd > 0.0);
            if states && runs.iter().all(|run| run.prepared.is_none()) {
                let message = format!(
                    "[noise] {} needs the column prepared in runs.csv: the preparation of each run",
                    scatter.key()
                );
                return Err(FileError::whole(name, message));
            }
        }
        for error in RigError::ALL {
            let states = matches!(file.noise.rig(error), ScatterSd::Known(sd) if sd > 0.0);
            if states && runs.iter().all(|run| error.column.id(run).is_none()) {
                let (key, column) = (error.key(), error.column.name());
                let message =
                    format!("[noise] {key} needs the column {column} in runs.csv: the {column} of each run");
                return Err(FileError::whole(name, message));
            }
        }
        if used.len() > 1 {
            let list = used.into_iter().collect::<Vec<_>>().join(", ");
            let message = format!(
                "one experiment is about one soil, but the runs name {list}: the soil parameters would be shared"
            );
            return Err(FileError::whole(file.runs.as_deref().unwrap_or(name), message));
        }
        Ok(Experiment {
            campaign: file.campaign,
            wheels: file.wheel,
            soils: file.soil,
            rig: file.rig,
            noise: file.noise,
            protocol: file.protocol,
            runs,
            plates,
            shear,
        })
    }

    /// Returns the names of the wheels that the runs use.
    pub fn wheel_names(&self) -> BTreeSet<&str> {
        self.runs.iter().map(|r| r.wheel.as_str()).collect()
    }

    /// Returns the series of all runs, with the holdout runs; `None` if the column `order` is absent or has a single
    /// value.
    pub fn series(&self) -> Option<Series> {
        let orders = || self.runs.iter().filter_map(|run| run.order);
        let (first, last) = (orders().min()?, orders().max()?);
        (first < last).then_some(Series { first, last })
    }

    /// Returns whether any run of this use has a measurement of the channel.
    pub fn measures(&self, channel: Channel, usage: RunUse) -> bool {
        self.runs
            .iter()
            .any(|r| r.usage == usage && r.measured[channel.index()].is_some())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case_table::cases;

    const TOML: &str = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.1\nwidth_m = 0.05\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n";
    const HEADER: &str = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,sinkage_m,use\n";

    fn parse(toml: &str, csv: &str) -> Result<Experiment, String> {
        let files = FileSet {
            toml: toml.into(),
            files: BTreeMap::from([("runs.csv".into(), csv.into())]),
        };
        Experiment::parse("experiment.toml", &files).map_err(|e| e.to_string())
    }

    #[test]
    fn a_blank_channel_is_unmeasured() {
        let csv = format!("{HEADER}a,w,s,0.2,100,0.01,5.5,,fit\nb,w,s,-1,100,0.01,,0.01,holdout\n");
        let experiment = parse(TOML, &csv).unwrap();
        assert_eq!(experiment.runs[0].measured, [Some(5.5), None, None, None]);
        assert_eq!(experiment.runs[1].usage, RunUse::Holdout);
        assert!((experiment.wheels["w"].rig_radius_m - 0.1).abs() < 1e-15);
        assert!(experiment.measures(Channel::Sinkage, RunUse::Holdout));
        assert!(!experiment.measures(Channel::Sinkage, RunUse::Fit));
    }

    /// Checks that each case, which has one wrong value, is refused with line, quantity, value, unit and bound.
    #[test]
    fn malformed_experiments_are_refused_with_their_mistake() {
        let row = |row: &str| parse(TOML, &format!("{HEADER}{row}\n")).unwrap_err();
        for (wrong, message) in cases(
            r#"
            a,w,s,1.0,100,0.01,1,,fit => slip 1 must lie in [-1, 1)
            a,w,s,0.2,-5,0.01,1,,fit => wheel_load_n -5 N must be > 0 N
            a,w,s,0.2,100,0,1,,fit => sled_speed_m_s 0 m/s must be > 0 m/s
            a,w,s,0.2,100,0.01,1,5.2,fit => sinkage_m 5.2 m is more than the wheel's diameter 0.2 m: metres are expected, were these millimetres or centimetres?
            a,v,s,0.2,100,0.01,1,,fit => unknown wheel "v"; known are w
            a,w,s,zero,100,0.01,1,,fit => slip "zero" is not a number
            a,w,s,0.2,100,0.01,NaN,,fit => drawbar_pull_n NaN is not a finite number
            a,w,s,0.2,100,0.01,1,,both => use "both" must be fit or holdout
            a,w,s,0.2,100,0.01 => 6 fields where the header has 9"#,
        ) {
            assert_eq!(row(wrong), format!("runs.csv line 2: {message}"));
        }
        let refused = |csv: &str, message: &str| assert_eq!(parse(TOML, csv).unwrap_err(), message);
        let two = format!("{HEADER}a,w,s,0.2,100,0.01,1,,fit\na,w,s,0.2,100,0.01,1,,fit\n");
        refused(&two, "runs.csv line 3: run \"a\" appears twice (first on line 2)");
        refused(HEADER, "runs.csv: the file has no test run");
        let commented =
            format!("# a\n\n{HEADER}a,w,s,0.2,100,0.01,1,,fit\n# b\n# c\nd,w,s,2,100,0.01,1,,fit");
        let message = "runs.csv line 7: slip 2 must be at most 1: was it typed in per cent (0.02)?";
        refused(&commented, message);
        let column = "run,wheel,soil,slipp,wheel_load_n,sled_speed_m_s\n";
        refused(
            column,
            "runs.csv line 1: unknown column \"slipp\"; the nearest known is \"slip\"",
        );
        let negative = parse(&TOML.replace("0.05", "-0.05"), HEADER).unwrap_err();
        assert_eq!(
            negative,
            "experiment.toml: [wheel.w] width_m -0.05 m must be > 0 m"
        );
    }

    #[test]
    fn a_campaign_is_kept_and_a_mistake_in_it_names_its_table() {
        let row = format!("{HEADER}a,w,s,0.2,100,0.01,1,,fit\n");
        assert_eq!(parse(TOML, &row).unwrap().campaign, None);
        let with = |lines: &str| parse(&format!("{TOML}[campaign]\n{lines}\n"), &row);
        let campaign = with("title = \"Sand\"").unwrap().campaign;
        assert_eq!(campaign.unwrap().title, "Sand");
        let message = with("title = \"\"").unwrap_err();
        assert_eq!(message, "experiment.toml: [campaign] title is blank");
    }

    #[test]
    fn the_order_of_the_runs_is_a_position_in_the_series() {
        let header = HEADER.replace("use", "use,order,prepared");
        let read = |rows: &str| parse(TOML, &format!("{header}{rows}"));
        let rows = "a,w,s,0.2,100,0.01,1,,fit,7,bed 1\nb,w,s,0.3,100,0.01,1,,holdout,3,bed 1\nc,w,s,0.4,100,0.01,1,,fit,5,\n";
        let experiment = read(rows).unwrap();
        let series = experiment.series().unwrap();
        let positions: Vec<_> = experiment.runs.iter().map(|r| series.position(r)).collect();
        assert_eq!(positions, [Some(0.5), Some(-0.5), Some(0.0)]);
        let prepared: Vec<_> = experiment.runs.iter().map(|r| r.prepared.as_deref()).collect();
        assert_eq!(prepared, [Some("bed 1"), Some("bed 1"), None]);
        assert_eq!(read("a,w,s,0.2,100,0.01,1,,fit,4,\n").unwrap().series(), None);
        assert_eq!(read("a,w,s,0.2,100,0.01,1,,fit,,\n").unwrap().series(), None);
        for (order, message) in cases(
            r#"
            ,, => run "c" has no order, but run "a" has one: a drift over the series needs the numbers of all
            ,5.5, => order "5.5" must be a whole number: that of the run in time"#,
        ) {
            let wrong = read(&rows.replace(",5,", order)).unwrap_err();
            assert_eq!(wrong, format!("runs.csv line 4: {message}"));
        }
    }

    #[test]
    fn sessions_tarings_and_operators_are_ids_of_runs() {
        let header = HEADER.replace("use", "use,operator,zero,session");
        let rows = "a,w,s,0.2,100,0.01,1,,fit,Ada,2,day 1\nb,w,s,0.3,100,0.01,1,,holdout,,3,\n";
        let experiment = parse(TOML, &format!("{header}{rows}")).unwrap();
        let ids = |run: &TestRun| RigColumn::ALL.map(|column| column.id(run).map(str::to_owned));
        let stated = |ids: [&str; 3]| ids.map(|id| (!id.is_empty()).then(|| id.to_owned()));
        assert_eq!(ids(&experiment.runs[0]), stated(["day 1", "2", "Ada"]));
        assert_eq!(ids(&experiment.runs[1]), stated(["", "3", ""]));
    }

    #[test]
    fn a_scatter_of_preparations_needs_their_ids() {
        let toml = TOML.replace("[noise]", "[noise]\npreparation_scatter = 0.1");
        let row = "a,w,s,0.2,100,0.01,1,,fit";
        let refused = parse(&toml, &format!("{HEADER}{row}\n")).unwrap_err();
        let message =
            "preparation_scatter needs the column prepared in runs.csv: the preparation of each run";
        assert_eq!(refused, format!("experiment.toml: [noise] {message}"));
        let header = HEADER.replace("use", "use,prepared");
        let noise = parse(&toml, &format!("{header}{row},bed 1\n")).unwrap().noise;
        assert_eq!(noise.scatter(Scatter::Preparation), ScatterSd::Known(0.1));
        assert_eq!(noise.scatter(Scatter::PreparationStrength), ScatterSd::Unknown);
    }

    #[test]
    fn a_history_gives_the_channels_that_are_not_stated() {
        let protocol = "[protocol]\nmeasured_transient_s = 0.1\nlowpass_hz = 0.0\n[noise]";
        let toml = TOML.replace("[noise]", protocol);
        let header = HEADER.replace("use", "history,use");
        let with = |row: &str| {
            let csv = format!("{header}{row}\n");
            let history = "t_s,drawbar_pull_n\n0.1,9\n0.2,1\n0.3,3\n";
            let files = FileSet {
                toml: toml.clone(),
                files: [("runs.csv", csv.as_str()), ("h.csv", history)]
                    .map(|(name, text)| (name.to_owned(), text.to_owned()))
                    .into(),
            };
            Experiment::parse("experiment.toml", &files).map_err(|e| e.to_string())
        };
        let run = with("a,w,s,0.2,100,0.01,,0.004,h.csv,fit")
            .unwrap()
            .runs
            .remove(0);
        assert_eq!(run.measured, [Some(2.0), None, Some(0.004), None]);
        assert_eq!(run.history.unwrap().file, "h.csv");
        for (row, message) in cases(
            r#"
            5,,h.csv,fit => runs.csv line 2: run "a": drawbar_pull_n is stated as 5 N and recorded in h.csv: leave one of them out
            ,,other.csv,fit => runs.csv: file "other.csv" is named but was not sent"#,
        ) {
            assert_eq!(with(&format!("a,w,s,0.2,100,0.01,{row}")).unwrap_err(), message);
        }
    }

    #[test]
    fn a_run_whose_recording_is_not_steady_is_held_out() {
        let toml = TOML.replace(
            "[noise]",
            "[protocol]\nmeasured_transient_s = 25\nlowpass_hz = 0\n[noise]\nsinkage_m = 0.001",
        );
        let csv = HEADER.replace("use", "history,use")
            + "a,w,s,0.2,100,0.01,5,,h.csv,fit\nb,w,s,0.3,100,0.01,5,,h.csv,fit\n";
        let mut history = "run,t_s,sinkage_m\n".to_owned();
        for k in 1..=30 {
            history += &format!("a,{k},0.01\nb,{k},{}\n", 0.004 + 0.0002 * f64::from(k));
        }
        let files = [("runs.csv", csv), ("h.csv", history)].map(|(name, text)| (name.to_owned(), text));
        let files = FileSet {
            toml,
            files: files.into(),
        };
        let experiment = Experiment::parse("experiment.toml", &files).unwrap();
        let uses: Vec<RunUse> = experiment.runs.iter().map(|run| run.usage).collect();
        assert_eq!(uses, [RunUse::Fit, RunUse::Holdout]);
        let averages = experiment
            .runs
            .iter()
            .map(|run| run.measured[Channel::Sinkage.index()].unwrap());
        let expected = [0.01, 0.0096];
        assert!(
            averages
                .zip(expected)
                .all(|(average, expected)| (average - expected).abs() < 1e-9)
        );
    }

    #[test]
    fn relative_scatter_is_read_and_bounded() {
        let read = |line: &str| parse(&TOML.replace("[noise]", &format!("[noise]\n{line}")), HEADER);
        let row = "a,w,s,0.2,100,0.01,1,,fit\n";
        let toml = TOML.replace("[noise]", "[noise]\nrun_scatter = 0.1\nplate_noise = \"unknown\"");
        let noise = parse(&toml, &format!("{HEADER}{row}")).unwrap().noise;
        assert_eq!(noise.scatter(Scatter::Run), ScatterSd::Known(0.1));
        assert_eq!(noise.scatter(Scatter::PlateReading), ScatterSd::Unknown);
        assert_eq!(noise.scatter(Scatter::RingTest), ScatterSd::Known(0.05));
        for (line, message) in cases(
            r#"
            run_scatter = -0.1 => run_scatter -0.1 must lie in [0, 1]: it is relative
            ring_noise = 0.0 => ring_noise 0 must be > 0 and <= 1: it is relative
            plate_scatter = "replicates" => plate_scatter = "replicates" must be a number or "unknown""#,
        ) {
            assert_eq!(
                read(line).unwrap_err(),
                format!("experiment.toml: [noise] {message}")
            );
        }
    }
}
