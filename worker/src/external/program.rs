//! A program with JSON input, within its limits.
//!
//! One process evaluates all runs of a parameter vector, because starting an interpreter takes longer than a simple model does. It
//! reads one object, `{"runs": [{"slip": 0.2, ..., "n": 1.1}, ...]}`, with every input and parameter of every run by name, and
//! writes one, `{"runs": [{"drawbar_pull_n": 20.1, ...}, ...]}`. A run without an answer may be `{"rejected": "the reason"}`.
//!
//! The process leads its own [group](super::group), which is killed when it ends, and has limits of memory and time.

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

/// The maximum size of an answer `[bytes]`.
const MAX_BYTES: u64 = 64 << 20;
/// The maximum size of the kept end of standard error `[bytes]`.
const MAX_ERROR_BYTES: usize = 4000;

/// Evaluates all runs in a new process.
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
        let (given, requested) = (answers.len(), runs.len());
        return Err(machine(format!(
            "{given} runs are answered of {requested} that were asked"
        )));
    }
    let outcome = |(run, answer): (usize, &Value)| match answer.get("rejected") {
        Some(reason) => {
            let reason = reason.as_str().map_or_else(|| shortened(reason), beginning);
            Err(ExternalFailure::refused("model", run, reason))
        }
        None => outputs(run, &model.outputs, |_, channel| answer.get(channel.column())),
    };
    answers.iter().enumerate().map(outcome).collect()
}

fn question(model: &ExternalModel, runs: &[ExternalRun]) -> Vec<u8> {
    let input = |run: &ExternalRun| {
        let inputs = model.inputs.iter().map(|input| input.name().to_owned());
        let parameters = model.parameters.iter().map(|parameter| parameter.name.clone());
        let values = run.inputs.iter().chain(&run.parameters).map(|value| json!(value));
        Value::Object(inputs.chain(parameters).zip(values).collect::<Map<_, _>>())
    };
    let runs: Vec<Value> = runs.iter().map(input).collect();
    let mut text = json!({ "runs": runs }).to_string().into_bytes();
    text.push(b'\n');
    text
}

/// Starts the program, writes the question to it, and returns its complete output.
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
        // A model must not act on the farm.
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
        // Only the first error is reported.
        let _ = group.end(Instant::now());
        return Err(machine("its limits cannot be set", &error));
    }
    let (Some(mut stdin), Some(stdout), Some(stderr)) = pipes else {
        return Err(machine("its pipes", &"not there"));
    };
    let (ended, text, stderr_end) = std::thread::scope(|scope| {
        // A program may answer without reading its question, so a failed write is ignored.
        scope.spawn(move || drop(stdin.write_all(question)));
        let (done, output) = channel();
        scope.spawn(move || {
            let mut text = Vec::new();
            let read = stdout.take(MAX_BYTES).read_to_end(&mut text);
            // After the timeout nobody receives.
            let _ = done.send(read.map(|_| text));
        });
        let errors = scope.spawn(move || last(stderr));
        let text = wait(&output, until);
        let ended = group.end(until);
        (ended, text, errors.join().unwrap_or_default())
    });
    let stderr_end = beginning(&String::from_utf8_lossy(&stderr_end)).replace('\n', " | ");
    let stderr_end = if stderr_end.is_empty() {
        stderr_end
    } else {
        format!(": {stderr_end}")
    };
    match ended.map_err(|e| machine("cannot be waited for", &e))? {
        None => {
            let message = format!("{name} takes longer than {} s{stderr_end}", limit.as_secs_f64());
            Err(ExternalFailure::broke("time_limit", 0, message))
        }
        Some(status) if !status.success() => {
            let message = format!("{name} failed, {status}{stderr_end}");
            Err(ExternalFailure::broke("model_error", 0, message))
        }
        Some(_) => {
            let text = text.unwrap_or_default();
            if text.len() as u64 >= MAX_BYTES {
                let bound = format!("at most {MAX_BYTES} bytes");
                return Err(machine("the answer is too long", &bound));
            }
            String::from_utf8(text).map_err(|e| machine("the answer is not text", &e))
        }
    }
}

/// Returns the output if it arrives in time.
fn wait(output: &Receiver<std::io::Result<Vec<u8>>>, until: Instant) -> Option<Vec<u8>> {
    let left = until.saturating_duration_since(Instant::now());
    output.recv_timeout(left).ok()?.ok()
}

/// Returns the end of standard error, because the reason comes last.
fn last(mut stderr: impl Read) -> Vec<u8> {
    let (mut stderr_end, mut part) = (Vec::new(), [0; 4096]);
    while let Ok(read @ 1..) = stderr.read(&mut part) {
        stderr_end.extend_from_slice(&part[..read]);
        let old = stderr_end.len().saturating_sub(MAX_ERROR_BYTES);
        stderr_end.drain(..old);
    }
    stderr_end.split_off(stderr_end.len().saturating_sub(300))
}
