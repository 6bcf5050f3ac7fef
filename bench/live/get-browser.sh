#!/usr/bin/env bash
# Prints the path of a Chromium: $CHROMIUM, the installed one, Debian's by apt-get for root, else playwright-core's own in FOLDER.
# Ends with 1 where none can be had. Its search takes at most 10 minutes.
# usage: get-browser.sh FOLDER
set -euo pipefail
folder=$1
cd "$(dirname "${BASH_SOURCE[0]}")"

if [ -n "${CHROMIUM:-}" ]; then
    command -v "$CHROMIUM"
    exit
fi
installed() { command -v chromium || command -v chromium-browser || command -v google-chrome; }
downloaded() {
    local found
    found=$(find "$folder" -type f \( -name headless_shell -o -name chrome-headless-shell \) -perm -u+x 2>/dev/null | sort | tail -1)
    [ -n "$found" ] && echo "$found"
}
debian() {
    [ "$(id -u)" -eq 0 ] && command -v apt-get >/dev/null || return 1
    local apt=(timeout 240 apt-get -q -o DPkg::Lock::Timeout=60 -o Acquire::Retries=2 -o Acquire::http::Timeout=20)
    export DEBIAN_FRONTEND=noninteractive
    "${apt[@]}" update >&2 || true
    "${apt[@]}" install -y --no-install-recommends chromium >&2
}
own() {
    mkdir -p "$folder"
    PLAYWRIGHT_BROWSERS_PATH=$folder timeout 120 npx --no-install playwright-core install --only-shell chromium >&2
}

installed || downloaded || { debian && installed; } || { own && downloaded; }
