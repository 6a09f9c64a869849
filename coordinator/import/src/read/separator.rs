//! What stands between the fields of a text, and the fields of its lines.

use std::collections::BTreeMap;

use crate::number;

/// What stands between fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Separator {
    Byte(u8),
    /// One or more spaces or tabs.
    Spaces,
}

/// Names in a map, the likeliest first where several fit a file as well.
const NAMES: [(&str, Separator); 5] = [
    ("tab", Separator::Byte(b'\t')),
    (";", Separator::Byte(b';')),
    ("|", Separator::Byte(b'|')),
    (",", Separator::Byte(b',')),
    ("space", Separator::Spaces),
];
/// Lines that are looked at.
const SAMPLE: usize = 200;

/// The fields of lines, with the number of each line.
type Lines = Vec<(usize, Vec<String>)>;

impl Separator {
    pub(super) fn named(name: &str) -> Result<Self, String> {
        let found = NAMES
            .iter()
            .find(|(known, _)| *known == name || (*known == "tab" && name == "\t"));
        let known = NAMES.map(|(name, _)| format!("\"{name}\"")).join(", ");
        found
            .map(|(_, separator)| *separator)
            .ok_or_else(|| format!("unknown separator \"{name}\"; known are {known}"))
    }

    /// The separator of a text: the one by which the most lines have as many fields, and the most fields are numbers.
    pub(super) fn found(text: &str) -> Option<Self> {
        let sample: String = text
            .lines()
            .filter(|line| !line.trim().is_empty())
            .take(SAMPLE)
            .flat_map(|line| [line, "\n"])
            .collect();
        let scored = NAMES
            .iter()
            .filter_map(|&(_, separator)| Some((separator, score(&sample, separator)?)));
        let best = scored.reduce(|best, next| if next.1 > best.1 { next } else { best });
        best.map(|(separator, _)| separator)
    }

    /// The fields of every line, with the line's number.
    pub(super) fn fields(self, text: &str) -> Result<Lines, (usize, String)> {
        match self {
            Separator::Spaces => Ok(text
                .lines()
                .enumerate()
                .map(|(i, line)| (i + 1, line.split_whitespace().map(str::to_owned).collect()))
                .collect()),
            Separator::Byte(delimiter) => {
                let mut reader = csv::ReaderBuilder::new()
                    .delimiter(delimiter)
                    .has_headers(false)
                    .flexible(true)
                    .from_reader(text.as_bytes());
                let mut rows = Vec::new();
                for record in reader.records() {
                    let record = record.map_err(|e| {
                        let line = e.position().map_or(1, |place| place.line());
                        (usize::try_from(line).unwrap_or(usize::MAX), e.to_string())
                    })?;
                    let line = record.position().map_or(1, |place| place.line());
                    // Blank lines before a record belong to its position.
                    let byte = record
                        .position()
                        .map_or(0, |place| usize::try_from(place.byte()).unwrap_or(0));
                    let blank = text
                        .get(byte..)
                        .unwrap_or_default()
                        .bytes()
                        .take_while(|b| *b == b'\n' || *b == b'\r')
                        .filter(|b| *b == b'\n')
                        .count();
                    let line = usize::try_from(line).unwrap_or(usize::MAX).saturating_add(blank);
                    rows.push((line, record.iter().map(str::to_owned).collect()));
                }
                Ok(rows)
            }
        }
    }
}

/// How well a separator fits: the share of the lines with the usual number of fields, and the share of numbers among theirs.
fn score(sample: &str, separator: Separator) -> Option<f64> {
    let rows = separator.fields(sample).ok()?;
    let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
    for (_, fields) in &rows {
        *counts.entry(fields.len()).or_default() += 1;
    }
    let (&usual, &lines) = counts
        .iter()
        .filter(|(fields, _)| **fields > 1)
        .max_by_key(|(fields, lines)| (**lines, **fields))?;
    let cells: Vec<&str> = rows
        .iter()
        .filter(|(_, fields)| fields.len() == usual)
        .flat_map(|(_, fields)| fields.iter().map(|f| f.trim()))
        .filter(|field| !field.is_empty())
        .collect();
    let numbers = cells
        .iter()
        .filter(|cell| !cell.contains(' ') && number::is_number(cell))
        .count();
    Some(lines as f64 / rows.len() as f64 + numbers as f64 / cells.len().max(1) as f64)
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
            assert_eq!(Separator::found(text), Some(separator), "{text}");
        }
        assert_eq!(Separator::found("one\ntwo\n"), None);
    }

    #[test]
    fn lines_are_those_of_the_file() {
        let rows = Separator::Byte(b';').fields("a;b\n\n\"x\ny\";2\n3;4\n").unwrap();
        let lines: Vec<usize> = rows.iter().map(|(line, _)| *line).collect();
        assert_eq!(lines, [1, 3, 5]);
    }
}
