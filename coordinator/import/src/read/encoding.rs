//! The encoding of a text file: its bytes decoded to characters.

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};

/// Returns the text, and a remark on the detected encoding if it is not UTF-8.
pub(super) fn decode(bytes: &[u8], stated: Option<&str>) -> Result<(String, Option<String>), String> {
    if let Some(label) = stated {
        let encoding = Encoding::for_label(label.as_bytes()).ok_or_else(|| {
            format!("unknown encoding \"{label}\"; known are utf-8, utf-16le, utf-16be, windows-1252, iso-8859-15, macintosh and others of the WHATWG's list")
        })?;
        let (text, _, has_errors) = encoding.decode(bytes);
        return if has_errors {
            Err(format!(
                "the file is not in {}: leave `encoding` out of the map to have it found",
                encoding.name()
            ))
        } else {
            Ok((text.into_owned(), None))
        };
    }
    let encoding = detect(bytes);
    let (text, used, has_errors) = encoding.decode(bytes);
    if has_errors || text.contains('\0') {
        return Err(format!(
            "this is neither text nor a spreadsheet nor a MATLAB file ({} characters do not fit): export the table as .csv or .xlsx",
            used.name()
        ));
    }
    let remark =
        (used != UTF_8).then(|| format!("the file is read as {}, which it does not state", used.name()));
    Ok((text.into_owned(), remark))
}

/// Returns the encoding: stated by its first bytes; UTF-16 where every second byte is 0; UTF-8 where it fits; else that of Western Windows.
fn detect(bytes: &[u8]) -> &'static Encoding {
    if let Some((encoding, _)) = Encoding::for_bom(bytes) {
        return encoding;
    }
    let beginning = &bytes[..bytes.len().min(2000)];
    let zeros = |parity: usize| {
        beginning
            .iter()
            .skip(parity)
            .step_by(2)
            .filter(|&&b| b == 0)
            .count()
    };
    if zeros(1) * 4 > beginning.len() {
        UTF_16LE
    } else if zeros(0) * 4 > beginning.len() {
        UTF_16BE
    } else if std::str::from_utf8(bytes).is_ok() {
        UTF_8
    } else {
        WINDOWS_1252
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_usual_encoding_is_found() {
        let text = "Prüfung;µm\n1;2\n";
        let wide = |to: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(to).collect::<Vec<u8>>();
        let (western, _, _) = WINDOWS_1252.encode(text);
        let with_mark = |mark: &[u8], bytes: &[u8]| [mark, bytes].concat();
        for bytes in [
            text.as_bytes().to_vec(),
            with_mark(b"\xef\xbb\xbf", text.as_bytes()),
            wide(u16::to_le_bytes),
            wide(u16::to_be_bytes),
            with_mark(b"\xff\xfe", &wide(u16::to_le_bytes)),
            with_mark(b"\xfe\xff", &wide(u16::to_be_bytes)),
            western.into_owned(),
        ] {
            assert_eq!(decode(&bytes, None).unwrap().0, text);
        }
        assert!(
            decode(b"a\xfcb", None)
                .unwrap()
                .1
                .unwrap()
                .contains("windows-1252")
        );
        assert!(
            decode(b"a\xfcb", Some("utf-8"))
                .unwrap_err()
                .contains("not in UTF-8")
        );
        assert!(decode(b"\0\x01\x02\x03abc\0", None).is_err());
        assert!(
            decode(b"a", Some("latin"))
                .unwrap_err()
                .contains("unknown encoding")
        );
    }
}
