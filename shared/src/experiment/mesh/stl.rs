//! STL files, ASCII and binary.

use std::fmt::Write;
use std::io::Cursor;

use stl_io::{Triangle, create_stl_reader};

use super::surface::{WheelMesh, check_count};
use crate::file::FileError;

/// Number of bytes before the first triangle of a binary file.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Parses ASCII STL. Several solids in one file are one surface; normals are not used.
pub(super) fn parse(file: &str, text: &str) -> Result<WheelMesh, FileError> {
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let is = |line: Option<&str>, word: &str| {
        line.and_then(|l| l.split_whitespace().next())
            .is_some_and(|w| w.eq_ignore_ascii_case(word))
    };
    if !is(lines.clone().next(), "solid") {
        return Err(FileError::whole(
            file,
            "ASCII STL must begin with \"solid\"; binary STL is converted where the experiment is read from disk",
        ));
    }
    if !is(lines.next_back(), "endsolid") {
        return Err(FileError::whole(
            file,
            "the last line is not \"endsolid\": is the file cut off?",
        ));
    }
    // The reader stops after the first solid and knows lower case only, so it gets one solid in lower case.
    let mut one = String::with_capacity(text.len());
    one.push_str("solid wheel\n");
    for line in lines.filter(|line| !is(Some(line), "solid") && !is(Some(line), "endsolid")) {
        one.push_str(&line.to_ascii_lowercase());
        one.push('\n');
    }
    one.push_str("endsolid wheel\n");
    let triangles = triangles(file, one.into_bytes())?;
    Ok(indexed(&triangles))
}

/// Returns the text form of a file: ASCII unchanged, binary as ASCII with every bit of its coordinates.
pub(super) fn text(file: &str, mut bytes: Vec<u8>) -> Result<String, FileError> {
    // Many binary files begin with the word "solid", too; their length identifies them.
    let count = bytes
        .get(HEADER - 4..HEADER)
        .and_then(|c| c.try_into().ok())
        .map(u32::from_le_bytes);
    let expected = count.map(|n| HEADER as u64 + TRIANGLE as u64 * u64::from(n));
    if expected != Some(bytes.len() as u64) {
        let length = bytes.len();
        return String::from_utf8(bytes).map_err(|_| {
            let says = expected.map_or_else(String::new, |n| {
                format!(": binary STL with this header would have {n} bytes, not {length}")
            });
            FileError::whole(file, format!("neither text nor binary STL{says}"))
        });
    }
    check_count(count.map_or(0, |n| n as usize)).map_err(|e| e.in_file(file))?;
    bytes[..HEADER - 4].fill(0);
    let mut text = String::from("solid wheel\n");
    for triangle in triangles(file, bytes)? {
        text.push_str("facet normal 0 0 0\nouter loop\n");
        for [x, y, z] in triangle.vertices.map(|v| v.0) {
            writeln!(text, "vertex {x:e} {y:e} {z:e}").expect("a string takes all text");
        }
        text.push_str("endloop\nendfacet\n");
    }
    text.push_str("endsolid wheel\n");
    Ok(text)
}

/// Reads the triangles of a file; an error names the face, counted from 1.
fn triangles(file: &str, bytes: Vec<u8>) -> Result<Vec<Triangle>, FileError> {
    let mut cursor = Cursor::new(bytes);
    let reader = create_stl_reader(&mut cursor).map_err(|e| FileError::whole(file, e.to_string()))?;
    let mut triangles: Vec<Triangle> = Vec::new();
    for (i, triangle) in reader.enumerate() {
        let wrong = |message: String| FileError::whole(file, format!("face {}: {message}", i + 1));
        let triangle = triangle.map_err(|e| wrong(e.to_string()))?;
        let mut numbers = triangle.vertices.iter().flat_map(|v| v.0);
        if let Some(x) = numbers.find(|x| !x.is_finite()) {
            return Err(wrong(format!("coordinate {x} m is not finite")));
        }
        triangles.push(triangle);
    }
    check_count(triangles.len()).map_err(|e| e.in_file(file))?;
    Ok(triangles)
}

/// Indexes the vertices, each once, in the order of their first use.
fn indexed(triangles: &[Triangle]) -> WheelMesh {
    let mut positions = std::collections::BTreeMap::new();
    let mut vertices_m = Vec::new();
    let triangles = triangles
        .iter()
        .map(|t| {
            t.vertices.map(|v| {
                *positions.entry(v.0.map(f32::to_bits)).or_insert_with(|| {
                    vertices_m.push(v.0.map(f64::from));
                    // There are three vertices for each of at most 200,000 triangles.
                    (vertices_m.len() - 1) as u32
                })
            })
        })
        .collect();
    WheelMesh {
        vertices_m,
        triangles,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "solid left\nfacet normal 0 0 1\n  outer loop\n  vertex 0 0 0\n  vertex 0.1 0 0\n  vertex 0.1 0.1 0\n endloop\nendfacet\nendsolid left\n\
        SOLID\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1E-1 1E-1 0\nVERTEX 0 0.1 0\nENDLOOP\nENDFACET\nENDSOLID\n\n";

    #[test]
    fn solids_of_a_file_are_one_surface_with_shared_vertices() {
        let mesh = parse("w.stl", SQUARE).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert!((mesh.vertices_m[3][1] - f64::from(0.1_f32)).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn malformed_files_name_the_face() {
        let wrong = |old: &str, new: &str| {
            assert!(SQUARE.contains(old), "{old}");
            let refused = parse("w.stl", &SQUARE.replacen(old, new, 1));
            refused.unwrap_err().to_string()
        };
        for (old, new, begin, part) in [
            ("VERTEX 0 0 0", "VERTEX 0 0", "face 2: ", "\"vertex\""),
            ("vertex 0.1 0 0", "vertex 0.1 0 nan", "face 1: ", "finite"),
            (
                "ENDSOLID",
                "",
                "the last line is not \"endsolid\"",
                ": is the file cut off?",
            ),
            ("solid left", "left", "ASCII STL must begin with \"solid\"", ""),
        ] {
            let message = wrong(old, new);
            assert!(message.starts_with(&format!("w.stl: {begin}")), "{message}");
            assert!(message.contains(part), "{message}");
        }
        let empty = parse("w.stl", "solid\nendsolid").unwrap_err();
        assert_eq!(empty.to_string(), "w.stl: the file has no triangle");
    }

    #[test]
    fn binary_files_keep_every_bit_in_their_text() {
        let numbers = [
            1e-39_f32,
            -0.125,
            0.1,
            3.402_823_5e38,
            1.0 / 3.0,
            -0.0,
            7.0,
            8.5,
            9.25,
        ];
        let mut bytes = b"solid by another program".to_vec();
        bytes.resize(80, b' ');
        bytes.extend(1_u32.to_le_bytes());
        bytes.extend([f32::NAN; 3].iter().chain(&numbers).flat_map(|x| x.to_le_bytes()));
        bytes.extend([0, 0]);
        let mesh = parse("w.stl", &text("w.stl", bytes.clone()).unwrap()).unwrap();
        let read: Vec<u64> = mesh.vertices_m.iter().flatten().map(|x| x.to_bits()).collect();
        assert_eq!(read, numbers.map(|x| f64::from(x).to_bits()));

        bytes[96..100].copy_from_slice(&f32::INFINITY.to_le_bytes());
        let infinite = text("w.stl", bytes.clone()).unwrap_err().to_string();
        assert_eq!(infinite, "w.stl: face 1: coordinate inf m is not finite");
        bytes.pop();
        let message = text("w.stl", bytes).unwrap_err().to_string();
        assert!(message.contains("134 bytes, not 133"), "{message}");
    }
}
