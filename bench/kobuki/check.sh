#!/usr/bin/env bash
# A program that is not trundle drives the emulated Kobuki over its serial line (10 s).
# Usage: bench/kobuki/check.sh [PROGRAM]. PROGRAM: default target/release/trundle. Skipped by name without Python 3.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=${1:-target/release/trundle}
packet=../shared/data/kobuki/feedback_packet.hex

command -v python3 >/dev/null || { echo "SKIPPED bench/kobuki: no python3"; exit 0; }
[ -e "$packet" ] || { echo "bench/kobuki: the real packet is absent: it is not read"; packet=; }
python3 bench/kobuki/drive.py "$program" ${packet:+"$packet"}
