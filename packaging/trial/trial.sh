#!/usr/bin/env bash
# Each way to install trundle, tried in a bare Debian 12: from an empty system to the first result, with the minutes of each step.
#
# usage: trial.sh FOLDER [--package FILE.deb] [--rust-of-host] WAY...      WAY: package, source, crate, python
#
# Runs as root on Linux, and needs debootstrap and git on this machine. FOLDER gets about 4 GB. The system of each way is unpacked anew, so
# that no way uses what another one installed. The sources are a clone of the last commit of this checkout. A way that builds gets Rust by
# rustup, and its crates from their registry: the minutes include both downloads. With --rust-of-host it gets this machine's toolchain and
# downloaded crates, and the minutes do not.
# Results: FOLDER/WAY.log, FOLDER/WAY.png (way crate: a plan in its log), and a table on standard output. The exit code is 1 if a way fails.
set -euo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
[ $# -ge 2 ] || { sed -n '2,/^set/p' "$0" | grep '^#' >&2; exit 2; }
work=$(realpath -m "$1"); shift
package=
if [ "$1" = --package ]; then package=$(realpath "$2"); shift 2; fi
is_rust_of_host=false
if [ "$1" = --rust-of-host ]; then is_rust_of_host=true; shift; fi
mirror=${DEBIAN_MIRROR:-http://deb.debian.org/debian}
system=$work/system
# The version that the sources ask for.
rust=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' "$repository/Cargo.toml")
mkdir -p "$work"

# The bare system: what debootstrap calls minbase, once, as an archive.
if [ ! -f "$work/bookworm.tar" ]; then
    debootstrap --variant=minbase bookworm "$system" "$mirror" >"$work/debootstrap.log"
    tar -C "$system" -cf "$work/bookworm.tar" . && rm -rf --one-file-system "$system"
fi

leave() {
    for place in dev proc opt/rust root/.cargo/registry; do
        ! mountpoint -q "$system/$place" || umount -l "$system/$place"
    done
    # A mount that is left would lead to this machine's own files.
    ! grep -q " $system/" /proc/mounts || { echo "still mounted below $system" >&2; exit 1; }
    rm -rf --one-file-system "$system"
}
trap leave EXIT

enter() {
    leave
    mkdir -p "$system" && tar -C "$system" -xf "$work/bookworm.tar"
    cp /etc/resolv.conf /etc/hosts "$system/etc/"
    mount --bind /dev "$system/dev" && mount -t proc proc "$system/proc"
    : >"$work/$1.log"
}

# rust_and_sources WAY PACKAGES: clones the sources, and installs Debian's packages and Rust: for the ways that build.
rust_and_sources() {
    git clone --quiet --depth 1 "file://$repository" "$system/root/trundle"
    # A proxy of this network may have its own certificates.
    cp -L /etc/ssl/certs/ca-certificates.crt "$system/opt/"
    if $is_rust_of_host; then
        mkdir -p "$system/opt/rust" "$system/root/.cargo/registry"
        mount --bind "$(rustc --print sysroot)" "$system/opt/rust" && mount -o remount,ro,bind "$system/opt/rust"
        mount --bind "${CARGO_HOME:-$HOME/.cargo}/registry" "$system/root/.cargo/registry"
        step "$1" "Debian's packages" "apt-get update && apt-get install -y --no-install-recommends $2"
        return
    fi
    step "$1" "Debian's packages" "apt-get update && apt-get install -y --no-install-recommends curl ca-certificates $2" &&
        step "$1" "rustup" "curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh -s -- -y --profile minimal --default-toolchain $rust"
}

# step WAY NAME COMMAND: runs the command in the system, and notes its minutes.
step() {
    local begin code=0
    begin=$(date +%s)
    printf '== %s: %s\n' "$2" "$3" >>"$work/$1.log"
    chroot "$system" /usr/bin/env -i HOME=/root PATH=/opt/rust/bin:/root/.cargo/bin:/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb DEBIAN_FRONTEND=noninteractive \
        PIP_CERT=/opt/ca-certificates.crt CARGO_HTTP_CAINFO=/opt/ca-certificates.crt CURL_CA_BUNDLE=/opt/ca-certificates.crt \
        SSL_CERT_FILE=/opt/ca-certificates.crt \
        bash -ec "cd /root; $3" >>"$work/$1.log" 2>&1 </dev/null || code=$?
    awk -v way="$1" -v name="$2" -v s=$(($(date +%s) - begin)) -v code="$code" \
        'BEGIN { printf "| %s | %s | %.1f | %s |\n", way, name, s / 60, code ? "failed, exit code " code : "ok" }'
    return "$code"
}

# picture WAY FILE: keeps the first picture; its first bytes must be those of a PNG.
picture() {
    head -c 8 "$system/root/$2" | od -An -tx1 | grep -q '89 50 4e 47 0d 0a 1a 0a' || { echo "no picture: $2" >&2; return 1; }
    cp "$system/root/$2" "$work/$1.png"
}

way_package() {
    [ -n "$package" ] || { echo "way package: --package FILE.deb is missing (cargo xtask deb builds it)" >&2; return 1; }
    cp "$package" "$system/root/trundle.deb"
    step package "apt-get install" "apt-get update && apt-get install -y ./trundle.deb" &&
        step package "trundle doctor" "trundle doctor" &&
        step package "demo" "trundle demo --scene room --direct" && picture package out/demo/map.png
}

way_source() {
    rust_and_sources source "gcc libc6-dev" &&
        step source "cargo install" "cd trundle && cargo install --path apps/trundle-cli --profile dist --locked" &&
        step source "demo" "trundle demo --scene room --direct" && picture source out/demo/map.png
}

# A program that uses the planner alone. Until the first release the crate comes from the sources instead of crates.io.
way_crate() {
    rust_and_sources crate "gcc libc6-dev" &&
        step crate "cargo new" "cargo new --vcs none planner && cd planner &&
            cargo add trundle --path ../trundle/crates/trundle --no-default-features --features planning &&
            cp ../trundle/crates/trundle/examples/03_plan_on_a_map.rs src/main.rs" &&
        step crate "first plan" "cd planner && cargo run --release | grep 'm of clearance'"
}

way_python() {
    rust_and_sources python "python3-venv gcc libc6-dev" &&
        step python "pip install" "python3 --version && python3 -m venv venv && cd trundle && ../venv/bin/pip install ./python" &&
        step python "first map" "awk '/\`\`\`python/ { on = 1; next } /\`\`\`/ { if (on) exit } on' trundle/docs/tutorials/python.md | sed 's/^   //' >first.py &&
            venv/bin/python first.py" && picture python map.png
}

echo "| way | step | minutes | result |"
echo "|---|---|---|---|"
missed=0
for way in "$@"; do
    case $way in package | source | crate | python) ;; *) echo "no way '$way': package, source, crate or python" >&2; exit 2 ;; esac
    enter "$way"
    "way_$way" || { missed=1; tail -n 5 "$work/$way.log" >&2; }
done
exit "$missed"
