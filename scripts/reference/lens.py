"""Reference answers for src/view/lens/, from OpenCV.

python3 scripts/reference/lens.py > scripts/reference/lens.csv     (pip install opencv-python-headless numpy)

Each line: the lens, fx fy cx cy, its coefficients, then five points x y z, each followed by its column and row.
"""

import cv2
import numpy as np

CAMERAS = 6
POINTS = 5


def line(name, *parts):
    numbers = np.concatenate([np.ravel(part) for part in parts])
    print(name + "," + ",".join(f"{number:.17g}" for number in numbers))


random = np.random.default_rng(11)
still = np.zeros(3)
for name, size in (("brown5", 5), ("brown8", 8), ("fisheye", 4)):
    for _ in range(CAMERAS):
        fx, cx, cy = random.uniform([400, 300, 220], [700, 340, 260])
        fy = fx * random.uniform(0.98, 1.02)
        matrix = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
        spread = np.array([0.2, 0.05, 0.003, 0.003, 0.03, 0.1, 0.03, 0.01])[:size]
        if name == "fisheye":
            spread = np.array([0.05, 0.02, 0.01, 0.005])
        lens = random.uniform(-spread, spread)
        z = random.uniform(0.5, 4, POINTS)
        slope = 0.5 if size > 4 else 3  # largest tangent of the angle to the axis, in x and in y
        points = np.column_stack([random.uniform(-slope, slope, (POINTS, 2)) * z[:, None], z])
        if name == "fisheye":
            pixels, _ = cv2.fisheye.projectPoints(points[None], still, still, matrix, lens)
        else:
            pixels, _ = cv2.projectPoints(points, still, still, matrix, lens)
        line(name, [fx, fy, cx, cy], lens, np.column_stack([points, pixels.reshape(-1, 2)]))
