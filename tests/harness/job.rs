//! The files of a small job, and ways to change them.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::workspace::{root, text};

/// An experiment and a job, as text.
#[derive(Debug, Clone)]
pub struct Job {
    /// `experiment.toml`.
    pub experiment: String,
    /// `runs.csv`.
    pub runs: String,
    /// `job.toml`.
    pub job: String,
    /// Other files that experiment or job name: name and content.
    pub others: Vec<(String, Vec<u8>)>,
}

/// Fitted runs of [`Job::small`].
pub const FIT_RUNS: usize = 24;

impl Job {
    /// The experiment `nothing-hidden`: four free parameters, 24 fitted runs and 16 others.
    pub fn small() -> Job {
        Job {
            experiment: include_str!("../data/nothing-hidden/experiment.toml").into(),
            runs: include_str!("../data/nothing-hidden/runs.csv").into(),
            job: SMALL.into(),
            others: Vec::new(),
        }
    }

    /// The job of a folder of `examples`.
    ///
    /// # Panics
    /// A file is not there.
    pub fn example(name: &str) -> Job {
        let folder = root().join("examples").join(name);
        let read = |file: &str| text(&folder.join(file));
        Job {
            experiment: read("experiment.toml"),
            runs: read("runs.csv"),
            job: read("job.toml"),
            others: Vec::new(),
        }
    }

    /// Two runs and a coarse terrain: a calibration of the three-dimensional model in seconds.
    pub fn rolling() -> Job {
        let small = Job::small();
        let few: Vec<&str> = small
            .runs
            .lines()
            .filter(|line| !line.starts_with('#'))
            .take(3)
            .collect();
        let runs = few.join("\n") + "\n";
        Job { runs, ..small }.in_job(
            "kind = \"quasi_static\"",
            "kind = \"scm\"\ndem_spacing_m = 0.008\ntravel_step_m = 0.001\nsteady_travel_m = 0.2",
        )
    }

    /// Runs whose soil yields only after some shear displacement, to be searched and extended by itself.
    pub fn hidden_shear() -> Job {
        let job = Job {
            runs: include_str!("../data/shear-mobilisation/runs.csv").into(),
            ..Job::small()
        };
        job.in_job("normal = [30.0, 5.7]", "normal = [30.0, 1.5]")
            .in_job("[sampler]", "[discovery]\napply = \"auto\"\n[sampler]")
    }

    /// Changes the settings of the sampler.
    pub fn sampler(self, particles: usize, moves: [usize; 2], seed: u64) -> Job {
        let sampler = format!("particles = {particles}\nmoves = {moves:?}\nseed = {seed}");
        self.in_job("particles = 60\nmoves = [2, 4]\nseed = 1", &sampler)
    }

    /// Changes a passage of `job.toml`.
    ///
    /// # Panics
    /// It is not there exactly once.
    #[track_caller]
    pub fn in_job(self, old: &str, new: &str) -> Job {
        Job {
            job: replace(&self.job, old, new),
            ..self
        }
    }

    /// Changes a passage of `experiment.toml`.
    ///
    /// # Panics
    /// It is not there exactly once.
    #[track_caller]
    pub fn in_experiment(self, old: &str, new: &str) -> Job {
        Job {
            experiment: replace(&self.experiment, old, new),
            ..self
        }
    }

    /// Changes a passage of `runs.csv`.
    ///
    /// # Panics
    /// It is not there exactly once.
    #[track_caller]
    pub fn in_runs(self, old: &str, new: &str) -> Job {
        Job {
            runs: replace(&self.runs, old, new),
            ..self
        }
    }

    /// Puts another file beside the experiment.
    pub fn beside(mut self, name: &str, content: impl Into<Vec<u8>>) -> Job {
        self.others.push((name.to_owned(), content.into()));
        self
    }

    /// The small job with a surface in place of the rim of its wheel; the file itself is still to be put beside it.
    pub fn with_mesh(file: &str) -> Job {
        let small = Job::small();
        let lines = small
            .experiment
            .lines()
            .filter(|line| !line.starts_with("grouser_"));
        let experiment = lines.map(|line| format!("{line}\n")).collect();
        Job { experiment, ..small }
            .in_experiment("width_m = 0.112", &format!("width_m = 0.112\nmesh = \"{file}\""))
    }

    /// The files that the job itself names: name and text of each.
    pub fn effect_files(&self) -> Value {
        let named = self
            .others
            .iter()
            .filter(|(name, _)| self.job.contains(name.as_str()));
        named
            .map(|(name, content)| (name.clone(), Value::from(String::from_utf8_lossy(content))))
            .collect()
    }

    /// Writes the files into a folder; the path of the job.
    ///
    /// # Panics
    /// They cannot be written.
    pub fn write(&self, folder: &Path) -> PathBuf {
        std::fs::create_dir_all(folder).expect("the folder of a job");
        let texts = [
            ("experiment.toml", self.experiment.as_bytes()),
            ("runs.csv", self.runs.as_bytes()),
            ("job.toml", self.job.as_bytes()),
        ];
        let others = self.others.iter().map(|(name, content)| (&**name, &**content));
        for (name, content) in texts.into_iter().chain(others) {
            std::fs::write(folder.join(name), content).expect("a file of a job");
        }
        folder.join("job.toml")
    }

    /// The body of `POST /v1/experiments`.
    pub fn experiment_json(&self) -> Value {
        let mut files = json!({"runs.csv": self.runs});
        for (name, content) in &self.others {
            files[name] = String::from_utf8_lossy(content).into();
        }
        json!({"toml": self.experiment, "files": files})
    }
}

#[track_caller]
fn replace(text: &str, old: &str, new: &str) -> String {
    assert_eq!(text.matches(old).count(), 1, "{old:?} in\n{text}");
    text.replacen(old, new, 1)
}

const SMALL: &str = r#"experiment = "experiment.toml"

[model]
kind = "quasi_static"
shear_velocity_m_s = 0.001

[priors]
log10_p_ref = { uniform = [4.0, 5.6] }
kappa = 0.0
n = { normal = [1.1, 0.2], bounds = [0.8, 2.0] }
friction_angle_deg = { normal = [30.0, 5.7], bounds = [11.5, 37.3] }
wheel_radius_m = { uniform = [0.125, 0.155] }

[sampler]
algorithm = "tmcmc"
particles = 60
moves = [2, 4]
seed = 1
"#;

/// An effect file: a gain of the pull that the data do not have.
pub const GAIN: &str = r#"name = "my_gain"
summary = "the sensor reads too much"
source = "a guess"
drawbar_pull = "drawbar_pull * (1 + gain) + gain * shift_n"
[parameters.gain]
unit = "1"
neutral = 0.0
prior = { normal = [0.0, 0.2] }
[parameters.shift_n]
unit = "N"
prior = 0.25
"#;
