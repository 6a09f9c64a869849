"""Another simulator: a rim in granular soil by resistive force theory (Li, Zhang & Goldman 2013, Science 339:1408; generic coefficients).

Each element of the rim that moves into the soil feels a stress in proportion to its depth, that depends on its tilt and the direction of its
motion alone. Nothing depends on speed. Elements behind the lowest point move out of the soil and feel nothing.
"""
import numpy as np

ELEMENTS = 120


def stresses(tilt, direction):
    """Horizontal and vertical stress over depth and scale, against a motion with a component forward; `direction` is positive downward."""
    vertical = 0.206 + 0.169 * np.cos(2 * tilt) + 0.212 * np.sin(2 * tilt + direction) + 0.358 * np.sin(direction)
    vertical += 0.055 * np.sin(-2 * tilt + direction)
    horizontal = -0.124 * np.cos(2 * tilt + direction) + 0.253 * np.cos(direction) + 0.007 * np.cos(-2 * tilt + direction)
    horizontal += 0.088 * np.sin(2 * tilt)
    return horizontal, vertical


def solve(runs, radius, scale):
    """Pull, torque and sinkage of each run, a row each."""
    column = lambda x: np.asarray(x, float).reshape(-1, 1)
    speed, load, width = column(runs["sled_speed_m_s"]), column(runs["wheel_load_n"])[:, 0], column(runs["width_m"])
    rim = speed / (1 - column(runs["slip"])) * radius / column(runs["rig_radius_m"])

    def forces(z):
        entry = np.arccos(1 - z / radius).reshape(-1, 1)
        theta = (np.arange(ELEMENTS) + 0.5) / ELEMENTS * entry
        depth = radius * np.cos(theta) - radius + z.reshape(-1, 1)
        forward, down = speed - rim * np.cos(theta), rim * np.sin(theta)
        side = np.where(forward >= 0, 1.0, -1.0)
        horizontal, vertical = stresses(side * theta, np.arctan2(down, np.abs(forward)))
        area = scale * depth * width * radius * entry / ELEMENTS
        push, lift = -side * horizontal * area, vertical * area
        # The moment about the axle of a force at (R sin, -R cos); the motor works against it.
        torque = radius * (push * np.cos(theta) + lift * np.sin(theta))
        return lift.sum(axis=1), push.sum(axis=1), torque.sum(axis=1)

    low, high = np.full(len(load), 1e-6), np.full(len(load), 0.9 * radius)
    for _ in range(60):
        z = (low + high) / 2
        carries = forces(z)[0] > load
        low, high = np.where(carries, low, z), np.where(carries, z, high)
    _, pull, torque = forces(z)
    return np.stack([pull, torque, z], axis=1)
