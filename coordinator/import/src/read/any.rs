//! A file of any format, recognised by its content.

use super::source_file::{Hints, SourceFile};
use crate::complaint::Complaint;
use crate::table::Table;

/// Reads a file of any format, recognised by its content.
pub(crate) fn read(source: &SourceFile<'_>, hints: &Hints) -> Result<Table, Box<Complaint>> {
    let begins = |magic: &[u8]| source.bytes.starts_with(magic);
    let wrong = |message: String| {
        Box::new(Complaint {
            file: source.name.to_owned(),
            message,
            ..Complaint::default()
        })
    };
    if source.bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(wrong(
            "the file is empty: a table of measurements is expected".into(),
        ));
    }
    if begins(b"PK\x03\x04") {
        super::sheet::read_zipped(source, hints)
    } else if begins(b"\xd0\xcf\x11\xe0") {
        super::sheet::read_old(source, hints)
    } else if begins(b"\x89HDF\r\n\x1a\n") || begins(b"MATLAB 7.3 MAT-file") {
        super::variable::table(source.name, super::mat73::read(source.bytes), hints)
    } else if begins(super::bag::MAGIC) {
        super::bag::read(source.name, source.bytes, hints)
    } else if begins(b"MATLAB 5.0 MAT-file") {
        super::variable::table(source.name, super::mat5::read(source.bytes), hints)
    } else if begins(b"#ROSBAG") || source.name.to_lowercase().ends_with(".bag") {
        Err(wrong(
            "this is a bag of another format than ROS 1, version 2.0: convert it, as by `rosbags-convert`"
                .into(),
        ))
    } else if source.name.to_lowercase().ends_with(".mat") {
        Err(wrong(
            "this is no MATLAB file of version 5, 7 or 7.3: save it again with save('NAME.mat', '-v7')"
                .into(),
        ))
    } else if begins(b"%PDF") {
        Err(wrong("this is a PDF: export its table as .xlsx or .csv".into()))
    } else {
        super::text::read(source, hints)
    }
}
