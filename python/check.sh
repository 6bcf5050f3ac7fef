#!/usr/bin/env bash
# The Python package: wheel, tests, docstrings' examples, stubs, the five examples and the command. Skipped by name where PyPI, or a
# Python of version 3.10 or later, cannot be had.
# usage: check.sh [VENV]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD
venv=$(realpath -m "${1:-target/python-venv}")
skip() {
    echo "skipped: the Python package ($1)"
    exit 0
}

command -v python3 >/dev/null || skip "no Python"
python3 -c 'import sys; sys.exit(sys.version_info < (3, 10))' || skip "Python is older than 3.10"
[ -x "$venv/bin/python" ] || python3 -m venv "$venv" >/dev/null 2>&1 || skip "no venv: apt-get install python3-venv"
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check -r python/requirements.txt >/dev/null 2>&1 ||
    skip "maturin, numpy, gymnasium and evo cannot be had: no network?"

# The build finds maturin by the search path. The crates are those of the release build of the program.
export PATH="$venv/bin:$PATH"
begin=$(date +%s)
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-build-isolation --no-deps --force-reinstall ./python
echo "ok   pip install ./python, $(($(date +%s) - begin)) s"

scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT
(cd "$scratch" && "$venv/bin/python" -m pytest -q -p no:cacheprovider "$root/python/tests")
echo "ok   tests and the examples of the docstrings"

(cd "$scratch" && "$venv/bin/python" -m mypy.stubtest trundle._native --concise && "$venv/bin/python" -m mypy --strict "$root"/python/trundle/*.py "$root"/python/examples/*.py)
echo "ok   stubs"

for example in python/examples/*.py; do
    (cd "$scratch" && "$venv/bin/python" "$root/$example" >out.txt 2>&1) || {
        cat "$scratch/out.txt"
        echo "FAILED: $example"
        exit 1
    }
    echo "ok   $example"
done
tum=$(realpath -m "$root/../shared/data/tum_fr1_rpy_400")
if [ -d "$tum" ]; then
    (cd "$scratch" && "$venv/bin/python" "$root/python/examples/01_slam_a_folder.py" "$tum" | tail -n 2)
    echo "ok   python/examples/01_slam_a_folder.py on a real sequence"
fi

"$venv/bin/trundle" --version
