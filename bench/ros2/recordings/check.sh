#!/usr/bin/env bash
# A fresh recording of `trundle demo`, opened by programs of others (PyPI): rosbags, mcap-ros2-support, rerun. Numbers are compared with
# trundle's own results. usage: bench/ros2/recordings/check.sh [TRUNDLE]; the virtual environment goes to target/ros2-readers-venv.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)"
trundle="${1:-$root/target/release/trundle}"
venv="$root/target/ros2-readers-venv"
bash "$root/bench/ros2/get-readers.sh" "$venv" "recordings in programs of others" || { [ $? = 3 ]; exit; }
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
"$trundle" demo --direct --goal 0.8,0.0,0 --record all --quiet --out "$scratch/run"
"$trundle" convert "$scratch/run/recording.mcap" "$scratch/tum" --to tum --quiet
"$venv/bin/python" "$root/bench/ros2/recordings/check.py" "$scratch/run" "$scratch/tum" "$venv/bin/rerun"
