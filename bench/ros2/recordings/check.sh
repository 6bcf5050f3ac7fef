#!/usr/bin/env bash
# A fresh recording of `trundle demo`, opened by programs of others (PyPI): rosbags, mcap-ros2-support, rerun. Numbers are compared with
# trundle's own results. usage: bench/ros2/recordings/check.sh [TRUNDLE]; the virtual environment goes to target/ros2-recordings-venv.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)"
trundle="${1:-$root/target/release/trundle}"
venv="$root/target/ros2-recordings-venv"
if [ ! -x "$venv/bin/python" ]; then
    python3 -m venv "$venv" || { echo "skipped: recordings in programs of others (no python3 -m venv)"; exit 0; }
fi
"$venv/bin/pip" -q install rosbags==0.11.9 mcap==1.6.0 mcap-ros2-support==0.6.0 numpy pillow >/dev/null 2>&1 ||
    "$venv/bin/python" -c "import rosbags, mcap_ros2, numpy, PIL" 2>/dev/null ||
    { echo "skipped: recordings in programs of others (PyPI cannot be reached)"; exit 0; }
"$venv/bin/pip" -q install rerun-sdk==0.41.0 >/dev/null 2>&1 ||
    "$venv/bin/python" -c "import rerun" 2>/dev/null || echo "skipped: rerun mcap convert (PyPI has no wheel for here)"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
"$trundle" demo --direct --goal 0.8,0.0,0 --record all --quiet --out "$scratch/run"
"$trundle" convert "$scratch/run/recording.mcap" "$scratch/tum" --to tum --quiet
"$venv/bin/python" "$root/bench/ros2/recordings/check.py" "$scratch/run" "$scratch/tum" "$venv/bin/rerun"
