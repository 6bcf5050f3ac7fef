#!/bin/sh
# What continuous integration runs: the environment, the interface table, each structure against rclpy's serialiser, the robot alone, then
# trundle driven by strangers. Not run there: latency.py, whose figures a loaded
# machine spoils, unreachable.py, and the longer parts of user.py and faults.py.
#
#   check.sh DIR [TRUNDLE]
#
# DIR is the folder of the Python environment (get-ros2.sh makes it). TRUNDLE is the binary; without it the parts that need it are
# left out. Exit 0 when every check holds or the environment cannot be had (a line begins with "skipped: "), else 1.
set -u

# Parts of user.py that take 2 minutes together; all of them take 4. `transforms` watches while the others drive.
user_parts="goal transforms parameters cancel preempt wrong_frame in_a_wall not_finite late_joiner lifecycle_states clear_costmaps save_map load_map"

if [ $# -lt 1 ]; then
    echo "check: the folder is missing; call: check.sh DIR [TRUNDLE]" >&2
    exit 2
fi
here=$(cd "$(dirname "$0")" && pwd)
said=$("$here/get-ros2.sh" "$1") || exit 1
echo "$said"
case $said in *skipped:*) exit 0 ;; esac

python=$(cd "$1" && pwd)/bin/python
failed=0
run() {
    echo "== $*"
    begin=$(date +%s)
    "$python" "$here/tests/$@" || failed=1
    echo "   $(($(date +%s) - begin)) s"
}

# The features are those of the program, so that its crates are not built twice.
interface_bytes() {
    cargo build --quiet --release --manifest-path "$here/../../Cargo.toml" --target-dir "$target" --package trundle-ros2 \
        --package trundle-cli --features trundle-cli/ros2,trundle-cli/mqtt,trundle-cli/foxglove,trundle-cli/tls --example interface_bytes
}

run interfaces.py
target=${CARGO_TARGET_DIR:-$here/../../target}
if command -v cargo >/dev/null; then
    interface_bytes || failed=1
    run serialiser.py --program "$target/release/examples/interface_bytes"
else
    echo "skipped: serialiser.py: cargo, which builds the structures in Rust, is absent"
fi
run robot_alone.py
if [ $# -gt 1 ]; then
    run goals.py --trundle "$2" --worlds flat corridor-a
    run user.py --trundle "$2" --only $user_parts
    run peer.py --trundle "$2"
    run faults.py --trundle "$2" --only restart_trundle
    run replies.py --trundle "$2"
    run bad_input.py --trundle "$2"
    run sim_images.py --trundle "$2"
fi
exit $failed
