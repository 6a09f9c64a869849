//! Tempering exponent and drift by stage.

use maud::{Markup, html};
use record::StageRow;

use super::axis::{AxisScale, ChartAxis};
use super::frame::{ChartFrame, Marker, line, marker, px};
use crate::words::number;

const WIDTH: f64 = 460.0;
const HEIGHT: f64 = 240.0;
/// A drift up to the first is calm, beyond the second alarming; the picture ends at the third.
const CALM: f64 = 2.0;
const ALARM: f64 = 3.0;
const FARTHEST: f64 = 12.0;

/// Tempering exponent by stage, on a scale of ratios.
pub(in crate::report) fn exponent(stages: &[StageRow]) -> Markup {
    let shown: Vec<&StageRow> = stages.iter().filter(|s| s.tempering_exponent > 0.0).collect();
    let y = ChartAxis::around(shown.iter().map(|s| s.tempering_exponent), 0.05, AxisScale::Log);
    let frame = ChartFrame::new(WIDTH, HEIGHT, numbers(stages), y);
    let place = |s: &StageRow| (frame.x.at(f64::from(s.stage)), frame.y.at(s.tempering_exponent));
    let points: Vec<_> = shown.iter().map(|s| place(s)).collect();
    let marks = html! {
        (line("path", &points))
        @for (stage, (x, y)) in shown.iter().zip(&points) {
            @let hint = format!("stage {}: exponent {}", stage.stage, number::significant(stage.tempering_exponent, 3));
            (marker(kind(stage), *x, *y, &hint))
        }
    };
    frame.draw(
        "tempering exponent by stage",
        "stage",
        "tempering exponent [1]",
        [8, 6],
        &marks,
    )
}

/// Drift by stage with its limits.
pub(in crate::report) fn drift(stages: &[StageRow]) -> Markup {
    let largest = stages
        .iter()
        .map(|s| s.drift_z.abs())
        .filter(|z| z.is_finite())
        .fold(ALARM + 1.0, f64::max);
    let half = largest.min(FARTHEST) * 1.05;
    let frame = ChartFrame::new(
        WIDTH,
        HEIGHT,
        numbers(stages),
        ChartAxis::new(-half, half, AxisScale::Linear),
    );
    let [left, right, ..] = frame.edges();
    let (top, bottom) = (frame.y.at(CALM), frame.y.at(-CALM));
    let marks = html! {
        rect.calm x=(px(left)) y=(px(top)) width=(px(right - left)) height=(px(bottom - top)) {}
        @for z in [-ALARM, ALARM] {
            path.bound d={ "M" (px(left)) " " (px(frame.y.at(z))) "H" (px(right)) } {}
        }
        path.zero d={ "M" (px(left)) " " (px(frame.y.at(0.0))) "H" (px(right)) } {}
        @for stage in stages.iter().filter(|s| s.drift_z.is_finite()) {
            @let hint = format!("stage {}: drift z {}", stage.stage, number::significant(stage.drift_z, 2));
            (marker(kind(stage), frame.x.at(f64::from(stage.stage)), frame.y.at(stage.drift_z), &hint))
        }
    };
    frame.draw(
        "drift of the log-likelihood by stage",
        "stage",
        "drift z [standard errors]",
        [8, 6],
        &marks,
    )
}

fn numbers(stages: &[StageRow]) -> ChartAxis {
    ChartAxis::around(stages.iter().map(|s| f64::from(s.stage)), 0.05, AxisScale::Whole)
}

fn kind(stage: &StageRow) -> Marker {
    if stage.equilibrated {
        Marker::Sound
    } else {
        Marker::Alarming
    }
}
