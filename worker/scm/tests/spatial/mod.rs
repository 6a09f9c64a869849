//! Checks of the wheel in three dimensions.
//!
//! # Layout
//! - `oracles`: every row of the validation table.
//! - `invariants`: invariants that hold for all parameters.
//! - `symmetry`: left and right, the mirrored half, the start on the grid.
//! - `grousers`, `passes`, `extremes`: effects of the soil's memory and shape.
//! - `protocol`, `vertical`: ways to run and average; `steady`: the time when a run has settled.
//! - `mesh`: triangles compared with the analytic wheel; `surfaces`: the triangles.
//! - `tread`: grousers in rows, oblique and bent, compared with straight ones and triangles.
//! - `comparison`: the choices behind the figures of another implementation.
//! - `cohesion`: the lowest kappa with a balance; `rejections`: parameters without an answer.
//! - `effects`: effects on a run; `signatures`: the change by each of them; `side_wall`: an effect that needs a slip angle.

mod cohesion;
mod comparison;
mod effects;
mod extremes;
mod grousers;
mod invariants;
mod mesh;
mod oracles;
mod passes;
mod protocol;
mod rejections;
mod side_wall;
mod signatures;
mod steady;
mod surfaces;
mod symmetry;
mod tread;
mod vertical;
