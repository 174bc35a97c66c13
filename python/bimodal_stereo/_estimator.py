"""The loop."""

from __future__ import annotations

from threading import Lock
from typing import TYPE_CHECKING, Any, Callable, Iterator, Optional, Union
from zlib import crc32

from . import _inputs, _native, _saved
from ._errors import BimodalError
from ._types import ColorImage, DepthMap, StepReport

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from typing_extensions import Unpack

    from ._inputs import Options
    from ._types import Floats, Pixels, Singles


class Estimator:
    """Shape, light and pose from one colour image and one depth map, one iteration after the other.

    ``image`` is a ``ColorImage``, or anything that its ``data`` accepts: an array (h, w), (h, w, 3) or (h, w,
    4), a picture, a file. ``depth`` is a ``DepthMap``, an array, (h, w) of depths or (h, w, 3) of an
    organised cloud, a picture, or a file. ``options`` are those of ``Options``; each has a default, so none
    has to be given. Every returned array is a copy. Other threads of Python run while a step does; threads
    that share an estimator wait for each other. ``for report in estimator`` steps until the loop ends.
    """

    def __init__(
        self, image: Union[ColorImage, Pixels], depth: Union[DepthMap, Pixels], **options: Unpack[Options]
    ) -> None:
        self._begin(_inputs.image(image), _inputs.depth(depth), _inputs.keywords(options))

    def _begin(self, image: _saved.View, depth: _saved.View, options: dict[str, Any]) -> None:
        self._own = _native.Estimator(image, depth, options)
        # The input that `save` writes, as it was at the time of the call.
        self._image, self._depth, self._options = _saved.copied(image), _saved.copied(depth), _saved.text(options)
        # Keeps `reset` and `save` apart, because saved options must be those of the run.
        self._lock = Lock()

    def step(self) -> StepReport:
        """Runs one iteration, or one slice of the search while the search lasts."""
        return StepReport._of(self._own.step())

    def step_stage(self) -> StepReport:
        """Runs one stage of an iteration, or one slice of the search; the report names the stage."""
        return StepReport._of(self._own.step_stage())

    def run(
        self, max_iterations: Optional[int] = None, on_step: Optional[Callable[[StepReport], Any]] = None
    ) -> StepReport:
        """Steps until the loop ends, at most ``max_iterations`` times, counting slices of the search.

        ``on_step`` is called with the report of each step. An interrupt, or whatever ``on_step`` raises, ends it between two steps; the
        estimator stays as the last step left it.
        """
        most = None if max_iterations is None else _inputs.whole(max_iterations, "max_iterations", 1)
        report = self.report
        done = 0
        while report.status == "running" and done != most:
            report = self.step()
            done += 1
            if on_step is not None:
                on_step(report)
        return report

    def __iter__(self) -> Iterator[StepReport]:
        """Steps until the loop ends and yields the report of each step. Another iteration continues where this one was left."""
        while self.report.status == "running":
            yield self.step()

    def reset(self, **options: Unpack[Options]) -> None:
        """Returns to the initial state with the same views. If options are given, they replace all earlier ones.

        ``workers`` stay as they are.
        """
        given = _inputs.keywords(options) if options else None
        with self._lock:
            self._own.reset(given)
            if given is not None:
                self._options = _saved.text(given)

    @property
    def report(self) -> StepReport:
        """The report of the last step; before the first one, that of the start."""
        return StepReport._of(self._own.report())

    def image_normals(self) -> Singles:
        """Normals of the image view, (h, w, 3) float32, NaN outside the mask."""
        return self._own.image_normals()

    def image_depth(self) -> Singles:
        """Depth of the image view, (h, w) float32, NaN outside the mask; median zero, in pixels, where the view is orthographic."""
        return self._own.image_depth()

    def depth_normals(self) -> Singles:
        """Refined normals of the depth view, in its own frame, (h, w, 3) float32, NaN outside the mask."""
        return self._own.depth_normals()

    def refined_depth(self) -> Singles:
        """Refined depth of the depth view, holes filled, (h, w) float32: metres, or pixels where it is orthographic."""
        return self._own.refined_depth()

    def correspondence(self) -> NDArray[np.int32]:
        """For each image pixel the index of its depth pixel, row * width + column, or -1: (h, w) int32."""
        return self._own.correspondence()

    def residual(self) -> Singles:
        """abs(log S - predicted) of each image pixel, (h, w) float32, NaN outside the mask: the length of log S - albedo - shading."""
        return self._own.residual()

    def albedo(self) -> Singles:
        """Log albedo of the image view (natural logarithm), (h, w, 3) float32, mean 0 over the mask in each channel, NaN outside it.

        Zero if a single albedo explains the colours, with ``registration="icp"``, and before the pose has converged.
        """
        return self._own.albedo()

    def shading(self) -> Singles:
        """Log shading of the image view, (h, w, 3) float32, NaN outside the mask and where there is no normal yet."""
        return self._own.shading()

    def light(self) -> Floats:
        """The coefficients of the light, (3, 9) float64: nine of red, of green, of blue."""
        return self._own.light()

    def points(self, view: str) -> Singles:
        """Points of one view, "image" or "depth", (n, 3) float32, both in the colour view's frame and units."""
        if view not in ("image", "depth"):
            raise BimodalError("option", 'view: must be "image" or "depth"', "view")
        return self._own.points(view == "depth")

    def save(self) -> bytes:
        """The run as bytes: both views, the options and the number of steps done.

        A repeated run is bit-identical, and ``restore`` relies on that.
        """
        with self._lock:
            reached, found = self._own.reached()
            return _saved.saved(self._image, self._depth, self._options, reached, crc32(found))

    @classmethod
    def restore(cls, state: Union[bytes, bytearray, memoryview]) -> Estimator:
        """An estimator in the bit-identical state of the saved one.

        Restoring takes as long as the run had taken. Raises a ``BimodalError`` of code "state": the bytes are not a saved run, are damaged,
        have another format version, come from the JavaScript package, or hold numbers that this build does not reproduce.
        """
        own = _saved.opened(state)
        estimator = cls.__new__(cls)
        try:
            estimator._begin(own.image, own.depth, own.options)
        except BimodalError as error:
            raise _saved.bad(f"cannot be run ({error})") from error
        if own.reached["begun"]:
            estimator._repeat(own.reached)
        if crc32(estimator._own.reached()[1]) != own.found:
            raise _saved.bad("was saved by a version or build of this package that computes different digits; run the pair again")
        return estimator

    def _repeat(self, reached: dict[str, Any]) -> None:
        """Runs as many stages as another run has, with the same views and options; an interrupt ends it between two of them."""
        slices = 0
        while True:
            report = self._own.step_stage()
            slices += report["stage"] == "search"
            is_there = (report["stage"], report["iteration"]) == (reached["stage"], reached["iteration"])
            is_enough = is_there and slices >= reached["slices"] and not reached["ended"]
            if report["status"] != "running" or is_enough:
                return
