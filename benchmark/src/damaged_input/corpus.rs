//! The undamaged inputs: the jobs of `examples/` and `tests/data/`, the catalogue, a wheel as a mesh, messages of workers.

use std::path::{Path, PathBuf};

use formula::catalogue::catalogue;
use job::Job;
use shared::exchange::{ExchangeRequest, PROTOCOL_VERSION, WorkResult};
use shared::experiment::Experiment;
use shared::file::{FileError, FileSet};
use shared::outcome::{Fault, Observables, Outcome};
use shared::text_file::{read_beside, read_text, sibling};

/// A job with its experiment and all files that they name.
#[derive(Debug, Clone)]
pub struct Campaign {
    pub job: FileSet,
    pub experiment: FileSet,
}

/// All undamaged inputs.
#[derive(Debug)]
pub struct Corpus {
    pub campaigns: Vec<Campaign>,
    pub effects: Vec<String>,
    pub messages: Vec<ExchangeRequest>,
}

/// A tetrahedron, in both forms of a mesh.
pub const MESHES: [(&str, &str); 2] = [
    (
        "wheel.obj",
        "v 0 0 0.1\nv 0.1 0 -0.05\nv -0.1 0.05 -0.05\nv 0 -0.05 -0.05\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n",
    ),
    (
        "wheel.stl",
        "solid w\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0.1\nvertex 0.1 0 -0.05\nvertex -0.1 0.05 -0.05\nendloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0.1\nvertex -0.1 0.05 -0.05\nvertex 0 -0.05 -0.05\nendloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0.1\nvertex 0 -0.05 -0.05\nvertex 0.1 0 -0.05\nendloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 0.1 0 -0.05\nvertex 0 -0.05 -0.05\nvertex -0.1 0.05 -0.05\nendloop\nendfacet\nendsolid w\n",
    ),
];

impl Corpus {
    /// Reads the inputs from the workspace.
    pub fn read() -> Result<Corpus, FileError> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let mut files = Vec::new();
        for folder in ["examples", "tests/data"] {
            jobs(&root.join(folder), &mut files);
        }
        files.sort();
        let campaigns = files.iter().map(|file| campaign(file));
        // Other files are models and parameters of forward runs, and jobs whose prior is the posterior of another job.
        let campaigns: Vec<Campaign> = campaigns.filter_map(Result::ok).collect();
        Ok(Corpus {
            campaigns,
            effects: catalogue()
                .iter()
                .map(|effect| as_user_effect(&effect.text))
                .collect(),
            messages: messages(),
        })
    }
}

/// Returns an effect of the catalogue as an effect of a user: with another name, and without the mechanism, which is reserved for the
/// library.
fn as_user_effect(text: &str) -> String {
    let lines = text.replacen("name = \"", "name = \"my_", 1);
    let lines = lines.split_inclusive('\n');
    lines.filter(|line| !line.starts_with("mechanism")).collect()
}

/// Finds the TOML files below a folder.
fn jobs(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            jobs(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "toml") {
            found.push(path);
        }
    }
}

fn campaign(path: &Path) -> Result<Campaign, FileError> {
    let toml = read_text(path)?;
    let job = Job::parse("job.toml", &toml)?;
    let experiment = job.experiment.as_deref().unwrap_or_default();
    let experiment = Experiment::read_files(&sibling(path, experiment))?;
    let files = read_beside(path, &job.named_files())?;
    Ok(Campaign {
        job: FileSet { toml, files },
        experiment,
    })
}

/// Returns a message with every field, and one without results.
fn messages() -> Vec<ExchangeRequest> {
    let mut observables = Observables::with_capacity(2);
    for channel in [
        &mut observables.drawbar_pull_n,
        &mut observables.torque_n_m,
        &mut observables.sinkage_m,
    ] {
        channel.extend([12.5, -0.25]);
    }
    let result = |outcome| WorkResult {
        lease: 1 << 40,
        calibration: 1,
        evaluation: 7,
        seal: "0123456789abcdef0123456789abcdef".into(),
        outcome,
        repeated: None,
    };
    let message = "out of memory".to_owned();
    let full = ExchangeRequest {
        worker: "lab-3".into(),
        protocol: PROTOCOL_VERSION,
        model_version: "scm-7".into(),
        models: [("wheel.py".to_owned(), "command-0123456789abcdef".to_owned())].into(),
        queue_job: Some("slurm 12_3".into()),
        threads: 8,
        evaluation_s: Some(0.25),
        results: vec![
            result(Outcome::Evaluated(observables)),
            result(Outcome::Fault(Fault { message })),
        ],
        holding: vec![1, 2, 3],
        returned: vec![4],
        started: vec![2],
        received: u64::MAX,
        want: 16,
        wait_ms: 10_000,
    };
    let empty = ExchangeRequest {
        results: Vec::new(),
        ..full.clone()
    };
    vec![full, empty]
}
