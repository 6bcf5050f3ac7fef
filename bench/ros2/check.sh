#!/bin/sh
# What continuous integration runs: the environment, the interface table, the robot alone, then trundle driven by strangers.
#
#   check.sh DIR [TRUNDLE]
#
# DIR is the folder of the Python environment (get-ros2.sh makes it). TRUNDLE is the binary; without it the parts that need it are
# left out. Exit 0 when every check holds or the environment cannot be had (a line begins with "skipped: "), else 1.
set -u

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
    "$python" "$here/tests/$@" || failed=1
}

run interfaces.py
run robot_alone.py
if [ $# -gt 1 ]; then
    run goals.py --trundle "$2" --worlds flat corridor-a
    run user.py --trundle "$2"
    run latency.py --trundle "$2" --seconds 10
fi
exit $failed
