#!/bin/sh
# What continuous integration runs: the environment, the interface table, the robot alone, then trundle driven by strangers. Not run there:
# latency.py, whose figures a loaded machine spoils, and the longer parts of user.py and faults.py.
#
#   check.sh DIR [TRUNDLE]
#
# DIR is the folder of the Python environment (get-ros2.sh makes it). TRUNDLE is the binary; without it the parts that need it are
# left out. Exit 0 when every check holds or the environment cannot be had (a line begins with "skipped: "), else 1.
set -u

# Parts of user.py that take 1.5 minutes together; all of them take 4.
user_parts="goal cancel preempt wrong_frame not_finite late_joiner lifecycle_states clear_costmaps save_map load_map"

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

run interfaces.py
run robot_alone.py
if [ $# -gt 1 ]; then
    run goals.py --trundle "$2" --worlds flat corridor-a
    run user.py --trundle "$2" --only $user_parts
    run faults.py --trundle "$2" --only restart_trundle
    run bad_input.py --trundle "$2"
    run sim_images.py --trundle "$2"
fi
exit $failed
