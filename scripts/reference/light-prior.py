"""The prior over lights (Eq. 2): a Gaussian fitted to 18 environments that are free for any use.

npm pack @pmndrs/assets@1.7.0
python3 scripts/reference/light-prior.py pmndrs-assets-1.7.0.tgz

Needs numpy 2.4.6 and OpenEXR 3.5.3 (PyPI). Source: npm package @pmndrs/assets 1.7.0, licence CC0-1.0, panoramas of
Poly Haven in its folder hdri/, 512x256, DWAB-compressed; INTEGRITY below is the hash that npm states for it. Writes
  src/light/environments.rs           mean and covariance as the crate has them
  scripts/reference/light-prior.json  the same numbers, as the option `prior` takes them, and the environments
and prints how well the nine coefficients fit, how likely each environment is under the prior made from the others, and
the distances of the test lights in ../shared/data if they are there. Nothing is random: every run writes the same.

One light is a panorama at one azimuth: its irradiance on the normals that a camera sees (optical frame: x right, y down,
n_z < 0), the logarithm of that, and for each channel the nine coefficients that fit the logarithm best. Normals are the
nodes of a product quadrature over the hemisphere, weighted by the area that they cover in an image, |n_z|, plus `LIMB`, so
that normals near the occluding contour count.

The Gaussian has the first and second moments over
  environments  with equal weights
  azimuths      32, evenly spread
  mirror        x to -x, which flips the signs of the terms odd in x (L4, L5, L8): moments of odd with even are exactly zero
  exposure      removed from each light, then replaced by MEAN_EXPOSURE and EXPOSURE_SPREAD, the same for R, G, B
FLOOR is added to the diagonal: the variance of a coefficient that 18 environments do not determine. It was set where the
environments left out have the largest median likelihood (the table that this prints).
"""

import base64
import csv
import hashlib
import json
import sys
import tarfile
import tempfile
from pathlib import Path

import numpy as np
import OpenEXR

PACKAGE = "@pmndrs/assets 1.7.0"
INTEGRITY = "sha512-zHmKNS+3Jvu9K3zJBQfYQKT9Pn9IQt8s0q/eJC3CXKpWpyg6IBa+ivN9NgDn+fDT2AVjUh2YRZ//GXUueuAdCg=="
ROOT = Path(__file__).resolve().parents[2]
TEST_LIGHTS = ROOT / "../shared/data/lights/natural_lights_114.csv"

# The constants of Ramamoorthi and Hanrahan (2001), as in src/light/harmonics.rs.
C1, C2, C3, C4, C5 = 0.429043, 0.511664, 0.743125, 0.886227, 0.247708
# Signs of L1..L9 of R, G and B in a mirror, and the positions of the constant terms.
MIRROR = np.tile([1.0, 1, 1, -1, -1, 1, 1, -1, 1], 3)
CONSTANT = np.arange(27) % 9 == 0

# Rows and columns of the cells into which a panorama is summed; azimuths of the rotated lights; polar angles
# and azimuths of the normals.
CELLS = (64, 128)
AZIMUTHS = 32
POLAR, AROUND = 16, 48
LIMB = 0.05

# Coefficient of the constant at the mean exposure: log S = log 0.36, one stop above middle grey. The spread is half a stop.
MEAN_EXPOSURE = np.log(0.36) / C4
EXPOSURE_SPREAD = 0.5 * np.log(2) / C4
FLOOR = 1e-3


def panoramas(package):
    """Name and linear colours (rows from the zenith down) of each environment in the package."""
    digest = base64.b64encode(hashlib.sha512(Path(package).read_bytes()).digest()).decode()
    if f"sha512-{digest}" != INTEGRITY:
        sys.exit(f"{package} is not {PACKAGE}: its hash is sha512-{digest}")
    with tarfile.open(package) as tar, tempfile.TemporaryDirectory() as folder:
        for member in sorted(tar.getnames()):
            if not (member.startswith("package/hdri/") and member.endswith(".exr.js")):
                continue
            module = tar.extractfile(member).read().decode()
            exr = Path(folder, "environment.exr")
            exr.write_bytes(base64.b64decode(module[module.index("base64,") + 7 : module.rindex("'")]))
            pixels = np.asarray(OpenEXR.File(str(exr)).channels()["RGB"].pixels, np.float64)
            yield Path(member).name.removesuffix(".exr.js"), np.where(np.isfinite(pixels), pixels, 0).clip(0)


def basis(normals):
    x, y, z = normals.T
    quadratic = [C1 * 2 * x * y, C1 * 2 * y * z, C3 * z * z - C5, C1 * 2 * x * z, C1 * (x * x - y * y)]
    return np.stack([np.full_like(x, C4), 2 * C2 * y, 2 * C2 * z, 2 * C2 * x, *quadratic], 1)


def visible_normals():
    """Nodes over the visible hemisphere, symmetric in x, and their weights, which add up to one."""
    node, weight = np.polynomial.legendre.leggauss(POLAR)
    towards = (node + 1) / 2
    sine = np.sqrt(1 - towards**2)
    angle = (np.arange(AROUND) + 0.5) / AROUND * 2 * np.pi
    parts = [np.outer(sine, np.cos(angle)), np.outer(sine, np.sin(angle)), np.outer(-towards, np.ones(AROUND))]
    weights = np.outer(weight * (towards + LIMB), np.ones(AROUND)).ravel()
    return np.stack(parts, -1).reshape(-1, 3), weights / weights.sum()


def cells(panorama):
    """Radiance times solid angle of each cell: a row's solid angle is the difference of two cosines."""
    height, width, _ = panorama.shape
    edges = np.cos(np.linspace(0, np.pi, height + 1))
    solid_angle = (edges[:-1] - edges[1:]) * 2 * np.pi / width
    rows, columns = CELLS
    shape = (rows, height // rows, columns, width // columns, 3)
    return (panorama * solid_angle[:, None, None]).reshape(shape).sum((1, 3))


def cell_directions():
    polar = (np.arange(CELLS[0]) + 0.5) / CELLS[0] * np.pi
    azimuth = (np.arange(CELLS[1]) + 0.5) / CELLS[1] * 2 * np.pi
    x, z = np.outer(np.sin(polar), np.sin(azimuth)), np.outer(np.sin(polar), np.cos(azimuth))
    return np.stack([x, np.outer(-np.cos(polar), np.ones(CELLS[1])), z], -1).reshape(-1, 3)


def lights_of(package):
    """27 coefficients for each azimuth of each environment, and the remaining error of the logarithm."""
    normals, weights = visible_normals()
    values = basis(normals)
    root = np.sqrt(weights)[:, None]
    solver = np.linalg.pinv(values * root) * root.T
    falling = np.maximum(0, normals @ cell_directions().T) / np.pi
    lights, errors = {}, {}
    for name, panorama in panoramas(package):
        radiance = cells(panorama)
        turned = [np.roll(radiance, turn * CELLS[1] // AZIMUTHS, 1).reshape(-1, 3) for turn in range(AZIMUTHS)]
        logs = np.log(falling @ np.concatenate(turned, 1)).reshape(-1, AZIMUTHS, 3)
        fitted = np.tensordot(solver, logs, 1)
        off = np.tensordot(values, fitted, 1) - logs
        lights[name] = fitted.transpose(1, 2, 0).reshape(AZIMUTHS, 27)
        errors[name] = np.sqrt((off**2).mean((0, 2)))
    return lights, errors


def exposed(lights):
    """Each light, rescaled to the mean exposure."""
    return lights + np.where(CONSTANT, MEAN_EXPOSURE - lights[:, CONSTANT].mean(1, keepdims=True), 0)


def gaussian(lights, floor=FLOOR):
    """Mean and covariance of lights (a list with one array for each environment), in closed form."""
    every = np.concatenate([exposed(of_one) for of_one in lights])
    every = np.concatenate([every, every * MIRROR])
    mean = every.mean(0)
    second = every.T @ every / len(every)
    # Sums whose terms cancel in pairs leave a rounding error; the mirror makes them exactly zero.
    mean[MIRROR < 0] = 0
    second[np.not_equal.outer(MIRROR, MIRROR)] = 0
    covariance = second - np.outer(mean, mean)
    covariance += EXPOSURE_SPREAD**2 * np.outer(CONSTANT, CONSTANT) + floor * np.eye(27)
    return mean, covariance


def scores(mean, covariance, lights):
    """Log-likelihood (up to a constant) and squared Mahalanobis distance of lights, with the exposure left free."""
    free = np.linalg.svd(CONSTANT[None].astype(float))[2][1:]
    lower = np.linalg.cholesky(free @ covariance @ free.T)
    squared = (np.linalg.solve(lower, free @ (lights - mean).T) ** 2).sum(0)
    return -squared / 2 - np.log(np.diag(lower)).sum(), squared


def left_out(lights, floor):
    """Median over the environments of their mean scores under the prior made from the others."""
    found = []
    for name, own in lights.items():
        others = [of_one for other, of_one in lights.items() if other != name]
        found.append([part.mean() for part in scores(*gaussian(others, floor), own)])
    return np.median(found, 0)


def rows_of(numbers, each=10):
    lines = [numbers[start : start + each] for start in range(0, len(numbers), each)]
    return "\n".join("    " + " ".join(f"{number:.6f}," for number in line) for line in lines)


def listed(numbers):
    return "[" + ", ".join(f"{number:.6f}" for number in numbers) + "]"


def write(mean, covariance, names):
    triangle = [covariance[row, column] for row in range(27) for column in range(row + 1)]
    (ROOT / "src/light/environments.rs").write_text(
        f"""//! Mean and covariance of lights around us, 27 numbers R1..9, G1..9, B1..9 in the optical frame.
//!
//! Generated by `scripts/reference/light-prior.py`, which says how. Don't edit.
//! Source: npm package {PACKAGE}, {len(names)} panoramas of Poly Haven; licence CC0-1.0.
//! {INTEGRITY}

/// Mean of the coefficients.
#[rustfmt::skip]
pub(super) const MEAN: [f32; 27] = [
{rows_of(mean)}
];

/// Lower triangle of the covariance, row after row.
#[rustfmt::skip]
pub(super) const COVARIANCE: [f32; 378] = [
{rows_of(triangle)}
];
"""
    )
    matrix = ",\n  ".join(listed(row) for row in covariance)
    (ROOT / "scripts/reference/light-prior.json").write_text(
        f"""{{
 "source": "{PACKAGE}, CC0-1.0, {INTEGRITY}",
 "environments": {json.dumps(names)},
 "mean": {listed(mean)},
 "covariance": [
  {matrix}
 ]
}}
"""
    )


def main(package):
    lights, errors = lights_of(package)
    mean, covariance = gaussian(list(lights.values()))
    write(mean + 0.0, covariance + 0.0, list(lights))

    print("environment, rms error of log irradiance, squared distance (medians over azimuths)")
    for name, of_one in lights.items():
        squared = scores(mean, covariance, of_one)[1]
        print(f"  {name:10} {np.median(errors[name]):.3f} {np.median(squared):6.1f}")
    every = np.concatenate(list(errors.values()))
    print(f"  all: {every.min():.3f} to {every.max():.3f}, median {np.median(every):.3f}")
    eigenvalues = np.linalg.eigvalsh(covariance)
    print(f"eigenvalues of the covariance: {eigenvalues[0]:.2e} to {eigenvalues[-1]:.2f}")

    print("left out: floor, log-likelihood, squared distance (medians over environments)")
    for floor in (1e-4, 3e-4, 1e-3, 3e-3, 1e-2):
        likelihood, squared = left_out(lights, floor)
        print(f"  {floor:.4f} {likelihood:6.2f} {squared:5.1f}")
    if TEST_LIGHTS.exists():
        table = np.array(list(csv.reader(TEST_LIGHTS.open()))[1:], float)[:, 1:]
        likelihood, squared = scores(mean, covariance, table)
        quantiles = np.quantile(squared, [0.1, 0.5, 0.9, 1]).round(1)
        print(f"test lights: log-likelihood {likelihood.mean():.2f}, squared distance 10/50/90/100 %: {quantiles}")


if __name__ == "__main__":
    main(sys.argv[1])
