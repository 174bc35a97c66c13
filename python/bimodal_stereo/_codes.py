"""Cause and remedy of every code that a run, a check or an error may have."""

from __future__ import annotations

import json
from typing import Mapping

from . import _native

# By group ("runs", "checks", "warnings", "errors") and code: "cause" and "remedy", and "lab", the remedy in the words of the page.
CODES: Mapping[str, Mapping[str, Mapping[str, str]]] = json.loads(_native.CODES)
