"""The pose: photometric registration, a search over all rotations, and ICP by Open3D."""

import numpy as np
from image_model import fit_light, harmonics, robust, shading_gradient, thinned
from scipy import ndimage
from scipy.spatial.transform import Rotation
from views import Pose, visible

BLURS = (3.0, 1.5, 0.0)  # of the image during registration, pixels
COARSE_POINTS = 5000  # on blurred images
FACING = 0.1  # least cosine of a visible point's normal to the line of sight; few points hide none, so only all are depth-tested
SCALE_WEIGHT = 0.3  # of the squared logarithm of the scale, which keeps the points from shrinking to a spot
OFF_MASK, BACKGROUND = 0.3, 0.1  # costs of a point off the mask, in registration and scan: a scale in log units, a squared one
ROTATIONS, SCAN_POINTS, SCAN_BLUR, CHUNK = 4608, 600, 2.0, 64  # rotations about 15 degrees apart
SCALES = (0.84, 1.0, 1.19)
CANDIDATES, APART = 80, np.radians(20)
STAGES = ((12, 400, (1.5,), 8), (3, 1500, (1.5,), 12), (1, None, (1.5, 0.0), 12))  # kept, points, blurs, rounds


def register(image, depth, pose, points=None, blurs=BLURS, rounds=12):
    """Levenberg-Marquardt for rotation, shift, scale and light, from blurred images to sharp ones: a pose and its gain."""
    for blur in blurs:
        chosen = np.arange(len(depth.points))[thinned(len(depth.points), points or (COARSE_POINTS if blur else len(depth.points)))]
        _, placed, normals = pose.of(depth, chosen)
        facing = normals[:, 2] < -FACING
        chosen = chosen[facing if points else visible(image, image.places(placed[:, :2])[0], placed[:, 2], facing)]
        state = linearised(image, depth, pose, chosen, blur)
        damping = 1e-3
        for _ in range(rounds):
            if state is None:
                return pose, -np.inf
            cost, system, right, scale = state
            moved = pose.moved(-np.linalg.solve(system + damping * np.diag(np.diag(system)), right)[:6])
            tried = linearised(image, depth, moved, chosen, blur, scale)
            if tried is None or tried[0] >= cost:
                damping *= 10
                if damping > 1:
                    break
                continue
            pose, state, damping = moved, tried, damping / 5
            if cost - tried[0] < 1e-5 * cost:
                break
    return pose, gain(image, depth, pose, points or COARSE_POINTS)


def linearised(image, depth, pose, chosen, blur, scale=None):
    """The robust mean cost at a pose, and the joint normal equations of pose (6) and light (27)."""
    turned, placed, normals = pose.of(depth, chosen)
    places, on = image.places(placed[:, :2])
    if on.sum() < 50:
        return None
    turned, normals = turned[on], normals[on]
    colours, slopes = image.colours(places[:, on], blur)
    light = fit_light(normals, colours, rounds=3)
    basis = harmonics(normals)
    residuals = colours - basis @ light
    weights, scale = robust(residuals, scale)
    x, y, z = turned.T
    zero, one = np.zeros_like(x), np.ones_like(x)
    # Derivatives of column and row by rotation vector, shift and logarithm of the scale.
    moves = np.stack([np.stack([zero, z, -y, one, zero, x], -1), np.stack([-z, zero, x, zero, one, y], -1)], axis=1)
    jacobian = slopes @ moves
    # A rotation w turns a normal by w x n, so shading changes by g . (w x n) = w . (n x g).
    jacobian[..., :3] -= np.cross(normals[:, None, :], shading_gradient(normals, light))
    weighted = weights[:, None, None] * jacobian
    system, right = np.zeros((33, 33)), np.zeros(33)
    system[:6, :6] = weighted.reshape(-1, 6).T @ jacobian.reshape(-1, 6)
    right[:6] = weighted.reshape(-1, 6).T @ residuals.ravel()
    inner = (basis * weights[:, None]).T @ basis
    for channel in range(3):
        own = slice(6 + 9 * channel, 15 + 9 * channel)
        system[own, own] = inner + 1e-9 * np.eye(9)
        system[:6, own] = -weighted[:, channel].T @ basis
        system[own, :6] = system[:6, own].T
        right[own] = -basis.T @ (weights * residuals[:, channel])
    held = SCALE_WEIGHT * len(chosen) * scale**2
    system[5, 5] += held
    right[5] += held * np.log(pose.scale)
    sizes = (residuals**2).sum(axis=-1)
    cost = np.sum(sizes / (1 + sizes / scale**2)) + scale**2 * np.sum(~on) + held * np.log(pose.scale) ** 2
    return cost / len(chosen), system, right, scale


def gain(image, depth, pose, most):
    """What the light explains beyond a constant colour, summed over the visible points; points off the mask cost."""
    _, placed, normals = pose.of(depth, thinned(len(depth.points), most))
    places, on = image.places(placed[:, :2])
    seen = normals[:, 2] < -FACING
    on &= seen
    if on.sum() < 50:
        return -np.inf
    colours, _ = image.colours(places[:, on], 0.0)
    fitted = harmonics(normals[on]) @ fit_light(normals[on], colours, rounds=3)
    without, left = (np.sum((colours - model) ** 2, axis=-1) for model in (np.median(colours, axis=0), fitted))
    explained = np.sum(without / (1 + without / OFF_MASK**2) - left / (1 + left / OFF_MASK**2))
    return (explained - OFF_MASK**2 * np.sum(seen & ~on)) / len(seen)


def grid(count):
    """Rotations spread evenly over all of them: super-Fibonacci spirals (Alexa 2022)."""
    s = np.arange(count) + 0.5
    inner, outer = np.sqrt(s / count), np.sqrt(1 - s / count)
    a, b = 2 * np.pi * s / np.sqrt(2), 2 * np.pi * s / 1.533751168755204
    spirals = np.stack([inner * np.sin(a), inner * np.cos(a), outer * np.sin(b), outer * np.cos(b)], axis=-1)
    return Rotation.from_quat(spirals).as_matrix()


def scan(image, depth):
    """Poses of the grid and three scales, each with its visible points centred on the mask, in the order of what light explains."""
    chosen = thinned(len(depth.points), SCAN_POINTS)
    points, normals = depth.points[chosen] - depth.middle, depth.normals[chosen]
    log = ndimage.gaussian_filter(image.log, (SCAN_BLUR, SCAN_BLUR, 0))
    rows, columns = np.nonzero(image.mask)
    centre = np.array([columns.mean(), rows.mean()]) - image.centre
    rotations = grid(ROTATIONS)
    # From behind, a depth map shows nothing.
    rotations = rotations[rotations[:, 2, 2] > 0]
    gains, shifts = [], []
    for some in np.array_split(rotations, len(rotations) // CHUNK):
        turned, facing = points @ some.transpose(0, 2, 1), normals @ some.transpose(0, 2, 1)
        seen = facing[..., 2] < -FACING
        middles = (turned[..., :2] * seen[..., None]).sum(axis=1) / np.maximum(seen.sum(axis=1), 1)[:, None]
        basis = harmonics(facing)
        each = [scanned(image, log, centre, scale, turned, seen, middles, basis) for scale in SCALES]
        gains += np.stack([found for found, _ in each], axis=1).ravel().tolist()
        shifts += list(np.stack([shift for _, shift in each], axis=1).reshape(-1, 2))
    order = np.argsort(gains)[::-1]
    return [Pose(rotations[k // len(SCALES)], np.append(shifts[k], 0.0), SCALES[k % len(SCALES)]) for k in order]


def scanned(image, log, centre, scale, turned, seen, middles, basis):
    """Gains and shifts of some rotations at one scale; the light of each is a small least-squares problem."""
    shifts = centre - scale * middles
    places, on = image.places((scale * turned[..., :2] + shifts[:, None]).reshape(-1, 2))
    on = on.reshape(seen.shape) & seen
    row, column = np.rint(np.clip(places, 0, [[image.height - 1], [image.width - 1]])).astype(int)
    colours = log[row, column].reshape(*seen.shape, 3)
    weighted = (basis * on[..., None]).transpose(0, 2, 1)
    light = np.linalg.solve(weighted @ basis + 1e-6 * np.eye(9), weighted @ colours)
    mean = (colours * on[..., None]).sum(axis=1, keepdims=True) / np.maximum(on.sum(axis=1), 1)[:, None, None]
    explained = ((colours - mean) ** 2 - (colours - basis @ light) ** 2).sum(axis=-1)
    return np.where(on, explained, 0).sum(axis=1) - BACKGROUND * (seen & ~on).sum(axis=1), shifts


def apart(poses):
    """The first poses that differ from all before them by some rotation or by their scale."""
    kept, rotations, scales = [], np.empty((0, 3, 3)), np.empty(0)
    for pose in poses:
        traces = np.sum(rotations * pose.rotation, axis=(1, 2))
        if np.all((traces < 1 + 2 * np.cos(APART)) | (scales != pose.scale)):
            kept.append(pose)
            rotations, scales = np.append(rotations, [pose.rotation], axis=0), np.append(scales, pose.scale)
        if len(kept) == CANDIDATES:
            break
    return kept


def search(image, depth):
    """A scan over all rotations, then registrations of its candidates, fewer and finer from stage to stage."""
    poses = apart(scan(image, depth))
    for kept, points, blurs, rounds in STAGES:
        ends = sorted((register(image, depth, pose, points, blurs, rounds) for pose in poses), key=lambda each: -each[1])
        poses = [pose for pose, _ in ends[:kept]]
    return poses[0]


def icp(open3d, depth, pose, surface, normals):
    """Point-to-plane ICP of Open3D from the depth map's points to the surface of the image: the rotation where it ends."""

    def cloud(points, directions):
        made = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
        made.normals = open3d.utility.Vector3dVector(directions)
        return made

    methods = open3d.pipelines.registration
    _, placed, turned = pose.of(depth)
    source, target = cloud(placed, turned), cloud(surface, normals)
    found = methods.registration_icp(source, target, 2.0, np.eye(4), methods.TransformationEstimationPointToPlane())
    return found.transformation[:3, :3] @ pose.rotation
