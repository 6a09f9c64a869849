//! Priors and likelihood, compared with known answers.

#![expect(clippy::unwrap_used, reason = "helpers of tests may panic as tests do")]

mod autocorrelation;
mod bevameter;
mod likelihood;
mod priors;
