"""Accuracy over several drives with noise: records them one after the other, runs the SLAM over each, and deletes them again.

usage: seeds.py SCENE... --trundle T --drive D [--first 1] [--seeds 5] [--length 46] [--up z] [--maps] [--out FILE]

SCENE is a built-in scene of `trundle sim` or a scene file. Each seed is another route and another noise. T is the program
`trundle`, D the example `drive` of trundle-slam (both built for release). Prints the output of `drive` for each drive, and for each scene the
median of the ATE. With --maps the drive is also mapped, along the poses of `trundle slam` and by wheels alone, and each map judged against
the true one. Needs numpy; a recording takes about 2 GB while it is looked at.
"""
import argparse
import json
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).parent


def run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def judge(scene, seed, length, args, scratch):
    """Output of `drive` for one recorded drive."""
    # A seed is another furnishing, too.
    sim = ["sim", scene, "--up", args.up, "--seed", seed]
    run(args.trundle, *sim, "--map", scratch / "map.yaml")
    path, recording = scratch / "path.txt", scratch / "drive"
    route = run(sys.executable, HERE / "routes.py", scratch / "map.yaml", path, "--length", length, "--seed", seed)
    start = route.rsplit("start ", 1)[1].strip()
    run(args.trundle, *sim, f"--start={start}", "--follow", path, "--record", recording)
    printed = run(args.drive, recording)
    if args.maps:
        run(args.trundle, *sim, "--map", scratch / "truth.yaml", "--resolution", 0.01)
        printed += maps(args.trundle, start, seed, recording, scratch)
    run("rm", "-r", recording)
    return printed


def maps(trundle, start, seed, recording, scratch):
    """How many of the occupied cells of the maps of a recording are right."""
    poses, out = scratch / "slam", scratch / "mapped"
    run(trundle, "slam", recording, "--height", 0.45, "--tilt", 8, "--out", poses)
    printed = "map: occupied cells within 5 cm of true ones, and true ones within 5 cm of the map's:"
    for motion, option in [("slam", ["--poses", poses / "trajectory.txt"]), ("wheels", [])]:
        run(trundle, "map", recording, *option, "--seed", seed, "--out", out)
        run(trundle, "eval", "map", scratch / "truth.yaml", out / "map.yaml", f"--at={start}", "--out", scratch / "judged")
        judged = json.loads((scratch / "judged" / "summary.json").read_text())
        printed += f" {motion} {judged['precision'] * 100:.2f} and {judged['recall'] * 100:.1f} %;"
    run("rm", "-r", poses, out)
    return printed + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--trundle", type=pathlib.Path, required=True)
    parser.add_argument("--drive", type=pathlib.Path, required=True)
    parser.add_argument("--first", type=int, default=1, help="seed of the first drive")
    parser.add_argument("--seeds", type=int, default=5, help="how many")
    parser.add_argument("--length", type=float, default=46.0, help="m, at least")
    parser.add_argument("--up", default="y", help="the axis that points up in a glTF scene")
    parser.add_argument("--maps", action="store_true", help="evaluate maps, too")
    parser.add_argument("--out", type=pathlib.Path, help="all that is printed goes here as well")
    args = parser.parse_args()
    lines = []

    def say(line):
        print(line, flush=True)
        lines.append(line)
        if args.out:
            args.out.write_text("\n".join(lines) + "\n")

    for scene in args.scenes:
        errors = []
        with tempfile.TemporaryDirectory() as scratch:
            for seed in range(args.first, args.first + args.seeds):
                printed = judge(scene, seed, args.length, args, pathlib.Path(scratch))
                errors.append(float(re.search(r"ATE ([\d.]+) cm", printed)[1]))
                say(f"{scene}, seed {seed}\n{printed.rstrip()}")
        say(f"{scene}: ATE {', '.join(f'{e:.2f}' for e in errors)} cm, median {statistics.median(errors):.2f} cm\n")


main()
