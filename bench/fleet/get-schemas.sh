#!/usr/bin/env bash
# The JSON schemas of VDA 5050 2.1 from PyPI: prints their folder. Fails without network.
# usage: get-schemas.sh DIR
set -euo pipefail
directory=$(realpath -m "${1:?usage: get-schemas.sh DIR}")
schemas=$directory/vda5050/validation/schemas
if [ ! -f "$schemas/state.json" ]; then
    mkdir -p "$directory"
    python3 -m pip download --quiet --disable-pip-version-check --no-deps --require-hashes \
        -r "$(dirname "${BASH_SOURCE[0]}")/requirements.txt" --dest "$directory" >&2
    python3 -m zipfile -e "$directory"/vda5050_sdk-*.whl "$directory"
fi
echo "$schemas"
