//! What a posterior is worth to those who use it: predictions of unseen conditions, and decisions.
//!
//! # Layout
//! - `finished`: a calibration with all that predictions need. [`unseen`]: predictions against a known truth.
//! - [`campaigns`]: decisions by the posterior and by the most probable parameters, over synthetic campaigns.
//! - [`recordings`]: recordings whose soil changes, followed.

pub mod campaigns;
mod finished;
pub mod recordings;
pub mod unseen;
