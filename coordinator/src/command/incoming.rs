//! The files that are dropped into a folder while a campaign lasts: their rows, and those that are set apart because of a mistake.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use anyhow::Context;
use import::{Files, convert_all};
use shared::experiment::Experiment;
use shared::file::FileSet;

use super::output::remark;
use super::run_table::run_names;

/// So long a file must stay as it is before it is read, because whoever writes it may not have ended.
const STILL: Duration = Duration::from_secs(5);
/// Endings of names that tables and recordings have. Other files are left alone.
const ENDINGS: [&str; 10] = [
    "csv", "tsv", "txt", "dat", "xlsx", "xlsm", "xls", "ods", "mat", "bag",
];
/// The folder within for files that have a mistake.
const REFUSED: &str = "refused";
/// Name of the experiment in messages.
const EXPERIMENT: &str = "experiment.toml";

/// How a file looks: its size `[B]`, and when it was written.
type Look = (u64, Option<SystemTime>);

/// A folder into which files are dropped. Each is read once, when it has stayed as it is for some seconds.
#[derive(Debug)]
pub(super) struct Incoming {
    folder: PathBuf,
    /// Name and text of the map of recordings.
    map: Option<(String, String)>,
    /// The runs of the study.
    runs: BTreeSet<String>,
    /// The experiment with the rows of all files so far.
    experiment: FileSet,
    /// How a file looked, and since when.
    seen: BTreeMap<PathBuf, (Look, Instant)>,
    /// The files that are done with, as they looked then.
    taken: BTreeMap<PathBuf, Look>,
}

impl Incoming {
    /// Makes a reader of a folder that has taken no file yet.
    ///
    /// # Errors
    /// The experiment is not valid.
    pub(super) fn new(
        folder: &Path,
        map: Option<(String, String)>,
        experiment: FileSet,
    ) -> anyhow::Result<Self> {
        let parsed = Experiment::parse(EXPERIMENT, &experiment)?;
        Ok(Incoming {
            folder: folder.to_owned(),
            map,
            runs: parsed.runs.into_iter().map(|run| run.name).collect(),
            experiment,
            seen: BTreeMap::new(),
            taken: BTreeMap::new(),
        })
    }

    /// Takes the files that have stayed as they are, in the order of their names. Those that have a mistake are said and set apart.
    ///
    /// # Returns
    /// Whether a file may still be written.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub(super) fn take(&mut self, now: Instant) -> anyhow::Result<bool> {
        let mut is_waiting = false;
        for (path, look) in self.files()? {
            if let Some(before) = self.taken.get_mut(&path) {
                if *before != look {
                    *before = look;
                    let changed = "it was changed after it was read, and counts as it was: drop corrected runs under another name";
                    remark("note:", &format!("{}: {changed}", path.display()));
                }
                continue;
            }
            if !self.is_still(&path, look, now) {
                is_waiting = true;
                continue;
            }
            self.seen.remove(&path);
            self.taken.insert(path.clone(), look);
            match self.rows(&path) {
                Ok(Some(enlarged)) => self.experiment = enlarged,
                Ok(None) => {}
                Err(mistakes) => self.refuse(&path, &mistakes),
            }
        }
        Ok(is_waiting)
    }

    /// Returns the rows of the experiment with those of all files so far, as CSV.
    pub(super) fn table(&self) -> anyhow::Result<&str> {
        let named = Experiment::runs_file(EXPERIMENT, &self.experiment)?;
        Ok(self.experiment.named(EXPERIMENT, &named)?)
    }

    /// Returns the tables and recordings in the folder, in order, as they look. The map, links, hidden files and those that programs write
    /// under a passing name are none.
    fn files(&self) -> anyhow::Result<Vec<(PathBuf, Look)>> {
        let name = || self.folder.display().to_string();
        let mut files = Vec::new();
        for entry in self.folder.read_dir().with_context(name)? {
            let path = entry.with_context(name)?.path();
            let file = path.file_name().unwrap_or_default().to_string_lossy();
            let is_passing = file.starts_with(['.', '~']);
            let ending = path
                .extension()
                .map(|ending| ending.to_string_lossy().to_lowercase());
            let is_table = ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str()));
            let is_map = self.map.as_ref().is_some_and(|(map, _)| Path::new(map) == path);
            // A file may be gone by now.
            let metadata = path.symlink_metadata().ok().filter(|m| m.is_file());
            if let Some(metadata) = metadata
                && is_table
                && !is_passing
                && !is_map
            {
                files.push((path, (metadata.len(), metadata.modified().ok())));
            }
        }
        files.sort();
        Ok(files)
    }

    /// Returns whether a file has not changed for a time.
    fn is_still(&mut self, path: &Path, look: Look, now: Instant) -> bool {
        let seen = self.seen.entry(path.to_owned()).or_insert((look, now));
        if seen.0 != look {
            *seen = (look, now);
        }
        now.duration_since(seen.1) >= STILL
    }

    /// Returns the experiment with the rows of a file; `None` where the study has all of its runs, as after a calibration with them.
    ///
    /// # Errors
    /// The mistakes of the file, each with its line.
    fn rows(&self, path: &Path) -> Result<Option<FileSet>, Vec<String>> {
        let name = path.display().to_string();
        let bytes = std::fs::read(path).map_err(|e| vec![format!("{name}: {e}")])?;
        let rows = match String::from_utf8(bytes) {
            Ok(text) if is_of_runs(&text) => text,
            _ => self.converted(&name)?,
        };
        if run_names(&rows, path).is_ok_and(|names| !names.is_empty() && names.is_subset(&self.runs)) {
            return Ok(None);
        }
        let (enlarged, _) =
            Experiment::with_runs(EXPERIMENT, &self.experiment, &rows).map_err(|mut error| {
                error.file.clone_from(&name);
                vec![error.to_string()]
            })?;
        Ok(Some(enlarged))
    }

    /// Converts a recording or a table by the map.
    fn converted(&self, name: &str) -> Result<String, Vec<String>> {
        let Some((map_name, map)) = &self.map else {
            return Err(vec![format!(
                "{name}: no titles of runs.csv (run, wheel, slip …): a recording, or another table, needs --map"
            )]);
        };
        let names = [name.to_owned()];
        let files = Files {
            names: &names,
            open: &|name| std::fs::read(name).map(Cow::Owned).map_err(|e| e.to_string()),
            is_own: true,
        };
        let converted = convert_all(files, (map_name, map), "runs");
        match converted.runs {
            Some(_) if !converted.histories.is_empty() => Err(vec![format!(
                "{name}: the map writes histories, which a campaign that is followed does not take: leave them out of the map"
            )]),
            Some(runs) => Ok(runs),
            None => Err(converted.complaints.iter().map(ToString::to_string).collect()),
        }
    }

    /// Says the mistakes of a file and sets it apart. A file that cannot be moved stays where it is.
    fn refuse(&self, path: &Path, mistakes: &[String]) {
        for mistake in mistakes {
            remark("error:", mistake);
        }
        match self.set_apart(path, mistakes) {
            Ok(place) => remark(
                "note:",
                &format!("{} is set apart as {}", path.display(), place.display()),
            ),
            Err(error) => remark(
                "note:",
                &format!("{} is not set apart: {error:#}", path.display()),
            ),
        }
    }

    /// Moves a file to those with mistakes, with a text that states them. Returns its new place.
    fn set_apart(&self, path: &Path, mistakes: &[String]) -> anyhow::Result<PathBuf> {
        let folder = self.folder.join(REFUSED);
        std::fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
        let file = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let numbered = (1..).map(|k| folder.join(format!("{k}-{file}")));
        let free = std::iter::once(folder.join(&file))
            .chain(numbered)
            .find(|place| !place.exists());
        let place = free.expect("numbers do not end");
        std::fs::rename(path, &place).with_context(|| place.display().to_string())?;
        let text = mistakes.join("\n") + "\n";
        let reason = PathBuf::from(format!("{}.txt", place.display()));
        std::fs::write(&reason, text).with_context(|| reason.display().to_string())?;
        Ok(place)
    }
}

/// Returns whether a text has the titles of `runs.csv`.
fn is_of_runs(text: &str) -> bool {
    let mut lines = text
        .lines()
        .map(|line| line.trim_start_matches('\u{feff}').trim());
    let titles = lines.find(|line| !line.is_empty() && !line.starts_with('#'));
    let titles: BTreeSet<&str> = titles.unwrap_or_default().split(',').map(str::trim).collect();
    ["run", "wheel", "slip"]
        .iter()
        .all(|title| titles.contains(title))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOML: &str = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.11\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n";
    const HEADER: &str = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,use\n";

    fn incoming(folder: &Path, map: Option<&str>) -> Incoming {
        let runs = format!("{HEADER}a,w,s,0.1,60,0.02,1.0,fit\n");
        let files = BTreeMap::from([("runs.csv".to_owned(), runs)]);
        let map = map.map(|map| ("map.toml".to_owned(), map.to_owned()));
        let experiment = FileSet {
            toml: TOML.to_owned(),
            files,
        };
        Incoming::new(folder, map, experiment).unwrap()
    }

    #[test]
    fn a_file_that_is_half_written_is_not_read_until_it_stays_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("b.csv");
        let mut incoming = incoming(folder.path(), None);
        let begin = Instant::now();
        std::fs::write(&file, format!("{HEADER}b,w,s,0.2,60,0.0")).unwrap();
        assert!(incoming.take(begin).unwrap());
        std::fs::write(&file, format!("{HEADER}b,w,s,0.2,60,0.02,2.0,fit\n")).unwrap();
        // It has changed since it was seen first.
        assert!(incoming.take(begin + STILL).unwrap());
        assert!(!incoming.table().unwrap().contains("b,w"));
        assert!(!incoming.take(begin + 2 * STILL).unwrap());
        assert!(incoming.table().unwrap().ends_with("b,w,s,0.2,60,0.02,2.0,fit\n"));
        // It is taken once.
        assert!(!incoming.take(begin + 9 * STILL).unwrap());
        assert_eq!(incoming.table().unwrap().matches("b,w").count(), 1);
        // What it becomes later is said, and does not count.
        std::fs::write(&file, format!("{HEADER}b,w,s,0.2,60,0.02,22.0,fit\n")).unwrap();
        incoming.take(begin + 20 * STILL).unwrap();
        assert!(incoming.table().unwrap().ends_with("b,w,s,0.2,60,0.02,2.0,fit\n"));
    }

    #[test]
    fn a_bad_file_is_kept_apart_with_its_line_and_the_others_count() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: String| std::fs::write(folder.path().join(name), text).unwrap();
        write(
            "b.csv",
            format!("{HEADER}b,w,s,0.2,60,0.02,2.0,fit\nc,w,s,1.4,60,0.02,2.0,fit\n"),
        );
        write("d.csv", format!("{HEADER}d,w,s,0.3,60,0.02,2.0,fit\n"));
        write(
            "again.csv",
            format!("{HEADER}a,w,s,0.3,60,0.02,2.0,fit\ne,w,s,0.3,60,0.02,2.0,fit\n"),
        );
        // A file of before the last calibration, and what is no table.
        write("before.csv", format!("{HEADER}a,w,s,0.1,60,0.02,1.0,fit\n"));
        write("rig.pdf", "%PDF".to_owned());
        write("notes.csv", "day,weather\n1,rain\n".to_owned());
        write(".hidden.csv", "day\n1\n".to_owned());
        let mut incoming = incoming(folder.path(), None);
        let begin = Instant::now();
        incoming.take(begin).unwrap();
        incoming.take(begin + STILL).unwrap();
        let table = incoming.table().unwrap();
        assert!(
            table.contains("d,w") && !table.contains("b,w") && !table.contains("c,w"),
            "{table}"
        );
        let reason = |name: &str| {
            let path = folder.path().join(REFUSED).join(format!("{name}.txt"));
            std::fs::read_to_string(path).unwrap()
        };
        assert!(
            reason("b.csv").contains("b.csv line 3: slip 1.4 must be"),
            "{}",
            reason("b.csv")
        );
        assert!(reason("again.csv").contains("again.csv line 2: run \"a\" is in the study already"));
        assert!(reason("notes.csv").contains("needs --map"));
        assert!(folder.path().join(REFUSED).join("b.csv").exists() && !folder.path().join("b.csv").exists());
        for name in [".hidden.csv", "before.csv", "rig.pdf", "d.csv"] {
            assert!(folder.path().join(name).exists(), "{name}");
        }
    }

    #[test]
    fn another_table_becomes_rows_by_the_map() {
        let map = "columns.wheel = { value = \"w\" }\ncolumns.soil = { value = \"s\" }\ncolumns.slip = { column = \"slip [%]\", unit = \"%\" }\n\
            columns.wheel_load_n = { column = \"load [N]\", unit = \"N\" }\ncolumns.sled_speed_m_s = { value = 20, unit = \"mm/s\" }\n\
            columns.drawbar_pull_n = { column = \"pull [N]\", unit = \"N\" }\ncolumns.run = { column = \"name\" }\n";
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        write("day.csv", "name;slip [%];load [N];pull [N]\nx1;20;60;2,5\n");
        write("wrong.csv", "name;slip [%];load [N];pull [N]\nx2;20;60;much\n");
        let mut incoming = incoming(folder.path(), Some(map));
        let begin = Instant::now();
        incoming.take(begin).unwrap();
        incoming.take(begin + STILL).unwrap();
        let table = incoming.table().unwrap();
        assert!(table.contains("x1,w,s,0.2,60,0.02,2.5"), "{table}");
        let reason = std::fs::read_to_string(folder.path().join(REFUSED).join("wrong.csv.txt")).unwrap();
        assert!(
            reason.contains("wrong.csv") && reason.contains("line 2"),
            "{reason}"
        );
    }
}
