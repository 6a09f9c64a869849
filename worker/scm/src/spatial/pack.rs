//! A pack: arithmetic on four lanes at a time, with the same bits on every machine.

use wide::f64x4;

/// Four neighbouring lanes of one strip or column.
pub(crate) type Pack = f64x4;

/// Number of lanes in a [`Pack`].
pub(crate) const PACK: usize = 4;

/// The lanes of one pack in a mask.
pub(crate) const LANES: u64 = (1 << PACK) - 1;

/// Returns a mask that selects the lanes whose bits are set among the last [`PACK`] of `mask`.
#[inline]
pub(crate) fn lanes_of(mask: u64) -> Pack {
    Pack::new(SELECTORS[(mask & LANES) as usize])
}

const SELECTORS: [[f64; PACK]; 1 << PACK] = {
    let mut selectors = [[0.0; PACK]; 1 << PACK];
    let mut place = 0;
    while place < selectors.len() {
        let mut lane = 0;
        while lane < PACK {
            selectors[place][lane] = f64::from_bits((place as u64 >> lane & 1).wrapping_neg());
            lane += 1;
        }
        place += 1;
    }
    selectors
};

/// Returns a number in every lane.
#[inline]
pub(crate) fn splat(value: f64) -> Pack {
    Pack::splat(value)
}

/// Returns the greater of two, lane by lane; neither may be NaN.
#[inline]
pub(crate) fn max(a: Pack, b: Pack) -> Pack {
    a.fast_max(b)
}

/// Returns the smaller of two, lane by lane; neither may be NaN.
#[inline]
pub(crate) fn min(a: Pack, b: Pack) -> Pack {
    a.fast_min(b)
}

/// Returns the sum of the lanes, in an order that does not depend on the machine's vector width.
#[inline]
pub(crate) fn sum(pack: Pack) -> f64 {
    let [a, b, c, d] = pack.to_array();
    (a + c) + (b + d)
}

/// Returns the smallest lane; none may be NaN.
#[inline]
pub(crate) fn min_lane(pack: Pack) -> f64 {
    let [a, b, c, d] = pack.to_array();
    let (low, high) = (if a < c { a } else { c }, if b < d { b } else { d });
    if low < high { low } else { high }
}

/// Returns the largest lane; none may be NaN.
#[inline]
pub(crate) fn max_lane(pack: Pack) -> f64 {
    -min_lane(-pack)
}

/// Returns four lanes of a row that begins at `first`.
#[inline]
pub(crate) fn load(row: &[f64], first: usize) -> Pack {
    let lanes = &row[first..first + PACK];
    Pack::new([lanes[0], lanes[1], lanes[2], lanes[3]])
}

/// Stores four lanes in a row.
#[inline]
pub(crate) fn store(row: &mut [f64], first: usize, pack: Pack) {
    row[first..first + PACK].copy_from_slice(&pack.to_array());
}
