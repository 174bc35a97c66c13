"""Both views, as arrays for interpolation and as points with normals, and a pose between them."""

import numpy as np
from image_model import unit
from scipy import ndimage
from scipy.spatial.transform import Rotation


class Image:
    """Log colours of the object, continued beyond the mask for interpolation; the splines of every blur are made once."""

    def __init__(self, colours):
        self.mask = ~np.isnan(colours[..., 0])
        self.height, self.width = self.mask.shape
        nearest = ndimage.distance_transform_edt(~self.mask, return_distances=False, return_indices=True)
        self.log = np.log(np.maximum(colours[tuple(nearest)], 1e-6))
        self.centre = np.array([self.width - 1, self.height - 1]) / 2
        self.levels = {}

    def level(self, blur):
        if blur not in self.levels:
            smooth = ndimage.gaussian_filter(self.log, (blur, blur, 0)) if blur else self.log
            splines = [ndimage.spline_filter(channel, order=3) for channel in np.moveaxis(smooth, -1, 0)]
            down, right = np.gradient(smooth, axis=(0, 1))
            self.levels[blur] = splines, np.concatenate([right, down], axis=-1)
        return self.levels[blur]

    def places(self, xy):
        """Rows and columns of points, and whether they lie on the mask."""
        column, row = (xy + self.centre).T
        nearest = np.rint(np.clip([row, column], 0, [[self.height - 1], [self.width - 1]])).astype(int)
        inside = (row >= 0) & (column >= 0) & (row <= self.height - 1) & (column <= self.width - 1)
        return np.array([row, column]), inside & self.mask[tuple(nearest)]

    def colours(self, places, blur):
        """Log colours at some places, and their gradients: (N, 3), (N, 3, 2)."""
        splines, slopes = self.level(blur)
        values = [ndimage.map_coordinates(spline, places, order=3, prefilter=False) for spline in splines]
        along = [ndimage.map_coordinates(slopes[..., k], places, order=1) for k in range(6)]
        return np.stack(values, axis=-1), np.stack([np.stack(along[:3], -1), np.stack(along[3:], -1)], axis=-1)


class Depth:
    """Points of a depth map and their normals by differences of neighbours."""

    def __init__(self, depth):
        self.height, self.width = depth.shape
        p, q = (self.slopes(depth, axis) for axis in (1, 0))
        self.mask = np.isfinite(depth) & np.isfinite(p) & np.isfinite(q)
        rows, columns = np.nonzero(self.mask)
        x, y = columns - (self.width - 1) / 2, rows - (self.height - 1) / 2
        self.points = np.stack([x, y, depth[self.mask]], axis=-1)
        self.normals = unit(np.stack([p[self.mask], q[self.mask], -np.ones(len(x))], axis=-1))
        self.middle = self.points.mean(axis=0)

    @staticmethod
    def slopes(depth, axis):
        """The mean of the differences to both neighbours along an axis, or the one that is known."""
        steps = np.diff(depth, axis=axis)
        border = np.full_like(np.take(depth, [0], axis=axis), np.nan)
        sides = np.stack([np.concatenate([border, steps], axis=axis), np.concatenate([steps, border], axis=axis)])
        known = np.isfinite(sides)
        return np.where(known, sides, 0).sum(axis=0) / np.where(known.any(axis=0), known.sum(axis=0), np.nan)


class Pose:
    """x -> s R (x - middle) + shift, with an orthographic image, which leaves the shift along z free."""

    def __init__(self, rotation, shift, scale=1.0):
        self.rotation, self.shift, self.scale = rotation, shift, scale

    def moved(self, step):
        rotation = Rotation.from_rotvec(step[:3]).as_matrix() @ self.rotation
        return Pose(rotation, self.shift + np.append(step[3:5], 0), self.scale * np.exp(step[5]))

    def of(self, depth, chosen=slice(None)):
        turned = self.scale * (depth.points[chosen] - depth.middle) @ self.rotation.T
        return turned, turned + self.shift, depth.normals[chosen] @ self.rotation.T


def visible(image, places, heights, facing):
    """Points that face the camera and that no other point hides, by a z-buffer with a tolerance."""
    row, column = np.rint(places).astype(int)
    seen = facing & (row >= 0) & (column >= 0) & (row < image.height) & (column < image.width)
    nearest = np.full((image.height, image.width), np.inf)
    np.minimum.at(nearest, (row[seen], column[seen]), heights[seen])
    nearest = ndimage.minimum_filter(nearest, 3)
    seen[seen] = heights[seen] < nearest[row[seen], column[seen]] + 3
    return seen
