//! Check the search for the missing effect on models whose answer is known.

#![expect(clippy::unwrap_used, reason = "helpers of tests may panic as tests do")]

mod discovery;
mod inquiry;
