"""A run as bytes, for ``Estimator.save`` and ``Estimator.restore``.

The views, the options and the number of stages that have been run determine a run to the bit, however the
steps were sliced. The file therefore holds these, with a checksum that shows whether the results were reproduced.
Restoring takes as long as the run, but the format does not change with every stage.

The layout is that of the JavaScript package (js/saved.ts) with another format number: native code and
WebAssembly differ in their last digits, so neither can continue the other's run to the bit. Sixteen bytes of
name and format, the header's length (32 bits, little-endian), the header (JSON), the arrays one after the
other, CRC-32 of all that.
"""

from __future__ import annotations

import json
import struct
from operator import index
from typing import Any, Mapping, NamedTuple, Union
from zlib import crc32

import numpy as np

from ._errors import BimodalError

NAME = b"bimodal-stereo\n"
# Python's formats are above 128, the JavaScript package's below.
FORMAT = 129
FOREIGN = 128
MARK = len(NAME) + 1
WORD = 4
# Largest number of bytes in a header: options hold at most 800 numbers of 25 characters each.
LONGEST_HEADER = 65_536
# Largest number of bytes in all: two views of 4096 pixels on a side with all members have 0.7 GB.
MOST_BYTES = 2**30

KINDS = {"uint8": "u1", "uint16": "<u2", "float32": "<f4"}
# The types that a member of a view may have.
MEMBERS = {"data": tuple(KINDS), "mask": ("uint8",), "points": ("float32",), "normals": ("float32",)}
VIEWS = ("image", "depth")
STAGES = ("search", "light", "shading", "surface", "registration", "refinement")
REACHED = {"begun": bool, "stage": str, "iteration": int, "slices": int, "ended": bool}
HEADER = {"image": dict, "depth": dict, "options": dict, "reached": dict, "found": int, "arrays": list}
ENTRY = {"view": str, "member": str, "type": str, "length": int}

View = dict[str, Any]


class Saved(NamedTuple):
    """The content of a file. ``reached``: the progress of the run; ``found``: the checksum of its results."""

    image: View
    depth: View
    options: dict[str, Any]
    reached: dict[str, Any]
    found: int


def bad(what: str) -> BimodalError:
    return BimodalError("state", f"state: {what}", "state")


def copied(view: Mapping[str, Any]) -> View:
    """A view with copies of its arrays, because the caller may change the originals before the run is saved."""
    return {name: value.copy() if isinstance(value, np.ndarray) else value for name, value in view.items()}


def text(options: Mapping[str, Any]) -> str:
    """The options as JSON for the header. Whatever the bindings accept as a number becomes a number."""
    return json.dumps(options, default=number)


def number(value: Any) -> Any:
    if isinstance(value, (np.ndarray, np.generic)):
        return np.ravel(value).tolist() if np.ndim(value) > 0 else value.item()
    try:
        return index(value)
    except TypeError:
        return float(value)


def saved(image: View, depth: View, options: str, reached: Mapping[str, Any], found: int) -> bytes:
    arrays: list[dict[str, Any]] = []
    data: list[bytes] = []

    def without(view: str, members: View) -> View:
        plain = {}
        for name, value in members.items():
            if isinstance(value, np.ndarray):
                arrays.append({"view": view, "member": name, "type": value.dtype.name, "length": value.size})
                data.append(value.astype(KINDS[value.dtype.name], copy=False).tobytes())
            else:
                plain[name] = value
        return plain

    views = {"image": without("image", image), "depth": without("depth", depth)}
    header = {**views, "options": json.loads(options), "reached": reached, "found": found, "arrays": arrays}
    written = json.dumps(header, default=number).encode()
    whole = b"".join([NAME, bytes([FORMAT]), struct.pack("<I", len(written)), written, *data])
    return whole + struct.pack("<I", crc32(whole))


def opened(state: Union[bytes, bytearray, memoryview]) -> Saved:
    """The content of a file, if it is complete and was written by this package. The estimator checks its views and options."""
    if not isinstance(state, (bytes, bytearray, memoryview)):
        raise BimodalError("type", f"state: must be bytes, not {type(state).__name__}", "state")
    whole = bytes(state)
    header, at = read_header(whole)
    end = len(whole) - WORD
    views = {name: header[name] for name in VIEWS}
    for entry in header["arrays"]:
        kind = np.dtype(KINDS[entry["type"]])
        size = entry["length"] * kind.itemsize
        if size > end - at:
            raise bad("is cut off")
        values = np.frombuffer(whole, kind, entry["length"], at)
        views[entry["view"]] = {**views[entry["view"]], entry["member"]: values.astype(entry["type"])}
        at += size
    if at != end:
        raise bad("is longer than it declares")
    return Saved(**views, **{name: header[name] for name in ("options", "reached", "found")})


def read_header(whole: bytes) -> tuple[dict[str, Any], int]:
    if whole[: len(NAME)] != NAME:
        raise bad("is not a saved run")
    if len(whole) < MARK + 2 * WORD:
        raise bad("is cut off")
    given = whole[len(NAME)]
    if given < FOREIGN:
        raise bad(f"was saved by the JavaScript package (format {given}), whose last digits differ; run the pair again")
    if given != FORMAT:
        raise bad(f"has format {given}; this version reads format {FORMAT}")
    if len(whole) > MOST_BYTES:
        raise bad(f"has {len(whole)} bytes; at most {MOST_BYTES} are allowed")
    end = len(whole) - WORD
    if struct.unpack_from("<I", whole, end)[0] != crc32(memoryview(whole)[:end]):
        raise bad("is damaged or cut off: its checksum does not match")
    length = struct.unpack_from("<I", whole, MARK)[0]
    start = MARK + WORD
    if length > min(LONGEST_HEADER, end - start):
        raise bad("has a header that is too long")
    try:
        header = json.loads(whole[start : start + length])
    except (ValueError, RecursionError) as error:
        raise bad("has a header that cannot be read") from error
    typed(header, HEADER, "header")
    typed(header["reached"], REACHED, "header.reached")
    if header["reached"]["stage"] not in STAGES:
        raise bad(f"cannot be run (header.reached.stage: must be one of {', '.join(STAGES)})")
    for position, entry in enumerate(header["arrays"]):
        path = f"header.arrays[{position}]"
        typed(entry, ENTRY, path)
        if entry["view"] not in VIEWS or entry["type"] not in MEMBERS.get(entry["member"], ()):
            raise bad(f"cannot be run ({path}: there is no such array)")
    return header, start + length


def typed(value: Any, members: Mapping[str, type], path: str) -> None:
    """Refuses a value with other members or members of another type; whole numbers must not be negative."""
    if type(value) is not dict or set(value) != set(members):
        raise bad(f"cannot be run ({path}: must have {', '.join(members)} and nothing else)")
    for name, kind in members.items():
        # Compares the type itself, because True is an int to isinstance.
        if type(value[name]) is not kind or (kind is int and value[name] < 0):
            raise bad(f"cannot be run ({path}.{name}: must be of another type or range)")
