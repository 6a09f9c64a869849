//! The files of a small job, and ways to change them.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::workspace::{data, root, text};

/// An experiment and a job, as text.
#[derive(Debug, Clone)]
pub struct Job {
    /// `experiment.toml`.
    pub experiment: String,
    /// `runs.csv`.
    pub runs: String,
    /// `job.toml`.
    pub job: String,
    /// The name and content of each further file that the experiment or the job names.
    pub attached: Vec<(String, Vec<u8>)>,
}

/// Fitted runs of [`Job::small`].
pub const FIT_RUNS: usize = 24;

impl Job {
    /// Returns the experiment `nothing-hidden`: four free parameters, 24 fitted runs and 16 held-out ones.
    pub fn small() -> Job {
        let folder = data("nothing-hidden");
        Job {
            experiment: text(&folder.join("experiment.toml")),
            runs: text(&folder.join("runs.csv")),
            job: SMALL.into(),
            attached: Vec::new(),
        }
    }

    /// Returns the job of a folder of `examples`.
    pub fn example(name: &str) -> Job {
        Job::read(&root().join("examples").join(name))
    }

    /// Returns the job of a folder of `tests/data`.
    pub fn data(name: &str) -> Job {
        Job::read(&data(name))
    }

    fn read(folder: &Path) -> Job {
        let file = |name: &str| text(&folder.join(name));
        Job {
            experiment: file("experiment.toml"),
            runs: file("runs.csv"),
            job: file("job.toml"),
            attached: Vec::new(),
        }
    }

    /// Returns two runs and a coarse terrain: a calibration of the three-dimensional model in seconds.
    pub fn rolling() -> Job {
        let small = Job::small();
        let lines = small.runs.lines().filter(|line| !line.starts_with('#')).take(3);
        let runs = lines.map(|line| format!("{line}\n")).collect();
        Job { runs, ..small }.in_job(
            "kind = \"quasi_static\"",
            "kind = \"scm\"\ndem_spacing_m = 0.008\ntravel_step_m = 0.001\nsteady_travel_m = 0.2",
        )
    }

    /// Returns [`Job::rolling`] on an emulator of the model.
    pub fn emulated() -> Job {
        Job::rolling().in_job("moves = [2, 4]", "stages = \"emulated\"")
    }

    /// Runs on soil that yields only after some shear displacement, with a narrow prior of the friction angle.
    pub fn late_shear() -> Job {
        let runs = text(&data("shear-mobilisation/runs.csv"));
        Job { runs, ..Job::small() }.in_job("normal = [30.0, 5.7]", "normal = [30.0, 1.5]")
    }

    /// [`Job::late_shear`] as a study that searches and extends its model automatically.
    pub fn hidden_shear() -> Job {
        Job::late_shear().in_job("[sampler]", "[discovery]\napply = \"auto\"\n[sampler]")
    }

    /// Changes the settings of the sampler.
    pub fn sampler(self, particles: usize, moves: [usize; 2], seed: u64) -> Job {
        let sampler = format!("particles = {particles}\nmoves = {moves:?}\nseed = {seed}");
        self.in_job("particles = 60\nmoves = [2, 4]\nseed = 1", &sampler)
    }

    /// Changes a passage of `job.toml`, which must occur exactly once.
    #[track_caller]
    pub fn in_job(self, old: &str, new: &str) -> Job {
        Job {
            job: replace(&self.job, old, new),
            ..self
        }
    }

    /// Changes a passage of `experiment.toml`, which must occur exactly once.
    #[track_caller]
    pub fn in_experiment(self, old: &str, new: &str) -> Job {
        Job {
            experiment: replace(&self.experiment, old, new),
            ..self
        }
    }

    /// Changes a passage of `runs.csv`, which must occur exactly once.
    #[track_caller]
    pub fn in_runs(self, old: &str, new: &str) -> Job {
        Job {
            runs: replace(&self.runs, old, new),
            ..self
        }
    }

    /// Puts another file beside the experiment.
    pub fn beside(mut self, name: &str, content: impl Into<Vec<u8>>) -> Job {
        self.attached.push((name.to_owned(), content.into()));
        self
    }

    /// Returns the small job with a surface mesh in place of the rim of its wheel. [`Job::beside`] adds the file of the
    /// mesh.
    pub fn with_mesh(file: &str) -> Job {
        let small = Job::small();
        let lines = small.experiment.lines();
        let lines = lines.filter(|line| !line.starts_with("grouser_"));
        let experiment = lines.map(|line| format!("{line}\n")).collect();
        Job { experiment, ..small }
            .in_experiment("width_m = 0.112", &format!("width_m = 0.112\nmesh = \"{file}\""))
    }

    /// Returns the name and text of each attached file that `job.toml` names.
    pub fn effect_files(&self) -> Value {
        let named = self.attached.iter();
        let named = named.filter(|(name, _)| self.job.contains(name.as_str()));
        named
            .map(|(name, content)| (name.clone(), Value::from(String::from_utf8_lossy(content))))
            .collect()
    }

    /// Writes the files into a folder; returns the path of `job.toml`.
    pub fn write(&self, folder: &Path) -> PathBuf {
        std::fs::create_dir_all(folder).expect("the folder of a job");
        let texts = [
            ("experiment.toml", self.experiment.as_bytes()),
            ("runs.csv", self.runs.as_bytes()),
            ("job.toml", self.job.as_bytes()),
        ];
        let attached = self.attached.iter().map(|(name, content)| (&**name, &**content));
        for (name, content) in texts.into_iter().chain(attached) {
            std::fs::write(folder.join(name), content).expect("a file of a job");
        }
        folder.join("job.toml")
    }

    /// Returns the body of `POST /v1/experiments`.
    pub fn experiment_json(&self) -> Value {
        let mut files = json!({"runs.csv": self.runs});
        for (name, content) in &self.attached {
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

/// An effect file with a gain of the drawbar pull, which the data of [`Job::small`] do not have.
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
