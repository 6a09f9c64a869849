//! Simulations of planned runs in this process, on all of its cores.

use std::sync::atomic::{AtomicUsize, Ordering};

use farm::calibration::SimulationResult;
use prediction::{Answers, Question, RunAnswers};

use crate::embedded::Evaluate;

/// Draws that one piece of work has: few enough that a single run of a slow model keeps all cores busy.
const CHUNK: usize = 32;

/// Simulates each variant of a question at each parameter vector. The answers do not depend on the number of threads.
///
/// # Errors
/// A sentence: the model cannot be evaluated here.
pub(super) fn simulate(question: &Question) -> Result<Answers, String> {
    let chunks = question.thetas.len().div_ceil(CHUNK).max(1);
    let done = in_parallel(question.variants.len() * chunks, |piece| {
        evaluate(question, piece / chunks, piece % chunks)
    })?;
    let mut answers: Answers = question.variants.iter().map(|_| Vec::new()).collect();
    for (piece, answer) in done.into_iter().enumerate() {
        answers[piece / chunks].extend(answer?);
    }
    Ok(answers)
}

/// Returns the results of numbered pieces of work on all cores, in their order.
///
/// # Errors
/// A sentence: a piece panicked.
pub(super) fn in_parallel<T: Send>(
    pieces: usize,
    work: impl Fn(usize) -> T + Sync,
) -> Result<Vec<T>, String> {
    let next = AtomicUsize::new(0);
    let share = || {
        let mut done = Vec::new();
        loop {
            let piece = next.fetch_add(1, Ordering::Relaxed);
            if piece >= pieces {
                return done;
            }
            done.push((piece, work(piece)));
        }
    };
    let threads = std::thread::available_parallelism()
        .map_or(1, usize::from)
        .min(pieces);
    let parts = std::thread::scope(|scope| {
        let started: Vec<_> = (0..threads).map(|_| scope.spawn(share)).collect();
        started
            .into_iter()
            .map(|thread| thread.join())
            .collect::<Vec<_>>()
    });
    let mut done = Vec::with_capacity(pieces);
    for part in parts {
        done.extend(part.map_err(|_| "the simulation of a planned run ended unexpectedly".to_owned())?);
    }
    done.sort_by_key(|(piece, _)| *piece);
    Ok(done.into_iter().map(|(_, result)| result).collect())
}

/// Simulates a variant at a chunk of the parameter vectors.
fn evaluate(question: &Question, variant: usize, chunk: usize) -> Result<RunAnswers, String> {
    let model = Evaluate::new(&question.variants[variant])?;
    let thetas = question.thetas.iter().skip(chunk * CHUNK).take(CHUNK);
    let result = |theta: &Vec<f64>| {
        let result = SimulationResult::new(model.evaluate(theta)).map_err(|e| e.to_string())?;
        Ok(result.0)
    };
    thetas.map(result).collect()
}
