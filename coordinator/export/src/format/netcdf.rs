//! A NetCDF file in the classic format with 64-bit offsets (CDF-2), which needs no HDF5.
//!
//! The format has no groups: variables and dimensions are named `GROUP.NAME`. It has no text either: texts are characters along an
//! additional dimension, in UTF-8 as the attribute `_Encoding` says. A variable without values is left out, because a dimension of
//! length 0 is the record dimension here.
//!
//! # Source
//! *The NetCDF Classic Format Specification*, Unidata (<https://docs.unidata.ucar.edu/netcdf-c/current/file_format_specifications.html>).

use std::collections::BTreeMap;

use crate::error::ExportError;
use crate::inference_data::InferenceData;
use crate::variable::{Values, Variable};

/// The format: `CDF` with 64-bit offsets, and no records.
const MAGIC: &[u8] = b"CDF\x02\0\0\0\0";
const DIMENSIONS: u32 = 10;
const VARIABLES: u32 = 11;
const ATTRIBUTES: u32 = 12;

/// The header of a variable, and its values.
struct Entry {
    name: String,
    dimensions: Vec<usize>,
    attributes: Vec<(&'static str, String)>,
    kind: u32,
    values: Vec<u8>,
}

/// Writes inference data as one file.
///
/// # Errors
/// [`ExportError::Size`] if a count exceeds the format.
pub fn netcdf(data: &InferenceData) -> Result<Vec<u8>, ExportError> {
    let mut dimensions = Dimensions::default();
    let mut entries = Vec::new();
    for group in &data.groups {
        let variables = group.variables().filter(|variable| !variable.values.is_empty());
        for variable in variables {
            entries.push(entry(&group.name, variable, &mut dimensions)?);
        }
    }
    // The length of the header does not depend on the offset of the values.
    let length = header(data, &dimensions, &entries, 0)?.len();
    let mut file = header(data, &dimensions, &entries, length)?;
    for entry in entries {
        file.extend(entry.values);
    }
    Ok(file)
}

/// Lengths of the dimensions in the order in which they are named.
#[derive(Default)]
struct Dimensions {
    lengths: Vec<(String, usize)>,
    places: BTreeMap<String, usize>,
}

impl Dimensions {
    fn place(&mut self, name: String, length: usize) -> usize {
        let Dimensions { lengths, places } = self;
        *places.entry(name).or_insert_with_key(|name| {
            lengths.push((name.clone(), length));
            lengths.len() - 1
        })
    }
}

fn entry(group: &str, variable: &Variable, dimensions: &mut Dimensions) -> Result<Entry, ExportError> {
    let name = format!("{group}.{}", variable.name);
    let named = variable.dims.iter().zip(&variable.shape);
    let mut places: Vec<usize> = named
        .map(|(dim, &length)| dimensions.place(format!("{group}.{dim}"), length))
        .collect();
    let mut attributes = vec![
        ("units", variable.unit.clone()),
        ("long_name", variable.meaning.clone()),
    ];
    let (kind, mut values): (u32, Vec<u8>) = match &variable.values {
        Values::Real(values) => (6, values.iter().flat_map(|value| value.to_be_bytes()).collect()),
        Values::Whole(values) => (4, whole(values)?),
        Values::Text(values) => {
            let width = values.iter().map(String::len).max().unwrap_or_default().max(1);
            places.push(dimensions.place(format!("{name}.bytes"), width));
            attributes.push(("_Encoding", "utf-8".to_owned()));
            let padded = |value: &String| {
                let mut bytes = value.clone().into_bytes();
                bytes.resize(width, 0);
                bytes
            };
            (2, values.iter().flat_map(padded).collect())
        }
    };
    pad(&mut values);
    attributes.retain(|(_, text)| !text.is_empty());
    Ok(Entry {
        name,
        dimensions: places,
        attributes,
        kind,
        values,
    })
}

/// Encodes whole numbers with 32 bits, because the classic format has no longer type.
fn whole(values: &[i64]) -> Result<Vec<u8>, ExportError> {
    let mut bytes = Vec::with_capacity(4 * values.len());
    for &value in values {
        let short = i32::try_from(value).map_err(|_| ExportError::Size {
            what: "a whole number",
            count: usize::try_from(value.unsigned_abs()).unwrap_or(usize::MAX),
            max: i32::MAX.unsigned_abs().into(),
        })?;
        bytes.extend(short.to_be_bytes());
    }
    Ok(bytes)
}

/// Encodes the header, for values that begin at byte `begin`.
fn header(
    data: &InferenceData,
    dimensions: &Dimensions,
    entries: &[Entry],
    mut begin: usize,
) -> Result<Vec<u8>, ExportError> {
    let mut bytes = MAGIC.to_vec();
    list(&mut bytes, DIMENSIONS, dimensions.lengths.len())?;
    for (name, length) in &dimensions.lengths {
        text(&mut bytes, name)?;
        number(&mut bytes, *length)?;
    }
    let attributes = data.attrs.iter().map(|(name, text)| (name.as_str(), text));
    add_attributes(&mut bytes, attributes)?;
    list(&mut bytes, VARIABLES, entries.len())?;
    for entry in entries {
        text(&mut bytes, &entry.name)?;
        number(&mut bytes, entry.dimensions.len())?;
        for &dimension in &entry.dimensions {
            number(&mut bytes, dimension)?;
        }
        let attributes = entry.attributes.iter().map(|(name, text)| (*name, text));
        add_attributes(&mut bytes, attributes)?;
        bytes.extend(entry.kind.to_be_bytes());
        number(&mut bytes, entry.values.len())?;
        bytes.extend((begin as u64).to_be_bytes());
        begin += entry.values.len();
    }
    Ok(bytes)
}

fn add_attributes<'a>(
    bytes: &mut Vec<u8>,
    attributes: impl ExactSizeIterator<Item = (&'a str, &'a String)>,
) -> Result<(), ExportError> {
    list(bytes, ATTRIBUTES, attributes.len())?;
    for (name, value) in attributes {
        text(bytes, name)?;
        bytes.extend(2_u32.to_be_bytes());
        text(bytes, value)?;
    }
    Ok(())
}

/// Begins a list; an empty list has no tag.
fn list(bytes: &mut Vec<u8>, kind: u32, count: usize) -> Result<(), ExportError> {
    let kind = if count == 0 { 0 } else { kind };
    bytes.extend(kind.to_be_bytes());
    number(bytes, count)
}

fn number(bytes: &mut Vec<u8>, count: usize) -> Result<(), ExportError> {
    let max = i32::MAX;
    let number = i32::try_from(count).map_err(|_| ExportError::Size {
        what: "a length",
        count,
        max: max.unsigned_abs().into(),
    })?;
    bytes.extend(number.to_be_bytes());
    Ok(())
}

fn text(bytes: &mut Vec<u8>, text: &str) -> Result<(), ExportError> {
    number(bytes, text.len())?;
    bytes.extend(text.as_bytes());
    pad(bytes);
    Ok(())
}

/// Pads to a multiple of 4 bytes, at which values and lists begin.
fn pad(bytes: &mut Vec<u8>) {
    bytes.resize(bytes.len().next_multiple_of(4), 0);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference_data::VariableGroup;

    #[test]
    fn a_file_has_the_bytes_of_the_specification() {
        let data = InferenceData {
            attrs: BTreeMap::new(),
            groups: vec![VariableGroup {
                name: "g".into(),
                coords: vec![Variable::labels("d", Values::Whole(vec![7]))],
                data_vars: vec![Variable::new("e", &[("d", 0)], "", "", Values::Real(vec![]))],
            }],
        };
        let expected = [
            b"CDF\x02\0\0\0\0".as_slice(),
            b"\0\0\0\x0a\0\0\0\x01\0\0\0\x03g.d\0\0\0\0\x01", // one dimension of length 1
            b"\0\0\0\0\0\0\0\0",                              // no attributes
            b"\0\0\0\x0b\0\0\0\x01\0\0\0\x03g.d\0\0\0\0\x01\0\0\0\0", // one variable along it
            b"\0\0\0\0\0\0\0\0\0\0\0\x04\0\0\0\x04\0\0\0\0\0\0\0\x54", // whole, 4 bytes, behind 84 bytes
            b"\0\0\0\x07",
        ];
        assert_eq!(netcdf(&data).unwrap(), expected.concat());
    }

    #[test]
    fn a_number_above_32_bits_is_refused() {
        let refused = whole(&[1 << 40]).unwrap_err().to_string();
        assert_eq!(
            refused,
            "a whole number: 1099511627776 must be at most 2147483647"
        );
    }
}
