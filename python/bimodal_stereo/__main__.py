"""``python -m bimodal_stereo check FOLDER --calibration FILE``: the commands of the package."""

from __future__ import annotations

import sys
from typing import Optional, Sequence

from ._native import VERSION, check_command

HELP = """Usage: python -m bimodal_stereo COMMAND

Commands:
  check  checks the calibration between a colour camera and a depth camera over a folder of frames

  --help     prints this text; after a command, its manual
  --version  prints the version
"""
BAD = 3


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """Runs a command; the exit code."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    if not words or words[0] in ("--help", "-h"):
        sys.stdout.write(HELP)
        return 0
    if words[0] in ("--version", "-V"):
        sys.stdout.write(f"bimodal-stereo {VERSION}\n")
        return 0
    if words[0] != "check":
        sys.stderr.write(f'there is no command "{words[0]}"; --help lists them\n')
        return BAD
    return check_command(words[1:], sys.stdout.write, sys.stderr.write, sys.stderr.isatty())


if __name__ == "__main__":
    sys.exit(main())
