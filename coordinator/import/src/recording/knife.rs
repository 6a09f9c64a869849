//! The data of a cut, and the rows of a run.

use crate::binding::{Binding, Output};
use crate::complaint::{Complaint, Complaints};
use crate::map::Recording;
use crate::number::Decimal;
use crate::table::Row;
use crate::title::Titled;

/// The data of a cut.
pub(crate) struct Knife<'a> {
    pub(crate) titled: &'a Titled,
    pub(crate) binding: &'a Binding,
    pub(crate) recording: &'a Recording,
    pub(crate) map_file: &'a str,
    pub(crate) decimal: Option<Decimal>,
    /// Prefix of the names of histories.
    pub(crate) stem: &'a str,
    /// Name of a run that is a file.
    pub(crate) file_run: &'a str,
    /// Whether runs of other files are beside these.
    pub(crate) is_one_of_several: bool,
}

pub(super) struct Sample<'a> {
    pub(super) row: &'a Row,
    pub(super) t_s: f64,
    pub(super) numbers: Vec<Option<f64>>,
}

/// The rows of a run.
pub(super) struct Segment<'a> {
    pub(super) name: String,
    pub(super) samples: Vec<Sample<'a>>,
}

impl Knife<'_> {
    /// Complains about the table `[recording]`.
    pub(super) fn complain(&self, complaints: &mut Complaints, message: &str) {
        complaints.add(Complaint {
            file: self.map_file.to_owned(),
            line: Some(self.recording.line),
            field: Some("recording".into()),
            message: format!("[recording]: {message}"),
            ..Complaint::default()
        });
    }

    /// Complains about a row of a run.
    pub(super) fn complain_at(&self, row: &Row, message: String, complaints: &mut Complaints) {
        complaints.add_cell(Complaint {
            line: Some(row.line),
            field: Some("recording".into()),
            ..self.titled.table.complaint(message)
        });
    }

    /// Complains about a channel's blank cell in a history, unless the cell has a complaint already.
    pub(super) fn complain_of_gap(&self, output: &Output, row: &Row, complaints: &mut Complaints) {
        if !complaints.is_said(row.line, &output.field.name) {
            let message = format!(
                "{} is blank within a run, and a history has no gaps",
                output.field.words
            );
            complaints.add_cell(self.binding.complaint(self.titled, row, output, message));
        }
    }
}
