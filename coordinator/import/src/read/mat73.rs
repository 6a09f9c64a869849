//! MATLAB files of version 7.3, which are HDF5: a dataset or a group for each variable.
//!
//! Source of the conventions (`MATLAB_class`, sizes in reverse, `#refs#` of cell arrays): files that MATLAB writes, as described by
//! The `MathWorks`, "MAT-File Versions".

use std::collections::BTreeMap;

use hdf5_reader::group::Group;
use hdf5_reader::{Dataset, Datatype, Hdf5File, OpenOptions};

use super::mat5::lines;
use super::variable::{Value, Variables};

/// Maximum size of a variable.
const MAX_BYTES: usize = 256 << 20;
/// Group that contains the parts of cell arrays.
const PARTS: &str = "#refs#";
/// Maximum number of cells in all cell arrays.
const MAX_CELLS: usize = 1_000_000;

type Damaged = String;

fn damaged(error: hdf5_reader::error::Error) -> Damaged {
    format!("the file cannot be read ({error}): save it again with save('NAME.mat', '-v7')")
}

/// The parts of cell arrays by address.
type Parts = BTreeMap<u64, Dataset>;

pub(super) fn read(bytes: &[u8]) -> Result<Variables, Damaged> {
    let bounds = OpenOptions::default()
        .with_max_read_bytes(MAX_BYTES)
        .with_max_chunk_bytes(MAX_BYTES);
    let file = Hdf5File::from_bytes_with_options(bytes, bounds).map_err(damaged)?;
    let root = file.root_group().map_err(damaged)?;
    let (groups, datasets) = root.members().map_err(damaged)?;
    let mut parts = Parts::new();
    if let Some(group) = groups.iter().find(|group| base(group.name()) == PARTS) {
        for dataset in group.datasets().map_err(damaged)? {
            if parts.len() < MAX_CELLS {
                parts.insert(dataset.address(), dataset);
            }
        }
    }
    let mut variables = Vec::new();
    for dataset in &datasets {
        variables.push((base(dataset.name()).to_owned(), value(dataset, &parts)?));
    }
    for group in groups.iter().filter(|group| !base(group.name()).starts_with('#')) {
        variables.push((base(group.name()).to_owned(), fields(group, &parts)?));
    }
    Ok(variables)
}

/// Returns a name without its groups.
fn base(name: &str) -> &str {
    name.rsplit('/').next().unwrap_or(name)
}

/// Returns a struct; in a struct array each field has a list of references.
fn fields(group: &Group, parts: &Parts) -> Result<Value, Damaged> {
    let mut fields = Vec::new();
    for dataset in group.datasets().map_err(damaged)? {
        let is_list = class(&dataset).is_none() && matches!(dataset.dtype(), Datatype::Reference { .. });
        let values = if is_list {
            referred(&dataset, parts)?
        } else {
            vec![value(&dataset, parts)?]
        };
        fields.push((base(dataset.name()).to_owned(), values));
    }
    for inner in group.groups().map_err(damaged)? {
        fields.push((
            base(inner.name()).to_owned(),
            vec![Value::Other("a struct within a struct")],
        ));
    }
    Ok(Value::Fields(fields))
}

fn class(dataset: &Dataset) -> Option<String> {
    dataset.attribute("MATLAB_class").ok()?.read_string().ok()
}

/// Returns the values to which a dataset of references refers.
fn referred(dataset: &Dataset, parts: &Parts) -> Result<Vec<Value>, Damaged> {
    let addresses = dataset.read_native_bytes().map_err(damaged)?;
    let addresses = addresses
        .chunks_exact(8)
        .filter_map(|chunk| chunk.try_into().ok())
        .map(u64::from_le_bytes);
    let value = |address: u64| match parts.get(&address) {
        // A cell within a cell is no text, and might refer to itself.
        Some(part) if matches!(part.dtype(), Datatype::Reference { .. }) => {
            Ok(Value::Other("a cell array within a cell array"))
        }
        Some(part) => value(part, parts),
        None => Ok(Value::Other("a struct in a cell array")),
    };
    addresses.map(value).collect()
}

fn value(dataset: &Dataset, parts: &Parts) -> Result<Value, Damaged> {
    let class = class(dataset).unwrap_or_default();
    let is_empty = dataset.attribute("MATLAB_empty").is_ok();
    let columns_rows: Vec<usize> = dataset
        .shape()
        .iter()
        .map(|&n| usize::try_from(n).unwrap_or(usize::MAX))
        .collect();
    let (columns, rows) = match columns_rows[..] {
        _ if is_empty => (0, 0),
        [] => (1, 1),
        [n] => (1, n),
        [columns, rows] => (columns, rows),
        _ => return Ok(Value::Other("an array of more than two dimensions")),
    };
    if is_empty {
        return Ok(Value::Numbers {
            rows,
            columns,
            values: Vec::new(),
        });
    }
    if matches!(dataset.dtype(), Datatype::Reference { .. }) {
        let shown = |value: Value| match value {
            Value::Texts(texts) if texts.len() <= 1 => Some(texts.into_iter().next().unwrap_or_default()),
            Value::Numbers { values, .. } if values.is_empty() => Some(String::new()),
            Value::Numbers { values, .. } if values.len() == 1 => Some(values[0].to_string()),
            _ => None,
        };
        let texts: Option<Vec<String>> = referred(dataset, parts)?.into_iter().map(shown).collect();
        return Ok(texts.map_or(Value::Other("a cell array of lists"), Value::Texts));
    }
    let Some(values) = numbers(dataset)? else {
        return Ok(Value::Other(
            "an object of MATLAB, as a table or a string: convert it with table2struct(t, 'ToScalar', true) or cellstr",
        ));
    };
    if class == "char" {
        let codes: Vec<u16> = values.iter().map(|&code| code as u16).collect();
        let characters: Vec<char> = char::decode_utf16(codes)
            .map(|c| c.unwrap_or('\u{fffd}'))
            .collect();
        return Ok(Value::Texts(lines(&characters, rows, columns)));
    }
    if !["double", "single", "logical", ""].contains(&class.as_str())
        && !class.starts_with("int")
        && !class.starts_with("uint")
    {
        return Ok(Value::Other(
            "an object of MATLAB, as a table or a string: convert it with table2struct(t, 'ToScalar', true) or cellstr",
        ));
    }
    Ok(Value::Numbers {
        rows,
        columns,
        values,
    })
}

/// Returns the numbers of a dataset in MATLAB's column order; none for an empty one.
fn numbers(dataset: &Dataset) -> Result<Option<Vec<f64>>, Damaged> {
    let read = || dataset.read_native_bytes().map_err(damaged);
    fn each<const N: usize>(bytes: &[u8], read: impl Fn([u8; N]) -> f64) -> Option<Vec<f64>> {
        let chunks = bytes
            .chunks_exact(N)
            .filter_map(|chunk| <[u8; N]>::try_from(chunk).ok());
        Some(chunks.map(read).collect())
    }
    Ok(match dataset.dtype() {
        Datatype::FloatingPoint { size: 8, .. } => each(&read()?, f64::from_ne_bytes),
        Datatype::FloatingPoint { size: 4, .. } => each(&read()?, |b| f64::from(f32::from_ne_bytes(b))),
        Datatype::FixedPoint { size, signed, .. } => match (size, signed) {
            (1, false) => each(&read()?, |b: [u8; 1]| f64::from(b[0])),
            (1, true) => each(&read()?, |b| f64::from(i8::from_ne_bytes(b))),
            (2, false) => each(&read()?, |b| f64::from(u16::from_ne_bytes(b))),
            (2, true) => each(&read()?, |b| f64::from(i16::from_ne_bytes(b))),
            (4, false) => each(&read()?, |b| f64::from(u32::from_ne_bytes(b))),
            (4, true) => each(&read()?, |b| f64::from(i32::from_ne_bytes(b))),
            (8, false) => each(&read()?, |b| u64::from_ne_bytes(b) as f64),
            (8, true) => each(&read()?, |b| i64::from_ne_bytes(b) as f64),
            _ => None,
        },
        _ => None,
    })
}
