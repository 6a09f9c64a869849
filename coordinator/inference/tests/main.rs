//! Check priors, likelihood and sampler against known answers.

#![expect(clippy::unwrap_used, reason = "helpers of tests may panic as tests do")]

mod answers;
mod ask_tell;
mod bevameter;
mod diagnostics;
mod discovery;
mod flags;
mod inquiry;
mod likelihood;
mod lm;
mod metamodel;
mod priors;
mod problems;
mod search;
mod trends;
