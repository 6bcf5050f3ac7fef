#!/usr/bin/env bash
# Home and fleet by a real broker: trundle under the master control of vda-5050-lib, with Debian's mosquitto between them (2 minutes).
# Skipped by name without Node, npm, mosquitto or a trundle with the feature mqtt.
# usage: check.sh [TRUNDLE]
set -euo pipefail
trundle=$(realpath "${1:-$(dirname "${BASH_SOURCE[0]}")/../../target/release/trundle}")
cd "$(dirname "${BASH_SOURCE[0]}")"
skip() {
    echo "skipped: VDA 5050 and Home Assistant by a broker ($1)"
    exit 0
}

command -v node >/dev/null && command -v npm >/dev/null || skip "no Node or npm"
npm ci --silent --no-audit --no-fund >/dev/null 2>&1 || skip "vda-5050-lib cannot be had: no network?"
broker=$(bash get-broker.sh "$PWD/../../target/fleet-broker" 2>/dev/null) || skip "no mosquitto: apt-get install mosquitto"
"$trundle" demo --help | grep -q -- --mqtt || skip "trundle was built without the feature mqtt"
schemas=$(bash get-schemas.sh "$PWD/../../target/vda-schemas" 2>/dev/null) || {
    schemas=
    echo "skipped: messages by the JSON schemas of VDA 5050 2.1 (they cannot be had: no PyPI?)"
}
node test.mjs "$trundle" "$broker" $schemas
