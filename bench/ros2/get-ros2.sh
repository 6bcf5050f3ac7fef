#!/bin/sh
# Make DIR a Python environment with ROS 2 Kilted (rclpy, Fast DDS) and MuJoCo from PyPI, and build the interface packages that
# PyPI lacks. A second call changes only what differs.
#
#   get-ros2.sh DIR [PIP OPTIONS]
#
# Exit 0 when the environment is ready, and when PyPI cannot be reached: then one line begins with "skipped: ". Exit 1 when a
# step fails although PyPI answers. Exit 2 for wrong arguments. PYTHON names a Python 3.12: the wheels are for 3.12 only.
set -u

if [ $# -lt 1 ]; then
    echo "get-ros2: the folder is missing; call: get-ros2.sh DIR [PIP OPTIONS]" >&2
    exit 2
fi
here=$(cd "$(dirname "$0")" && pwd)
dir=$1
shift

# Versions that the tests were written with.
packages="ros-kilted-rclpy==9.1.2 ros-kilted-rmw-fastrtps-cpp==9.3.3 ros-kilted-common-interfaces==5.5.1 numpy mujoco==4.0.0 pillow"

find_python() {
    for candidate in "${PYTHON:-}" python3.12 "$HOME/.pyenv/versions"/3.12.*/bin/python3.12 python3; do
        if [ -n "$candidate" ] && "$candidate" -c 'import sys; sys.exit(sys.version_info[:2] != (3, 12))' 2>/dev/null; then
            echo "$candidate"
            return
        fi
    done
}

missing() {
    echo "skipped: $1"
    exit 0
}

ready() {
    "$dir/bin/python" - $packages <<'END' 2>/dev/null
import importlib.metadata, sys
for wanted in sys.argv[1:]:
    name, _, version = wanted.partition("==")
    if version and importlib.metadata.version(name) != version:
        sys.exit(1)
    importlib.metadata.version(name)
END
}

if [ ! -x "$dir/bin/python" ]; then
    python=$(find_python)
    [ -n "$python" ] || missing "no Python 3.12 found (the ROS 2 Kilted wheels are for 3.12); set PYTHON to one"
    "$python" -m venv "$dir" || { echo "get-ros2: $python cannot create an environment in $dir" >&2; exit 1; }
fi

# A wheel's start-up file sets the library path and starts Python again; the first run of pip must not meet a half-made one.
if ! ready; then
    log=$dir/pip.log
    # shellcheck disable=SC2086
    if ! "$dir/bin/python" -m pip install --quiet --disable-pip-version-check --retries 1 "$@" $packages >"$log" 2>&1; then
        if grep -qE 'NewConnectionError|ConnectTimeout|ReadTimeout|Name or service not known|Temporary failure|Connection refused|ProxyError|Connection to .* timed out|Max retries' "$log"; then
            missing "PyPI cannot be reached: $(tail -n 1 "$log")"
        fi
        cat "$log" >&2
        echo "get-ros2: pip install failed, see above" >&2
        exit 1
    fi
fi

for compiler in "${CC:-gcc}" "${CXX:-g++}"; do
    command -v "$compiler" >/dev/null || missing "no compiler '$compiler': tf2_msgs, map_msgs and nav2_msgs cannot be built"
done
"$dir/bin/python" "$here/build_interfaces.py" || exit 1

"$dir/bin/python" - <<'END' || missing "MuJoCo cannot draw: install libegl1 and libgl1-mesa-dri (EGL), or libosmesa6 and set MUJOCO_GL=osmesa"
import os
os.environ.setdefault("MUJOCO_GL", "egl")
import mujoco
mujoco.GLContext(16, 16).make_current()
END
echo "ready: $dir ($("$dir/bin/python" -c 'from importlib.metadata import version as v; print("rclpy", v("rclpy") + ", mujoco", v("mujoco"))'))"
