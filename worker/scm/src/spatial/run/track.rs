//! The terrain of a run, and the size of its steps.

use super::super::contact::MAX_LANES;
use super::super::settings::{RunSettings, Vertical};
use super::super::terrain::{BERM_LANES, Terrain};
use super::super::wheel::motion::Motion;
use crate::rejection::{Rejection, require};
use crate::{Condition, Soil, Wheel, quasi_static};

/// Number of slope relaxations while the wheel advances by one column.
const RELAXATIONS_PER_COLUMN: f64 = 4.0;
/// Minimum number of nodes in a contact along travel.
const NODES_ALONG: f64 = 8.0;
/// Minimum number of columns in a grouser's pitch for the spacing to be fitted to it.
const COLUMNS_PER_PITCH: f64 = 4.0;
/// Number of columns beyond the wheel's reach, at either end of the track.
const SPARE_COLUMNS: f64 = 12.0;
/// Length beyond the wheel's reach, at either end of the track, relative to the reach.
const SPARE_REACH: f64 = 0.1;
/// The maximum number of nodes of a terrain: a quarter of a gigabyte.
const MAX_NODES: f64 = 1e7;
/// The maximum number of steps of all passes of a run.
const MAX_STEPS: f64 = 2e6;
/// Minimum share of the travel along the heading for steps to follow columns; below it the wheel slides sideways.
const MIN_ALONG: f64 = 1e-3;
/// Time of a step with a free hub `[s]`: a twentieth of the period of the stiffest expected spring.
const DYNAMIC_STEP_S: f64 = 1e-3;
/// Longest path of the rim in one step, relative to the travel step, so that a grouser does not jump over nodes.
const RIM_PATH: f64 = 2.0;

/// Steps of a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Steps {
    /// Time of a step `[s]`.
    pub(crate) time: f64,
    /// Travel of the sled in one step `[m]`.
    pub(crate) travel: f64,
    /// Number of steps from column to column; forces repeat with this period without grousers.
    pub(crate) to_column: usize,
    /// Number of steps from one sliding of the slopes to the next, because soil slides from column to column, not from step
    /// to step.
    pub(crate) to_slide: usize,
}

/// Returns the spacing along travel: the given one, or an eighth of a smooth wheel's contact if that is finer `[m]`.
///
/// The contact is that of the quasi-static model or, on soil that hardly yields, that on the elastic layer alone. If the
/// quasi-static model has no contact, because the soil does not carry a smooth wheel, the given spacing is used. Checked by
/// `spatial::extremes::hard_soil_needs_no_finer_grid_than_its_elastic_layer`.
pub(crate) fn spacing_along(
    soil: &Soil,
    elastic_stiffness: f64,
    wheel: &Wheel,
    condition: &Condition,
    settings: &RunSettings,
) -> f64 {
    let smooth = quasi_static::simulate(soil, wheel, condition);
    smooth.map_or(settings.dem_spacing_m, |averages| {
        let contact = averages
            .contact_length_m
            .max(elastic_contact(elastic_stiffness, wheel, condition));
        settings.dem_spacing_m.min(contact / NODES_ALONG)
    })
}

/// Returns the widest spacing up to a given one at which a grouser's pitch is a half-integer number of columns `[m]`.
///
/// Then two successive grousers meet the columns half a column apart, the third like the first: the grid's ripple repeats in
/// two periods and nearly cancels in their mean. At any other spacing it repeats in many periods, and no mean over few of
/// them settles. A pitch of few columns is unchanged.
pub(crate) fn fit_to_pitch(dx: f64, pitch: f64) -> f64 {
    if pitch < COLUMNS_PER_PITCH * dx {
        return dx;
    }
    pitch / (libm::ceil(pitch / dx - 0.5) + 0.5)
}

/// Returns the length of a smooth wheel's contact on independent springs of a stiffness `[Pa/m]` on rigid ground `[m]`.
///
/// They carry `W = K b int (d - x^2 / 2R) dx = 4/3 K b d sqrt(2 R d)` over `2 sqrt(2 R d)`, d the depth of the rim.
fn elastic_contact(stiffness: f64, wheel: &Wheel, condition: &Condition) -> f64 {
    let diameter = 2.0 * wheel.radius_m;
    let root = libm::cbrt(0.75 * condition.wheel_load_n / (stiffness * wheel.width_m * libm::sqrt(diameter)));
    2.0 * root * libm::sqrt(diameter)
}

/// Returns the steps of a run on a terrain of some spacing.
pub(crate) fn steps(
    wheel: &Wheel,
    condition: &Condition,
    motion: &Motion,
    settings: &RunSettings,
    dx: f64,
) -> Steps {
    // A column takes a whole number of steps, so that the effect of the grid repeats.
    let along = motion.forward.abs() / condition.sled_speed_m_s;
    let wanted = settings.travel_step_m.min(dx);
    let rim_per_travel = motion.rotation.abs() * wheel.radius_m / condition.sled_speed_m_s;
    let wanted = wanted.min(RIM_PATH * settings.travel_step_m / rim_per_travel.max(f64::MIN_POSITIVE));
    let wanted = match settings.vertical {
        Vertical::Balance => wanted,
        Vertical::Dynamic { .. } => wanted.min(DYNAMIC_STEP_S * condition.sled_speed_m_s),
    };
    let (travel, to_column) = if along > MIN_ALONG {
        let to_column = libm::ceil(dx / (wanted * along)).max(1.0);
        (dx / (to_column * along), to_column)
    } else {
        (wanted, 1.0)
    };
    Steps {
        time: travel / condition.sled_speed_m_s,
        travel,
        to_column: to_column as usize,
        to_slide: libm::ceil(to_column / RELAXATIONS_PER_COLUMN) as usize,
    }
}

/// Returns the number of whole steps in a travel; an error if it exceeds the maximum over all passes.
pub(crate) fn count(travel: f64, steps: &Steps, condition: &Condition) -> Result<usize, Rejection> {
    let whole = libm::floor(travel / steps.travel);
    let all = whole * f64::from(condition.pass);
    require(
        all <= MAX_STEPS,
        "steps of the run",
        all,
        "(count)",
        "at most 2000000: take longer steps, less travel, fewer passes, or less slip",
    )?;
    Ok(whole as usize)
}

/// Returns undisturbed terrain for a wheel of a width that travels a distance, and the hub's place at the start; an
/// error if the wheel covers more lanes than a mask holds, or the terrain has too many nodes.
pub(crate) fn terrain(
    width: f64,
    motion: &Motion,
    settings: &RunSettings,
    dx: f64,
    reach: f64,
    travel: f64,
    mirrored: bool,
) -> Result<(Terrain, f64), Rejection> {
    // The number of lanes is even and fits the width.
    let half_lanes = libm::round(0.5 * width / settings.dem_spacing_m).max(1.0);
    let covered = if mirrored {
        half_lanes
    } else {
        2.0 * half_lanes + 1.0
    };
    require(
        covered <= MAX_LANES as f64,
        "dem_spacing_m",
        settings.dem_spacing_m,
        "m",
        "at least 1/62 of the wheel's width, 1/126 where the slip angle is 0",
    )?;
    let dy = 0.5 * width / half_lanes;
    let speed = libm::hypot(motion.forward, motion.lateral);
    let (ahead, aside) = (travel * motion.forward / speed, travel * motion.lateral / speed);
    let start = (1.0 + SPARE_REACH) * reach + SPARE_COLUMNS * dx;
    let columns = libm::ceil((ahead.abs() + 2.0 * start) / dx);
    let beside = half_lanes as usize + BERM_LANES + 5; // a pack and a lane to spare
    let nodes = columns * (2.0 * beside as f64 + aside.abs() / dy);
    require(
        nodes <= MAX_NODES,
        "nodes of the terrain",
        nodes,
        "(count)",
        "at most 10000000: take a coarser spacing or less travel; a short contact on hard soil refines the spacing",
    )?;
    let (lanes, first_y) = if mirrored {
        (beside + 3, 0.5 * dy)
    } else {
        let right = beside + ((-aside).max(0.0) / dy) as usize;
        let left = beside + 3 + (aside.max(0.0) / dy) as usize;
        (right + left, (0.5 - right as f64) * dy)
    };
    let terrain = Terrain::new(dx, dy, first_y, columns as usize, lanes, mirrored);
    Ok((terrain, start))
}
