//! Processor time and memory of a process, from proc(5).

use crate::error::StudyError;

/// Processor time of all threads of a process so far \[s\], which Linux counts in hundredths.
///
/// # Arguments
/// - `process`: its number, or `self`.
pub fn cpu_s(process: &str) -> Result<f64, StudyError> {
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat"))?;
    let fields = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
    let ticks: Result<Vec<f64>, _> = fields.skip(11).take(2).map(str::parse).collect();
    Ok(ticks?.iter().sum::<f64>() / 100.0)
}

/// Returns a size in `/proc/PROCESS/status`, as `VmRSS` for the resident memory and `VmHWM` for its maximum \[kB\].
pub fn memory_kb(process: &str, key: &str) -> Result<u64, StudyError> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status"))?;
    let value = status
        .lines()
        .find_map(|line| line.strip_prefix(key)?.strip_prefix(':'));
    let value = value.ok_or_else(|| format!("no {key} of process {process}"))?;
    Ok(value.trim().trim_end_matches(" kB").parse()?)
}
