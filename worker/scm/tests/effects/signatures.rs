//! What each effect of the catalogue changes.

use crate::validation::{self, effects};

#[test]
fn effects_change_what_another_implementation_says() {
    let rows = validation::rows(effects::add);
    let failed: Vec<_> = rows.iter().filter(|row| !row.passes()).collect();
    assert!(
        rows.len() > 600 && failed.is_empty(),
        "{} of {}: {failed:#?}",
        failed.len(),
        rows.len()
    );
}
