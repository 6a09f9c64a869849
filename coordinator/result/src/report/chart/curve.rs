//! The curve of a law outside the library.

use maud::Markup;

use super::axis::{AxisScale, ChartAxis};
use super::frame::{ChartFrame, line};

const WIDTH: f64 = 460.0;
const HEIGHT: f64 = 240.0;

/// A curve through points; `x` and `y` are the titles of the axes.
pub(in crate::report) fn curve(points: &[[f64; 2]], x: &str, y: &str) -> Markup {
    let axis = |i: usize| ChartAxis::around(points.iter().map(|point| point[i]), 0.05, AxisScale::Linear);
    let frame = ChartFrame::new(WIDTH, HEIGHT, axis(0), axis(1));
    let places: Vec<_> = points
        .iter()
        .map(|[px, py]| (frame.x.at(*px), frame.y.at(*py)))
        .collect();
    frame.draw(&format!("{y} by {x}"), x, y, [6, 5], &line("path", &places))
}
