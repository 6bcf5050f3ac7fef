#!/usr/bin/env bash
# Makes DIR a virtual environment with programs of others that read and write ROS 2 files: rosbags, mcap-ros2-support, rerun (PyPI).
# usage: get-readers.sh DIR WHAT. Exit 3 where they cannot be had, after a line `skipped: WHAT (reason)`; rerun may be missing.
set -euo pipefail
dir=$1 what=$2
packages="rosbags==0.11.9 mcap==1.6.0 mcap-ros2-support==0.6.0 numpy pillow"
if [ ! -x "$dir/bin/python" ]; then
    python3 -m venv "$dir" || { echo "skipped: $what (no python3 -m venv)"; exit 3; }
fi
# shellcheck disable=SC2086
"$dir/bin/pip" -q install $packages >/dev/null 2>&1 ||
    "$dir/bin/python" -c "import rosbags, mcap_ros2, numpy, PIL" 2>/dev/null ||
    { echo "skipped: $what (PyPI cannot be reached)"; exit 3; }
"$dir/bin/pip" -q install rerun-sdk==0.41.0 >/dev/null 2>&1 ||
    "$dir/bin/python" -c "import rerun" 2>/dev/null || echo "skipped: rerun mcap convert (PyPI has no wheel for here)"
