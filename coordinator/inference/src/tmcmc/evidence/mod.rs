//! The log-evidence (`log_evidence`) from bridge estimates between neighbouring stages (`bridge`).

mod bridge;
mod log_evidence;

pub(super) use log_evidence::Evidence;
