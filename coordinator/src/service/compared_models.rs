//! The compared models that a study does not go on with.

use crate::study::{Lineage, most_probable};
use record::CalibrationRow;

/// The compared models that a study does not go on with: all but the one of most evidence.
pub(super) fn passed_over(rows: &[CalibrationRow]) -> Vec<i64> {
    let compared = Lineage::new(rows).compared();
    if compared.len() < 2 {
        return Vec::new();
    }
    let best = most_probable(compared.iter().map(|row| row.log_evidence));
    let others = compared.iter().enumerate();
    let others = others.filter(|(number, _)| Some(*number) != best);
    others.map(|(_, row)| row.id).collect()
}
