//! Measured points and predictive intervals of one wheel and channel, run by run.

use maud::{Markup, html};
use shared::channel::Channel;
use shared::experiment::RunUse;

use super::axis::{AxisScale, ChartAxis};
use super::frame::{ChartFrame, Marker, interval, line, marker, px};
use crate::table::row::ComparisonRow;
use crate::words::data_channel::{ShownUnit, title};
use crate::words::number;

const WIDTH: f64 = 460.0;
const HEIGHT: f64 = 290.0;
/// Runs nearer than this many pixels are drawn side by side.
const SAME_PLACE: f64 = 6.0;
/// Distance of neighbours that are drawn side by side `[pixels]`, and the room that all of them may take.
const APART: f64 = 11.0;
const ROOM: f64 = 55.0;

/// Slips that differ less do not make an axis; nor do loads within such a factor, nor such angles `[deg]`.
const LEAST_SLIP: f64 = 0.05;
const LEAST_LOAD_FACTOR: f64 = 1.1;
const LEAST_ANGLE_DEG: f64 = 2.0;

/// The abscissa of a wheel's runs: the first condition that varies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Abscissa {
    Slip,
    WheelLoad,
    SlipAngle,
    Run,
}

impl Abscissa {
    fn of(rows: &[&ComparisonRow]) -> Self {
        let ends = |value: fn(&ComparisonRow) -> f64| {
            rows.iter()
                .map(|r| value(r))
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                    (low.min(v), high.max(v))
                })
        };
        let (slip, load, angle) = (
            ends(|r| r.slip),
            ends(|r| r.wheel_load_n),
            ends(|r| r.slip_angle_deg),
        );
        if slip.1 - slip.0 >= LEAST_SLIP {
            Abscissa::Slip
        } else if load.1 >= LEAST_LOAD_FACTOR * load.0 {
            Abscissa::WheelLoad
        } else if angle.1 - angle.0 >= LEAST_ANGLE_DEG {
            Abscissa::SlipAngle
        } else {
            Abscissa::Run
        }
    }

    fn value(self, row: &ComparisonRow, position: usize) -> f64 {
        match self {
            Abscissa::Slip => row.slip,
            Abscissa::WheelLoad => row.wheel_load_n,
            Abscissa::SlipAngle => row.slip_angle_deg,
            Abscissa::Run => (position + 1) as f64,
        }
    }

    fn label(self) -> &'static str {
        match self {
            Abscissa::Slip => "slip [1]",
            Abscissa::WheelLoad => "wheel load [N]",
            Abscissa::SlipAngle => "slip angle [deg]",
            Abscissa::Run => "run, in the order of the table",
        }
    }

    fn scale(self) -> AxisScale {
        if self == Abscissa::Run {
            AxisScale::Whole
        } else {
            AxisScale::Linear
        }
    }
}

/// The rows of one wheel and channel as a picture.
#[derive(Debug)]
pub(in crate::report) struct ComparisonChart<'a> {
    rows: Vec<&'a ComparisonRow>,
    channel: Channel,
    unit: ShownUnit,
}

impl<'a> ComparisonChart<'a> {
    /// The rows of one wheel and channel; `None` without any.
    pub(in crate::report) fn new(rows: &'a [ComparisonRow], wheel: &str, channel: Channel) -> Option<Self> {
        let rows: Vec<_> = rows
            .iter()
            .filter(|r| r.wheel == wheel && r.channel == channel)
            .collect();
        (!rows.is_empty()).then(|| ComparisonChart {
            rows,
            channel,
            unit: ShownUnit::of(channel),
        })
    }

    /// The picture; `range` (SI) replaces the vertical range of its own.
    pub(in crate::report) fn draw(&self, range: Option<(f64, f64)>) -> Markup {
        let against = Abscissa::of(&self.rows);
        let scale = self.unit.factor;
        let places = self.rows.iter().enumerate().map(|(i, r)| against.value(r, i));
        let x = ChartAxis::around(places.clone(), 0.06, against.scale());
        let (low, high) = range.unwrap_or_else(|| ends(self.values()));
        let y = ChartAxis::around([low * scale, high * scale], 0.05, AxisScale::Linear);
        let frame = ChartFrame::new(WIDTH, HEIGHT, x, y);
        let pixels = side_by_side(&places.map(|v| frame.x.at(v)).collect::<Vec<_>>());
        let at = |si: f64| frame.y.at(si * scale);
        let [left, right, ..] = frame.edges();
        let marks = html! {
            @if frame.y.holds(0.0) {
                path.zero d={ "M" (px(left)) " " (px(at(0.0))) "H" (px(right)) } {}
            }
            @if self.is_one_line() { (line("trend", &self.trend(&pixels, at))) }
            @for (row, place) in self.rows.iter().zip(&pixels) {
                @if let Some(mean) = row.predicted {
                    (interval(place.x, at(row.q05.unwrap_or(mean)), at(mean), at(row.q95.unwrap_or(mean))))
                }
            }
            @for (row, place) in self.rows.iter().zip(&pixels) {
                @let kind = if row.usage == RunUse::Holdout { Marker::Holdout } else { Marker::Fit };
                (marker(kind, place.x, at(row.measured), &self.hint(row)))
            }
        };
        let label = format!(
            "{} of wheel {}, measured and predicted, against {}",
            self.channel.words(),
            self.rows[0].wheel,
            against.label()
        );
        frame.draw(&label, against.label(), &title(self.channel), [7, 6], &marks)
    }

    /// Every value that must find room (SI).
    fn values(&self) -> impl Iterator<Item = f64> {
        self.rows.iter().flat_map(|r| {
            [Some(r.measured), r.predicted, r.q05, r.q95]
                .into_iter()
                .flatten()
        })
    }

    /// Whether a line through the predictions compares like with like: one speed, one slip angle, about one load.
    fn is_one_line(&self) -> bool {
        let first = self.rows[0];
        let near = |a: f64, b: f64| a / b < 1.5 && b / a < 1.5;
        self.rows.iter().all(|r| {
            near(r.wheel_load_n, first.wheel_load_n)
                && near(r.sled_speed_m_s, first.sled_speed_m_s)
                && (r.slip_angle_deg - first.slip_angle_deg).abs() < LEAST_ANGLE_DEG
        }) && Abscissa::of(&self.rows) != Abscissa::Run
    }

    /// Mean prediction of the runs at each place, from left to right.
    fn trend(&self, pixels: &[RunPlace], at: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        let groups = pixels.iter().map(|p| p.group + 1).max().unwrap_or(0);
        (0..groups)
            .filter_map(|g| {
                let members = self.rows.iter().zip(pixels).filter(|(_, p)| p.group == g);
                let (x, y): (Vec<f64>, Vec<f64>) = members
                    .filter_map(|(r, p)| Some((p.centre, r.predicted?)))
                    .unzip();
                let mean = y.iter().sum::<f64>() / y.len() as f64;
                (!y.is_empty()).then(|| (x[0], at(mean)))
            })
            .collect()
    }

    fn hint(&self, row: &ComparisonRow) -> String {
        let value = |v: Option<f64>| number::or_none(v, |v| number::fixed(v * self.unit.factor, 2));
        let interval = match (row.q05, row.q95) {
            (None, None) => String::new(),
            (q05, q95) => format!(
                ", 90 % interval {} to {} {}",
                value(q05),
                value(q95),
                self.unit.name
            ),
        };
        format!(
            "{} ({}): slip {}, load {} N; measured {} {unit}, model {} {unit}{interval}",
            row.run,
            row.usage.name(),
            number::fixed(row.slip, 3),
            number::fixed(row.wheel_load_n, 1),
            value(Some(row.measured)),
            value(row.predicted),
            unit = self.unit.name
        )
    }
}

/// One vertical range (SI) for all pictures of a channel, unless some picture would use too little of it.
pub(in crate::report) fn shared_range(charts: &[ComparisonChart]) -> Option<(f64, f64)> {
    const LEAST_SHARE: f64 = 0.4;
    let joint = ends(charts.iter().flat_map(ComparisonChart::values));
    let fills = |c: &ComparisonChart| {
        let own = ends(c.values());
        own.1 - own.0 >= LEAST_SHARE * (joint.1 - joint.0)
    };
    charts.iter().all(fills).then_some(joint)
}

fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
        (low.min(v), high.max(v))
    })
}

/// Position of a run in the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
struct RunPlace {
    /// Pixel.
    x: f64,
    /// Pixel of the middle of its group.
    centre: f64,
    /// Number of its group, from left to right.
    group: usize,
}

/// Spreads runs that would hide each other; their order within a group is the order of the rows.
fn side_by_side(pixels: &[f64]) -> Vec<RunPlace> {
    let mut order: Vec<usize> = (0..pixels.len()).collect();
    order.sort_by(|&a, &b| pixels[a].total_cmp(&pixels[b]));
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for i in order {
        match groups.last_mut() {
            Some(group) if pixels[i] - pixels[group[0]] < SAME_PLACE => group.push(i),
            _ => groups.push(vec![i]),
        }
    }
    let mut places = vec![
        RunPlace {
            x: 0.0,
            centre: 0.0,
            group: 0
        };
        pixels.len()
    ];
    for (number, group) in groups.iter_mut().enumerate() {
        group.sort_unstable();
        let centre = group.iter().map(|&i| pixels[i]).sum::<f64>() / group.len() as f64;
        let apart = APART.min(ROOM / group.len() as f64);
        let middle = 0.5 * (group.len() - 1) as f64;
        for (k, &i) in group.iter().enumerate() {
            places[i] = RunPlace {
                x: centre + apart * (k as f64 - middle),
                centre,
                group: number,
            };
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeats_stand_side_by_side_in_their_order() {
        let places = side_by_side(&[101.0, 50.0, 100.0, 99.0]);
        let x: Vec<String> = places.iter().map(|p| px(p.x)).collect();
        assert_eq!(x, ["89", "50", "100", "111"]);
        assert_eq!(places.iter().map(|p| p.group).collect::<Vec<_>>(), [1, 0, 1, 1]);
    }

    #[test]
    fn many_repeats_keep_to_their_room() {
        let places = side_by_side(&[10.0; 100]);
        assert!(places.iter().all(|p| (p.x - 10.0).abs() <= 0.5 * ROOM));
    }
}
