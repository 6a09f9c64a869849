//! Check of the processor against the build.

/// The processor feature that the build needs, as named by Linux.
const NEEDED: &str = "avx2";

/// This machine's processor lacks what the build asks for.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "this program was built for processors with {NEEDED}, which this machine does not have: build with \
     RUSTFLAGS=\"-C target-cpu=x86-64\"; results are the same"
)]
pub struct ProcessorError;

/// Checks the processor; otherwise the first vector instruction would end the program without a message.
///
/// # Errors
/// [`ProcessorError`] says how to build for this machine.
pub fn check() -> Result<(), ProcessorError> {
    if !cfg!(target_feature = "avx2") {
        return Ok(());
    }
    // `is_x86_feature_detected!` answers what the build assumes, not what the machine has.
    match std::fs::read_to_string("/proc/cpuinfo") {
        Ok(text) => check_flags(&text),
        Err(_) => Ok(()), // not Linux: nothing to ask
    }
}

fn check_flags(cpuinfo: &str) -> Result<(), ProcessorError> {
    let flags = cpuinfo.lines().find_map(|line| line.strip_prefix("flags"));
    match flags {
        Some(flags) if !flags.split_whitespace().any(|flag| flag == NEEDED) => Err(ProcessorError),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::check_flags;

    #[test]
    fn a_processor_without_the_needed_flag_is_named() {
        assert_eq!(
            check_flags("model name\t: x\nflags\t\t: fpu avx avx2 bmi1\n"),
            Ok(())
        );
        assert!(
            check_flags("flags\t\t: fpu avx bmi1\n")
                .unwrap_err()
                .to_string()
                .contains("avx2")
        );
        assert_eq!(check_flags("Features\t: neon\n"), Ok(()));
    }
}
