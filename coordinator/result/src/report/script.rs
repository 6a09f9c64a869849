//! The scripts of the page and their data: modules and numbers inside the page, so that it needs nothing from elsewhere.

use maud::{Markup, PreEscaped, html};

use crate::figure::StudyFigures;

/// The modules, each behind those that it imports.
const MODULES: [(&str, &str); 11] = [
    ("text", include_str!("../../../page/figures/text.js")),
    ("axis", include_str!("../../../page/figures/axis.js")),
    ("frame", include_str!("../../../page/figures/frame.js")),
    ("mark", include_str!("../../../page/figures/mark.js")),
    ("contour", include_str!("../../../page/figures/contour.js")),
    ("quantity", include_str!("../../../page/figures/quantity.js")),
    (
        "convergence",
        include_str!("../../../page/figures/convergence.js"),
    ),
    (
        "populations",
        include_str!("../../../page/figures/populations.js"),
    ),
    ("posterior", include_str!("../../../page/figures/posterior.js")),
    ("history", include_str!("../../../page/figures/history.js")),
    (
        "error_density",
        include_str!("../../../page/figures/error_density.js"),
    ),
];
/// The module that draws, behind all others.
const PAGE: (&str, &str) = ("page", include_str!("../../../page/figures/page.js"));

/// The numbers of the figures, and the modules that draw them.
pub(super) fn scripts(figures: &StudyFigures) -> Markup {
    let program = format!(
        "const modules = {{}};\n{}modules.page.draw(document);\n",
        program()
    );
    html! {
        script type="application/json" id="figures-data" { (PreEscaped(data(figures))) }
        script type="module" { (PreEscaped(program)) }
    }
}

/// Numbers and names as JSON in which no text can end the element that it stands in.
fn data(figures: &StudyFigures) -> String {
    let json = serde_json::to_string(figures).expect("figures have a JSON form");
    // `<` stands in texts alone, where its escape means the same
    json.replace('<', "\\u003c")
}

/// Every module as a function of its own scope: a page opened from a file may not import one module into another.
fn program() -> String {
    MODULES
        .iter()
        .chain([&PAGE])
        .map(|(name, source)| module(name, source))
        .collect()
}

fn module(name: &str, source: &str) -> String {
    let mut body = String::new();
    let mut exports = Vec::new();
    for line in source.lines() {
        if let Some((names, from)) = import(line) {
            body += &format!("const {names} = modules.{from};\n");
        } else if let Some(function) = line.strip_prefix("export function ") {
            exports.extend(function.split('(').next());
            body += &format!("function {function}\n");
        } else {
            body += &format!("{line}\n");
        }
    }
    let exports = exports.join(", ");
    format!("modules.{name} = (() => {{\n{body}return {{ {exports} }};\n}})();\n")
}

/// The names in braces and the module that `import { a, b } from "./module.js";` takes them from.
fn import(line: &str) -> Option<(&str, &str)> {
    let (names, from) = line.strip_prefix("import ")?.split_once(" from \"./")?;
    Some((names, from.strip_suffix(".js\";")?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn every_module_stands_behind_those_that_it_imports() {
        let mut known: Vec<&str> = Vec::new();
        for (name, source) in MODULES.iter().chain([&PAGE]) {
            for line in source.lines().filter(|l| l.starts_with("import ")) {
                let (_, from) = import(line).unwrap_or_else(|| panic!("{name}: {line}"));
                assert!(known.contains(&from), "{name} imports {from}");
            }
            known.push(name);
        }
        let program = program();
        let leftovers = ["\nimport ", "\nexport ", "</script", "<!--"];
        assert!(leftovers.iter().all(|word| !program.contains(word)), "{program}");
    }

    #[test]
    fn exports_become_the_fields_of_a_scope() {
        let source = "import { px } from \"./text.js\";\n\nconst A = 1;\nexport function f(x) {\n}\n";
        let expected = "modules.m = (() => {\nconst { px } = modules.text;\n\nconst A = 1;\nfunction f(x) {\n}\nreturn { f };\n})();\n";
        assert_eq!(module("m", source), expected);
    }

    #[test]
    fn the_data_parse_back_and_cannot_leave_their_element() {
        let figures = fixture::study().figures();
        let data = data(&figures);
        assert!(!data.contains('<'));
        let parsed: serde_json::Value = serde_json::from_str(&data).unwrap();
        assert_eq!(parsed, serde_json::to_value(&figures).unwrap());
        assert_eq!(parsed["experiment"], "<script>sand");
    }
}
