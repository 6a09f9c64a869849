//! Samplers, point estimates and diagnostics against known answers.

#![expect(clippy::unwrap_used, reason = "helpers of tests may panic as tests do")]

mod answers;
mod ask_tell;
mod diagnostics;
mod draws;
mod emulated;
mod evolution;
mod flags;
mod lm;
mod normal_approximation;
mod output_problems;
mod problems;
mod setup;
mod trends;
