"""The test rig of the campaigns: its wheel, its noise, and runs of one truth on it."""
import numpy as np

import wheel

RADIUS_M, WIDTH_M, NOISE_SHARE = 0.125, 0.112, 0.03


def noise_sds(values):
    """Noise of each channel: a share of its root mean square."""
    return NOISE_SHARE * np.sqrt(np.mean(values**2, axis=0))


def simulate(runs, soil, hooks):
    """Channels of every run, and the contact, of one soil with effects of given strengths."""
    rows = len(runs["slip"])
    columns = {key: np.full(rows, number) for key, number in soil.items()}
    return wheel.solve(runs, columns, [(effect, {key: np.full((rows, 1), x) for key, x in a.items()}) for effect, a in hooks])
