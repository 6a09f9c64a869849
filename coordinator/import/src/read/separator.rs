//! The separator of a text, and the fields of its lines.

use std::collections::BTreeMap;

use crate::number;
use crate::table::{Cell, MAX_COLUMNS, Row, too_wide};

/// The separator between fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Separator {
    Byte(u8),
    /// One or more spaces or tabs.
    Spaces,
}

/// Names in a map; where several fit equally, the likeliest is first.
const NAMES: [(&str, Separator); 5] = [
    ("tab", Separator::Byte(b'\t')),
    (";", Separator::Byte(b';')),
    ("|", Separator::Byte(b'|')),
    (",", Separator::Byte(b',')),
    ("space", Separator::Spaces),
];
/// Number of lines and of bytes that are examined; the first two lines are examined as a whole.
const SAMPLE: usize = 200;
const SAMPLE_BYTES: usize = 1 << 20;
/// Number of fields of a line that are tested for numbers.
const SAMPLE_FIELDS: usize = 1000;

impl Separator {
    pub(super) fn named(name: &str) -> Result<Self, String> {
        let entry = NAMES
            .iter()
            .find(|(candidate, _)| *candidate == name || (*candidate == "tab" && name == "\t"));
        let names = NAMES.map(|(name, _)| format!("\"{name}\"")).join(", ");
        entry
            .map(|(_, separator)| *separator)
            .ok_or_else(|| format!("unknown separator \"{name}\"; known are {names}"))
    }

    /// Returns the separator of a text: the one by which the most lines have as many fields, and the most fields are numbers.
    pub(super) fn detect(text: &str) -> Option<Self> {
        let (mut sample, mut lines) = (String::new(), 0);
        for line in text.lines().filter(|line| !line.trim().is_empty()) {
            if lines == SAMPLE || (lines >= 2 && sample.len() + line.len() > SAMPLE_BYTES) {
                break;
            }
            lines += 1;
            sample += line;
            sample.push('\n');
        }
        let scored = NAMES
            .iter()
            .filter_map(|&(_, separator)| Some((separator, score(&sample, separator)?)));
        let best = scored.reduce(|best, next| if next.1 > best.1 { next } else { best });
        best.map(|(separator, _)| separator)
    }

    /// Returns the rows of a text, none wider than a table may be.
    pub(super) fn rows(self, text: &str) -> Result<Vec<Row>, (usize, String)> {
        let mut rows = Vec::new();
        self.each(text, |line, fields| {
            if fields.len() > MAX_COLUMNS {
                return Err(too_wide(fields.len()));
            }
            rows.push(Row {
                line,
                cells: fields.iter().map(|field| Cell::from_text(field)).collect(),
            });
            Ok(())
        })?;
        Ok(rows)
    }

    /// Passes number and fields of each line to `take`, so that a large text is held only once.
    fn each(
        self,
        text: &str,
        mut take: impl FnMut(usize, &[&str]) -> Result<(), String>,
    ) -> Result<(), (usize, String)> {
        let Separator::Byte(delimiter) = self else {
            for (number, line) in text.lines().enumerate() {
                let fields: Vec<&str> = line.split_whitespace().collect();
                take(number + 1, &fields).map_err(|message| (number + 1, message))?;
            }
            return Ok(());
        };
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(delimiter)
            .has_headers(false)
            .flexible(true)
            .from_reader(text.as_bytes());
        let number = |line: u64| usize::try_from(line).unwrap_or(usize::MAX);
        let mut record = csv::StringRecord::new();
        loop {
            let is_there = reader.read_record(&mut record).map_err(|e| {
                let line = e.position().map_or(1, csv::Position::line);
                (number(line), e.to_string())
            })?;
            if !is_there {
                return Ok(());
            }
            let line = number(record.position().map_or(1, csv::Position::line));
            // Blank lines before a record count as part of it.
            let byte = number(record.position().map_or(0, csv::Position::byte));
            let blank = text
                .get(byte..)
                .unwrap_or_default()
                .bytes()
                .take_while(|b| *b == b'\n' || *b == b'\r')
                .filter(|b| *b == b'\n')
                .count();
            let line = line.saturating_add(blank);
            let fields: Vec<&str> = record.iter().collect();
            take(line, &fields).map_err(|message| (line, message))?;
        }
    }
}

/// Returns the quality of a separator: the share of lines with the usual number of fields, and the share of numbers among their fields.
fn score(sample: &str, separator: Separator) -> Option<f64> {
    let (mut rows, mut counts) = (Vec::new(), BTreeMap::<usize, usize>::new());
    let judged = separator.each(sample, |_, fields| {
        let filled = fields
            .iter()
            .take(SAMPLE_FIELDS)
            .map(|field| field.trim())
            .filter(|field| !field.is_empty());
        let is_number = |field: &&str| !field.contains(' ') && number::is_number(field);
        rows.push((
            fields.len(),
            filled.clone().count(),
            filled.filter(is_number).count(),
        ));
        *counts.entry(fields.len()).or_default() += 1;
        Ok(())
    });
    judged.ok()?;
    let (&usual, &lines) = counts
        .iter()
        .filter(|(fields, _)| **fields > 1)
        .max_by_key(|(fields, lines)| (**lines, **fields))?;
    let (mut cells, mut numbers) = (0, 0);
    for (_, filled, numeric) in rows.iter().filter(|(fields, ..)| *fields == usual) {
        cells += filled;
        numbers += numeric;
    }
    Some(lines as f64 / rows.len() as f64 + numbers as f64 / cells.max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_separator_is_told_from_a_decimal_comma() {
        for (text, separator) in [
            ("a;b;c\n1,5;2,5;3\n2,5;3,5;4\n", Separator::Byte(b';')),
            ("a,b,c\n1.5,2.5,3\n2.5,3.5,4\n", Separator::Byte(b',')),
            (
                "Rig 3, sand\nmade on 1 May, 2020\n\na\tb\n1,5\t2,5\n2,5\t3,5\n",
                Separator::Byte(b'\t'),
            ),
            ("a b c\n0,1 20,5 3\n0,2 30,5 4,5\n", Separator::Spaces),
            ("a|b\n1|2\n3|4\n", Separator::Byte(b'|')),
            (
                "run,remark,x\nr1,one; two,3.5\nr2,a; b,4.5\n",
                Separator::Byte(b','),
            ),
        ] {
            assert_eq!(Separator::detect(text), Some(separator), "{text}");
        }
        assert_eq!(Separator::detect("one\ntwo\n"), None);
    }

    #[test]
    fn lines_are_those_of_the_file() {
        let rows = Separator::Byte(b';').rows("a;b\n\n\"x\ny\";2\n3;4\n").unwrap();
        let lines: Vec<usize> = rows.iter().map(|row| row.line).collect();
        assert_eq!(lines, [1, 3, 5]);
    }
}
