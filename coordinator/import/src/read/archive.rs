//! The size of a zipped spreadsheet before it is unpacked.

use std::io::{Cursor, Read};

use zip::ZipArchive;

/// Maximum size of all parts together.
const MAX_BYTES: u64 = 512 << 20;
/// Number of bytes at the beginning of the shared strings in which their number is stated.
const HEAD: u64 = 2000;

/// The reason for which an archive is not unpacked, in words.
pub(super) fn check(bytes: &[u8]) -> Result<(), String> {
    let damaged = |e: zip::result::ZipError| {
        format!("the file is damaged ({e}): open it in its program and save it again")
    };
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(damaged)?;
    let mut size = 0_u64;
    for part in 0..archive.len() {
        size = size.saturating_add(archive.by_index_raw(part).map_err(damaged)?.size());
    }
    if size > MAX_BYTES {
        return Err(format!(
            "the unpacked file has {size} bytes, and may have at most {MAX_BYTES}: export the sheet as .csv"
        ));
    }
    // The reader allocates memory for as many strings as are stated.
    let Ok(part) = archive.by_name("xl/sharedStrings.xml") else {
        return Ok(());
    };
    let stated_size = part.size();
    let mut head = String::new();
    let _ = part.take(HEAD).read_to_string(&mut head);
    let count = head
        .split_once("uniqueCount=\"")
        .and_then(|(_, rest)| rest.split('"').next()?.parse::<u64>().ok());
    if count.is_some_and(|count| count > stated_size) {
        return Err(
            "the file is damaged (it states more texts than it has): open it in Excel and save it again"
                .into(),
        );
    }
    Ok(())
}
