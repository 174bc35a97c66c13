"""The stages of the method as a person would write them in numpy, scipy and Open3D, to be timed beside the package.

npm run bench -- --beside

That command starts this script in an environment with its requirements and sends one request a line; each answer is a line of JSON.
`scene PATH` reads a scene of scripts/bench/scenes.mjs, `step` times one iteration of the loop from the true pose, and `answer` the whole
way from two views to pose, light and shapes, with nothing else known. The views are orthographic, lengths are pixels, and the frame is
that of the package: x right, y down, z forward.
"""

import json
import os
import sys
import time

# One thread, as the package has without workers.
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np
from image_model import fit_light
from registration import BLURS, icp, register, search
from scipy import ndimage
from shape import Heights, solve_normals
from views import Depth, Image, Pose, visible

POSE = 13  # numbers of a pose in a scene's file: s, R row by row, t
ITERATIONS = 3  # of an answer, after its registration
ANCHOR, KEPT = 1e-3, 0.05  # weights of the depth points in the image's surface, and of the measured depth in the refined one
FIRST_ROUNDS, FIRST_STEPS = 6, 2  # of normals and heights in the first iteration, which starts from the prior


class Clock:
    """Calls functions and adds up their times by name, milliseconds."""

    def __init__(self):
        self.milliseconds = {}

    def __call__(self, name, work, *given, **named):
        begun = time.perf_counter()
        result = work(*given, **named)
        self.milliseconds[name] = self.milliseconds.get(name, 0) + 1000 * (time.perf_counter() - begun)
        return result


class Pair:
    """Both views with what an iteration changes: pose, light, normals and heights of the image, normals and heights of the depth map."""

    def __init__(self, colours, depth):
        self.image, self.depth = Image(colours), Depth(depth)
        for blur in BLURS:
            self.image.level(blur)
        self.colours = self.image.log[self.image.mask]
        self.surface, self.refined = Heights(self.image.mask), Heights(self.depth.mask)
        self.measured = self.depth.points[:, 2]
        self.normals = self.heights = self.light = None
        self.depth_normals = self.depth.normals

    def correspond(self, pose):
        """For every image pixel the nearest visible depth point that falls on it; prior normals and anchors."""
        self.pose = pose
        _, placed, normals = pose.of(self.depth)
        self.places, on = self.image.places(placed[:, :2])
        self.seen = on & visible(self.image, self.places, placed[:, 2], normals[:, 2] < -0.05)
        row, column = np.rint(self.places[:, self.seen]).astype(int)
        order = np.argsort(-placed[self.seen, 2])
        owner = np.full(self.image.mask.shape, -1)
        owner[row[order], column[order]] = np.flatnonzero(self.seen)[order]
        owner = owner[self.image.mask]
        self.known = owner >= 0
        self.prior = np.where(self.known[:, None], normals[owner], [0.0, 0.0, -1.0])
        middle = np.median(placed[owner[self.known], 2])
        self.anchors = np.where(self.known, placed[owner, 2], middle)
        self.weights = np.where(self.known, ANCHOR, 1e-6)

    def fit_light(self):
        self.light = fit_light(self.prior[self.known], self.colours[self.known])

    def shading(self):
        before = self.prior if self.normals is None else self.normals
        rounds = {} if self.normals is not None else {"rounds": FIRST_ROUNDS}
        self.normals = solve_normals(self.colours, self.light, before, self.prior, self.known, **rounds)

    def integrate(self):
        given = self.colours, self.light, self.normals, self.anchors, self.weights
        first = self.heights is None
        if first:
            self.heights = self.surface.integrate(self.normals, self.anchors, self.weights)
        for _ in range(FIRST_STEPS if first else 1):
            self.heights = self.surface.shade(self.heights, *given)
        self.normals = self.surface.normals(self.heights)

    def refine(self):
        """Normals of the depth map by the colours that its points see, then heights between them and the measured depth."""
        channels = np.moveaxis(self.image.log, -1, 0)
        colours = np.stack([ndimage.map_coordinates(channel, self.places, order=1) for channel in channels], axis=-1)
        turned = self.depth_normals @ self.pose.rotation.T
        prior = self.depth.normals @ self.pose.rotation.T
        solved = solve_normals(colours, self.light, turned, prior, np.ones(len(turned), bool))
        normals = np.where(self.seen[:, None], solved @ self.pose.rotation, self.depth.normals)
        self.depth_heights = self.refined.integrate(normals, self.measured, np.full(self.refined.count, KEPT))
        self.depth_normals = self.refined.normals(self.depth_heights)

    def points(self):
        rows, columns = np.nonzero(self.image.mask)
        return np.column_stack([columns - self.image.centre[0], rows - self.image.centre[1], self.heights])

    def stages(self):
        return [("light", self.fit_light), ("shading", self.shading), ("surface", self.integrate), ("refinement", self.refine)]


def degrees_between(a, b):
    return float(np.degrees(2 * np.arcsin(min(1, np.linalg.norm(a - b) / np.sqrt(8)))))


class Scene:
    """A file of scripts/bench/scenes.mjs, and the measurements on it."""

    def __init__(self, path):
        with open(path, "rb") as file:
            content = file.read()
        width, height = (int(side) for side in np.frombuffer(content, "<u4", 2))
        pose = np.frombuffer(content, "<f8", POSE, 8)
        views = np.frombuffer(content, "<f4", offset=8 + 8 * POSE).astype(float)
        self.scale, self.rotation, self.translation = pose[0], pose[1:10].reshape(3, 3), pose[10:]
        self.colours = views[: 3 * width * height].reshape(height, width, 3)
        self.depth = views[3 * width * height :].reshape(height, width)
        self.steady = None

    def truth(self, depth):
        return Pose(self.rotation, self.scale * self.rotation @ depth.middle + self.translation, self.scale)

    def settled(self):
        """A pair after its first iteration from the true pose, from which steady iterations are timed."""
        if self.steady is None:
            self.steady = Pair(self.colours, self.depth)
            self.steady.correspond(self.truth(self.steady.depth))
            for _, stage in self.steady.stages():
                stage()
        return self.steady

    def step(self):
        pair, clock = self.settled(), Clock()
        clock("preparation", Pair, self.colours, self.depth)
        pose, _ = clock("registration", register, pair.image, pair.depth, self.truth(pair.depth))
        clock("registration", pair.correspond, pose)
        for name, stage in pair.stages():
            clock(name, stage)
        clock.milliseconds["step"] = sum(clock.milliseconds.values()) - clock.milliseconds["preparation"]
        answer = {"milliseconds": clock.milliseconds, "degrees": degrees_between(pose.rotation, self.rotation)}
        if o3d:
            rotation = clock("ICP", icp, o3d, pair.depth, pose, pair.points(), pair.normals)
            answer["icpDegrees"] = degrees_between(rotation, self.rotation)
        return answer

    def answer(self):
        clock = Clock()
        pair = clock("preparation", Pair, self.colours, self.depth)
        pose = clock("search", search, pair.image, pair.depth)
        clock("registration", pair.correspond, pose)
        for _ in range(ITERATIONS):
            for name, stage in pair.stages():
                clock(name, stage)
        clock.milliseconds["answer"] = sum(clock.milliseconds.values())
        return {"milliseconds": clock.milliseconds, "degrees": degrees_between(pose.rotation, self.rotation)}


def open3d():
    """Open3D, or why it cannot be loaded: it has no wheel for every Python, and needs libraries of the system."""
    try:
        import open3d as module
    except ImportError as error:
        return None, str(error)
    return module, None


def main():
    scene = None
    print(json.dumps({"missing": reason}), flush=True)
    for line in sys.stdin:
        word, _, rest = line.strip().partition(" ")
        if word == "scene":
            scene = Scene(rest)
            answer = {}
        else:
            answer = {"step": scene.step, "answer": scene.answer}[word]()
        print(json.dumps(answer), flush=True)


o3d, reason = open3d()
if __name__ == "__main__":
    main()
