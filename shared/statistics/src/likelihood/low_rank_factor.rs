//! The factor of a large covariance with few common errors, with sums in a fixed order.

/// W of `S^-1 = W' W` for `S = D (I + U U') D`, with D the noise sds and U the common errors over the noise.
///
/// With `L L' = I + U' U`, of the size of the common errors: `W = (I - U (L' + I)^-1 L^-1 U') D^-1`, and
/// `ln det S = sum ln d^2 + 2 sum ln L_kk`. Errors of few data come first, so that those of disjoint data fill no row of L.
///
/// # Source
/// Woodbury's identity; the root follows from `(I + L) (I + L') = L L' + L + L' + I`. Checked by
/// `likelihood::a_large_block_has_the_density_of_its_covariance`.
#[derive(Debug, Clone)]
pub(super) struct LowRankFactor {
    sds: Vec<f64>,
    /// The columns of U as lists of (position, value).
    common: Vec<Vec<(usize, f64)>>,
    /// L, row by row, each from its first element.
    rows: Vec<ProfileRow>,
}

/// A row of L up to the diagonal, without the zeros before its first element.
#[derive(Debug, Clone)]
struct ProfileRow {
    first: usize,
    elements: Vec<f64>,
}

impl ProfileRow {
    fn element(&self, column: usize) -> f64 {
        match column.checked_sub(self.first) {
            Some(place) => self.elements[place],
            None => 0.0,
        }
    }

    fn diagonal(&self) -> f64 {
        self.elements[self.elements.len() - 1]
    }

    /// Returns the elements before the diagonal, each with its column.
    fn before(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let count = self.elements.len() - 1;
        (self.first..).zip(self.elements[..count].iter().copied())
    }
}

impl LowRankFactor {
    /// Factors `diag(d^2) + sum v v'`; `None` if that overflows.
    ///
    /// # Arguments
    /// - `sds`: d, each > 0. `common`: each v as a list of (position, value).
    pub(super) fn new(sds: Vec<f64>, mut common: Vec<Vec<(usize, f64)>>) -> Option<Self> {
        common.sort_by_key(Vec::len);
        for (position, v) in common.iter_mut().flatten() {
            *v /= sds[*position];
        }
        let rows = factored(gram(sds.len(), &common))?;
        Some(Self { sds, common, rows })
    }

    /// Returns ln det S.
    pub(super) fn log_determinant(&self) -> f64 {
        let noise: f64 = self.sds.iter().map(|sd| libm::log(*sd)).sum();
        let common: f64 = self.rows.iter().map(|row| libm::log(row.diagonal())).sum();
        2.0 * (noise + common)
    }

    /// Returns `W v`.
    pub(super) fn whiten(&self, mut v: Vec<f64>) -> Vec<f64> {
        for (v, sd) in v.iter_mut().zip(&self.sds) {
            *v /= sd;
        }
        let along = |u: &Vec<(usize, f64)>| u.iter().map(|&(position, u)| u * v[position]).sum();
        let mut shares: Vec<f64> = self.common.iter().map(along).collect();
        for (k, row) in self.rows.iter().enumerate() {
            let before: f64 = row.before().map(|(column, l)| l * shares[column]).sum();
            shares[k] = (shares[k] - before) / row.diagonal();
        }
        for (k, row) in self.rows.iter().enumerate().rev() {
            shares[k] /= row.diagonal() + 1.0;
            let share = shares[k];
            for (column, l) in row.before() {
                shares[column] -= l * share;
            }
        }
        for (u, share) in self.common.iter().zip(shares) {
            for &(position, u) in u {
                v[position] -= u * share;
            }
        }
        v
    }
}

/// Returns the lower half of `I + U' U`, each row from the first error that shares a datum with it.
fn gram(count: usize, common: &[Vec<(usize, f64)>]) -> Vec<ProfileRow> {
    let mut errors: Vec<Vec<(usize, f64)>> = vec![Vec::new(); count];
    for (k, error) in common.iter().enumerate() {
        for &(position, u) in error {
            errors[position].push((k, u));
        }
    }
    let row = |k: usize| {
        let shared = common[k]
            .iter()
            .filter_map(|(position, _)| errors[*position].first());
        let first = shared.map(|(first, _)| *first).min().unwrap_or(k);
        let mut elements = vec![0.0; k + 1 - first];
        elements[k - first] = 1.0;
        for (position, u) in &common[k] {
            for (column, v) in errors[*position].iter().take_while(|(column, _)| *column <= k) {
                elements[column - first] += u * v;
            }
        }
        ProfileRow { first, elements }
    };
    (0..common.len()).map(row).collect()
}

/// Replaces a symmetric matrix by its Cholesky factor; `None` if that overflows.
fn factored(mut rows: Vec<ProfileRow>) -> Option<Vec<ProfileRow>> {
    for i in 0..rows.len() {
        let (done, rest) = rows.split_at_mut(i);
        let row = &mut rest[0];
        let first = row.first;
        for (j, earlier) in done.iter().enumerate().skip(first) {
            let from = first.max(earlier.first);
            let products = (from..j).map(|k| row.element(k) * earlier.element(k));
            let sum = row.element(j) - products.sum::<f64>();
            row.elements[j - first] = sum / earlier.diagonal();
        }
        let squares: f64 = row.before().map(|(_, l)| l * l).sum();
        let square = row.diagonal() - squares;
        if !(square.is_finite() && square > 0.0) {
            return None;
        }
        let last = row.elements.len() - 1;
        row.elements[last] = square.sqrt();
    }
    Some(rows)
}
