#!/usr/bin/env bash
# RGB-D bags of an independent writer (PyPI: rosbags), read by `trundle convert` and `trundle slam`, compared pixel by pixel.
# usage: bench/ros2/bags/check.sh [TRUNDLE]; the virtual environment goes to target/ros2-bags-venv.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)"
trundle="${1:-$root/target/release/trundle}"
venv="$root/target/ros2-bags-venv"
if [ ! -x "$venv/bin/python" ]; then
    python3 -m venv "$venv" || { echo "skipped: bags of rosbags (no python3 -m venv)"; exit 0; }
fi
"$venv/bin/pip" -q install rosbags==0.11.9 numpy pillow >/dev/null 2>&1 ||
    "$venv/bin/python" -c "import rosbags, numpy, PIL" 2>/dev/null ||
    { echo "skipped: bags of rosbags (PyPI cannot be reached)"; exit 0; }
exec "$venv/bin/python" "$root/bench/ros2/bags/bags.py" "$trundle"
