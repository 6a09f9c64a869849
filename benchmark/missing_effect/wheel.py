"""A rigid wheel that rolls steadily over plastic soil: forces of a smooth rim by Bekker's pressure and Mohr–Coulomb shear.

Written from the published formulas for this benchmark; it shares nothing with the models of Grouser. Many runs, each with parameters of its own,
are solved at once: an array has a row for each run and a column for each strip of the contact.

The rim touches the soil from the entry at theta_1 = acos(1 - z/R) to the lowest point. The pressure is p = gamma k* depth^n with
k* = k_c/b_eff + k_phi and b_eff = l b/(l + b); gamma is the square root of the distance to the border of the footprint, averaged over the width, of mean
one. The shear stress is (c + p tan phi) (1 - exp(-|v_t|/v0)) against the sliding of the rim. The sinkage is that at which the soil carries the load.
"""
import numpy as np

STRIPS = 60
REFERENCE_SINKAGE_M, REFERENCE_WIDTH_M = 0.01, 0.03
CHANNELS = ("drawbar_pull_n", "torque_n_m", "sinkage_m")
DENSITY_KG_M3, GRAVITY, BIN_LENGTH_M, GROUSERS, GROUSER_HEIGHT_M = 1400.0, 9.81, 1.5, 12, 0.009
# The solver ends once each load is met to this share, or rejects the run after as many steps.
TOLERANCE, STEPS = 1e-7, 80


class State:
    """What an effect may read, by the names of the catalogue's formulas, in SI; (rows, 1) or (rows, strips)."""

    def __init__(self, runs, soil, effects):
        column = lambda x: np.asarray(x, float).reshape(-1, 1)
        self.slip, self.wheel_load, self.sled_speed = (column(runs[k]) for k in ("slip", "wheel_load_n", "sled_speed_m_s"))
        self.order = column(runs["order"]) if "order" in runs else np.zeros_like(self.slip)
        self.width, self.rig_radius = column(runs["width_m"]), column(runs["rig_radius_m"])
        self.radius, self.n = column(soil["wheel_radius_m"]), column(soil["n"])
        self.friction_angle_rad = np.radians(column(soil["friction_angle_deg"]))
        kappa = column(soil["kappa"])
        self.k_phi = 10 ** column(soil["log10_p_ref"]) / REFERENCE_SINKAGE_M**self.n / (1 + kappa)
        self.k_c = kappa * REFERENCE_WIDTH_M * self.k_phi
        self.cohesion_pa, self.shear_velocity, self.gamma_exponent = 0.0, 0.001, 0.5
        self.speed, self.rim_speed = self.sled_speed, self.sled_speed / (1 - self.slip)
        self.effects = effects
        for effect, strength in effects:
            if "condition" in effect:
                effect["condition"](self, strength)
        # The rim of a wheel with another radius than the rig's moves with another speed.
        self.rim_velocity = self.rim_speed * self.radius / self.rig_radius

    def applied(self, quantity, value):
        for effect, strength in self.effects:
            if quantity in effect:
                value = effect[quantity](self, value, strength)
        return value


def footprint_weights(x, length, width, exponent):
    """gamma at x: the distance to the border to a power, averaged over the width, of mean one."""
    nearest, half = np.minimum(x, length - x), width / 2
    inner = np.minimum(nearest, half)
    gamma = (inner / half) ** exponent * (inner / (exponent + 1) + half - inner)
    return gamma / gamma.mean(axis=1, keepdims=True)


def forces(s, z0, strips):
    """Vertical force, pull and torque at these sinkages; leaves the fields along the contact in the state."""
    s.sinkage = z0.reshape(-1, 1)
    s.entry = np.arccos(np.clip(1 - s.sinkage / s.radius, -1, 1))
    s.contact_length = s.radius * np.sin(s.entry)
    s.position = (np.arange(strips) + 0.5) / strips
    x = s.position * s.contact_length
    sine = x / s.radius
    cosine = np.sqrt(1 - sine**2)
    s.theta = np.arcsin(sine)
    s.z = np.maximum(s.radius * cosine - s.radius + s.sinkage, 0)
    s.v_n = s.speed * sine
    sliding = s.rim_velocity - s.speed * cosine
    s.v_t = np.abs(sliding)
    # The way of a point of the rim over the soil since its entry.
    s.j = np.abs(s.radius * (s.entry - s.theta - s.speed / s.rim_velocity * (np.sin(s.entry) - sine)))
    s.b_eff = s.contact_length * s.width / (s.contact_length + s.width)
    s.k_star = s.k_c / s.b_eff + s.k_phi
    s.exponent = s.applied("sinkage_exponent", s.n)
    s.gamma = footprint_weights(x, s.contact_length, s.width, s.gamma_exponent)
    s.p = s.applied("pressure", s.gamma * s.k_star * s.z**s.exponent)
    s.tau_max = s.applied("shear_limit", s.cohesion_pa + s.p * np.tan(s.friction_angle_rad))
    s.tau = s.applied("shear", s.tau_max * (1 - np.exp(-s.v_t / s.shear_velocity)))
    tau, area, tangent = s.tau * np.sign(sliding), s.width * s.contact_length / strips, sine / cosine
    vertical = ((s.p + tau * tangent) * area).sum(axis=1)
    pull = ((tau - s.p * tangent) * area).sum(axis=1)
    torque = (s.radius * tau / cosine * area).sum(axis=1)
    return vertical, pull, torque


def solve(runs, soil, effects=(), strips=STRIPS):
    """Pull, torque and sinkage of each run, a row each, NaN where the soil does not carry the wheel; and the state of the contact.

    `runs`: arrays of the conditions. `soil`: arrays of the base's parameters, one for each run. `effects`: pairs of an effect (a dictionary of its
    formulas by what they change) and its strengths (arrays with a row for each run).
    """
    with np.errstate(all="ignore"):
        state = State(runs, soil, effects)

        def excess(z):
            vertical, pull, torque = forces(state, z, strips)
            state.pull = pull.reshape(-1, 1)
            load = state.applied("wheel_load", state.wheel_load)
            return (vertical - load[:, 0]) / load[:, 0], pull, torque

        rows = len(state.slip)
        low, high = np.full(rows, 1e-7), 0.95 * state.radius[:, 0] * np.ones(rows)
        below, above = excess(low)[0], excess(high)[0]
        fine = (below < 0) & (above > 0) & np.all(state.k_star > 0, axis=1)
        z = np.full(rows, 0.004)
        for step in range(STEPS):
            value, pull, torque = excess(z)
            open_ = np.abs(value) > TOLERANCE
            if not np.any(open_ & fine):
                break
            rises = value > 0
            high, above = np.where(rises, z, high), np.where(rises, value, above)
            low, below = np.where(rises, low, z), np.where(rises, below, value)
            # Vertical force goes about as a power of the sinkage: the chord is taken in logarithms, and every third step halves the bracket.
            chord = np.exp((np.log(low) * np.log1p(above) - np.log(high) * np.log1p(below)) / (np.log1p(above) - np.log1p(below)))
            middle = np.sqrt(low * high)
            inside = (chord > low) & (chord < high) & (step % 3 != 2)
            z = np.where(open_, np.where(inside, chord, middle), z)
        carried = fine & (np.abs(value) < 1e-4) & np.all(state.k_star > 0, axis=1)
        channels = [pull.reshape(-1, 1), torque.reshape(-1, 1), z.reshape(-1, 1)]
        for effect, strength in state.effects:
            if "channels" in effect:
                channels = effect["channels"](state, *channels, strength)
        return np.where(carried[:, None], np.hstack([np.broadcast_to(c, (rows, 1)) for c in channels]), np.nan), state
