//! Formulas of curves whose law is known.

#![expect(clippy::unwrap_used, reason = "helpers of tests may panic as tests do")]

mod setup;

mod knots;
mod library;
mod limit;
mod recovery;
mod refitted;
mod text;
