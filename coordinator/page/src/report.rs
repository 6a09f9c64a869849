//! A report: the page's modules, styles and the recorded answers of the service in one document.

use std::borrow::Cow;
use std::collections::BTreeMap;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::value::RawValue;
use serde_json::{Map, Value, json};

use crate::asset::{modules, text};

/// Prefix of a module's name in the document, where relative paths do not resolve.
const PREFIX: &str = "grouser/";
/// Content security policy: a report makes no requests, and runs only scripts that it contains.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' data:; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; form-action 'none'";

/// The modules of the page that describes the interface, which a report does not show.
const INTERFACE: &str = "modules/interface/";

/// The element that states which calibration of which study is shown first.
const SHOWN: &str = "shown";

/// The content of a report.
#[derive(Debug, Clone)]
pub struct Report<'a> {
    /// Title of the document, as text.
    pub title: &'a str,
    /// Text shown if scripts are disabled.
    pub text: &'a str,
    /// Id of the study.
    pub study: i64,
    /// Id of the calibration whose model is shown first.
    pub calibration: i64,
    /// Answers of the service by their paths.
    pub answers: &'a BTreeMap<String, Box<RawValue>>,
}

/// Builds the document.
pub fn report(report: &Report) -> String {
    let mut page = String::from("<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    let styles: String = ["base", "layout", "chart"]
        .iter()
        .map(|name| text(&format!("style/{name}.css")))
        .collect();
    let mut line = |part: &str| {
        page.push_str(part);
        page.push('\n');
    };
    line("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">");
    line("<meta name=\"color-scheme\" content=\"light dark\">");
    line(&format!(
        "<meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">"
    ));
    line(&format!("<title>{}</title>", escaped(report.title)));
    line(&format!("<style>\n{styles}</style>"));
    line(&format!("<script type=\"importmap\">{}</script>", import_map()));
    line("</head>\n<body>");
    line(&format!(
        "<main id=\"page\" class=\"report\"><pre>{}</pre></main>",
        escaped(report.text)
    ));
    // The answers are megabytes: each is written where it stays.
    line(&format!("{}{{", opening("answers")));
    for (place, (path, answer)) in report.answers.iter().enumerate() {
        let comma = if place == 0 { "" } else { "," };
        line(&format!(
            "{comma}{}:{}",
            embedded(&Value::from(path.as_str()).to_string()),
            embedded(answer.get())
        ));
    }
    line("}</script>");
    let shown = json!({"study": report.study, "calibration": report.calibration});
    line(&format!(
        "{}{}</script>",
        opening(SHOWN),
        embedded(&shown.to_string())
    ));
    line(&format!("<script>{}</script>", text("vendor/d3.js")));
    line(&format!("<script>{}</script>", text("vendor/plot.js")));
    line(&format!(
        "<script type=\"module\">import \"{PREFIX}modules/report.js\";</script>"
    ));
    line("</body>\n</html>");
    page
}

/// Shows the model of another calibration first in a report.
pub fn showing(document: &str, calibration: i64) -> String {
    let (begin, end) = (opening(SHOWN), "</script>");
    let parts = document.split_once(&begin).and_then(|(before, rest)| {
        let (shown, after) = rest.split_once(end)?;
        Some((before, serde_json::from_str::<Value>(shown).ok()?, after))
    });
    let Some((before, mut shown, after)) = parts else {
        return document.to_owned();
    };
    shown["calibration"] = calibration.into();
    format!("{before}{begin}{shown}{end}{after}")
}

fn opening(id: &str) -> String {
    format!("<script type=\"application/json\" id=\"{id}\">")
}

/// Returns JSON for a script element, escaped so that it cannot close the element.
fn embedded(json: &str) -> Cow<'_, str> {
    // `<` occurs in texts only, where its escape means the same.
    match json.contains('<') {
        true => Cow::Owned(json.replace('<', "\\u003c")),
        false => Cow::Borrowed(json),
    }
}

/// Returns the import map, which locates each module in the document.
fn import_map() -> String {
    let entry = |path: String| {
        let source = STANDARD.encode(with_names(&path, &text(&path)));
        (
            format!("{PREFIX}{path}"),
            Value::from(format!("data:text/javascript;base64,{source}")),
        )
    };
    let carried = modules().into_iter().filter(|path| !path.starts_with(INTERFACE));
    let imports: Map<String, Value> = carried.map(entry).collect();
    json!({ "imports": imports }).to_string()
}

/// What stands before the path of an import: of one at the start, and of one at the first use.
const IMPORTS: [&str; 2] = [" from \"", " => import(\""];

/// Replaces the relative paths of a module's imports by names.
fn with_names(path: &str, source: &str) -> String {
    let folder = folder_of(path);
    let line = |line: &str| {
        let mut places = IMPORTS.iter().filter_map(|before| {
            let (head, relative) = line.rsplit_once(before)?;
            let is_relative = relative.starts_with('.');
            is_relative.then(|| format!("{head}{before}{PREFIX}{}", resolved(folder, relative)))
        });
        places.next().unwrap_or_else(|| line.to_owned())
    };
    source.split_inclusive('\n').map(line).collect()
}

fn folder_of(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |(folder, _)| folder)
}

/// Returns the path of a relative import below a folder.
fn resolved(folder: &str, relative: &str) -> String {
    if let Some(rest) = relative.strip_prefix("../") {
        return resolved(folder_of(folder), rest);
    }
    let rest = relative.strip_prefix("./").unwrap_or(relative);
    match folder {
        "" => rest.to_owned(),
        folder => format!("{folder}/{rest}"),
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example(answers: &BTreeMap<String, Box<RawValue>>) -> String {
        report(&Report {
            title: "<sand>",
            text: "a < b",
            study: 1,
            calibration: 3,
            answers,
        })
    }

    #[test]
    fn imports_go_by_name() {
        let source = "import { a } from \"./b.js\";\nexport { c } from \"../rest/d.js\";\nconst e = 1;\n";
        let expected = "import { a } from \"grouser/modules/view/b.js\";\nexport { c } from \"grouser/modules/rest/d.js\";\nconst e = 1;\n";
        assert_eq!(with_names("modules/view/x.js", source), expected);
        let later = "const f = () => import(\"./g.js\").then((g) => g.f);\n";
        let expected = "const f = () => import(\"grouser/modules/view/g.js\").then((g) => g.f);\n";
        assert_eq!(with_names("modules/view/x.js", later), expected);
        let expected = "import { a } from \"grouser/vendor/p.js\";";
        assert_eq!(
            with_names("modules/x.js", "import { a } from \"../vendor/p.js\";"),
            expected
        );
    }

    #[test]
    fn every_module_that_is_imported_is_carried() {
        let map: Value = serde_json::from_str(&import_map()).unwrap();
        let carried = modules().into_iter().filter(|path| !path.starts_with(INTERFACE));
        for path in carried {
            let source = with_names(&path, &text(&path));
            let named = IMPORTS.iter().flat_map(|before| {
                let rests = source.split(before).skip(1);
                rests.filter_map(|rest| rest.split('"').next())
            });
            for name in named.filter(|_| path.starts_with("modules/")) {
                assert!(map["imports"][name].is_string(), "{path} imports {name}");
            }
        }
    }

    #[test]
    fn no_text_leaves_its_element() {
        let answer = RawValue::from_string(r#"{"name": "</script><i>"}"#.to_owned()).unwrap();
        let answers = BTreeMap::from([("/v1/studies/1".to_owned(), answer)]);
        let page = example(&answers);
        assert!(!page.contains("</script><i>") && page.contains("&lt;sand&gt;") && page.contains("a &lt; b"));
        // The document has an import map, two sets of data, two libraries and the entry point.
        assert_eq!(page.matches("<script").count(), 6);
        assert_eq!(page.matches("</script").count(), 6);
    }

    #[test]
    fn another_calibration_is_shown() {
        let page = example(&BTreeMap::new());
        let moved = showing(&page, 5);
        assert!(page.contains("{\"calibration\":3,\"study\":1}</script>"));
        assert!(moved.contains("{\"calibration\":5,\"study\":1}</script>"));
        assert_eq!(showing(&moved, 3), page);
        assert_eq!(showing("no report", 3), "no report");
    }

    #[test]
    fn nothing_is_asked_elsewhere() {
        let page = example(&BTreeMap::new());
        assert!(page.contains(POLICY));
        for word in ["src=\"http", "href=\"http", "@import url"] {
            assert!(!page.contains(word), "{word}");
        }
    }
}
