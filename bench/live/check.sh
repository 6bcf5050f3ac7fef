#!/usr/bin/env bash
# The live page: its built files are those of its source, and it works in a real browser (5 minutes). Skipped by name without Node, npm or a
# Chromium that can be had.
# usage: check.sh [TRUNDLE]; with $PICTURES the pictures of the page go into that folder
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
root=$PWD/../..
trundle=${1:-$root/target/release/trundle}

if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
    echo "skipped: live page built from its source, live page in a browser (no Node or npm)"
    exit 0
fi
page=$root/crates/trundle-live/page
if ! (cd "$page" && npm ci --silent --no-audit --no-fund >/dev/null 2>&1); then
    echo "skipped: live page built from its source, live page in a browser (npm ci failed: no network?)"
    exit 0
fi
built=$(mktemp -d)
trap 'rm -r "$built"' EXIT
(cd "$page" && npx tsc --noEmit && npx vite build --logLevel warn --outDir "$built" --emptyOutDir)
diff -r "$built" "$root/crates/trundle-live/assets" || {
    echo "crates/trundle-live/assets is not what its source gives: npm run build in crates/trundle-live/page"
    exit 1
}
echo "ok   the built page is that of its source"

if ! npm ci --silent --no-audit --no-fund >/dev/null 2>&1; then
    echo "skipped: live page in a browser (playwright-core cannot be had)"
    exit 0
fi
if ! chromium=$(bash get-browser.sh "$root/target/live-browser" 2>/dev/null); then
    echo "skipped: live page in a browser (no Chromium: apt-get install chromium)"
    exit 0
fi
node test.mjs "$trundle" "$chromium" ${PICTURES:+"$PICTURES"}
