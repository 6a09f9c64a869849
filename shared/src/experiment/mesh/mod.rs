//! A wheel given as a surface of triangles.
//!
//! # Layout
//! - This file: reading a mesh in the text form in which it is sent.
//! - `surface`: the triangles and their bounds.
//! - `stl`: STL files, ASCII and binary.
//! - `obj`: Wavefront OBJ files.
//!
//! Files are sent as text. ASCII STL and OBJ are text already; binary STL becomes ASCII STL when it is read from disk
//! ([`Experiment::read_files`](super::Experiment::read_files)), with every coordinate unchanged. A client of the service
//! sends ASCII STL or OBJ.

mod error;
mod obj;
mod stl;
mod surface;

use std::path::Path;

pub use error::MeshError;
pub use surface::{MAX_TRIANGLES, WheelMesh};

use crate::file::FileError;
use crate::text_file::read_text;

/// The maximum size of a file `[bytes]`; the service accepts bodies of 64 MiB.
pub const MAX_BYTES: usize = 48 << 20;

impl WheelMesh {
    /// Reads a mesh from the text of an STL or OBJ file, by the ending of the file's name.
    ///
    /// # Errors
    /// [`FileError`] with the line (OBJ) or the face (STL), counted from 1. Checked by this folder's tests.
    pub fn parse(file: &str, text: &str) -> Result<WheelMesh, FileError> {
        check_size(file, text.len())?;
        let mesh = match format(file).map_err(|e| e.in_file(file))? {
            Format::Stl => stl::parse(file, text)?,
            Format::Obj => obj::parse(file, text)?,
        };
        mesh.check().map_err(|e| e.in_file(file))?;
        Ok(mesh)
    }
}

/// The known formats.
enum Format {
    Stl,
    Obj,
}

fn format(file: &str) -> Result<Format, MeshError> {
    let ending = Path::new(file).extension().unwrap_or_default();
    match ending.to_string_lossy().to_ascii_lowercase().as_str() {
        "stl" => Ok(Format::Stl),
        "obj" => Ok(Format::Obj),
        _ => Err(MeshError::Ending(file.to_owned())),
    }
}

/// Checks the ending of a file's name.
pub(super) fn check_name(file: &str) -> Result<(), MeshError> {
    format(file).map(|_| ())
}

/// Reads a mesh file from disk in the text form in which it is sent.
pub(super) fn read(path: &Path) -> Result<String, FileError> {
    let file = path.display().to_string();
    let whole = |message: String| FileError::whole(&file, message);
    let bytes = std::fs::metadata(path).map_err(|e| whole(e.to_string()))?.len();
    check_size(&file, usize::try_from(bytes).unwrap_or(usize::MAX))?;
    match format(&file).map_err(|e| e.in_file(&file))? {
        Format::Stl => stl::text(&file, std::fs::read(path).map_err(|e| whole(e.to_string()))?),
        Format::Obj => read_text(path),
    }
}

fn check_size(file: &str, bytes: usize) -> Result<(), FileError> {
    if bytes <= MAX_BYTES {
        return Ok(());
    }
    let message = format!("the file has {bytes} bytes, at most {MAX_BYTES} are allowed");
    Err(FileError::whole(file, message))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_of_the_name_gives_the_format() {
        let message = WheelMesh::parse("w.ply", "ply").unwrap_err().to_string();
        assert_eq!(message, "w.ply: mesh = \"w.ply\" must end in .stl or .obj");
    }
}
