//! A program that is fed with JSON, within its limits.
//!
//! One process evaluates all runs of a parameter vector: to start an interpreter takes longer than a simple model does. It reads
//! one object, `{"runs": [{"slip": 0.2, ..., "n": 1.1}, ...]}`, with every input and parameter of every run by name, and writes
//! one, `{"runs": [{"drawbar_pull_n": 20.1, ...}, ...]}`. A run that has no answer may be `{"rejected": "the reason"}`.
//!
//! The process leads a [group](super::group) of its own, which is killed when it ends, and has limits of memory and time.

use std::io::{Read, Write};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use serde_json::{Map, Value, json};
use shared::model::ExternalModel;

use super::ExternalRun;
use super::answer::{beginning, json, outputs, shortened};
use super::failure::ExternalFailure;
use super::group::ProcessGroups;

/// Longest answer `[bytes]`.
const MOST_BYTES: u64 = 64 << 20;
/// How much of what the program says of its errors is kept `[bytes]`.
const MOST_ERROR_BYTES: usize = 4000;

/// Evaluates all runs by a process of its own.
///
/// # Errors
/// [`ExternalFailure`].
pub(super) fn evaluate(
    program: &Path,
    model: &ExternalModel,
    runs: &[ExternalRun],
    groups: &ProcessGroups,
) -> Result<Vec<Vec<f64>>, ExternalFailure> {
    let limit = Duration::from_secs_f64(model.time_s * runs.len().max(1) as f64);
    let text = run(program, &question(model, runs), limit, model.memory_mb, groups)?;
    let machine = |message: String| ExternalFailure::Machine(format!("{}: {message}", program.display()));
    let answer =
        json(&text).map_err(|e| machine(format!("the answer is not JSON: {e}: \"{}\"", beginning(&text))))?;
    let Some(answers) = answer.get("runs").and_then(Value::as_array) else {
        return Err(machine(format!(
            "the answer must be as {{\"runs\": [...]}}, and is {}",
            shortened(&answer)
        )));
    };
    if answers.len() != runs.len() {
        let (given, asked) = (answers.len(), runs.len());
        return Err(machine(format!(
            "{given} runs are answered of {asked} that were asked"
        )));
    }
    let of_run = |(run, answer): (usize, &Value)| match answer.get("rejected") {
        Some(reason) => {
            let reason = reason.as_str().map_or_else(|| shortened(reason), beginning);
            Err(ExternalFailure::refused("model", run, reason))
        }
        None => outputs(run, &model.outputs, |_, channel| answer.get(channel.column())),
    };
    answers.iter().enumerate().map(of_run).collect()
}

fn question(model: &ExternalModel, runs: &[ExternalRun]) -> Vec<u8> {
    let of_run = |run: &ExternalRun| {
        let inputs = model.inputs.iter().map(|input| input.name().to_owned());
        let parameters = model.parameters.iter().map(|parameter| parameter.name.clone());
        let values = run.inputs.iter().chain(&run.parameters).map(|value| json!(value));
        Value::Object(inputs.chain(parameters).zip(values).collect::<Map<_, _>>())
    };
    let runs: Vec<Value> = runs.iter().map(of_run).collect();
    let mut text = json!({ "runs": runs }).to_string().into_bytes();
    text.push(b'\n');
    text
}

/// Starts the program, gives it the question, and gives what it has written by its end.
fn run(
    program: &Path,
    question: &[u8],
    limit: Duration,
    memory_mb: Option<u64>,
    groups: &ProcessGroups,
) -> Result<String, ExternalFailure> {
    let name = program.display();
    let machine = |what: &str, error: &dyn std::fmt::Display| {
        ExternalFailure::Machine(format!("{name}: {what}: {error}"))
    };
    let until = Instant::now() + limit;
    let mut child = Command::new(program)
        // A model has no business with the farm.
        .env_remove("GROUSER_TOKEN")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .process_group(0)
        .spawn()
        .map_err(|e| machine("cannot be started (it must be an executable file)", &e))?;
    let pipes = (child.stdin.take(), child.stdout.take(), child.stderr.take());
    let mut group = groups.take(child).map_err(|e| machine("is not run", &e))?;
    if let Err(error) = group.limit(memory_mb, limit) {
        // The error that matters is the first.
        let _ = group.end(Instant::now());
        return Err(machine("its limits cannot be set", &error));
    }
    let (Some(mut stdin), Some(stdout), Some(stderr)) = pipes else {
        return Err(machine("its pipes", &"not there"));
    };
    let (ended, text, said) = std::thread::scope(|scope| {
        // A program that ends without reading its question answers by what it writes.
        scope.spawn(move || drop(stdin.write_all(question)));
        let (done, output) = channel();
        scope.spawn(move || {
            let mut text = Vec::new();
            let read = stdout.take(MOST_BYTES).read_to_end(&mut text);
            // Nobody waits where the time has come.
            let _ = done.send(read.map(|_| text));
        });
        let errors = scope.spawn(move || last(stderr));
        let text = wait(&output, until);
        let ended = group.end(until);
        (ended, text, errors.join().unwrap_or_default())
    });
    let said = beginning(&String::from_utf8_lossy(&said)).replace('\n', " | ");
    let said = if said.is_empty() {
        said
    } else {
        format!(": {said}")
    };
    match ended.map_err(|e| machine("cannot be waited for", &e))? {
        None => {
            let message = format!("{name} takes longer than {} s{said}", limit.as_secs_f64());
            Err(ExternalFailure::broke("time_limit", 0, message))
        }
        Some(status) if !status.success() => {
            let message = format!("{name} failed, {status}{said}");
            Err(ExternalFailure::broke("model_error", 0, message))
        }
        Some(_) => {
            let text = text.unwrap_or_default();
            if text.len() as u64 >= MOST_BYTES {
                let bound = format!("at most {MOST_BYTES} bytes");
                return Err(machine("the answer is too long", &bound));
            }
            String::from_utf8(text).map_err(|e| machine("the answer is not text", &e))
        }
    }
}

/// The output, where it is there in time.
fn wait(output: &Receiver<std::io::Result<Vec<u8>>>, until: Instant) -> Option<Vec<u8>> {
    let left = until.saturating_duration_since(Instant::now());
    output.recv_timeout(left).ok()?.ok()
}

/// The end of what a program says of its errors: the reason stands last.
fn last(mut stderr: impl Read) -> Vec<u8> {
    let (mut said, mut part) = (Vec::new(), [0; 4096]);
    while let Ok(read @ 1..) = stderr.read(&mut part) {
        said.extend_from_slice(&part[..read]);
        let old = said.len().saturating_sub(MOST_ERROR_BYTES);
        said.drain(..old);
    }
    said.split_off(said.len().saturating_sub(300))
}
