"""The command `trundle`."""

import sys

from ._native import run_command


def main() -> None:
    """Runs the command line of `sys.argv` and ends the process with its exit code."""
    sys.exit(run_command(["trundle", *sys.argv[1:]]))
