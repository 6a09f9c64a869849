//! A damaged input and its reader.

use std::collections::BTreeMap;
use std::sync::Arc;

use farm::calibration::{Calibration, CalibrationIdentity};
use job::{Spec, check_effect, foreign_effects};
use shared::bearer::BearerToken;
use shared::exchange::ExchangeRequest;
use shared::experiment::{Experiment, WheelMesh};
use shared::file::FileSet;
use shared::model::effects::read_user_effect;
use shared::wire::WireForm;
use statistics::rng::Stream;

use super::corpus::{Campaign, Corpus, MESHES};
use super::damage::{damaged, damaged_bytes};
use crate::error::StudyError;

const JOB: &str = "job.toml";
const EXPERIMENT: &str = "experiment.toml";
const EFFECT: &str = "effect.toml";
/// The sampler of one job in this number is started, which draws a population.
const STARTED: usize = 16;

/// A damaged input.
#[derive(Debug)]
pub enum Input {
    /// A job with its experiment, one file of which is damaged, and whether its sampler is started.
    Campaign(Campaign, bool),
    /// Further runs for an experiment.
    MoreRuns(FileSet, String),
    /// An effect file.
    Effect(String),
    /// The name and the text of a mesh file.
    Mesh(&'static str, String),
    /// A message of a worker.
    Message(WireForm, Vec<u8>),
    /// The text of a token file.
    Token(String),
}

impl Input {
    /// Draws the input of a number.
    pub fn new(corpus: &Corpus, seed: u64, number: u64) -> Input {
        let dice = &mut Stream::new(seed, 0, number, 0);
        let campaign = || &corpus.campaigns;
        match dice.below(20) {
            0..=10 => {
                let mut one = campaign()[dice.below(campaign().len())].clone();
                let texts = 2 + one.job.files.len() + one.experiment.files.len();
                let text = match dice.below(texts) {
                    0 => &mut one.job.toml,
                    1 => &mut one.experiment.toml,
                    n => {
                        let files = one.job.files.values_mut();
                        let mut files = files.chain(one.experiment.files.values_mut());
                        files.nth(n - 2).expect("counted above")
                    }
                };
                *text = damaged(text, dice);
                Input::Campaign(one, dice.below(STARTED) == 0)
            }
            11..=12 => {
                let one = &campaign()[dice.below(campaign().len())];
                let runs = one.experiment.files.values().next();
                let renamed = runs.map_or(String::new(), |text| text.replace("\nr", "\nmore"));
                Input::MoreRuns(one.experiment.clone(), damaged(&renamed, dice))
            }
            13..=15 => Input::Effect(damaged(&corpus.effects[dice.below(corpus.effects.len())], dice)),
            16 => {
                let (name, text) = MESHES[dice.below(MESHES.len())];
                Input::Mesh(name, damaged(text, dice))
            }
            17..=18 => {
                let form = WireForm::ALL[dice.below(WireForm::ALL.len())];
                let message = &corpus.messages[dice.below(corpus.messages.len())];
                let bytes = message.to_bytes(form).expect("the messages have finite numbers");
                let is_text = form == WireForm::Json && dice.below(2) == 0;
                let text = is_text.then(|| damaged(&String::from_utf8_lossy(&bytes), dice).into_bytes());
                Input::Message(form, text.unwrap_or_else(|| damaged_bytes(&bytes, dice)))
            }
            _ => Input::Token(damaged("grouser-0123456789abcdef\n", dice)),
        }
    }

    /// Returns the name of the reader.
    pub fn reader(&self) -> &'static str {
        match self {
            Input::Campaign(..) => "job and experiment",
            Input::MoreRuns(..) => "further runs",
            Input::Effect(_) => "effect file",
            Input::Mesh(..) => "mesh",
            Input::Message(WireForm::Json, _) => "message in JSON",
            Input::Message(WireForm::MessagePack, _) => "message in MessagePack",
            Input::Token(_) => "token file",
        }
    }

    /// Returns the files, one of which a refusal must name.
    pub fn files(&self) -> Vec<String> {
        let all = |first: &[&str], named: &[&BTreeMap<String, String>]| {
            let named = named.iter().flat_map(|files| files.keys().cloned());
            first.iter().map(|&file| file.to_owned()).chain(named).collect()
        };
        match self {
            Input::Campaign(one, _) => all(
                &[JOB, EXPERIMENT, "[sampler]"],
                &[&one.job.files, &one.experiment.files],
            ),
            Input::MoreRuns(experiment, _) => all(&[EXPERIMENT, "the new runs"], &[&experiment.files]),
            Input::Effect(_) => all(&[EFFECT], &[]),
            Input::Mesh(name, _) => all(&[name], &[]),
            Input::Message(..) => all(&["the body", "the result of lease"], &[]),
            Input::Token(_) => all(&["GROUSER_TOKEN"], &[]),
        }
    }

    /// Reads the input; an error is the refusal of the reader.
    pub fn read(&self) -> Result<(), StudyError> {
        match self {
            Input::Campaign(one, is_started) => {
                foreign_effects(&one.job.toml);
                Experiment::parse(EXPERIMENT, &one.experiment)?;
                let spec = Spec::new(JOB, &one.job, EXPERIMENT, &one.experiment)?;
                if *is_started {
                    let identity = CalibrationIdentity {
                        id: 1,
                        name: "fuzz".into(),
                        study: 1,
                        experiment: 1,
                    };
                    Calibration::new(identity, Arc::new(spec))?;
                }
            }
            Input::MoreRuns(experiment, csv) => drop(Experiment::with_runs(EXPERIMENT, experiment, csv)?),
            Input::Effect(text) => check_effect(EFFECT, &read_user_effect(EFFECT, text)?)?,
            Input::Mesh(name, text) => drop(WheelMesh::parse(name, text)?),
            Input::Message(form, bytes) => drop(ExchangeRequest::from_bytes(bytes, *form)?),
            Input::Token(text) => drop(BearerToken::find(None, Some(text.clone()))?),
        }
        Ok(())
    }
}
