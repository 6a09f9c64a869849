//! The files of an import, and those that the map names beside each.

use std::borrow::Cow;

use crate::complaint::Complaint;
use crate::field::Field;
use crate::map::Layout;
use crate::pattern::{Names, Pattern};
use crate::read::{self, SourceFile};
use crate::title::{self, Titled};

/// Returns the content of a file by its name, or says why it cannot be read.
type Open<'a> = dyn Fn(&str) -> Result<Cow<'a, [u8]>, String> + 'a;

/// The files of an import.
#[derive(Clone, Copy)]
pub struct Files<'a> {
    /// Names of the files that are converted.
    pub names: &'a [String],
    /// Returns the content of one of these files, or of a file that the map names beside it; an error says why it cannot be read.
    pub open: &'a Open<'a>,
    /// Whether the user runs this program ([`SourceFile::is_own`]).
    pub is_own: bool,
}

impl Files<'_> {
    /// Reads a file with its titles.
    pub(crate) fn read(
        &self,
        name: &str,
        layout: &Layout,
        fields: &[Field],
    ) -> Result<Titled, Box<Complaint>> {
        let bytes = (self.open)(name).map_err(|message| {
            Box::new(Complaint {
                file: name.to_owned(),
                message,
                ..Complaint::default()
            })
        })?;
        let source = SourceFile {
            name,
            bytes: &bytes,
            is_own: self.is_own,
        };
        let table = read::read(&source, &layout.hints)?;
        title::find(table, (layout.titles, layout.units), fields)
    }
}

/// The files beside one that is converted, and what its name says.
pub(crate) struct Beside<'a, 'f> {
    files: Files<'f>,
    fields: &'a [Field],
    folder: &'a str,
    pub(crate) names: Names,
    /// Files that are held in memory; each at most once, so that all together are bounded by their sizes.
    held: Vec<String>,
}

impl<'a, 'f> Beside<'a, 'f> {
    pub(crate) fn new(files: Files<'f>, fields: &'a [Field], file: &'a str, names: Names) -> Self {
        Beside {
            files,
            fields,
            folder: file
                .rfind(['/', '\\'])
                .and_then(|at| file.get(..=at))
                .unwrap_or_default(),
            names,
            held: vec![file.to_owned()],
        }
    }

    /// Reads a file beside this one, by its name with places, and passes it to `take`.
    ///
    /// # Errors
    /// A place that the name does not have, a file that cannot be read or is being read, and the errors of `take`.
    pub(crate) fn with<T>(
        &mut self,
        pattern: &Pattern,
        layout: &Layout,
        take: impl FnOnce(&Titled, &mut Self) -> Result<T, Box<Complaint>>,
    ) -> Result<T, Box<Complaint>> {
        let wrong = |file: &str, message: String| {
            Box::new(Complaint {
                file: file.to_owned(),
                message,
                ..Complaint::default()
            })
        };
        let name = pattern
            .filled(&self.names)
            .map_err(|message| wrong("", message))?;
        let name = format!("{}{name}", self.folder);
        if self.held.contains(&name) {
            return Err(wrong(&name, "a file does not stand beside itself".into()));
        }
        let titled = self.files.read(&name, layout, self.fields)?;
        self.held.push(name);
        let taken = take(&titled, self);
        self.held.pop();
        taken
    }
}

/// Returns a file's name without folders and ending.
pub(crate) fn stem(file: &str) -> &str {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    match name.rsplit_once('.') {
        Some((stem, _)) if !stem.is_empty() => stem,
        _ => name,
    }
}
