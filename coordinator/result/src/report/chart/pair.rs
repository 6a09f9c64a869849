//! The draws of two parameters against each other.

use job::FreeParameter;
use maud::{Markup, html};

use super::axis::ChartAxis;
use super::frame::{ChartFrame, px};
use super::scale::scale;

const WIDTH: f64 = 320.0;
const HEIGHT: f64 = 280.0;
/// More dots than this only make the file long.
const DOTS: usize = 500;

/// A scatter of the draws, evenly thinned.
pub(in crate::report) fn pair(parameters: [&FreeParameter; 2], draws: [&[f64]; 2]) -> Markup {
    let axis = |i: usize| ChartAxis::around(draws[i].iter().copied(), 0.04, scale(parameters[i], draws[i]));
    let frame = ChartFrame::new(WIDTH, HEIGHT, axis(0), axis(1));
    let every = draws[0].len().div_ceil(DOTS).max(1);
    // A segment without length under a round cap is a dot.
    let dots: String = draws[0]
        .iter()
        .zip(draws[1])
        .step_by(every)
        .map(|(x, y)| format!("M{} {}h0", px(frame.x.at(*x)), px(frame.y.at(*y))))
        .collect();
    let title = |p: &FreeParameter| format!("{} [{}]", p.name, p.unit);
    let label = format!("draws of {} against {}", parameters[1].name, parameters[0].name);
    let marks = html! { path.dots d=(dots) {} };
    frame.draw(
        &label,
        &title(parameters[0]),
        &title(parameters[1]),
        [4, 5],
        &marks,
    )
}
