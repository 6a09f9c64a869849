//! A co-simulation unit by FMI 3.0: a zip archive with a description, the library that computes, and the model.

use std::io::{Cursor, Write};

use shared::model::DrawnModel;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::description::description;
use crate::error::ExportError;

/// File name of the library that is built beside the program.
pub const LIBRARY: &str = if cfg!(windows) {
    "grouser_fmu.dll"
} else if cfg!(target_os = "macos") {
    "libgrouser_fmu.dylib"
} else {
    "libgrouser_fmu.so"
};

/// The platform of this build as the standard names it, and the suffix of a shared library on it.
fn platform() -> (String, &'static str) {
    let (system, suffix) = match std::env::consts::OS {
        "macos" => ("darwin", "dylib"),
        "windows" => ("windows", "dll"),
        other => (other, "so"),
    };
    (format!("{}-{system}", std::env::consts::ARCH), suffix)
}

/// Returns the unit as the bytes of a file: the same ones for the same model and library.
///
/// # Arguments
/// - `library`: the bytes of the library of this platform.
///
/// # Errors
/// [`ExportError::Archive`]: the archive cannot be written. Checked by `tests::a_unit_holds_description_library_and_model`.
///
/// # Source
/// Modelica Association 2023, *Functional Mock-up Interface Specification*, version 3.0.1, section 2.5.
pub fn fmu(model: &DrawnModel, library: &[u8]) -> Result<Vec<u8>, ExportError> {
    let (platform, suffix) = platform();
    let resources = serde_json::to_vec(model).map_err(|e| ExportError::Archive(e.to_string()))?;
    let description = description(model);
    let files: [(String, &[u8]); 3] = [
        ("modelDescription.xml".into(), description.as_bytes()),
        (format!("binaries/{platform}/grouser.{suffix}"), library),
        ("resources/model.json".into(), &resources),
    ];
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    // The time of every entry is 1980: the bytes depend on nothing else.
    let options = SimpleFileOptions::default().last_modified_time(zip::DateTime::DEFAULT);
    for (name, bytes) in files {
        archive.start_file(name, options)?;
        archive
            .write_all(bytes)
            .map_err(|e| ExportError::Archive(e.to_string()))?;
    }
    Ok(archive.finish()?.into_inner())
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::super::fixture::model;
    use super::*;

    #[test]
    fn a_unit_holds_description_library_and_model() {
        let bytes = fmu(&model(), b"library").unwrap();
        assert_eq!(bytes, fmu(&model(), b"library").unwrap());
        let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
        let mut read = |name: &str| {
            let mut bytes = Vec::new();
            archive.by_name(name).unwrap().read_to_end(&mut bytes).unwrap();
            bytes
        };
        let (platform, suffix) = platform();
        assert_eq!(read(&format!("binaries/{platform}/grouser.{suffix}")), b"library");
        let held: DrawnModel = serde_json::from_slice(&read("resources/model.json")).unwrap();
        assert_eq!(held, model());
        let xml = String::from_utf8(read("modelDescription.xml")).unwrap();
        let token = format!("instantiationToken=\"{}\"", model().token);
        for part in [
            token.as_str(),
            "modelName=\"quasi_static &lt;a &amp; b&gt;\"",
            "max=\"2\"",
        ] {
            assert!(xml.contains(part), "{part} in {xml}");
        }
    }
}
