#!/usr/bin/env bash
# RGB-D bags of an independent writer (PyPI: rosbags), read by `trundle convert` and `trundle slam`, compared pixel by pixel.
# usage: bench/ros2/bags/check.sh [TRUNDLE]; the virtual environment goes to target/ros2-readers-venv.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)"
trundle="${1:-$root/target/release/trundle}"
venv="$root/target/ros2-readers-venv"
bash "$root/bench/ros2/get-readers.sh" "$venv" "bags of rosbags" || { [ $? = 3 ]; exit; }
exec "$venv/bin/python" "$root/bench/ros2/bags/bags.py" "$trundle"
