//! Strips from the samples of a mesh: as few as its steps and edges allow.

use super::super::super::pack::{PACK, Pack};
use super::super::super::terrain::Terrain;
use super::super::envelope::{Envelope, Facet, NOWHERE, Strip};
use super::super::pose::{Pose, Range};
use super::raster::Raster;

/// Largest change of the slope dh/dx within a smooth surface; half of it is the steepest step that counts as part of one.
const KINK: f64 = 0.5;

/// Difference of rises `[m]` or slopes that rounding can cause.
const ROUNDING: f64 = 1e-12;

/// Memory that is reused from step to step.
#[derive(Debug, Clone, Default)]
pub(super) struct Buffers {
    /// The samples that give the surface of each strip.
    sources: Vec<[usize; 2]>,
    /// True if the surface breaks off between a sample and the preceding one.
    breaks: Vec<bool>,
}

/// Turns the samples of a range of columns into strips and facets.
///
/// Neighbouring samples of a column that lie on one smooth surface in every lane are one strip. A surface that also holds
/// the column's node is evaluated at the node, in all its strips, because it shaped the soil there; any other in its strip's
/// middle. A column under one surface that continues into both neighbours is a smooth strip, between which the ends of the
/// contact may be interpolated.
pub(super) fn fill(
    raster: &Raster,
    terrain: &Terrain,
    pose: Pose,
    range: Range,
    radial: bool,
    buffers: &mut Buffers,
    out: &mut Envelope,
) {
    let Buffers { sources, breaks } = buffers;
    sources.clear();
    breaks.clear();
    out.strips.clear();
    let per_column = raster.per_column;
    breaks.extend((0..=raster.samples).map(|i| i > 0 && i < raster.samples && !goes_on(raster, i - 1, i)));
    for column in range.start..range.end {
        let node = terrain.x(column) - pose.x;
        let rear = node - 0.5 * terrain.dx;
        let first = (column - range.start) * per_column;
        let (middle, end) = (first + per_column / 2, first + per_column);
        let mut begin = first;
        while begin < end {
            let mut stop = begin + 1;
            while stop < end && !breaks[stop] && goes_on(raster, begin, stop) {
                stop += 1;
            }
            let border = |sample: usize| rear + (sample - first) as f64 * raster.spacing;
            let whole = begin == first && stop == end;
            let holds_node = begin <= middle && middle < stop;
            let central = [(begin + stop - 1) / 2, (begin + stop) / 2];
            let at_node = holds_node || goes_on(raster, central[0].min(middle), central[0].max(middle));
            let source = if at_node { [middle; 2] } else { central };
            let (back, front) = (border(begin), border(stop));
            let ahead = if at_node { node } else { 0.5 * (back + front) };
            let (rise, slope) = deepest(raster, source);
            out.strips.push(Strip {
                column,
                rear: back,
                middle: 0.5 * (back + front),
                front,
                ahead,
                rise,
                slope: if radial { radial_slope(ahead, rise) } else { slope },
                holds_node,
                smooth: whole && !breaks[begin] && !breaks[stop],
            });
            sources.push(source);
            begin = stop;
        }
    }
    out.facets.clear();
    let mut rows = sources.iter().flatten();
    if radial && rows.clone().all(|&i| alike(raster, &raster.rise, i))
        || rows
            .all(|&i| alike(raster, &raster.rise, i) && alike(raster, &raster.slope_x, i) && flat(raster, i))
    {
        return;
    }
    for first_lane in (0..raster.stride).step_by(PACK) {
        let strips = out.strips.iter().zip(sources.iter());
        out.facets.extend(strips.map(|(strip, &source)| {
            let facet = facet(raster, source, first_lane);
            if radial {
                Facet {
                    rise: facet.rise,
                    slope_x: Pack::new(facet.rise.to_array().map(|r| radial_slope(strip.ahead, r))),
                    slope_y: Pack::splat(0.0),
                }
            } else {
                facet
            }
        }));
    }
}

/// Returns whether two samples lie on one smooth surface in every lane, or under none.
fn goes_on(raster: &Raster, from: usize, to: usize) -> bool {
    let distance = (to - from) as f64 * raster.spacing;
    let step = 0.5 * KINK * distance;
    let lanes = |sample: usize| sample * raster.stride..sample * raster.stride + raster.lanes;
    let (a, b) = (lanes(from), lanes(to));
    let rises = raster.rise[a.clone()].iter().zip(&raster.rise[b.clone()]);
    let slopes = raster.slope_x[a].iter().zip(&raster.slope_x[b]);
    let mut goes_on = true;
    for ((r, r_to), (s, s_to)) in rises.zip(slopes) {
        // beside the wheel both rises are the same and both slopes 0
        let expected = -0.5 * (s + s_to) * distance;
        goes_on &= (s_to - s).abs() <= KINK && (r_to - r - expected).abs() <= step;
    }
    goes_on
}

/// Returns the rise and slope of the lane that reaches deepest.
fn deepest(raster: &Raster, source: [usize; 2]) -> (f64, f64) {
    let mut best = (NOWHERE, 0.0);
    for lane in 0..raster.lanes {
        let rise = mean(&raster.rise, raster.stride, source, lane);
        if rise > best.0 {
            best = (rise, mean(&raster.slope_x, raster.stride, source, lane));
        }
    }
    best
}

/// Returns whether all lanes of a sample have the same value, except for rounding.
fn alike(raster: &Raster, values: &[f64], sample: usize) -> bool {
    let lanes = &values[sample * raster.stride..][..raster.lanes];
    lanes.iter().all(|value| (value - lanes[0]).abs() <= ROUNDING)
}

/// Returns whether a sample has no lateral slope in any lane, except for rounding.
fn flat(raster: &Raster, sample: usize) -> bool {
    let lanes = &raster.slope_y[sample * raster.stride..][..raster.lanes];
    lanes.iter().all(|slope| slope.abs() <= ROUNDING)
}

/// Returns the mean of two samples of one smooth surface.
fn mean(values: &[f64], stride: usize, source: [usize; 2], lane: usize) -> f64 {
    0.5 * (values[source[0] * stride + lane] + values[source[1] * stride + lane])
}

fn facet(raster: &Raster, source: [usize; 2], lane: usize) -> Facet {
    let pack = |values: &[f64]| {
        let at = |i| mean(values, raster.stride, source, lane + i);
        Pack::new([at(0), at(1), at(2), at(3)])
    };
    Facet {
        rise: pack(&raster.rise),
        slope_x: pack(&raster.slope_x),
        slope_y: pack(&raster.slope_y),
    }
}

/// Returns the slope of a surface whose normal points to the axle; 0 at the axle's height and beside the wheel.
fn radial_slope(ahead: f64, rise: f64) -> f64 {
    if rise > 0.0 { ahead / rise } else { 0.0 }
}
