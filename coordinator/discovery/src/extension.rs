//! Fit the base with one effect added, from what the screen knows.

use crate::coordinate::Frame;
use crate::depth::Depth;
use crate::descent::{Descent, Point, Step};
use crate::screen::Screened;
use statistics::likelihood::Likelihood;

/// Broyden's steps alone, the first to the linear solution.
pub(crate) const PLAN: [Step; 1] = [Step::Trials(9)];

/// The same at shapes that are held, then with them.
pub(crate) const HELD: [Step; 4] = [Step::Trials(6), Step::Release, Step::Differences, Step::Trials(6)];

/// Begins at the fitted base or at the screen's point, whichever is more probable.
pub(crate) fn descent(
    frame: &Frame,
    base: &Descent,
    screened: &Screened,
    likelihood: &Likelihood,
    depth: &Depth,
) -> Option<Descent> {
    let position = frame.without(&screened.point.position);
    let absent = Point::new(frame, likelihood, position, base.point.values.clone())?;
    let is_present = screened.point.value < absent.value;
    let is_strength = |k: usize| frame.strengths.iter().any(|(strength, _)| *strength == k);
    let mut columns = base.columns.clone();
    columns.extend_from_slice(&screened.columns[base.columns.len()..]);
    if !is_present {
        // Where an effect is absent its shape changes nothing.
        for k in (base.columns.len()..columns.len()).filter(|k| !is_strength(*k)) {
            columns[k].fill(0.0);
        }
    }
    let point = if is_present {
        screened.point.clone()
    } else {
        absent
    };
    let mut descent = Descent::new(frame.clone(), point, columns, depth.plan);
    if depth.holds_shapes {
        descent.hold((base.columns.len()..frame.dimension()).filter(|k| !is_strength(*k)));
    }
    Some(descent)
}
