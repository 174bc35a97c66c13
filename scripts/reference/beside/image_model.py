"""Image model and light: log colours are linear in nine functions of the normal."""

import numpy as np

MOST_PIXELS = 8000  # that a light is fitted to, as in the package
C1, C2, C3, C4, C5 = 0.429043, 0.511664, 0.743125, 0.886227, 0.247708


def harmonics(n):
    """Nine functions of normals, (.., 9)."""
    x, y, z = np.moveaxis(n, -1, 0)
    return np.stack([
        np.full_like(x, C4), 2 * C2 * y, 2 * C2 * z, 2 * C2 * x, 2 * C1 * x * y,
        2 * C1 * y * z, C3 * z * z - C5, 2 * C1 * x * z, C1 * (x * x - y * y),
    ], axis=-1)  # fmt: skip


def shading_gradient(n, light):
    """Derivatives of the predicted log colours by the normals: (N, 3 channels, 3 axes)."""
    x, y, z = n[:, :1], n[:, 1:2], n[:, 2:]
    _, l2, l3, l4, l5, l6, l7, l8, l9 = light
    by_x = 2 * C2 * l4 + 2 * C1 * (y * l5 + z * l8 + x * l9)
    by_y = 2 * C2 * l2 + 2 * C1 * (x * l5 + z * l6 - y * l9)
    by_z = 2 * C2 * l3 + 2 * C1 * (y * l6 + x * l8) + 2 * C3 * z * l7
    return np.stack([by_x, by_y, by_z], axis=-1)


def unit(n):
    return n / np.linalg.norm(n, axis=-1, keepdims=True)


def robust(residuals, scale=None):
    """Weights of Geman and McClure for residuals over all channels, and their scale: by default three medians."""
    sizes = np.linalg.norm(residuals, axis=-1)
    scale = scale or max(3 * np.median(sizes), 1e-3)
    return 1 / (1 + (sizes / scale) ** 2) ** 2, scale


def thinned(count, most):
    """Every n-th of some elements, so that at most about `most` remain."""
    return slice(None, None, max(1, count // most))


def fit_light(normals, colours, rounds=8):
    """Robust least squares of log colours on nine harmonics: (9, 3)."""
    chosen = thinned(len(normals), MOST_PIXELS)
    normals, colours = normals[chosen], colours[chosen]
    basis = harmonics(normals)
    weights = np.ones(len(basis))
    for _ in range(rounds):
        weighted = basis * weights[:, None]
        light = np.linalg.solve(weighted.T @ basis + 1e-9 * np.eye(9), weighted.T @ colours)
        weights, _ = robust(colours - basis @ light)
    return light
