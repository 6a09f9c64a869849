//! The file formats of an export.
//!
//! # Layout
//! - `zarr`: a Zarr v3 hierarchy; `netcdf`: one NetCDF file. Both take inference data.
//! - `arrow`, `parquet`: the table of draws.

mod arrow;
mod netcdf;
mod parquet;
mod zarr;

pub use arrow::arrow;
pub use netcdf::netcdf;
pub use parquet::parquet;
pub use zarr::zarr;
