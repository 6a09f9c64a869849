//! The built-in examples, with which a first calibration needs no files.

/// A text with the name of its file.
type NamedFile = (&'static str, &'static str);

/// A job with its experiment.
#[derive(Debug, Clone, Copy)]
pub struct Example {
    /// Name of the example.
    pub name: &'static str,
    /// Title of the example.
    pub title: &'static str,
    /// A sentence about its content.
    pub summary: &'static str,
    /// File of the job.
    pub job: NamedFile,
    /// File of the experiment.
    pub experiment: NamedFile,
    /// The files that the experiment names.
    pub files: &'static [NamedFile],
}

/// Every example.
pub const EXAMPLES: [Example; 4] = [
    Example {
        name: "hidden-effect",
        title: "A hidden effect",
        summary: "synthetic tests of a smooth wheel: the model misses one effect, which is found, added and checked on held-out runs",
        job: ("job.toml", include_str!("../../examples/hidden-effect/job.toml")),
        experiment: (
            "experiment.toml",
            include_str!("../../examples/hidden-effect/experiment.toml"),
        ),
        files: &[("runs.csv", include_str!("../../examples/hidden-effect/runs.csv"))],
    },
    Example {
        name: "cmu-sand",
        title: "Measured sand: calibration",
        summary: "single-wheel tests of a smooth and a grousered wheel by Carnegie Mellon University: one calibration of the base model",
        job: ("job.toml", include_str!("../../examples/cmu-sand/job.toml")),
        experiment: (
            "experiment.toml",
            include_str!("../../examples/cmu-sand/experiment.toml"),
        ),
        files: &[("runs.csv", include_str!("../../examples/cmu-sand/runs.csv"))],
    },
    Example {
        name: "cmu-sand-discover",
        title: "Measured sand: what is missing",
        summary: "the same tests: a search for the effect that the model misses, which is added and searched again",
        job: (
            "discover.toml",
            include_str!("../../examples/cmu-sand/discover.toml"),
        ),
        experiment: (
            "discover-experiment.toml",
            include_str!("../../examples/cmu-sand/discover-experiment.toml"),
        ),
        files: &[("runs.csv", include_str!("../../examples/cmu-sand/runs.csv"))],
    },
    Example {
        name: "which-model",
        title: "Which of three models",
        summary: "synthetic tests of a smooth wheel: three models are calibrated and compared by evidence and on held-out runs",
        job: ("job.toml", include_str!("../../examples/which-model/job.toml")),
        experiment: (
            "experiment.toml",
            include_str!("../../examples/which-model/experiment.toml"),
        ),
        files: &[("runs.csv", include_str!("../../examples/which-model/runs.csv"))],
    },
];

#[cfg(test)]
mod tests {
    use job::Spec;
    use shared::file::FileSet;

    use super::*;

    #[test]
    fn every_example_is_a_valid_job_with_all_its_files() {
        for example in EXAMPLES {
            let set = |toml: &str, files: &[NamedFile]| FileSet {
                toml: toml.to_owned(),
                files: files
                    .iter()
                    .map(|&(name, text)| (name.to_owned(), text.to_owned()))
                    .collect(),
            };
            let job = set(example.job.1, &[]);
            let experiment = set(example.experiment.1, example.files);
            let spec = Spec::new(example.job.0, &job, example.experiment.0, &experiment);
            assert!(spec.is_ok(), "{}: {:?}", example.name, spec.err());
        }
    }
}
