//! Wavefront OBJ files.

use std::io::Cursor;

use tobj::{LoadError, LoadOptions, load_obj_buf};

use super::surface::WheelMesh;
use crate::file::FileError;

/// Parses OBJ. All objects of a file are one surface; faces with more corners are split into fans about their first
/// corner; materials, normals, texture and colours are not used.
pub(super) fn parse(file: &str, text: &str) -> Result<WheelMesh, FileError> {
    let text = &shape(text);
    let options = LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..LoadOptions::default()
    };
    let mut cursor = Cursor::new(text.as_bytes());
    let (models, _) = load_obj_buf(&mut cursor, &options, |_| Ok(Default::default())).map_err(|error| {
        let read = usize::try_from(cursor.position()).unwrap_or(usize::MAX);
        match error {
            // Faces are resolved once the file has ended.
            LoadError::FaceVertexOutOfBounds => missing_vertex(file, text),
            _ => FileError::at(file, line_at(text, read), error.to_string()),
        }
    })?;
    let mut mesh = WheelMesh {
        vertices_m: Vec::new(),
        triangles: Vec::new(),
    };
    for tobj::Mesh {
        positions, indices, ..
    } in models.into_iter().map(|m| m.mesh)
    {
        let offset = mesh.vertices_m.len() as u32;
        mesh.vertices_m
            .extend(positions.chunks_exact(3).map(|v| [v[0], v[1], v[2]]));
        mesh.triangles.extend(
            indices
                .chunks_exact(3)
                .map(|t| [t[0], t[1], t[2]].map(|i| i + offset)),
        );
    }
    Ok(mesh)
}

/// Returns only the vertices and faces of a file, at their lines, so that a mistake in any unused element cannot keep a
/// surface from being read.
fn shape(text: &str) -> String {
    let mut shape = String::with_capacity(text.len());
    for line in text.trim_start_matches('\u{feff}').lines() {
        let line = line.split('#').next().unwrap_or_default();
        let words = || line.split_whitespace();
        match words().next() {
            // A weight, or a colour of three numbers, may follow the three coordinates.
            Some("v") if words().count() > 5 => {
                words().take(4).for_each(|word| shape.extend([word, " "]));
            }
            Some("v" | "f") => shape.push_str(line),
            _ => {}
        }
        shape.push('\n');
    }
    shape
}

/// Returns the line, counted from 1, that ends at this byte.
fn line_at(text: &str, end: usize) -> usize {
    let read = &text.as_bytes()[..end.min(text.len())];
    let ended = read.iter().filter(|&&b| b == b'\n').count();
    ended + usize::from(read.last().is_some_and(|&b| b != b'\n'))
}

/// Names the first face that refers to a missing vertex.
fn missing_vertex(file: &str, text: &str) -> FileError {
    let words = |line: &str, key: &str| {
        let mut words = line.split_whitespace();
        (words.next() == Some(key)).then(|| words.map(str::to_owned).collect::<Vec<_>>())
    };
    let vertices = text.lines().filter(|line| words(line, "v").is_some()).count();
    for (i, line) in text.lines().enumerate() {
        let missing = words(line, "f").into_iter().flatten().find(|corner| {
            let index = corner.split('/').next().and_then(|v| v.parse::<i64>().ok());
            index.is_some_and(|v| v == 0 || v.unsigned_abs() as usize > vertices)
        });
        if let Some(corner) = missing {
            let message = format!("face vertex \"{corner}\" is not among the {vertices} vertices");
            return FileError::at(file, i + 1, message);
        }
    }
    FileError::whole(file, "a face refers to a vertex that is not there")
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "# a square and a triangle\nmtllib w.mtl\nv 0 0 0\nv 0.1 0 0\nv 0.1 0.1 0\nv 0 0.1 0\n\
        vn 0 0 1\no rim\nusemtl steel\nf 1//1 2//1 3//1 4//1\no cap\nv 0.3 0 0\nf -1 1 2\n";

    #[test]
    fn objects_of_a_file_are_one_surface_and_corners_are_split() {
        let mesh = parse("w.obj", SQUARE).unwrap();
        assert_eq!(mesh.triangles.len(), 3);
        let corner = |t: usize, c: usize| mesh.vertices_m[mesh.triangles[t][c] as usize];
        let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(x, y)| (x - y).abs() < 1e-15);
        assert!(near(corner(1, 0), [0.0; 3]) && near(corner(1, 2), [0.0, 0.1, 0.0]));
        // Objects share their vertices.
        assert_eq!(mesh.vertices_m.len(), 5);
        assert!(near(corner(2, 0), [0.3, 0.0, 0.0]) && near(corner(2, 2), [0.1, 0.0, 0.0]));
    }

    #[test]
    fn comments_colours_and_texture_do_not_disturb() {
        let text = "\u{feff}v 0 0 0 1 0.5 0 # red\r\nv 0.1 0 0 # plain\r\nv 0 0 0.1\r\nvt oops\r\nusemtl #1\r\nf 1/7/8 2/7/8 3/7/8 # face\r\n";
        let mesh = parse("w.obj", text).unwrap();
        assert_eq!((mesh.vertices_m.len(), mesh.triangles), (3, vec![[0, 1, 2]]));
    }

    #[test]
    fn malformed_files_name_the_line() {
        let wrong = |old: &str, new: &str| {
            assert!(SQUARE.contains(old), "{old}");
            let refused = parse("w.obj", &SQUARE.replacen(old, new, 1));
            refused.unwrap_err().to_string()
        };
        for (old, new, message) in [
            ("v 0.1 0.1 0", "v 0.1 nought 0", "5: position parse error"),
            ("f -1 1 2", "f a b c", "13: face parse error"),
            (
                "4//1",
                "9//1",
                "10: face vertex \"9//1\" is not among the 5 vertices",
            ),
        ] {
            assert_eq!(wrong(old, new), format!("w.obj line {message}"));
        }
    }
}
