"""Reference answers for src/pose, from numpy and scipy.

python3 scripts/reference/pose.py > scripts/reference/pose.csv

Each case is two lines of numbers, after a line that names the columns:
  angles  alpha beta gamma (degrees), then R row by row, from scipy's intrinsic 'XYZ' = Rx Ry Rz
  pairs   six pairs p q with weights w, then s, R and t of Umeyama (1991), weighted, by numpy's SVD
"""

import numpy as np
from scipy.spatial.transform import Rotation

CASES = 8
POINTS = 6


def umeyama(p, q, w):
    w = w / w.sum()
    p0, q0 = w @ p, w @ q
    covariance = ((q - q0) * w[:, None]).T @ (p - p0)
    u, d, vt = np.linalg.svd(covariance)
    sign = np.diag([1, 1, np.sign(np.linalg.det(u) * np.linalg.det(vt))])
    rotation = u @ sign @ vt
    scale = np.trace(np.diag(d) @ sign) / (w @ ((p - p0) ** 2).sum(1))
    return scale, rotation, q0 - scale * rotation @ p0


def line(name, *parts):
    numbers = np.concatenate([np.ravel(part) for part in parts])
    print(name + "," + ",".join(f"{number:.17g}" for number in numbers))


random = np.random.default_rng(7)
for _ in range(CASES):
    angles = random.uniform([-180, -90, -180], [180, 90, 180])
    line("angles", angles, Rotation.from_euler("XYZ", angles, degrees=True).as_matrix())
for case in range(CASES):
    p = random.normal(size=(POINTS, 3))
    if case % 2:  # flat points, for which a careless solution is a reflection
        p[:, 2] = 0.3 * p[:, 0]
    rotation = Rotation.random(random_state=case).as_matrix()
    q = 1.7 * p @ rotation.T + random.normal(size=3) + 0.3 * random.normal(size=(POINTS, 3))
    w = random.uniform(0.1, 1, POINTS)
    line("pairs", np.column_stack([p, q, w]), *umeyama(p, q, w))
