//! The answers of external models, as numbers.

use serde_json::Value;
use shared::channel::Channel;

use super::failure::ExternalFailure;

/// Words that languages write for values without a JSON number.
const NO_NUMBERS: [&str; 7] = ["-Infinity", "Infinity", "-inf", "inf", "NaN", "-nan", "nan"];

/// Reads JSON that may have one of those words in place of a number; the word becomes null.
pub(super) fn json(text: &str) -> Result<Value, String> {
    let strict = serde_json::from_str(text);
    strict.or_else(|_| serde_json::from_str(&without_words(text)).map_err(|e| e.to_string()))
}

fn without_words(text: &str) -> String {
    let mut rest = text;
    let mut clean = String::with_capacity(text.len());
    let (mut is_text, mut is_escaped) = (false, false);
    while let Some(c) = rest.chars().next() {
        let word = NO_NUMBERS
            .iter()
            .find(|word| !is_text && rest.starts_with(**word));
        if let Some(word) = word {
            clean.push_str("null");
            rest = &rest[word.len()..];
            continue;
        }
        is_text ^= c == '"' && !is_escaped;
        is_escaped = is_text && c == '\\' && !is_escaped;
        clean.push(c);
        rest = &rest[c.len_utf8()..];
    }
    clean
}

/// Returns the outputs of one run as numbers. Null stands for no number and means that the parameters have no answer.
pub(super) fn outputs<'a>(
    run: usize,
    outputs: &[Channel],
    value_of: impl Fn(usize, Channel) -> Option<&'a Value>,
) -> Result<Vec<f64>, ExternalFailure> {
    let number = |(place, &channel): (usize, &Channel)| match value_of(place, channel) {
        Some(Value::Null) => Err(ExternalFailure::refused(
            "not_finite",
            run,
            format!("{} is not a finite number", channel.column()),
        )),
        Some(Value::Number(number)) => number.as_f64().filter(|x| x.is_finite()).ok_or_else(|| {
            let message = format!("{} = {number} is not a finite number", channel.column());
            ExternalFailure::refused("not_finite", run, message)
        }),
        other => Err(ExternalFailure::Machine(format!(
            "the model answers {} of run {run} with {}, not with a number",
            channel.column(),
            other.map_or("nothing".to_owned(), shortened)
        ))),
    };
    outputs.iter().enumerate().map(number).collect()
}

/// Returns the beginning of a value, for a message.
pub(super) fn shortened(value: &Value) -> String {
    beginning(&value.to_string())
}

/// Returns the beginning of a text, for a message.
pub(super) fn beginning(text: &str) -> String {
    const LONGEST: usize = 200;
    let text = text.trim();
    match text.char_indices().nth(LONGEST) {
        None => text.to_owned(),
        Some((end, _)) => format!("{} …", &text[..end]),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn words_for_missing_numbers_are_null_outside_strings() {
        let read = json(r#"{"a": [NaN, -Infinity, nan, 1e3], "b": "NaN \" inf"}"#).unwrap();
        assert_eq!(read, json!({"a": [null, null, null, 1e3], "b": "NaN \" inf"}));
        assert!(json("Traceback (most recent call last)").is_err());
    }

    #[test]
    fn null_is_a_rejection_and_a_missing_value_a_fault() {
        let answer = |value: Option<Value>| outputs(3, &[Channel::Torque], |_, _| value.as_ref());
        assert_eq!(answer(Some(json!(2.5))), Ok(vec![2.5]));
        match answer(Some(Value::Null)) {
            Err(ExternalFailure::Refused(r)) => assert_eq!((r.kind.as_str(), r.condition), ("not_finite", 3)),
            other => panic!("{other:?}"),
        }
        for wrong in [None, Some(json!("12")), Some(json!([1.0]))] {
            assert!(matches!(answer(wrong), Err(ExternalFailure::Machine(_))));
        }
    }
}
