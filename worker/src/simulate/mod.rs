//! Forward runs of an experiment without a coordinator.
//!
//! # Layout
//! - This file: the wheel's runs, and the destination of each table.
//! - `averages`: the table of the wheel's runs.
//! - `bevameter`: the tables of plates and rings.
//! - `histories`: the time histories of each run.

mod averages;
mod bevameter;
mod error;
mod histories;

pub use error::SimulateError;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use rand::{RngExt, SeedableRng};
use scm::spatial::History;
use shared::channel::Channel;
use shared::experiment::{Experiment, NoiseSd, Scatter, ScatterSd, TestRun};
use shared::file::{FileError, number, parse_toml};
use shared::model::effects::read_user_effect;
use shared::model::{EffectSet, ModelSettings, ModelVariant};
use shared::outcome::Outcome;
use shared::text_file::{read_beside, read_text};

use crate::config::Simulate;
use crate::external::allowed::AllowedModels;
use crate::model::{CompiledBevameter, CompiledVariant, without_action};

/// Simulates an experiment and writes each requested table as CSV.
///
/// The tables are averages of the wheel's runs, pressures under plates, shear stresses under rings. If the model rejects any
/// of them, no file is written.
pub fn simulate(command: &Simulate, models: &Arc<AllowedModels>) -> Result<(), SimulateError> {
    let name = command.experiment.display().to_string();
    let experiment = Experiment::parse(&name, &Experiment::read_files(&command.experiment)?)?;
    for (flag, key, path, rows) in [
        ("--out", "runs", &command.out, experiment.runs.len()),
        ("--plates", "plates", &command.plates, experiment.plates.len()),
        ("--shear", "shear", &command.shear, experiment.shear.len()),
    ] {
        if path.is_some() && rows == 0 {
            let message = format!("{flag}: the experiment names no {key}: add {key} = \"{key}.csv\"");
            return Err(FileError::whole(&name, message).into());
        }
    }
    // without a table of runs no wheel rolls, and the model need not support it
    let runs: &[TestRun] = command.out.as_ref().map_or(&[], |_| &experiment.runs);
    let variant = variant(&experiment, runs, &command.model, &command.parameters)?;
    let mut tables: Vec<(PathBuf, Vec<u8>)> = Vec::new();
    if let Some(path) = &command.out {
        let compiled = CompiledVariant::new(&variant, models)
            .map_err(|e| FileError::whole(&command.model.display().to_string(), e.to_string()))?;
        let mut rolled = Vec::new();
        let runs = wheel_runs(&experiment, &variant, &compiled, command, &mut rolled)?;
        tables.push((path.clone(), runs));
        if let Some(folder) = &command.histories {
            tables.extend(histories::histories(&experiment, &variant, &rolled, folder)?);
            std::fs::create_dir_all(folder).map_err(|source| SimulateError::Write {
                path: folder.display().to_string(),
                source,
            })?;
        }
    }
    if command.plates.is_some() || command.shear.is_some() {
        for effect in without_action(&variant) {
            tracing::warn!(effect, "does not act on plates and rings");
        }
        let bevameter = CompiledBevameter::new(&variant)
            .map_err(|e| FileError::whole(&command.model.display().to_string(), e))?
            .at(&[]);
        if let Some(path) = &command.plates {
            tables.push((path.clone(), bevameter::plates(&experiment, &bevameter)?));
        }
        if let Some(path) = &command.shear {
            tables.push((path.clone(), bevameter::shear(&experiment, &bevameter)?));
        }
    }
    for (path, table) in tables {
        std::fs::write(&path, table).map_err(|source| SimulateError::Write {
            path: path.display().to_string(),
            source,
        })?;
    }
    Ok(())
}

/// Writes the table of the wheel's runs; their histories, if requested and available, go to `rolled`.
fn wheel_runs(
    experiment: &Experiment,
    variant: &ModelVariant,
    compiled: &CompiledVariant,
    command: &Simulate,
    rolled: &mut Vec<History>,
) -> Result<Vec<u8>, SimulateError> {
    let refused = |run: &str, message: String| SimulateError::Rejected {
        what: "run",
        name: run.to_owned(),
        message,
    };
    let outcome = compiled.evaluate_and_keep(&[], |run| {
        if command.histories.is_some() {
            rolled.push(run.history);
        }
    });
    let observables = match outcome {
        Outcome::Evaluated(observables) => observables,
        Outcome::Rejected(r) => {
            return Err(refused(&experiment.runs[r.condition as usize].name, r.message));
        }
        Outcome::Fault(f) => return Err(refused("", f.message)),
    };
    for (run, settled) in experiment.runs.iter().zip(&observables.settled_to) {
        let tolerance = variant.spatial.map_or(0.0, |spatial| spatial.steady_tolerance);
        if *settled > tolerance {
            tracing::warn!(
                run = run.name,
                settled_to = settled,
                tolerance,
                "averages have not settled"
            );
        } else {
            tracing::info!(run = run.name, settled_to = settled, "averages settled");
        }
    }
    let noise = noise(experiment, command)?;
    Ok(averages::averages(experiment, &observables, &noise)?)
}

fn variant(
    experiment: &Experiment,
    runs: &[TestRun],
    model: &Path,
    parameters: &Path,
) -> Result<ModelVariant, FileError> {
    let (model_name, parameters_name) = (model.display().to_string(), parameters.display().to_string());
    let mut table: toml::Table = parse_toml(&model_name, &read_text(model)?)?;
    // a job file is accepted, too: its table [model] is used
    if let Some(toml::Value::Table(inner)) = table.remove("model") {
        table = inner;
    }
    let mut settings = ModelSettings::from_table(&table).map_err(|e| FileError::whole(&model_name, e))?;
    let text = read_text(parameters)?;
    check_quotes(&parameters_name, &text)?;
    let theta: BTreeMap<String, f64> = parse_toml(&parameters_name, &text)?;
    settings.fixed.extend(theta);
    let texts = read_beside(model, &settings.effect_files)?;
    let names = settings.fixed.keys().map(String::as_str);
    let effects = EffectSet::choose(
        &model_name,
        (&settings.effects, &settings.effect_files),
        names,
        |name| texts.get(name).map(|text| read_user_effect(name, text)),
    )?;
    state_shapes(experiment, &effects, &mut settings.fixed, &parameters_name)?;
    ModelVariant::new(experiment, &settings, &effects, Vec::new(), runs)
        .map_err(|e| FileError::whole(&parameters_name, e))
}

/// Adds the values that effect files fix; all other values must be given.
fn state_shapes(
    experiment: &Experiment,
    effects: &EffectSet,
    fixed: &mut BTreeMap<String, f64>,
    file: &str,
) -> Result<(), FileError> {
    let names = fixed.keys().map(String::as_str).collect();
    let mut defaults = Vec::new();
    for unstated in effects.unstated_parameters(&names, &experiment.wheel_names()) {
        let prior = &unstated.parameter.prior;
        let Some(number) = number(prior) else {
            let unit = match unstated.parameter.unit.as_str() {
                "1" => String::new(),
                unit => format!(" [{unit}]"),
            };
            let message = format!(
                "{}{unit} has no value: it is a parameter of effect {}",
                unstated.name, unstated.chosen.effect.name
            );
            return Err(FileError::whole(file, message));
        };
        defaults.push((unstated.name, number));
    }
    fixed.extend(defaults);
    Ok(())
}

/// Rejects a dotted name without quotes, which is a table in TOML.
fn check_quotes(file: &str, parameters: &str) -> Result<(), FileError> {
    // the parser reports text that is not TOML
    for (name, value) in parameters.parse::<toml::Table>().unwrap_or_default() {
        if let Some(key) = value.as_table().and_then(|table| table.keys().next()) {
            let message = format!("write the name in quotes: \"{name}.{key}\"");
            return Err(FileError::whole(file, message));
        }
    }
    Ok(())
}

/// Draws noise by run and channel: independent normal numbers, one stream for each seed.
fn noise(experiment: &Experiment, command: &Simulate) -> Result<Vec<[f64; 4]>, FileError> {
    let mut noise = vec![[0.0; 4]; experiment.runs.len()];
    let Some(seed) = command.noise_seed else {
        return Ok(noise);
    };
    let fail = |message: String| {
        Err(FileError::whole(
            &command.experiment.display().to_string(),
            message,
        ))
    };
    if experiment.noise.scatter(Scatter::Run) != ScatterSd::Known(0.0) {
        return fail(
            "--noise-seed draws independent noise only: [noise] run_scatter is not supported in this version"
                .into(),
        );
    }
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    for (row, run) in noise.iter_mut().zip(&experiment.runs) {
        for channel in Channel::ALL {
            let c = channel.index();
            let sd = match (run.sd[c], experiment.noise.sd[c]) {
                (Some(sd), _) | (None, Some(NoiseSd::Known(sd))) => sd,
                (None, None) => 0.0,
                (None, Some(_)) => {
                    return fail(format!(
                        "--noise-seed needs a number for [noise] {}",
                        channel.column()
                    ));
                }
            };
            // Box-Muller; 1 - u lies in (0, 1], so the logarithm is finite.
            let (u, v): (f64, f64) = (rng.random(), rng.random());
            row[c] = sd * (-2.0 * libm::log(1.0 - u)).sqrt() * libm::cos(std::f64::consts::TAU * v);
        }
    }
    Ok(noise)
}
