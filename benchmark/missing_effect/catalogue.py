"""Effects that a library of missing effects has, in numpy, each from the published formula that PHYSICS and the sources of the catalogue state.

An effect is a dictionary of what it changes: `condition` (of the rig and the wheel), `wheel_load`, `sinkage_exponent`, `pressure`, `shear_limit`,
`shear`, `channels`; a formula is given the state of the contact, the value so far, and the strengths. A prior is a name and its numbers.
Left out: `elastic_rebound` and `wheel_flexibility`, whose contact reaches where the formulas leave several forms open; effects at a slip angle, in
skid and of further passes, which these designs do not show; `gravity_scaling`, which is absent on Earth; `small_diameter`, `edge_loss` and
`reece_pressure`, which need wheels of two sizes.
"""
import numpy as np
from scipy.special import ndtr, ndtri

from wheel import BIN_LENGTH_M, DENSITY_KG_M3, GRAVITY, GROUSER_HEIGHT_M, GROUSERS


def quantile(prior, u):
    """The value of a prior at a standard normal coordinate."""
    kind, *numbers = prior
    if kind == "uniform":
        low, high = numbers
        return low + (high - low) * ndtr(u)
    if kind == "loguniform":
        low, high = np.log(numbers)
        return np.exp(low + (high - low) * ndtr(u))
    if kind == "half_normal":
        return -numbers[0] * ndtri(0.5 * ndtr(-u))
    if kind == "lognormal":
        median, factor = numbers
        return median * factor**u
    mean, sd, *bounds = numbers
    low, high = ndtr((np.array(bounds) - mean) / sd) if bounds else (0.0, 1.0)
    return mean + sd * ndtri(low + (high - low) * ndtr(u))


def coordinate(prior, value):
    """The standard normal coordinate of a value."""
    kind, *numbers = prior
    if kind == "uniform":
        return ndtri((value - numbers[0]) / (numbers[1] - numbers[0]))
    if kind == "loguniform":
        return ndtri(np.log(value / numbers[0]) / np.log(numbers[1] / numbers[0]))
    if kind == "half_normal":
        return ndtri(2 * ndtr(value / numbers[0]) - 1)
    if kind == "lognormal":
        return np.log(value / numbers[0]) / np.log(numbers[1])
    mean, sd, *bounds = numbers
    low, high = ndtr((np.array(bounds) - mean) / sd) if bounds else (0.0, 1.0)
    return ndtri((ndtr((value - mean) / sd) - low) / (high - low))


def slip_radius(s, a):
    """The sled moves with v (1 + error) at the same speed of the rim."""
    s.speed = s.sled_speed * (1 + a["speed_error"])
    s.slip = 1 - s.speed / s.rim_speed


def scaled(name, key):
    def condition(s, a):
        setattr(s, name, getattr(s, name) * (1 + a[key]))
    return condition


def peaked(s, p, a):
    """Wong and Reece's profile: behind the angle of the peak the depth is that of the mirrored angle ahead of it."""
    share = np.minimum(a["front_share"] + a["front_share_per_slip"] * np.abs(s.slip), 0.9)
    peak = share * s.entry
    mirrored = s.entry - (s.entry - peak) * s.theta / peak
    depth = np.maximum(s.radius * (np.cos(np.minimum(mirrored, s.entry)) - np.cos(s.entry)), 0)
    return np.where(s.theta < peak, p * (depth / s.z) ** s.exponent, p)


def moist_limit(s, limit, a):
    wetter = np.tan(s.friction_angle_rad + np.radians(3 * a["water_index"])) - np.tan(s.friction_angle_rad)
    return limit + 1000 * a["water_index"] + s.p * wetter


def stress_dependent(s, limit, a):
    decades = np.log10(1e5 / np.maximum(s.p, 1000))
    angle = s.friction_angle_rad + np.radians(a["angle_per_decade_deg"]) * decades
    return np.maximum(limit + s.p * (np.tan(angle) - np.tan(s.friction_angle_rad)), 0)


def wedge(s, pull, torque, sinkage, a):
    phi = s.friction_angle_rad
    flow = np.exp(np.pi * np.tan(phi)) * np.tan(np.pi / 4 + phi / 2) ** 2
    weight = (2 * 2 * (flow + 1) + 1) * np.cos(phi) ** 2
    approach = np.arccos(1 - sinkage / s.radius)
    spread = np.sin(approach + phi) / (2 * np.sin(approach) * np.cos(phi))
    return pull - a["resistance_scale"] * s.width * spread * GRAVITY * DENSITY_KG_M3 * sinkage**2 * weight, torque, sinkage


def lugs(s, pull, torque, sinkage, a):
    surcharge = s.wheel_load / (s.width * s.contact_length)
    passive = np.tan(np.pi / 4 + s.friction_angle_rad / 2) ** 2
    height = GROUSER_HEIGHT_M
    per_lug = s.width * (DENSITY_KG_M3 * GRAVITY * height**2 / 2 + 0.3 * surcharge * height) * passive
    thrust = a["thrust_scale"] * per_lug * s.contact_length * GROUSERS / (2 * np.pi * s.radius) * (1 - np.exp(-s.slip / 0.15))
    return pull + thrust, torque + thrust * (s.radius + height / 2), sinkage


def side_walls(s, limit, a):
    pressed = s.k_star * s.z ** (s.n + 1) / (s.n + 1)
    return limit + a["pressed_share"] * 2 / s.width * pressed * np.tan(s.friction_angle_rad)


def end_walls(s, p, a):
    reach = 0.1
    return p * (1 + 2 * a["wall_stiffening"] * reach / BIN_LENGTH_M * (1 - np.exp(-BIN_LENGTH_M / reach)))


def mobilised_slower(s, tau, a):
    return tau * np.expm1(-s.v_t / (s.shear_velocity * np.exp(a["log_scale"]))) / np.expm1(-np.maximum(s.v_t, 1e-12) / s.shear_velocity)


def pull_of(formula):
    return lambda s, pull, torque, sinkage, a: (formula(s, pull, a), torque, sinkage)


def torque_of(formula):
    return lambda s, pull, torque, sinkage, a: (pull, formula(s, torque, a), sinkage)


def sinkage_of(formula):
    return lambda s, pull, torque, sinkage, a: (pull, torque, formula(s, sinkage, a))


def effect(priors, **formulas):
    return {"priors": priors, **formulas}


half, uniform, normal = (lambda x: ("half_normal", x)), (lambda a, b: ("uniform", a, b)), (lambda *x: ("normal", *x))
EFFECTS = {
    "pressure_distribution_shape": effect({"flatness": uniform(0, 1)},
        pressure=lambda s, p, a: (1 - a["flatness"]) * p + a["flatness"] * s.k_star * s.z**s.exponent),
    "peak_pressure_angle": effect({"front_share": uniform(0, 0.5), "front_share_per_slip": uniform(0, 0.6)}, pressure=peaked),
    "slip_sinkage": effect({"exponent_per_slip": half(0.5)}, sinkage_exponent=lambda s, n, a: n + a["exponent_per_slip"] * np.abs(s.slip)),
    "slip_digging": effect({"depth_m": half(0.01)}, channels=sinkage_of(lambda s, z, a: z + a["depth_m"] * s.slip / (1 - s.slip))),
    "rate_dependent_pressure": effect({"rate_exponent": half(0.1)}, pressure=lambda s, p, a: p * (1 + s.v_n / 0.001) ** a["rate_exponent"]),
    "hard_pan": effect({"inverse_depth_per_m": half(25)}, pressure=lambda s, p, a: p / np.maximum(1 - s.z * a["inverse_depth_per_m"], 0.001)),
    "density_gradient": effect({"gradient_per_m": half(20)}, pressure=lambda s, p, a: p * (1 + a["gradient_per_m"] * s.z)),
    "saturating_pressure": effect({"saturation_per_m": half(25)}, pressure=lambda s, p, a: p / (1 + a["saturation_per_m"] * s.z)),
    "slip_softened_pressure": effect({"softening_per_slip": half(0.5)}, pressure=lambda s, p, a: p * np.exp(-a["softening_per_slip"] * np.abs(s.slip))),
    "end_wall": effect({"wall_stiffening": half(0.15)}, pressure=end_walls),
    "moisture": effect({"water_index": uniform(0, 1)}, pressure=lambda s, p, a: p * (1 + 0.5 * a["water_index"]), shear_limit=moist_limit),
    "adhesion": effect({"adhesion_pa": half(300)}, shear_limit=lambda s, t, a: t + a["adhesion_pa"]),
    "interface_friction": effect({"lost_share": uniform(0, 0.8)}, shear_limit=lambda s, t, a: t * (1 - a["lost_share"])),
    "stress_dependent_friction": effect({"angle_per_decade_deg": half(2.5)}, shear_limit=stress_dependent),
    "friction_rate_weakening": effect({"weakening_per_log": half(0.05)},
        shear_limit=lambda s, t, a: t * np.maximum(1 - a["weakening_per_log"] * np.log1p(s.v_t / 0.001), 0)),
    "side_wall_friction": effect({"pressed_share": uniform(0, 0.5)}, shear_limit=side_walls),
    "shear_velocity_scale": effect({"log_scale": normal(0, 1)}, shear=mobilised_slower),
    "janosi_hanamoto": effect({"shear_modulus_m": ("lognormal", 0.008, 2.5)}, shear=lambda s, t, a: -t * np.expm1(-s.j / a["shear_modulus_m"])),
    "stretched_mobilisation": effect({"shear_modulus_m": ("lognormal", 0.008, 2.5)},
        shear=lambda s, t, a: -t * np.expm1(-((s.j / a["shear_modulus_m"]) ** 0.73))),
    "stick_slip": effect({"slow_loss": uniform(0, 0.6)}, shear=lambda s, t, a: t * (1 - a["slow_loss"] * np.exp(-s.rim_speed / 0.02))),
    "slip_radius_error": effect({"speed_error": normal(0, 0.02)}, condition=slip_radius),
    "load_scale": effect({"load_error": normal(0, 0.03)}, wheel_load=lambda s, w, a: w * (1 + a["load_error"])),
    "load_transfer": effect({"transferred_share": normal(0, 0.15, -0.6, 0.6)}, wheel_load=lambda s, w, a: w - a["transferred_share"] * s.pull),
    "lug_thrust": effect({"thrust_scale": half(0.7)}, channels=lugs),
    "bulldozing": effect({"resistance_scale": half(1.0)}, channels=wedge),
    "bin_slope": effect({"slope_deg": normal(0, 0.5)}, channels=pull_of(lambda s, f, a: f - s.wheel_load * np.sin(np.radians(a["slope_deg"])))),
    "sled_tare": effect({"tare_n": normal(0, 3)}, channels=pull_of(lambda s, f, a: f - a["tare_n"])),
    "sled_drag": effect({"drag_n_s_m": half(200)}, channels=pull_of(lambda s, f, a: f - a["drag_n_s_m"] * s.sled_speed)),
    "bearing_torque": effect({"friction_torque_n_m": half(0.2)}, channels=torque_of(lambda s, t, a: t + a["friction_torque_n_m"])),
    "bearing_friction": effect({"friction_arm_m": half(0.003)}, channels=torque_of(lambda s, t, a: t + a["friction_arm_m"] * s.wheel_load)),
    "drawbar_pull_gain": effect({"gain_error": normal(0, 0.03)}, channels=pull_of(lambda s, f, a: f * (1 + a["gain_error"]))),
    "torque_gain": effect({"gain_error": normal(0, 0.03)}, channels=torque_of(lambda s, t, a: t * (1 + a["gain_error"]))),
    "sinkage_offset": effect({"offset_m": normal(0, 0.001)}, channels=sinkage_of(lambda s, z, a: z + a["offset_m"])),
}
# Errors of the rig that a library names too; they are drawn as faults, not as effects of the library.
FAULT_EFFECTS = {
    "wheel_radius_error": effect({"relative_error": normal(0, 0.03)}, condition=scaled("radius", "relative_error")),
    "wheel_width_error": effect({"relative_error": normal(0, 0.03)}, condition=scaled("width", "relative_error")),
    "drift_stiffness": effect({"ln_change": normal(0, 0.2)}, pressure=lambda s, p, a: p * np.exp(a["ln_change"] * s.order)),
    "drift_drawbar_pull_zero": effect({"change_n": normal(0, 2)}, channels=pull_of(lambda s, f, a: f + a["change_n"] * s.order)),
    "drift_torque_zero": effect({"change_n_m": normal(0, 0.2)}, channels=torque_of(lambda s, t, a: t + a["change_n_m"] * s.order)),
    "drift_sinkage_zero": effect({"change_m": normal(0, 0.001)}, channels=sinkage_of(lambda s, z, a: z + a["change_m"] * s.order)),
}
