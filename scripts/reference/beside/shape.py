"""Shapes: normals of single pixels, and heights by sparse least squares."""

import numpy as np
from image_model import harmonics, robust, shading_gradient, unit
from scipy import sparse
from scipy.sparse.linalg import splu

PRIOR, UNIT, EDGE = 0.05, 1.0, 0.1  # weights: prior normals, unit length, slopes of pixels' normals beside the colours
STEEPEST = 0.1  # least cosine of a normal to the line of sight


def solve_normals(colours, light, normals, prior, known, rounds=3):
    """A normal for each pixel by Gauss-Newton: three colours, unit length, and the prior where it is known."""
    weight = np.where(known, PRIOR, 1e-6)[:, None]
    for _ in range(rounds):
        residuals = colours - harmonics(normals) @ light
        jacobian = shading_gradient(normals, light)
        length = np.sum(normals**2, axis=-1, keepdims=True) - 1
        system = jacobian.transpose(0, 2, 1) @ jacobian + 4 * UNIT * normals[:, :, None] * normals[:, None, :]
        system += weight[..., None] * np.eye(3)
        right = np.einsum("nci,nc->ni", jacobian, residuals) - 2 * UNIT * length * normals + weight * (prior - normals)
        step = np.linalg.solve(system, right[..., None])[..., 0]
        normals = normals + step / np.maximum(1, 2 * np.linalg.norm(step, axis=-1, keepdims=True))
        normals[:, 2] = np.minimum(normals[:, 2], -STEEPEST)
    return unit(normals)


class Heights:
    """Heights on a mask: sparse differences over cells of four pixels and over edges between neighbours."""

    def __init__(self, mask):
        self.count = int(mask.sum())
        index = np.full(mask.shape, -1)
        index[mask] = np.arange(self.count)
        self.corners = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, :-1], index[1:, 1:]], axis=-1)
        self.corners = self.corners[np.all(self.corners >= 0, axis=-1)]
        self.right = self.differences(self.corners, [-0.5, 0.5, -0.5, 0.5])
        self.down = self.differences(self.corners, [-0.5, -0.5, 0.5, 0.5])
        neighbours = (index[:, :-1], index[:, 1:]), (index[:-1], index[1:])
        along = [np.stack(pair, axis=-1).reshape(-1, 2) for pair in neighbours]
        along = [pairs[np.all(pairs >= 0, axis=-1)] for pairs in along]
        self.pairs, self.axes = np.concatenate(along), np.repeat([0, 1], [len(pairs) for pairs in along])
        self.edges = self.differences(self.pairs, [-1.0, 1.0])
        self.laplacian = (self.edges.T @ self.edges).tocsc()
        self.kept = None

    def differences(self, members, signs):
        count = len(members)
        rows = np.repeat(np.arange(count), len(signs))
        return sparse.csr_matrix((np.tile(signs, count), (rows, members.ravel())), shape=(count, self.count))

    def steps(self, normals):
        """Differences of heights over the edges, as normals predict them."""
        slopes = -normals[:, :2] / np.minimum(normals[:, 2:], -STEEPEST)
        return slopes[self.pairs, self.axes[:, None]].mean(axis=1)

    def integrate(self, normals, anchors, weights):
        """Linear least squares of the edges and the anchors. The factors are kept while the weights stay, as a person would."""
        if self.kept is None or not np.array_equal(self.kept[0], weights):
            self.kept = weights.copy(), factors(self.laplacian + sparse.diags(weights, format="csc"))
        return self.kept[1].solve(self.edges.T @ self.steps(normals) + weights * anchors)

    def shade(self, heights, colours, light, normals, anchors, weights):
        """One Gauss-Newton step of heights whose cells explain the colours."""
        p, q = self.right @ heights, self.down @ heights
        length = np.sqrt(1 + p * p + q * q)
        cells = np.stack([p, q, -np.ones_like(p)], axis=-1) / length[:, None]
        residuals = colours[self.corners].mean(axis=1) - harmonics(cells) @ light
        factor, _ = robust(residuals)
        slopes = shading_gradient(cells, light)
        inward = np.einsum("nci,ni->nc", slopes, cells)
        by_p, by_q = ((slopes[..., k] - inward * cells[:, k : k + 1]) / length[:, None] for k in (0, 1))
        pp, pq, qq = (np.sum(factor[:, None] * a * b, axis=-1) for a, b in ((by_p, by_p), (by_p, by_q), (by_q, by_q)))
        to_p, to_q = (np.sum(factor[:, None] * a * residuals, axis=-1) for a in (by_p, by_q))
        right, down = self.right, self.down
        mixed = right.T @ sparse.diags(pq) @ down
        system = right.T @ sparse.diags(pp) @ right + mixed + mixed.T + down.T @ sparse.diags(qq) @ down
        system = system + EDGE * self.laplacian + sparse.diags(weights)
        gradient = right.T @ to_p + down.T @ to_q + EDGE * (self.edges.T @ (self.steps(normals) - self.edges @ heights))
        return heights + factors(system.tocsc()).solve(gradient + weights * (anchors - heights))

    def normals(self, heights):
        """Normals of pixels: means over the edges that meet there."""
        steps = self.edges @ heights
        slopes = np.empty((self.count, 2))
        for axis in (0, 1):
            chosen = self.axes == axis
            pairs = self.pairs[chosen].ravel()
            sums = np.bincount(pairs, np.repeat(steps[chosen], 2), self.count)
            slopes[:, axis] = sums / np.maximum(np.bincount(pairs, minlength=self.count), 1)
        return unit(np.column_stack([slopes, -np.ones(self.count)]))


def factors(system):
    """Sparse factors of a symmetric matrix; this order of elimination is much faster here than the one that scipy takes by itself."""
    return splu(system, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
