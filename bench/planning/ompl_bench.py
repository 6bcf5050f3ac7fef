#!/usr/bin/env python3
"""trundle-planning and OMPL (PyPI) on the same questions, in one run, on one core.

    python3 bench/planning/ompl_bench.py [--data ../shared/data/nav] [--venv /tmp/trundle-ompl-venv] [--pairs 60]

Needs pip: makes a virtual environment at --venv and installs `ompl` (2.0.1 measured) and `numpy` there. Runs
`cargo run --release -p trundle-planning --example plan_bench` first, which writes its questions and numbers (CPU time, the best
of 20 askings), then asks OMPL's RRT-Connect (first solution, simplified) and BIT* (100 ms) the same questions once: x, y of a
disc of 0.26 m. OMPL gives a polyline without headings; trundle way-points, a curve through both headings and its timing.

OMPL's validity check is a look-up in an inflated grid, called through Python: its CPU times hold that. So the cost of a call is
measured, and the times are given without all calls too: what they would be if a look-up cost nothing. Lengths are over the
shortest any-angle length for the disc (Theta*, pulled taut), and trundle's also over that for the room which its plan keeps.
"""

import argparse
import csv
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RADIUS = 0.26
# Calls of the validity check that are timed.
PROBES = 2000
MAPS = {
    "depot": "nav2/depot.yaml",
    "tb3_sandbox": "nav2/tb3_sandbox.yaml",
    "office01add": "mrpb/maps/office01add/map.yaml",
    "room02": "mrpb/maps/room02/map.yaml",
}


def in_venv(folder):
    """Runs this program again in a virtual environment that has ompl and numpy."""
    python = Path(folder) / "bin" / "python"
    if Path(sys.prefix).resolve() == Path(folder).resolve():
        return
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    subprocess.run([python, "-m", "pip", "install", "-q", "ompl", "numpy"], check=True)
    os.execv(python, [str(python), *sys.argv])


def read_map(yaml):
    """Occupied cells (row 0 at the lowest y), resolution and origin of a map_server map."""
    import numpy as np

    field = dict(line.split(":", 1) for line in yaml.read_text().splitlines() if ":" in line)
    data = (yaml.parent / field["image"].strip()).read_bytes()
    words, at = [], 0
    while len(words) < 4:
        end = at
        while not data[end : end + 1].isspace():
            end += 1
        if data[at : at + 1] == b"#":
            at = data.index(b"\n", at) + 1
            continue
        if end > at:
            words.append(data[at:end])
        at = end + 1
    width, height = int(words[1]), int(words[2])
    pixels = np.frombuffer(data, np.uint8, width * height, at).reshape(height, width)[::-1]
    occupied = (255 - pixels.astype(float)) / 255 > float(field["occupied_thresh"])
    origin = [float(word) for word in field["origin"].strip(" []").split(",")]
    return occupied, float(field["resolution"]), origin[:2]


def inflated(occupied, resolution, fine):
    """Whether a disc at each of `fine` points a cell touches an occupied square, by stamping exact discs."""
    import numpy as np

    height, width = occupied.shape
    blocked = np.zeros((height * fine, width * fine), bool)
    step = resolution / fine
    reach = int(np.ceil((RADIUS + resolution) / step))
    offsets = np.arange(-reach, reach + fine)
    gap = np.maximum(0, np.maximum(-(offsets + 0.5) * step, (offsets + 0.5) * step - resolution))
    near = np.hypot(gap[:, None], gap[None, :]) < RADIUS
    for dy, row in zip(offsets, near):
        for dx in offsets[row]:
            rows, cols = np.nonzero(occupied)
            y, x = rows * fine + dy, cols * fine + dx
            inside = (y >= 0) & (x >= 0) & (y < blocked.shape[0]) & (x < blocked.shape[1])
            blocked[y[inside], x[inside]] = True
    return blocked


def ask(ob, og, blocked, step, origin, start, goal, name):
    """Milliseconds, the same without the validity checks, and length (None: no path) of one planner on one question."""
    height, width = blocked.shape
    rows = blocked.tolist()
    checks = 0

    def is_free(state):
        nonlocal checks
        checks += 1
        col, row = int((state[0] - origin[0]) / step), int((state[1] - origin[1]) / step)
        return 0 <= col < width and 0 <= row < height and not rows[row][col]

    space = ob.RealVectorStateSpace(2)
    bounds = ob.RealVectorBounds(2)
    for axis, size in ((0, width), (1, height)):
        bounds.setLow(axis, origin[axis])
        bounds.setHigh(axis, origin[axis] + size * step)
    space.setBounds(bounds)
    setup = og.SimpleSetup(space)
    setup.setStateValidityChecker(is_free)
    information = setup.getSpaceInformation()
    # Moves are looked at every 2.5 cm.
    information.setStateValidityCheckingResolution(0.025 / space.getMaximumExtent())
    ends = []
    for point in (start, goal):
        state = space.allocState()
        state[0], state[1] = point
        ends.append(state)
    setup.setStartAndGoalStates(*ends)
    setup.setPlanner(og.RRTConnect(information) if name == "RRT-Connect" else og.BITstar(information))
    setup.setup()
    free = ends[0]
    begin = time.process_time()
    for _ in range(PROBES):
        information.isValid(free)
    check_ms = (time.process_time() - begin) * 1e3 / PROBES
    checks = 0
    begin = time.process_time()
    solved = setup.solve(5.0 if name == "RRT-Connect" else 0.1)
    if solved and name == "RRT-Connect":
        setup.simplifySolution(1.0)
    ms = (time.process_time() - begin) * 1e3
    found = solved and setup.haveExactSolutionPath()
    return ms, max(ms - checks * check_ms, 0.0), setup.getSolutionPath().length() if found else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", default=str(ROOT / "../shared/data/nav"))
    parser.add_argument("--venv", default=str(Path(tempfile.gettempdir()) / "trundle-ompl-venv"))
    parser.add_argument("--pairs", type=int, default=60, help="questions a map")
    parser.add_argument("--csv", help="questions and numbers of an earlier run of plan_bench")
    args = parser.parse_args()
    in_venv(args.venv)
    import numpy as np
    from ompl import base as ob, geometric as og, util as ou

    ou.noOutputHandler()
    path = args.csv
    if path is None:
        path = str(Path(tempfile.mkdtemp()) / "pairs.csv")
        example = ["cargo", "run", "--release", "-p", "trundle-planning", "--example", "plan_bench"]
        subprocess.run([*example, "--", "--only-plans", "--csv", path], check=True, cwd=ROOT)
    with open(path, newline="") as lines:
        questions = list(csv.DictReader(lines))
    print("\nCPU ms; length over the shortest any-angle length for the disc.")
    print("| map | planner | found | ms median | p99 | without checks: median | p99 | length mean | worst |")
    print("|---|---|---|---|---|---|---|---|---|")
    for name, file in MAPS.items():
        asked = [row for row in questions if row["map"] == name][: args.pairs]
        occupied, resolution, origin = read_map(Path(args.data) / file)
        blocked = inflated(occupied, resolution, 2)
        mine = [(float(row["ms"]), None, row["length_m"] and float(row["length_m"])) for row in asked]
        print_row(name, "trundle (curve, timed)", asked, mine, "shortest_m")
        print_row(name, "trundle, same clearance", asked, mine, "roomy_m")
        for planner in ("RRT-Connect", "BIT*"):
            answers = []
            for row in asked:
                start, goal = ((float(row[x]), float(row[y])) for x, y in (("sx", "sy"), ("gx", "gy")))
                answers.append(ask(ob, og, blocked, resolution / 2, origin, start, goal, planner))
            print_row(name, f"OMPL {planner}", asked, answers, "shortest_m")


def print_row(name, planner, asked, answers, shortest):
    """A row of the table: answers are (ms, ms without checks, length), of trundle (ms, None, length or nothing)."""
    import numpy as np

    quantiles = lambda values: [f"{np.quantile(values, share):.2f}" for share in (0.5, 0.99)]
    found = [(row, length) for row, (_, _, length) in zip(asked, answers) if length]
    ratios = [length / float(row[shortest]) for row, length in found]
    times = quantiles([ms for ms, _, _ in answers])
    bare = [ms for _, ms, _ in answers if ms is not None]
    lengths = [f"{np.mean(ratios):.3f}", f"{np.max(ratios):.3f}"] if ratios else ["", ""]
    cells = [name, planner, f"{len(found)} of {len(asked)}", *times, *(quantiles(bare) if bare else ["", ""]), *lengths]
    print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
    # OMPL's bindings report leaks at a regular exit.
    sys.stdout.flush()
    os._exit(0)
