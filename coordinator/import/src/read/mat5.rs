//! MATLAB files of version 5 to 7: a header, then one element for each variable.
//!
//! Source: The `MathWorks`, "MAT-File Format", level 5: tags, array flags, classes. The crates that read it refuse headers of other
//! programs or know no structs.

use std::io::Read;

use flate2::read::ZlibDecoder;

use super::variable::{Value, Variables};

const HEADER: usize = 128;
/// Maximum size of an unpacked variable.
const MAX_BYTES: u64 = 256 << 20;
/// Maximum nesting of structs and cells.
const DEEPEST: usize = 8;

/// Type codes of elements (miMATRIX and others).
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;

type Damaged = String;

fn cut() -> Damaged {
    "the file is damaged or cut off: save it again with save('NAME.mat', '-v7')".into()
}

struct Elements<'a> {
    rest: &'a [u8],
    is_big: bool,
}

/// The type of an element and its data.
type Element<'a> = (u32, &'a [u8]);

impl<'a> Elements<'a> {
    fn word(&self, bytes: &[u8]) -> u32 {
        let bytes = [0, 1, 2, 3].map(|k| bytes.get(k).copied().unwrap_or(0));
        if self.is_big {
            u32::from_be_bytes(bytes)
        } else {
            u32::from_le_bytes(bytes)
        }
    }

    fn take(&mut self, bytes: usize) -> Result<&'a [u8], Damaged> {
        let (data, rest) = self.rest.split_at_checked(bytes).ok_or_else(cut)?;
        self.rest = rest;
        Ok(data)
    }

    /// Returns the next element; a short one has its data in its tag.
    fn next(&mut self) -> Result<Element<'a>, Damaged> {
        let tag = self.take(8)?;
        let kind = self.word(tag);
        if kind >> 16 != 0 {
            let data = tag.get(4..4 + (kind >> 16) as usize).ok_or_else(cut)?;
            return Ok((kind & 0xffff, data));
        }
        let bytes = self.word(&tag[4..]) as usize;
        let data = self.take(bytes)?;
        if kind != COMPRESSED {
            // Elements begin at multiples of 8 bytes; the last one may not be padded.
            self.take(bytes.wrapping_neg() % 8)
                .or_else(|_| self.take(self.rest.len()))?;
        }
        Ok((kind, data))
    }

    /// Returns the numbers of an element of any type.
    fn numbers(&self, (kind, data): Element<'_>) -> Result<Vec<f64>, Damaged> {
        fn each<const N: usize>(data: &[u8], is_big: bool, read: impl Fn([u8; N]) -> f64) -> Vec<f64> {
            let chunks = data
                .chunks_exact(N)
                .filter_map(|chunk| <[u8; N]>::try_from(chunk).ok());
            chunks
                .map(|mut bytes| {
                    if is_big {
                        bytes.reverse();
                    }
                    read(bytes)
                })
                .collect()
        }
        let big = self.is_big;
        Ok(match kind {
            1 => each(data, big, |b| f64::from(i8::from_le_bytes(b))),
            2 | 16 => each(data, big, |b| f64::from(u8::from_le_bytes(b))),
            3 => each(data, big, |b| f64::from(i16::from_le_bytes(b))),
            4 | 17 => each(data, big, |b| f64::from(u16::from_le_bytes(b))),
            5 => each(data, big, |b| f64::from(i32::from_le_bytes(b))),
            6 | 18 => each(data, big, |b| f64::from(u32::from_le_bytes(b))),
            7 => each(data, big, |b| f64::from(f32::from_le_bytes(b))),
            9 => each(data, big, f64::from_le_bytes),
            12 => each(data, big, |b| i64::from_le_bytes(b) as f64),
            13 => each(data, big, |b| u64::from_le_bytes(b) as f64),
            _ => return Err(cut()),
        })
    }
}

pub(super) fn read(bytes: &[u8]) -> Result<Variables, Damaged> {
    let body = bytes.get(HEADER..).ok_or_else(cut)?;
    let is_big = match &bytes[HEADER - 2..HEADER] {
        b"IM" => false,
        b"MI" => true,
        _ => return Err(cut()),
    };
    let mut elements = Elements { rest: body, is_big };
    let mut variables = Vec::new();
    while !elements.rest.is_empty() {
        let (kind, data) = elements.next()?;
        let variable = match kind {
            MATRIX => matrix(data, is_big, 0)?,
            COMPRESSED => {
                let mut unpacked = Vec::new();
                let mut decoder = ZlibDecoder::new(data).take(MAX_BYTES + 1);
                decoder.read_to_end(&mut unpacked).map_err(|_| cut())?;
                if unpacked.len() as u64 > MAX_BYTES {
                    return Err(format!(
                        "a variable has more than {MAX_BYTES} bytes: save the columns of the measurements alone"
                    ));
                }
                let mut inner = Elements {
                    rest: &unpacked,
                    is_big,
                };
                match inner.next()? {
                    (MATRIX, data) => matrix(data, is_big, 0)?,
                    _ => return Err(cut()),
                }
            }
            _ => continue,
        };
        // Variables without a name are internal to MATLAB, for objects.
        if !variable.0.is_empty() {
            variables.push(variable);
        }
    }
    Ok(variables)
}

fn text(data: &[u8]) -> String {
    String::from_utf8_lossy(data).trim_end_matches('\0').to_owned()
}

/// Returns a variable, or a part of one, with its name.
fn matrix(data: &[u8], is_big: bool, depth: usize) -> Result<(String, Value), Damaged> {
    if depth > DEEPEST {
        return Err(format!("structs are nested more than {DEEPEST} deep"));
    }
    let mut parts = Elements { rest: data, is_big };
    if data.is_empty() {
        let (rows, columns, values) = (0, 0, Vec::new());
        return Ok((
            String::new(),
            Value::Numbers {
                rows,
                columns,
                values,
            },
        ));
    }
    let (_, flags) = parts.next()?;
    let flags = parts.word(flags);
    let (class, is_complex) = (flags & 0xff, flags & 0x0800 != 0);
    // Objects have their name in the place of the size.
    if class == 17 {
        return Ok((
            text(parts.next()?.1),
            Value::Other(
                "an object, as a table or a string: convert it with table2struct(t, 'ToScalar', true) or cellstr",
            ),
        ));
    }
    let size = parts.next()?;
    let size = parts.numbers(size)?;
    let name = text(parts.next()?.1);
    let elements: f64 = size.iter().product();
    let (rows, columns) = (
        size.first().copied().unwrap_or(0.0) as usize,
        size.get(1).copied().unwrap_or(0.0) as usize,
    );
    let value = match class {
        _ if size.len() > 2 => Value::Other("an array of more than two dimensions"),
        1 => cells(&mut parts, depth)?,
        2 | 3 => fields(&mut parts, elements, depth)?,
        4 => {
            let element = parts.next()?;
            Value::Texts(lines(&characters(&parts, element)?, rows, columns))
        }
        6..=15 if is_complex => Value::Other("complex numbers"),
        6..=15 => numbers(&mut parts, elements, rows, columns)?,
        5 => Value::Other("a sparse matrix"),
        _ => Value::Other("an object of MATLAB"),
    };
    Ok((name, value))
}

fn cells(parts: &mut Elements, depth: usize) -> Result<Value, Damaged> {
    let mut values = Vec::new();
    while !parts.rest.is_empty() {
        let (_, data) = parts.next()?;
        values.push(matrix(data, parts.is_big, depth + 1)?.1);
    }
    Ok(list(values))
}

fn numbers(parts: &mut Elements, count: f64, rows: usize, columns: usize) -> Result<Value, Damaged> {
    let element = parts.next()?;
    let values = parts.numbers(element)?;
    if (values.len() as f64 - count).abs() > 0.0 {
        return Err(cut());
    }
    Ok(Value::Numbers {
        rows,
        columns,
        values,
    })
}

/// Returns a cell array of texts, or of single numbers.
fn list(values: Vec<Value>) -> Value {
    let shown = |value: Value| match value {
        Value::Texts(texts) if texts.len() <= 1 => Some(texts.into_iter().next().unwrap_or_default()),
        Value::Numbers { values, .. } if values.is_empty() => Some(String::new()),
        Value::Numbers { values, .. } if values.len() == 1 => Some(values[0].to_string()),
        _ => None,
    };
    match values.into_iter().map(shown).collect() {
        Some(texts) => Value::Texts(texts),
        None => Value::Other("a cell array of lists"),
    }
}

fn fields(parts: &mut Elements<'_>, elements: f64, depth: usize) -> Result<Value, Damaged> {
    let element = parts.next()?;
    let length = parts.numbers(element)?.first().copied().unwrap_or(0.0) as usize;
    let (_, names) = parts.next()?;
    if length == 0 {
        return Err(cut());
    }
    let mut fields: Vec<(String, Vec<Value>)> = names
        .chunks(length)
        .map(|name| {
            (
                text(name.split(|&b| b == 0).next().unwrap_or_default()),
                Vec::new(),
            )
        })
        .collect();
    let mut left = elements;
    while left > 0.0 && !fields.is_empty() {
        for (_, values) in &mut fields {
            let (_, data) = parts.next()?;
            values.push(matrix(data, parts.is_big, depth + 1)?.1);
        }
        left -= 1.0;
    }
    Ok(Value::Fields(fields))
}

/// Returns the characters of a char matrix in column order.
fn characters(parts: &Elements<'_>, element: Element<'_>) -> Result<Vec<char>, Damaged> {
    if element.0 == 16 {
        return Ok(String::from_utf8_lossy(element.1).chars().collect());
    }
    let codes = parts.numbers(element)?;
    Ok(codes
        .into_iter()
        .map(|code| char::from_u32(code as u32).unwrap_or('\u{fffd}'))
        .collect())
}

/// Returns the rows of a char matrix, without padding.
pub(super) fn lines(characters: &[char], rows: usize, columns: usize) -> Vec<String> {
    if rows == 0 || columns == 0 {
        return vec![String::new()];
    }
    let rows = rows.min(characters.len().max(1));
    let line = |row: usize| {
        characters
            .iter()
            .skip(row)
            .step_by(rows)
            .collect::<String>()
            .trim_end()
            .to_owned()
    };
    (0..rows).map(line).collect()
}
