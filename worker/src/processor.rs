//! Check of the processor against the build.

/// The features of x86-64-v3 beyond those of every x86-64 processor since 2009, as named by Linux; `abm` has LZCNT.
const NEEDED: [&str; 8] = ["avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "abm", "movbe"];

/// The processor of this machine lacks features that the build needs.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "this program was built for processors with AVX2 (x86-64-v3); this machine lacks {0}: build with \
     RUSTFLAGS=\"-C target-cpu=x86-64\"; results are the same"
)]
pub struct ProcessorError(&'static str);

/// Checks the processor; otherwise the first vector instruction would end the program without a message. [`ProcessorError`]
/// says how to build for this machine.
pub fn check() -> Result<(), ProcessorError> {
    if !cfg!(target_feature = "avx2") {
        return Ok(());
    }
    // `is_x86_feature_detected!` reports the assumptions of the build, not the features of the machine.
    match std::fs::read("/proc/cpuinfo") {
        Ok(text) => check_flags(&text),
        Err(_) => Ok(()), // without Linux the features are unknown
    }
}

/// Compares bytes one by one, because iterators over texts use vector registers, whose presence is in question.
fn check_flags(cpuinfo: &[u8]) -> Result<(), ProcessorError> {
    let Some(flags) = cpuinfo
        .split(|&byte| byte == b'\n')
        .find(|line| line.starts_with(b"flags"))
    else {
        return Ok(());
    };
    for feature in NEEDED {
        let is_there = flags
            .split(u8::is_ascii_whitespace)
            .any(|flag| flag == feature.as_bytes());
        if !is_there {
            return Err(ProcessorError(feature));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{NEEDED, check_flags};

    #[test]
    fn missing_processor_features_are_named() {
        let whole = "model name\t: x\nflags\t\t: fpu avx avx2 bmi1 bmi2 f16c fma abm movbe\n";
        assert_eq!(check_flags(whole.as_bytes()), Ok(()));
        for feature in NEEDED {
            let without = whole.replace(&format!(" {feature}"), " other");
            let message = check_flags(without.as_bytes()).unwrap_err().to_string();
            assert!(
                message.contains(&format!("this machine lacks {feature}")),
                "{message}"
            );
        }
        assert_eq!(check_flags(b"Features\t: neon\n"), Ok(()));
    }
}
