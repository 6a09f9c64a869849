//! Patterns of file names: what is read from a name, and the names of files that belong together.

use std::collections::BTreeMap;

/// Maximum length of a pattern and of a name, in characters: the search costs the product of both.
const MAX_CHARS: usize = 250;

/// The texts of a file's name, by the names of their places in a pattern.
pub(crate) type Names = BTreeMap<String, String>;

#[derive(Debug, Clone, PartialEq, Eq)]
enum Part {
    Text(Vec<char>),
    /// A place for one character or more.
    Place(String),
}

/// A name with places in braces, as `{wheel}_s{slip}.txt`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Pattern {
    text: String,
    parts: Vec<Part>,
}

impl Pattern {
    /// Reads a pattern.
    ///
    /// # Errors
    /// A brace without its other, a place without name, or two places without a text between, in words.
    pub(crate) fn read(text: &str) -> Result<Self, String> {
        if text.chars().count() > MAX_CHARS {
            return Err(format!("a pattern must have at most {MAX_CHARS} characters"));
        }
        let mut parts = Vec::new();
        let mut rest = text;
        while !rest.is_empty() {
            let (before, place) = match rest.split_once('{') {
                Some((before, behind)) => match behind.split_once('}') {
                    Some((place, behind)) => {
                        rest = behind;
                        (before, Some(place))
                    }
                    None => return Err(format!("\"{text}\" has a {{ without }}")),
                },
                None => (std::mem::take(&mut rest), None),
            };
            if before.contains('}') {
                return Err(format!("\"{text}\" has a }} without {{"));
            }
            if !before.is_empty() {
                parts.push(Part::Text(before.chars().collect()));
            }
            let Some(place) = place else { continue };
            let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
            if place.is_empty() || !place.chars().all(is_name) {
                return Err(format!(
                    "\"{{{place}}}\" of \"{text}\" must be a name of letters, digits and _"
                ));
            }
            parts.push(Part::Place(place.to_owned()));
        }
        Ok(Pattern {
            text: text.to_owned(),
            parts,
        })
    }

    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// Returns what the places of the pattern are in the name of a file, whose folders count as far as the pattern has folders; `None` if the
    /// name does not fit. No place holds a `/`.
    ///
    /// # Errors
    /// The name fits in two ways, or is too long.
    pub(crate) fn matched(&self, file: &str) -> Result<Option<Names>, String> {
        let folders = self.text.matches('/').count();
        let path = file.replace('\\', "/");
        let begin = path.rmatch_indices('/').nth(folders).map_or(0, |(at, _)| at + 1);
        let name: Vec<char> = path.get(begin..).unwrap_or_default().chars().collect();
        if name.len() > MAX_CHARS {
            return Err(format!("a name must have at most {MAX_CHARS} characters"));
        }
        let places = || {
            self.parts.iter().filter_map(|part| match part {
                Part::Place(place) => Some(place),
                Part::Text(_) => None,
            })
        };
        if let Some(place) = places()
            .enumerate()
            .find(|(k, place)| places().take(*k).any(|known| known == *place))
        {
            return Err(format!("\"{}\" has the place {{{}}} twice", self.text, place.1));
        }
        let ways = self.ways(&name);
        match ways[0][0] {
            0 => Ok(None),
            1 => Ok(Some(self.only(&name, &ways))),
            _ => Err(format!(
                "the name fits \"{}\" in two ways: a text that no place holds must stand between two places",
                self.text
            )),
        }
    }

    /// Returns the number of ways in which the parts from each one fit the characters from each one; two stands for more.
    fn ways(&self, name: &[char]) -> Vec<Vec<u8>> {
        let mut ways = vec![vec![0; name.len() + 1]; self.parts.len() + 1];
        ways[self.parts.len()][name.len()] = 1;
        for (p, part) in self.parts.iter().enumerate().rev() {
            for at in (0..name.len()).rev() {
                ways[p][at] = match part {
                    Part::Text(text) if name[at..].starts_with(text) => ways[p + 1][at + text.len()],
                    Part::Text(_) => 0,
                    Part::Place(_) if name[at] == '/' => 0,
                    Part::Place(_) => 2.min(ways[p + 1][at + 1] + ways[p][at + 1]),
                };
            }
        }
        ways
    }

    /// Returns the only way in which the name fits.
    fn only(&self, name: &[char], ways: &[Vec<u8>]) -> Names {
        let (mut names, mut at) = (Names::new(), 0);
        for (p, part) in self.parts.iter().enumerate() {
            match part {
                Part::Text(text) => at += text.len(),
                Part::Place(place) => {
                    let end = (at + 1..=name.len()).find(|&end| ways[p + 1][end] > 0);
                    let end = end.unwrap_or(name.len());
                    names.insert(place.clone(), name[at..end].iter().collect());
                    at = end;
                }
            }
        }
        names
    }

    /// Returns the text with its places filled.
    ///
    /// # Errors
    /// The first place that has no text, with those that have one.
    pub(crate) fn filled(&self, names: &Names) -> Result<String, String> {
        let part = |part: &Part| match part {
            Part::Text(text) => Ok(text.iter().collect()),
            Part::Place(place) => names.get(place).cloned().ok_or_else(|| {
                let known = names.keys().map(|name| format!("{{{name}}}"));
                format!(
                    "\"{{{place}}}\" is no part of the file's name; known are {}",
                    known.collect::<Vec<_>>().join(", ")
                )
            }),
        };
        self.parts.iter().map(part).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matched(pattern: &str, file: &str) -> Result<Option<Vec<String>>, String> {
        let names = Pattern::read(pattern)?.matched(file)?;
        Ok(names.map(|names| {
            names
                .into_iter()
                .map(|(name, text)| format!("{name}={text}"))
                .collect()
        }))
    }

    #[test]
    fn places_are_read_from_a_name_and_put_into_another() {
        let pattern = Pattern::read("{rim}_s{slip}_v{speed}.txt").unwrap();
        let names = pattern.matched("raw/smooth_s-20_v10.5.txt").unwrap().unwrap();
        let listed: Vec<&str> = names.values().map(String::as_str).collect();
        assert_eq!(listed, ["smooth", "-20", "10.5"]);
        let filled = |text: &str| Pattern::read(text).unwrap().filled(&names);
        assert_eq!(filled("{rim}/{slip}.bag").as_deref(), Ok("smooth/-20.bag"));
        assert_eq!(
            filled("{trial}"),
            Err("\"{trial}\" is no part of the file's name; known are {rim}, {slip}, {speed}".into())
        );
        assert_eq!(
            matched("{day}/run{n}.csv", "C:\\raw\\monday\\run3.csv"),
            Ok(Some(vec!["day=monday".into(), "n=3".into()]))
        );
        assert_eq!(matched("run{n}.csv", "raw/run.csv"), Ok(None));
        assert_eq!(matched("run{n}.csv", "raw/run3.txt"), Ok(None));
    }

    #[test]
    fn what_can_be_read_in_two_ways_is_refused() {
        let two = "the name fits \"{a}_{b}.txt\" in two ways: a text that no place holds must stand between two places";
        assert_eq!(matched("{a}_{b}.txt", "x_y_z.txt"), Err(two.into()));
        assert_eq!(
            matched("{a}_{a}", "x_x"),
            Err("\"{a}_{a}\" has the place {a} twice".into())
        );
        for (pattern, message) in [
            ("{a", "\"{a\" has a { without }"),
            ("a}", "\"a}\" has a } without {"),
            (
                "{a b}",
                "\"{a b}\" of \"{a b}\" must be a name of letters, digits and _",
            ),
        ] {
            assert_eq!(Pattern::read(pattern), Err(message.into()));
        }
    }

    #[test]
    fn a_hostile_pattern_costs_the_product_of_two_lengths() {
        let places: Vec<String> = (0..48).map(|k| format!("{{{k}}}x")).collect();
        assert_eq!(matched(&(places.concat() + ".txt"), &"x".repeat(240)), Ok(None));
    }
}
