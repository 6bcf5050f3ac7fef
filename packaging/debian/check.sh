#!/usr/bin/env bash
# The Debian packages of the release program, for this computer and for arm64: built, their content checked, unpacked, and their programs
# run, that of arm64 by qemu. Skipped by name if cargo-deb is neither installed nor can be built from its registry (1 minute), or without
# dpkg; that of arm64 also without the target or qemu. Its program is that of `cargo xtask aarch64`.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

tools=$PWD/target/debian-tools
if ! cargo deb --version >/dev/null 2>&1 && [ ! -x "$tools/bin/cargo-deb" ]; then
    cargo install --locked --quiet --root "$tools" --version =3.8.0 cargo-deb >/dev/null 2>&1 || true
fi
PATH=$PATH:$tools/bin
${XTASK:-cargo xtask} deb --profile release
${XTASK:-cargo xtask} deb --profile release --arm64
