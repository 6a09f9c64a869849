//! Checks of the wheel in three dimensions.
//!
//! # Layout
//! - `oracles`: every row of the validation table.
//! - `invariants`: what must hold whatever the parameters.
//! - `symmetry`: left and right, the mirrored half, the start on the grid.
//! - `grousers`, `passes`, `extremes`: what memory and shape of the soil do.
//! - `protocol`, `vertical`: ways to run and average; `steady`: when a run has settled.
//! - `mesh`: triangles against the analytic wheel; `surfaces`: the triangles.
//! - `tread`: grousers in rows, oblique and bent, against straight ones and triangles.
//! - `comparison`: the choices behind the figures of another implementation.
//! - `cohesion`: down to which kappa a wheel finds a balance; `rejections`: parameters without an answer.
//! - `effects`: how effects enter; `signatures`: what each of them changes; `side_wall`: one that needs
//!   a slip angle.

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
