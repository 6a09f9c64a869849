//! Assets: the embedded files of the page, by path, with media type and hash.

use std::borrow::Cow;

#[derive(rust_embed::RustEmbed)]
#[folder = "shell"]
struct Shell;

#[derive(rust_embed::RustEmbed)]
#[folder = "modules"]
#[prefix = "modules/"]
struct Modules;

#[derive(rust_embed::RustEmbed)]
#[folder = "style"]
#[prefix = "style/"]
struct Style;

#[derive(rust_embed::RustEmbed)]
#[folder = "vendor"]
#[prefix = "vendor/"]
struct Vendor;

/// A table of measurements as people keep it, to try the import with.
const TABLE: &str = "example/Messung_Sand.xlsx";
/// Content of the table.
const TABLE_CONTENT: &[u8] = include_bytes!("../../../examples/import-german/Messung_Sand.xlsx");

fn file(path: &str) -> Option<rust_embed::EmbeddedFile> {
    Shell::get(path)
        .or_else(|| Modules::get(path))
        .or_else(|| Style::get(path))
        .or_else(|| Vendor::get(path))
}

/// A file of the page.
#[derive(Debug, Clone)]
pub struct Asset {
    /// Content of the file.
    pub content: Cow<'static, [u8]>,
    /// Media type.
    pub media_type: &'static str,
    /// Hash of the content, in hexadecimal digits.
    pub tag: String,
}

/// The document that a browser loads first.
pub const INDEX: &str = "index.html";
/// The document that describes the interface.
pub const DOCS: &str = "docs.html";

/// Returns a file by its path below the folder of the page; `None` if there is none.
pub fn asset(path: &str) -> Option<Asset> {
    if path == TABLE {
        return Some(Asset {
            content: Cow::Borrowed(TABLE_CONTENT),
            media_type: "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
            tag: format!("{}-{}", env!("CARGO_PKG_VERSION"), TABLE_CONTENT.len()),
        });
    }
    let file = file(path)?;
    let hash = file.metadata.sha256_hash();
    Some(Asset {
        media_type: media_type(path),
        tag: hash.iter().take(16).map(|byte| format!("{byte:02x}")).collect(),
        content: file.data,
    })
}

/// Returns the content of a text file that must exist.
pub(crate) fn text(path: &str) -> String {
    let file = file(path).unwrap_or_else(|| panic!("the page has the file {path}"));
    String::from_utf8_lossy(&file.data).into_owned()
}

/// Returns the paths of all modules, in order.
pub(crate) fn modules() -> Vec<String> {
    let mut paths: Vec<String> = Modules::iter().map(Cow::into_owned).collect();
    paths.push("vendor/preact.js".into());
    paths.sort();
    paths
}

fn media_type(path: &str) -> &'static str {
    match path.rsplit_once('.').map(|(_, extension)| extension) {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("svg") => "image/svg+xml",
        _ => "text/plain; charset=utf-8",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_that_the_documents_name_is_there() {
        let documents = text(INDEX) + &text(DOCS);
        let named: Vec<&str> = documents
            .split('"')
            .filter_map(|part| part.strip_prefix("/page/"))
            .collect();
        assert!(named.len() > 5, "{named:?}");
        for path in named {
            let asset = asset(path).unwrap_or_else(|| panic!("{path}"));
            assert!(asset.media_type != "text/plain; charset=utf-8", "{path}");
            assert_eq!(asset.tag.len(), 32);
        }
        assert!(asset("Cargo.toml").is_none() && asset("../Cargo.toml").is_none());
    }

    #[test]
    fn the_table_to_import_is_there() {
        let table = asset(TABLE).unwrap();
        // A spreadsheet is a zip archive.
        assert!(table.content.starts_with(b"PK") && table.media_type.ends_with("sheet"));
    }

    #[test]
    fn nothing_asks_another_host() {
        for path in modules().iter().filter(|path| path.starts_with("modules/")) {
            let source = text(path).replace("http://www.w3.org/2000/svg", "");
            assert!(
                !source.contains("http://") && !source.contains("https://"),
                "{path}"
            );
        }
    }
}
