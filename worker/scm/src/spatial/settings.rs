//! Inputs of the model beyond soil, wheel and condition.

use super::grousers::Grousers;
use super::surface::{Normals, SurfaceMesh};
use super::tread::Tread;
use crate::Wheel;
use crate::rejection::{Rejection, require};

/// The deformation of the soil, in addition to the laws of [`Soil`](crate::Soil).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ground {
    /// Stiffness of unloading and reloading `[Pa/m]`, > 0. A higher stiffness shortens the contact behind the axle.
    pub elastic_stiffness_pa_m: f64,
    /// Share of the displaced soil that flows to the border of the footprint `[–]`, in [0, 1]; the rest compacts.
    pub flow_fraction: f64,
    /// Share of the loose soil that carries load like undisturbed soil `[–]`, in [0, 1].
    pub bearing_credit: f64,
    /// Angle of repose `[rad]`, in (0, π/2).
    pub repose_angle_rad: f64,
}

impl Default for Ground {
    /// Returns nearly rigid-plastic sand with an angle of repose of 32°, a quarter of which flows.
    fn default() -> Self {
        Self {
            elastic_stiffness_pa_m: 1e9,
            flow_fraction: 0.25,
            bearing_credit: 0.3,
            repose_angle_rad: 32.0 * core::f64::consts::PI / 180.0,
        }
    }
}

impl Ground {
    /// Checks that the laws are defined for the ground, and returns it; [`Rejection::InvalidParameter`] names the first
    /// field outside its bounds.
    pub fn checked(self) -> Result<Self, Rejection> {
        let fraction = |name, value: f64| {
            require(
                (0.0..=1.0).contains(&value),
                name,
                value,
                "(dimensionless)",
                "between 0 and 1",
            )
        };
        require(
            self.elastic_stiffness_pa_m > 0.0,
            "elastic_stiffness_pa_m",
            self.elastic_stiffness_pa_m,
            "Pa/m",
            "above 0",
        )?;
        fraction("flow_fraction", self.flow_fraction)?;
        fraction("bearing_credit", self.bearing_credit)?;
        require(
            self.repose_angle_rad > 0.0 && self.repose_angle_rad < core::f64::consts::FRAC_PI_2,
            "repose_angle_rad",
            self.repose_angle_rad,
            "rad",
            "above 0 and below pi/2",
        )?;
        Ok(self)
    }
}

/// The wheel's outer shape.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A cylindrical rim, smooth or with grousers; radius and width are the [`Wheel`]'s.
    Rim(Grousers),
    /// A cylindrical rim with grousers in rows: staggered, oblique, V-shaped or bent.
    Tread(Tread),
    /// Any surface, in its given size. The [`Wheel`]'s radius is the reference of sinkage and grid; its width matters for
    /// the grid only.
    Mesh {
        /// Surface of the wheel.
        surface: SurfaceMesh,
        /// Number of identical sectors in one turn, ≥ 1, such as the number of grousers; averages cover whole periods.
        ///
        /// `None`: found from the vertices, up to 1e-5 of the wheel's size; a mesh without repeating parts is averaged over
        /// whole turns if the travel holds two. A faceted cylinder repeats with its facets. Checked by
        /// `spatial::mesh::the_period_is_found_from_the_vertices`.
        repeats_per_turn: Option<u32>,
        /// The directions of pressure and shear.
        normals: Normals,
    },
}

impl From<SurfaceMesh> for Shape {
    /// Returns a mesh whose period is found from its vertices, with the normals of its triangles.
    fn from(surface: SurfaceMesh) -> Self {
        Self::Mesh {
            surface,
            repeats_per_turn: None,
            normals: Normals::default(),
        }
    }
}

impl Shape {
    /// Checks the fields; [`Rejection::InvalidParameter`] names the first outside its bounds.
    pub fn checked(&self, wheel: &Wheel) -> Result<(), Rejection> {
        match self {
            Self::Rim(grousers) => grousers.checked(wheel),
            Self::Tread(tread) => {
                tread.grousers.checked(wheel)?;
                tread.checked(wheel)
            }
            Self::Mesh {
                surface,
                repeats_per_turn,
                ..
            } => {
                if let Some(repeats) = *repeats_per_turn {
                    let value = f64::from(repeats);
                    require(repeats > 0, "repeats_per_turn", value, "(count)", "at least 1")?;
                }
                surface.checked()
            }
        }
    }
}

/// The frame in which the shear displacement j is stored, which formulas may use.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Displacement {
    /// On the rim: the sliding of an element of the wheel's surface since it entered the soil.
    #[default]
    Rim,
    /// On the soil: the shearing of a node of the terrain while in contact.
    Node,
}

/// The direction of the pressure.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum PressureDirection {
    /// Along the normal of the wheel's surface.
    #[default]
    WheelNormal,
    /// Along the normal of the undisturbed soil, vertically; shear acts horizontally. There is no compaction resistance, as
    /// in some other implementations.
    Vertical,
}

/// The effective width `b_eff = 2 A / L` that applies to the nodes of a footprint; without `k_c` it has no effect.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Footprint {
    /// One for the whole footprint, as in the source paper: that of the rectangle that its patches span.
    ///
    /// Its area extends, lane by lane, from the rear to the front end of the contact; its width is that of the lanes in
    /// contact. Two parallel rims thus count as one of their joint width. A smooth wheel's footprint is its hull.
    #[default]
    Hull,
    /// One for each patch of connected nodes, by its contour: a grouser's tip is a separate plate.
    Patches,
}

/// The motion of the hub in height.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Vertical {
    /// The soil carries the wheel load at every step.
    #[default]
    Balance,
    /// The hub moves under its mass, load / gravity, and a damper; for transients.
    Dynamic {
        /// Damping of the vertical motion \[N s/m\], ≥ 0.
        damping_n_s_m: f64,
        /// Acceleration of gravity `[m/s²]`, > 0.
        gravity_m_s2: f64,
    },
}

/// The end of a run, and its averaged part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Protocol {
    /// The run ends when averages over whole grouser periods have settled.
    Steady {
        /// Tolerated distance of settled averages to their limit, relative to the wheel load, to load times radius and to
        /// the sinkage.
        tolerance: f64,
        /// Travel at which the run ends in any case `[m]`.
        most_travel_m: f64,
    },
    /// The run has a fixed time, and transients are cut.
    Fixed {
        /// Simulated time `[s]`.
        duration_s: f64,
        /// Time cut from the start of drawbar pull, torque and lateral force `[s]`.
        transient_force_s: f64,
        /// Time cut from the start of the sinkage `[s]`.
        transient_sinkage_s: f64,
        /// Cut-off of the zero-phase low-pass filter of the histories \[Hz\]; 0: no filter.
        lowpass_hz: f64,
    },
}

impl Default for Protocol {
    fn default() -> Self {
        Self::Steady {
            tolerance: 0.005,
            most_travel_m: 1.0,
        }
    }
}

/// Settings of the discretisation and variants of the laws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunSettings {
    /// Spacing of the terrain's nodes `[m]`; along travel it is refined to an eighth of the contact.
    pub dem_spacing_m: f64,
    /// Travel of one step `[m]`; refined to the spacing along travel.
    pub travel_step_m: f64,
    /// The frame in which the shear displacement is stored.
    pub displacement: Displacement,
    /// The direction of the pressure.
    pub pressure_direction: PressureDirection,
    /// The effective width that applies to the nodes of a footprint.
    pub footprint: Footprint,
    /// The motion of the hub in height.
    pub vertical: Vertical,
    /// The end of the run.
    pub protocol: Protocol,
    /// Models both halves of the wheel even if one mirrors the other; for tests.
    pub both_halves: bool,
}

impl Default for RunSettings {
    fn default() -> Self {
        Self {
            dem_spacing_m: 0.004,
            travel_step_m: 0.0005,
            displacement: Displacement::default(),
            pressure_direction: PressureDirection::default(),
            footprint: Footprint::default(),
            vertical: Vertical::default(),
            protocol: Protocol::default(),
            both_halves: false,
        }
    }
}

impl RunSettings {
    /// Checks the fields, and returns the settings; [`Rejection::InvalidParameter`] names the first outside its bounds.
    pub fn checked(self) -> Result<Self, Rejection> {
        let positive = |name, value: f64, unit| require(value > 0.0, name, value, unit, "above 0");
        let not_negative = |name, value: f64, unit| require(value >= 0.0, name, value, unit, "at least 0");
        positive("dem_spacing_m", self.dem_spacing_m, "m")?;
        positive("travel_step_m", self.travel_step_m, "m")?;
        if let Vertical::Dynamic {
            damping_n_s_m,
            gravity_m_s2,
        } = self.vertical
        {
            not_negative("damping_n_s_m", damping_n_s_m, "N s/m")?;
            positive("gravity_m_s2", gravity_m_s2, "m/s^2")?;
        }
        match self.protocol {
            Protocol::Steady {
                tolerance,
                most_travel_m,
            } => {
                positive("tolerance", tolerance, "(dimensionless)")?;
                positive("most_travel_m", most_travel_m, "m")?;
            }
            Protocol::Fixed {
                duration_s,
                transient_force_s,
                transient_sinkage_s,
                lowpass_hz,
            } => {
                positive("duration_s", duration_s, "s")?;
                for (name, value) in [
                    ("transient_force_s", transient_force_s),
                    ("transient_sinkage_s", transient_sinkage_s),
                ] {
                    require(
                        (0.0..duration_s).contains(&value),
                        name,
                        value,
                        "s",
                        "at least 0 and less than the duration",
                    )?;
                }
                not_negative("lowpass_hz", lowpass_hz, "Hz")?;
            }
        }
        Ok(self)
    }
}
