//! Tables of columns with fixed widths.

use std::fmt::Display;

use result::words::data_channel::{ShownUnit, short_name};
use shared::channel::Channel;

/// A table of rows `R`: each column states its width, its title and its cell of a row.
pub(super) struct Table<'a, R> {
    columns: Vec<Column<'a, R>>,
}

struct Column<'a, R> {
    /// Number of blanks before the column.
    gap: usize,
    width: usize,
    is_right: bool,
    title: String,
    cell: Box<dyn Fn(R) -> String + 'a>,
}

impl<R> Column<'_, R> {
    fn padded(&self, text: &str) -> String {
        let (gap, width) = (self.gap, self.width);
        match self.is_right {
            true => format!("{:gap$}{text:>width$}", ""),
            false => format!("{:gap$}{text:<width$}", ""),
        }
    }
}

impl<'a, R: Copy> Table<'a, R> {
    /// Makes a table without columns.
    pub(super) fn new() -> Self {
        Table { columns: Vec::new() }
    }

    /// Adds a column of words.
    pub(super) fn left<C: Display>(self, width: usize, title: &str, cell: impl Fn(R) -> C + 'a) -> Self {
        self.column(1, width, false, title, cell)
    }

    /// Adds a column of numbers.
    pub(super) fn right<C: Display>(self, width: usize, title: &str, cell: impl Fn(R) -> C + 'a) -> Self {
        self.column(1, width, true, title, cell)
    }

    /// Adds a column of words, set off from the numbers before it.
    pub(super) fn apart<C: Display>(self, width: usize, title: &str, cell: impl Fn(R) -> C + 'a) -> Self {
        self.column(2, width, false, title, cell)
    }

    /// Adds a remark that follows the column before without a blank and has no title.
    pub(super) fn remark<C: Display>(self, cell: impl Fn(R) -> C + 'a) -> Self {
        self.column(0, 0, false, "", cell)
    }

    fn column<C: Display>(
        mut self,
        gap: usize,
        width: usize,
        is_right: bool,
        title: &str,
        cell: impl Fn(R) -> C + 'a,
    ) -> Self {
        self.columns.push(Column {
            gap: if self.columns.is_empty() { 0 } else { gap },
            width,
            is_right,
            title: title.to_owned(),
            cell: Box::new(move |row| cell(row).to_string()),
        });
        self
    }

    /// Returns the line of titles.
    pub(super) fn header(&self) -> String {
        let titles = self.columns.iter().map(|column| column.padded(&column.title));
        titles.collect::<String>() + "\n"
    }

    /// Returns the first cells of a row without a line break.
    pub(super) fn start(&self, count: usize, row: R) -> String {
        let columns = self.columns.iter().take(count);
        columns.map(|column| column.padded(&(column.cell)(row))).collect()
    }

    /// Returns the line of a row.
    pub(super) fn line(&self, row: R) -> String {
        self.start(self.columns.len(), row) + "\n"
    }

    /// Returns the titles and all rows.
    pub(super) fn text(&self, rows: impl IntoIterator<Item = R>) -> String {
        let lines = rows.into_iter().map(|row| self.line(row));
        self.header() + &lines.collect::<String>()
    }
}

/// Returns the title of a channel's column: `sinkage mm`.
pub(super) fn channel_title(channel: Channel) -> String {
    format!("{} {}", short_name(channel), ShownUnit::new(channel).name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_and_cells_share_their_widths_and_a_remark_follows_without_a_blank() {
        let table = Table::<&(&str, f64)>::new()
            .left(5, "name", |row| row.0)
            .right(6, "x", |row| format!("{:.1}", row.1))
            .apart(4, "sign", |row| if row.1 < 0.0 { "-" } else { "+" })
            .remark(|row| if row.1 > 9.0 { "  LARGE" } else { "" });
        let text = table.text(&[("a", 1.25), ("b", -10.0), ("c", 10.0)]);
        assert_eq!(
            text,
            "name       x  sign\na        1.2  +   \nb      -10.0  -   \nc       10.0  +     LARGE\n"
        );
        assert_eq!(table.start(2, &("a", 2.0)), "a        2.0");
    }
}
