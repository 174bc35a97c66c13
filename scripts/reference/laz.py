"""LAZ files for the tests of the reader, written by an independent program, laspy with lazrs.

    pip install laspy==2.7.0 lazrs==0.8.2
    python scripts/reference/laz.py tests/fixtures/rig

A scan of eight lasers in a round room with a wavy wall, laser after laser; tests/contract/rig-laz.test.mjs has the same formulas.
"""

import sys
from pathlib import Path

import laspy
import numpy as np

LASERS, COLUMNS = 8, 72
# The version of LAS that introduced each point format. Another test also mutates the files of ALONE, which are not in a subfolder.
FORMATS = {0: "1.2", 1: "1.2", 2: "1.2", 3: "1.2", 4: "1.3", 6: "1.4", 7: "1.4", 8: "1.4", 10: "1.4"}
ALONE = (1, 6)


def scan():
    laser, column = np.divmod(np.arange(LASERS * COLUMNS), COLUMNS)
    azimuth = np.radians(360 * column / COLUMNS)
    elevation = np.radians(4 * laser - 14)
    radius = 5 + np.sin(3 * azimuth) / 2
    points = [radius * np.cos(azimuth), radius * np.sin(azimuth), radius * np.tan(elevation)]
    return points, (7 * laser + column) % 256, 100 + 1e-5 * np.arange(LASERS * COLUMNS)


def write(path, point_format, version):
    header = laspy.LasHeader(point_format=point_format, version=version)
    header.scales, header.offsets = [0.001] * 3, [1, -2, 0.5]
    las = laspy.LasData(header)
    (las.x, las.y, las.z), las.intensity, times = scan()
    if "gps_time" in las.point_format.dimension_names:
        las.gps_time = times
    las.write(str(path), laz_backend=laspy.LazBackend.Lazrs)


folder = Path(sys.argv[1])
(folder / "laz").mkdir(exist_ok=True)
for point_format, version in FORMATS.items():
    name = f"scan-{point_format}.laz"
    write(folder / name if point_format in ALONE else folder / "laz" / name, point_format, version)
