//! Fit the base with one effect added, from what the screen knows.

use super::coordinate::Frame;
use super::descent::{Descent, Point, Step};
use super::screen::Screened;
use crate::likelihood::Likelihood;

/// Broyden's steps alone, the first to the linear solution.
pub(super) const PLAN: [Step; 1] = [Step::Trials(9)];

/// Begins at the fitted base or at the screen's point, whichever is more probable.
pub(super) fn descent(
    frame: &Frame,
    base: &Descent,
    screened: &Screened,
    likelihood: &Likelihood,
) -> Option<Descent> {
    let strength = frame.strength?;
    let mut position = screened.point.position.clone();
    position[strength] = frame.neutral;
    let absent = Point::new(frame, likelihood, position, base.point.values.clone())?;
    let is_present = screened.point.value < absent.value;
    let mut columns = base.columns.clone();
    columns.extend_from_slice(&screened.columns[base.columns.len()..]);
    if !is_present {
        for column in &mut columns[base.columns.len()..] {
            column.fill(0.0);
        }
    }
    columns[strength].clone_from(&screened.change);
    let point = if is_present {
        screened.point.clone()
    } else {
        absent
    };
    Some(Descent::new(frame.clone(), point, columns, &PLAN))
}
