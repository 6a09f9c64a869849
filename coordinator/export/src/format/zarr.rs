//! A Zarr v3 hierarchy: a folder with `zarr.json` for each group and variable, and the values as one chunk each.
//!
//! # Source
//! Zarr core specification 3.0 (<https://zarr-specs.readthedocs.io/en/latest/v3/core/index.html>). Texts are of the data type `string`
//! with the codec `vlen-utf8` (<https://github.com/zarr-developers/zarr-extensions>). Metadata is repeated at the root, as
//! `zarr.consolidate_metadata` of zarr-python does it, so that a reader asks for one file.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

use crate::error::ExportError;
use crate::inference_data::InferenceData;
use crate::variable::{Values, Variable};

/// Name of the file with the metadata of a group or variable.
const METADATA: &str = "zarr.json";

/// Writes inference data as files, keyed by their paths below the folder of the hierarchy.
///
/// # Errors
/// [`ExportError::Size`] if a text is too long.
pub fn zarr(data: &InferenceData) -> Result<BTreeMap<String, Vec<u8>>, ExportError> {
    let mut files = BTreeMap::new();
    let mut nodes = Map::new();
    for group in &data.groups {
        nodes.insert(group.name.clone(), node(&json!({})));
        for variable in group.variables() {
            let path = format!("{}/{}", group.name, variable.name);
            if !variable.values.is_empty() {
                let zeros = vec!["0"; variable.shape.len()].join("/");
                files.insert(format!("{path}/c/{zeros}"), chunk(&variable.values)?);
            }
            nodes.insert(path, array(variable));
        }
    }
    for (path, node) in &nodes {
        files.insert(format!("{path}/{METADATA}"), text(node));
    }
    let mut root = node(&json!(data.attrs));
    root["consolidated_metadata"] = json!({"kind": "inline", "must_understand": false, "metadata": nodes});
    files.insert(METADATA.to_owned(), text(&root));
    Ok(files)
}

fn text(metadata: &Value) -> Vec<u8> {
    format!("{metadata:#}\n").into_bytes()
}

fn node(attributes: &Value) -> Value {
    json!({"zarr_format": 3, "node_type": "group", "attributes": attributes})
}

fn array(variable: &Variable) -> Value {
    let (data_type, fill_value, codec) = match variable.values {
        Values::Real(_) => ("float64", json!("NaN"), little_endian()),
        Values::Whole(_) => ("int64", json!(0), little_endian()),
        Values::Text(_) => (
            "string",
            json!(""),
            json!({"name": "vlen-utf8", "configuration": {}}),
        ),
    };
    let attributes = [("units", &variable.unit), ("long_name", &variable.meaning)];
    let attributes: BTreeMap<_, _> = attributes
        .into_iter()
        .filter(|(_, text)| !text.is_empty())
        .collect();
    // A chunk has at least one place along each dimension, even without values.
    let chunk: Vec<usize> = variable.shape.iter().map(|&length| length.max(1)).collect();
    json!({
        "zarr_format": 3,
        "node_type": "array",
        "shape": variable.shape,
        "data_type": data_type,
        "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": chunk}},
        "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}},
        "fill_value": fill_value,
        "codecs": [codec],
        "dimension_names": variable.dims,
        "attributes": attributes,
    })
}

fn little_endian() -> Value {
    json!({"name": "bytes", "configuration": {"endian": "little"}})
}

/// Encodes the values.
fn chunk(values: &Values) -> Result<Vec<u8>, ExportError> {
    Ok(match values {
        Values::Real(values) => values.iter().flat_map(|value| value.to_le_bytes()).collect(),
        Values::Whole(values) => values.iter().flat_map(|value| value.to_le_bytes()).collect(),
        Values::Text(values) => {
            let mut bytes = length(values.len())?.to_vec();
            for value in values {
                bytes.extend(length(value.len())?);
                bytes.extend(value.as_bytes());
            }
            bytes
        }
    })
}

fn length(count: usize) -> Result<[u8; 4], ExportError> {
    let length = u32::try_from(count).map_err(|_| ExportError::Size {
        what: "texts, or bytes of a text",
        count,
        max: u32::MAX.into(),
    })?;
    Ok(length.to_le_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference_data::VariableGroup;

    #[test]
    fn values_stand_in_one_chunk_behind_their_metadata() {
        let dims = [("chain", 1), ("draw", 2)];
        let data = InferenceData {
            attrs: BTreeMap::from([("name".into(), "sand".into())]),
            groups: vec![VariableGroup {
                name: "posterior".into(),
                coords: vec![Variable::labels(
                    "run",
                    Values::Text(vec!["a".into(), "µ".into()]),
                )],
                data_vars: vec![
                    Variable::new("n", &dims, "1", "", Values::Real(vec![1.0, f64::NAN])),
                    Variable::new("none", &[("draw", 0)], "", "", Values::Real(vec![])),
                ],
            }],
        };
        let files = zarr(&data).unwrap();
        let chunk = &files["posterior/n/c/0/0"];
        assert_eq!(chunk[..8], 1.0_f64.to_le_bytes());
        assert_eq!(chunk.len(), 16);
        assert_eq!(
            files["posterior/run/c/0"],
            b"\x02\0\0\0\x01\0\0\0a\x02\0\0\0\xc2\xb5"
        );
        assert!(!files.contains_key("posterior/none/c/0"));
        let metadata: Value = serde_json::from_slice(&files["posterior/n/zarr.json"]).unwrap();
        assert_eq!(metadata["shape"], json!([1, 2]));
        assert_eq!(metadata["dimension_names"], json!(["chain", "draw"]));
        assert_eq!(metadata["attributes"], json!({"units": "1"}));
        let root: Value = serde_json::from_slice(&files["zarr.json"]).unwrap();
        assert_eq!(root["attributes"]["name"], "sand");
        assert_eq!(root["consolidated_metadata"]["metadata"]["posterior/n"], metadata);
    }
}
