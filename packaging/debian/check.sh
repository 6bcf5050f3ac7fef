#!/usr/bin/env bash
# The Debian package of the release program: built, its content checked, unpacked, and its program run. Skipped by name if cargo-deb is
# neither installed nor can be built from its registry (1 minute), or without dpkg.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

tools=$PWD/target/debian-tools
if ! cargo deb --version >/dev/null 2>&1 && [ ! -x "$tools/bin/cargo-deb" ]; then
    cargo install --locked --quiet --root "$tools" --version =3.8.0 cargo-deb >/dev/null 2>&1 || true
fi
PATH=$PATH:$tools/bin
cargo xtask deb --profile release
