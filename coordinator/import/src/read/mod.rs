//! The readers of files: from the bytes of a file to a table of cells.
//!
//! # Layout
//! - `source_file`: the file, and the map's statements about it. `any`: a file of any format, recognised by its content.
//! - `text`: text with separators; `encoding`, `separator`: their detection.
//! - `sheet`: spreadsheets; `archive`: their size before they are unpacked.
//! - `variable`: the variables of a MATLAB file as a table; `mat5`, `mat73`: its two formats.
//! - `bag`: the wrenches of a ROS 1 bag.

mod any;
mod archive;
mod bag;
mod encoding;
mod mat5;
mod mat73;
mod separator;
mod sheet;
mod source_file;
mod text;
mod variable;

pub(crate) use any::read;
pub(crate) use source_file::Hints;
pub use source_file::SourceFile;
