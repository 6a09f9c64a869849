//! What the rig did, in sentences: offsets of sessions, tarings and operators that repeats show.

use super::explanation::p;
use result::rig::{RepeatOffsets, RigWords};
use result::words::number::list;

/// Probability of offsets from which a sentence says that they are there.
const CLAIMED: f64 = 0.95;
/// Probability of offsets from which a sentence says that they may be there.
const POSSIBLE: f64 = 0.8;

/// Returns a sentence for each quantity that has offsets, one for the other quantities of a wheel, and the reason where the data cannot
/// tell.
pub fn rig_sentences(found: &[RepeatOffsets]) -> Vec<String> {
    let mut sentences = Vec::new();
    for part in found.chunk_by(|a, b| (a.column, &a.wheel) == (b.column, &b.wheel)) {
        sentences.extend(part.iter().filter_map(claim));
        sentences.extend(nothing(part));
        for reason in part.iter().filter_map(|quantity| quantity.confounded.as_ref()) {
            let sentence = capital(reason);
            if !sentences.contains(&sentence) {
                sentences.push(sentence);
            }
        }
    }
    sentences
}

/// Returns the wheel in words.
fn wheel(found: &RepeatOffsets) -> String {
    match &found.wheel {
        Some(wheel) => format!("wheel {wheel}"),
        None => "all wheels".to_owned(),
    }
}

/// Says that a quantity has offsets; `None` if that is not probable.
fn claim(found: &RepeatOffsets) -> Option<String> {
    let probability = found.probability.filter(|p| *p >= POSSIBLE)?;
    let verb = if probability >= CLAIMED {
        "shift"
    } else {
        "may shift"
    };
    let words = RigWords::new(found.column);
    let size = |sd: Option<f64>| Some(found.quantity.shown().size(sd?));
    Some(capital(&format!(
        "{} {verb} the {} of {} ({}): their offsets scatter by {}; repeats of a condition scatter by {} {} one {} and by {} over all",
        words.several,
        found.quantity.words(),
        wheel(found),
        p(probability),
        size(found.offset_sd)?,
        size(found.repeat_sd)?,
        words.preposition,
        words.one,
        size(found.repeat_sd_without)?,
    )))
}

/// Says of which quantities no offset is probable; `None` if there are none.
fn nothing(part: &[RepeatOffsets]) -> Option<String> {
    let quantity = |found: &RepeatOffsets| {
        let probability = found.probability.filter(|p| *p < POSSIBLE)?;
        Some(format!("{} ({})", found.quantity.words(), p(probability)))
    };
    let quantities: Vec<String> = part.iter().filter_map(quantity).collect();
    let first = part.first().filter(|_| !quantities.is_empty())?;
    let one = RigWords::new(first.column).with_article;
    let (quantities, wheel) = (list(&quantities), wheel(first));
    Some(format!("No offset of {one} shows in the {quantities} of {wheel}"))
}

/// Returns a sentence with a capital at its beginning.
fn capital(sentence: &str) -> String {
    let mut letters = sentence.chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

#[cfg(test)]
mod tests {
    use result::rig::RepeatedQuantity;
    use shared::experiment::RigColumn;

    use super::*;

    fn found(
        quantity: RepeatedQuantity,
        probability: Option<f64>,
        confounded: Option<&str>,
    ) -> RepeatOffsets {
        RepeatOffsets {
            wheel: Some("smooth".into()),
            quantity,
            unit: quantity.unit().into(),
            column: RigColumn::Session,
            runs: 60,
            log_bayes_factor: None,
            probability,
            offset_sd: Some(0.00046),
            repeat_sd: Some(0.00035),
            repeat_sd_without: Some(0.00049),
            offsets: Vec::new(),
            confounded: confounded.map(str::to_owned),
        }
    }

    #[test]
    fn offsets_have_a_sentence_each_and_what_has_none_shares_one() {
        let sentences = rig_sentences(&[
            found(RepeatedQuantity::WheelLoad, Some(0.3), None),
            found(RepeatedQuantity::DrawbarPull, Some(0.12), None),
            found(RepeatedQuantity::Sinkage, Some(0.99982), None),
            found(RepeatedQuantity::LateralForce, None, Some("the repeats are few")),
            found(RepeatedQuantity::Torque, None, Some("the repeats are few")),
        ]);
        assert_eq!(
            sentences,
            [
                "Sessions shift the sinkage of wheel smooth (P > 0.999): their offsets scatter by 0.46 mm; repeats of a condition scatter by 0.35 mm in one session and by 0.49 mm over all",
                "No offset of a session shows in the wheel load (P 0.30) and drawbar pull (P 0.12) of wheel smooth",
                "The repeats are few",
            ]
        );
        let possible = rig_sentences(&[found(RepeatedQuantity::Sinkage, Some(0.9), None)]);
        assert!(
            possible[0].starts_with("Sessions may shift the sinkage"),
            "{possible:?}"
        );
    }
}
