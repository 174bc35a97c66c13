"""Independent reference of the surface integration: sparse least squares in 64 bits with scipy.

Writes tests/fixtures/integration.txt: a small masked grid with unknown gradients and a few weighted anchors, and the
minimiser of  sum w (z_j - z_i - (g_i + g_j)/2)^2 + sum a (z_i - t_i)^2  with and without the anchors.
Run from the project's root:  python3 scripts/reference/integration.py
"""

from pathlib import Path

import numpy as np
from scipy.sparse import lil_matrix
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import spsolve

WIDTH, HEIGHT = 23, 17
rng = np.random.default_rng(7)


def scene():
    rows, columns = np.mgrid[:HEIGHT, :WIDTH].astype(float)
    disc = (columns - 8) ** 2 + (rows - 8) ** 2 < 60
    hole = (columns - 6) ** 2 + (rows - 9) ** 2 < 4
    bar = (columns > 18) & (rows > 2)
    mask = (disc & ~hole) | bar
    p = 0.3 * np.cos(columns / 4) + 0.1 * rows / HEIGHT + 0.05 * rng.standard_normal(mask.shape)
    q = -0.4 * np.sin(rows / 5) + 0.05 * rng.standard_normal(mask.shape)
    p[rng.random(mask.shape) < 0.06] = np.nan
    q[rng.random(mask.shape) < 0.06] = np.nan
    anchor = np.where(rng.random(mask.shape) < 0.3, 20 + np.sin(columns / 3) * np.cos(rows / 4), np.nan)
    weight = rng.uniform(0.01, 0.5, mask.shape)
    # Two isolated pixels that no edge reaches, one of them with an anchor.
    for row, column, height in ((5, 9, 21.5), (11, 9, np.nan)):
        p[row, column] = q[row, column] = np.nan
        anchor[row, column] = height
    # Rounded to 32 bits, as both sides read them from the file.
    return mask, *(field.astype(np.float32).astype(float) for field in (p, q, anchor, weight))


def edges(mask, p, q):
    """Index pairs and predicted differences; edges with an unknown gradient drop out."""
    for row in range(HEIGHT):
        for column in range(WIDTH):
            for down, right, g in ((0, 1, p), (1, 0, q)):
                r, c = row + down, column + right
                if r < HEIGHT and c < WIDTH and mask[row, column] and mask[r, c]:
                    step = (g[row, column] + g[r, c]) / 2
                    if not np.isnan(step):
                        yield row * WIDTH + column, r * WIDTH + c, step


def integrate(mask, p, q, anchor, weight):
    count = WIDTH * HEIGHT
    normal, right_side = lil_matrix((count, count)), np.zeros(count)
    touched = np.zeros(count, bool)
    graph = lil_matrix((count, count))
    for i, j, step in edges(mask, p, q):
        normal[i, i] += 1
        normal[j, j] += 1
        normal[i, j] -= 1
        normal[j, i] -= 1
        right_side[i] -= step
        right_side[j] += step
        touched[[i, j]] = True
        graph[i, j] = 1
    held = np.zeros(count, bool)
    if anchor is not None:
        held = mask.ravel() & ~np.isnan(anchor.ravel())
        for i in np.flatnonzero(held):
            normal[i, i] += weight.ravel()[i]
            right_side[i] += weight.ravel()[i] * anchor.ravel()[i]
    known = touched | held
    _, label = connected_components(graph, directed=False)
    free = [np.flatnonzero(label == k) for k in np.unique(label[touched]) if not held[label == k].any()]
    for component in free:
        normal[component[0], component[0]] += 1  # fixes a level, so that there is one solution; the mean is subtracted below
    normal, index = normal.tocsc(), np.flatnonzero(known)
    z = np.full(count, np.nan)
    z[index] = spsolve(normal[index][:, index], right_side[index])
    for component in free:
        z[component] -= z[component].mean()
    return z


def main():
    mask, p, q, anchor, weight = scene()
    free = integrate(mask, p, q, None, weight)
    anchored = integrate(mask, p, q, anchor, weight)
    path = Path("tests/fixtures/integration.txt")
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w") as file:
        file.write("# Written by scripts/reference/integration.py: width height, then for each pixel\n")
        file.write("# mask p q anchor weight z z_anchored\n")
        file.write(f"{WIDTH} {HEIGHT}\n")
        for row in zip(mask.ravel(), p.ravel(), q.ravel(), anchor.ravel(), weight.ravel(), free, anchored):
            file.write(" ".join([str(int(row[0]))] + [f"{value:.9g}" for value in row[1:]]) + "\n")


if __name__ == "__main__":
    main()
