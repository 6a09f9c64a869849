//! The measurements that a calibration fits: their noise, their likelihood, their predicted values.

pub(crate) mod bevameter_readings;
pub(crate) mod confounded_order;
pub(crate) mod error;
pub(crate) mod level;
pub(crate) mod likelihood;
pub(crate) mod noise;
pub(crate) mod outside_model;
pub(crate) mod predicted_values;
pub(crate) mod rig_groups;
pub(crate) mod shared_error;
pub(crate) mod shared_sd;
pub(crate) mod transient_readings;
