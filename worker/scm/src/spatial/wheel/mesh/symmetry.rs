//! Symmetries of a wheel, found from the corners of its triangles.

use core::f64::consts::TAU;

/// Distance at which two points count as one, relative to the wheel's reach, because coordinates in files are rounded.
const TOLERANCE: f64 = 1e-5;

/// Returns the number of equal sectors of the points, ≥ 1: the largest number k such that a turn by 2π/k maps every point
/// onto a point. Triangles between them are not compared.
pub(super) fn repeats_per_turn(points: &[[f64; 3]], reach: f64) -> u32 {
    let tolerance = TOLERANCE * reach;
    let polar = points.iter().map(|&[x, y, z]| {
        let (radius, angle) = (libm::hypot(x, z), libm::atan2(x, -z));
        // points at the angle 0 must not be split into 0 and 2π
        let whole = if angle < -TOLERANCE { TAU } else { 0.0 };
        [radius, y, angle + whole]
    });
    let mut polar: Vec<[f64; 3]> = polar.filter(|p| p[0] > tolerance).collect();
    let rings = grouped(&mut polar, tolerance);
    let angles: Vec<Vec<f64>> = rings
        .iter()
        .map(|ring| without_doubles(ring, tolerance / ring[0][0]))
        .collect();
    let Some(fewest) = angles.iter().map(Vec::len).min() else {
        return 1;
    };
    let repeats = |sectors: usize| angles.iter().all(|ring| turns_onto_itself(ring, sectors));
    let sectors = (1..=fewest)
        .rev()
        .find(|&k| fewest.is_multiple_of(k) && repeats(k));
    sectors.map_or(1, |k| k as u32)
}

/// Returns whether every point has its mirror image at −y. Triangles between them are not compared.
pub(super) fn mirrors(points: &[[f64; 3]], reach: f64) -> bool {
    let tolerance = TOLERANCE * reach;
    let mut points: Vec<[f64; 3]> = points.iter().map(|&[x, y, z]| [x, z, y]).collect();
    grouped(&mut points, tolerance).iter().all(|group| {
        let places = without_doubles(group, tolerance);
        let mirrored = places.iter().rev();
        places
            .iter()
            .zip(mirrored)
            .all(|(y, m)| (y + m).abs() <= tolerance)
    })
}

/// Groups points whose first two coordinates agree, each group sorted by the third.
fn grouped(points: &mut [[f64; 3]], tolerance: f64) -> Vec<&[[f64; 3]]> {
    let mut groups = Vec::new();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    for alike in points.chunk_by_mut(|a, b| b[0] - a[0] <= tolerance) {
        alike.sort_by(|a, b| a[1].total_cmp(&b[1]));
        for group in alike.chunk_by_mut(|a, b| b[1] - a[1] <= tolerance) {
            group.sort_by(|a, b| a[2].total_cmp(&b[2]));
            groups.push(&*group);
        }
    }
    groups
}

/// Returns the third coordinates without duplicates.
fn without_doubles(group: &[[f64; 3]], tolerance: f64) -> Vec<f64> {
    let mut thirds: Vec<f64> = group.iter().map(|p| p[2]).collect();
    thirds.dedup_by(|b, a| *b - *a <= tolerance);
    thirds
}

/// Returns whether sorted angles are unchanged by a turn of 2π / `sectors`.
fn turns_onto_itself(angles: &[f64], sectors: usize) -> bool {
    if !angles.len().is_multiple_of(sectors) {
        return false;
    }
    let count = angles.len() / sectors;
    let sector = TAU / sectors as f64;
    let next = |i: usize| {
        let place = i + count;
        if place < angles.len() {
            angles[place]
        } else {
            angles[place - angles.len()] + TAU
        }
    };
    (0..angles.len()).all(|i| (next(i) - angles[i] - sector).abs() <= 2.0 * TOLERANCE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(count: usize, y: f64) -> Vec<[f64; 3]> {
        (0..count)
            .map(|i| {
                let angle = TAU * i as f64 / count as f64;
                [0.1 * libm::sin(angle), y, 0.1 * libm::cos(angle)]
            })
            .collect()
    }

    #[test]
    fn sectors_and_mirror_images_are_found() {
        let mut points = ring(36, 0.05);
        assert_eq!(repeats_per_turn(&points, 0.1), 36);
        assert!(!mirrors(&points, 0.1));
        points.extend(ring(36, -0.05));
        assert!(mirrors(&points, 0.1));
        points.extend(ring(24, 0.0));
        assert_eq!(repeats_per_turn(&points, 0.1), 12);
        points.extend(points.clone()); // corners that triangles do not share
        assert_eq!(repeats_per_turn(&points, 0.1), 12);
        points.push([0.09, 0.0, 0.0]);
        assert_eq!(repeats_per_turn(&points, 0.1), 1);
    }
}
