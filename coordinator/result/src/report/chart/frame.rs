//! The frame of a picture: axes with ticks, titles and units, and the marks that all pictures share.

use maud::{Markup, html};

use super::axis::ChartAxis;

/// Room for labels around the plotted area: left, right, top, bottom.
const MARGINS: [f64; 4] = [52.0, 12.0, 12.0, 42.0];

/// A picture's axes, placed on its pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct ChartFrame {
    width: f64,
    height: f64,
    /// Left to right.
    pub(super) x: ChartAxis,
    /// Bottom to top.
    pub(super) y: ChartAxis,
}

/// A point's mark; every kind has a shape of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::report) enum Marker {
    /// A filled circle: a fitted measurement.
    Fit,
    /// An open diamond: a measurement that was held out.
    Holdout,
    /// A small filled square.
    Sound,
    /// A cross.
    Alarming,
}

impl ChartFrame {
    /// Lays two axes out on a picture of this size.
    pub(super) fn new(width: f64, height: f64, x: ChartAxis, y: ChartAxis) -> Self {
        let [left, right, top, bottom] = MARGINS;
        ChartFrame {
            width,
            height,
            x: x.on(left, width - right),
            y: y.on(height - bottom, top),
        }
    }

    /// Pixels of the plotted area: left, right, top, bottom.
    pub(super) fn edges(&self) -> [f64; 4] {
        let [left, right, top, bottom] = MARGINS;
        [left, self.width - right, top, self.height - bottom]
    }

    /// The picture: frame, ticks and titles around the marks. `label` is what a reader who cannot see it is told.
    pub(super) fn draw(
        &self,
        label: &str,
        x_title: &str,
        y_title: &str,
        ticks: [usize; 2],
        marks: &Markup,
    ) -> Markup {
        let [left, right, top, bottom] = self.edges();
        let y_title_at = px(0.5 * (top + bottom));
        html! {
            svg role="img" aria-label=(label) viewBox={ "0 0 " (px(self.width)) " " (px(self.height)) } {
                @for (value, text) in self.x.ticks(ticks[0]) {
                    @let x = px(self.x.at(value));
                    line.grid x1=(x) x2=(x) y1=(px(top)) y2=(px(bottom)) {}
                    text.tick x=(x) y=(px(bottom + 14.0)) text-anchor="middle" { (text) }
                }
                @for (value, text) in self.y.ticks(ticks[1]) {
                    @let y = self.y.at(value);
                    line.grid x1=(px(left)) x2=(px(right)) y1=(px(y)) y2=(px(y)) {}
                    text.tick x=(px(left - 5.0)) y=(px(y + 3.5)) text-anchor="end" { (text) }
                }
                (marks)
                rect.frame x=(px(left)) y=(px(top)) width=(px(right - left)) height=(px(bottom - top)) {}
                text.axis x=(px(0.5 * (left + right))) y=(px(self.height - 8.0)) text-anchor="middle" { (x_title) }
                text.axis transform={ "translate(12 " (y_title_at) ") rotate(-90)" } text-anchor="middle" { (y_title) }
            }
        }
    }
}

/// A mark at a pixel, with a text for the pointer that rests on it.
pub(super) fn marker(kind: Marker, x: f64, y: f64, hint: &str) -> Markup {
    let shape = |points: &[(f64, f64)], close: &str| {
        let points: Vec<String> = points
            .iter()
            .map(|(dx, dy)| format!("{} {}", px(x + dx), px(y + dy)))
            .collect();
        format!("M{}{close}", points.join("L"))
    };
    html! {
        @match kind {
            Marker::Fit => circle.fit cx=(px(x)) cy=(px(y)) r="3.4" { title { (hint) } },
            Marker::Holdout => {
                path.holdout d=(shape(&[(-4.8, 0.0), (0.0, -4.8), (4.8, 0.0), (0.0, 4.8)], "Z")) { title { (hint) } }
            },
            Marker::Sound => {
                path.sound d=(shape(&[(-3.2, -3.2), (3.2, -3.2), (3.2, 3.2), (-3.2, 3.2)], "Z")) { title { (hint) } }
            },
            Marker::Alarming => {
                path.alarming
                    d={ (shape(&[(-4.5, -4.5), (4.5, 4.5)], "")) (shape(&[(-4.5, 4.5), (4.5, -4.5)], "")) } {
                    title { (hint) }
                }
            },
        }
    }
}

/// A predictive interval with its mean.
pub(super) fn interval(x: f64, low: f64, mean: f64, high: f64) -> Markup {
    let cap = |y: f64| format!("M{} {}h6", px(x - 3.0), px(y));
    html! {
        path.interval d={ (cap(low)) (cap(high)) "M" (px(x)) " " (px(low)) "V" (px(high)) } {}
        path.mean d={ "M" (px(x - 5.0)) " " (px(mean)) "h10" } {}
    }
}

/// A line through points; nothing for fewer than two.
pub(super) fn line(class: &str, points: &[(f64, f64)]) -> Markup {
    let text: Vec<String> = points
        .iter()
        .map(|(x, y)| format!("{} {}", px(*x), px(*y)))
        .collect();
    html! { @if points.len() > 1 { path class=(class) d={ "M" (text.join("L")) } {} } }
}

/// A mark on its own, for a legend.
pub(in crate::report) fn glyph(kind: Option<Marker>) -> Markup {
    html! {
        svg.glyph viewBox="0 0 16 16" aria-hidden="true" {
            @match kind {
                Some(kind) => (marker(kind, 8.0, 8.0, "")),
                None => (interval(8.0, 15.0, 8.0, 1.0)),
            }
        }
    }
}

/// A pixel to a tenth.
pub(super) fn px(value: f64) -> String {
    let text = format!("{value:.1}");
    match text.strip_suffix(".0") {
        Some("-0") => "0".into(),
        Some(whole) => whole.into(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_short() {
        assert_eq!([px(12.0), px(12.34), px(-0.01)], ["12", "12.3", "0"]);
    }

    #[test]
    fn hints_are_escaped() {
        let text = marker(Marker::Fit, 1.0, 2.0, "<b>").into_string();
        assert!(text.contains("&lt;b&gt;") && !text.contains("<b>"));
    }
}
