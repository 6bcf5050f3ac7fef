#!/usr/bin/env bash
# Makes the environment of the comparisons with ORB-SLAM3: a Python environment with the program, and a vocabulary of its descriptors.
# usage: get-peer.sh FOLDER TRUNDLE SEQUENCE...      (from the repository: target/slam-venv target/release/trundle ../shared/data/tum_fr1_rpy_400)
# Each SEQUENCE is a TUM RGB-D folder or a recording of `trundle sim --record`. ORB-SLAM3 is GPL-3: it stays outside the repository.
set -euo pipefail
if [ $# -lt 3 ]; then
    echo "usage: get-peer.sh FOLDER TRUNDLE SEQUENCE..." >&2
    exit 2
fi
bench=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=$1 trundle=$2
shift 2
for program in python3.11 "$trundle"; do
    command -v "$program" >/dev/null || { echo "get-peer.sh: $program cannot be found" >&2; exit 2; }
done

if ! "$folder/bin/python" -c 'import pyorbslam3, numpy, cv2' 2>/dev/null; then
    python3.11 -m venv "$folder"
    "$folder/bin/python" -m pip install --quiet --disable-pip-version-check \
        pyorbslam3==0.1.1 numpy opencv-python-headless
fi
if [ ! -s "$folder/peer.txt" ]; then
    rm -rf "$folder/peer" && mkdir -p "$folder/peer"
    "$folder/bin/python" "$bench/orb_descriptors.py" "$folder/peer" "$@" --stride 5
    "$trundle" vocabulary train --descriptors "$folder/peer" --depth 6 --out "$folder/peer.voc"
    "$trundle" vocabulary export "$folder/peer.voc" --dbow2 "$folder/peer.part"
    mv "$folder/peer.part" "$folder/peer.txt"
fi
echo "$folder/bin/python $folder/peer.txt"
