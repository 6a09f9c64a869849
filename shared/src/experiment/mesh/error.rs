//! Errors of a wheel's surface.

use crate::file::FileError;

/// Why a surface cannot be used; vertices and faces are counted from 1.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// The ending of the file's name is not known.
    #[error("mesh = \"{0}\" must end in .stl or .obj")]
    Ending(String),
    /// The mesh has no triangle.
    #[error("the file has no triangle")]
    Empty,
    /// The mesh has too many triangles.
    #[error("the surface has {triangles} triangles, at most {max} are allowed")]
    TooMany {
        /// Number of triangles.
        triangles: usize,
        /// The largest number allowed.
        max: usize,
    },
    /// A coordinate is not a finite number.
    #[error("vertex {vertex}: coordinate {value} m is not finite")]
    NotFinite {
        /// Number of the vertex.
        vertex: usize,
        /// Coordinate of the vertex `[m]`.
        value: f64,
    },
    /// A face refers to a vertex that does not exist.
    #[error("face {face}: vertex {vertex} is not among the {vertices} vertices")]
    NoVertex {
        /// Number of the face.
        face: usize,
        /// Number of the missing vertex.
        vertex: u64,
        /// Number of vertices.
        vertices: usize,
    },
    /// The surface does not fit the nominal radius and width: a sentence with the extent, its bound and the likely mistake.
    #[error("{0}")]
    Extent(String),
}

impl MeshError {
    /// Returns the error of a file.
    pub(super) fn in_file(&self, file: &str) -> FileError {
        FileError::whole(file, self.to_string())
    }
}
