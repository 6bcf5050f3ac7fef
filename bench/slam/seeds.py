"""Accuracy over several drives with noise: records them one after the other, runs the SLAM over each, and deletes them again.

usage: seeds.py SCENE... --trundle T --drive D [--seeds 5] [--length 46] [--out FILE]

SCENE is a built-in scene of `trundle sim` or a scene file. Each seed is another route and another noise. T is the program
`trundle`, D the example `drive` of trundle-slam (both built for release). Prints of each drive what `drive` says, and of each scene the
median of the ATE. Needs numpy; a recording takes about 2 GB while it is looked at.
"""
import argparse
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
    """What `drive` says of one recorded drive."""
    if not (scratch / "map.yaml").exists():
        run(args.trundle, "sim", scene, "--map", scratch / "map.yaml")
    way, recording = scratch / "way.txt", scratch / "drive"
    route = run(sys.executable, HERE / "routes.py", scratch / "map.yaml", way, "--length", length, "--seed", seed)
    start = route.rsplit("start ", 1)[1].strip()
    run(args.trundle, "sim", scene, "--seed", seed, f"--start={start}", "--follow", way, "--record", recording)
    said = run(args.drive, recording)
    run("rm", "-r", recording)
    return said


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--trundle", type=pathlib.Path, required=True)
    parser.add_argument("--drive", type=pathlib.Path, required=True)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--length", type=float, default=46.0, help="m, at least")
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
            for seed in range(1, args.seeds + 1):
                said = judge(scene, seed, args.length, args, pathlib.Path(scratch))
                errors.append(float(re.search(r"ATE ([\d.]+) cm", said)[1]))
                say(f"{scene}, seed {seed}\n{said.rstrip()}")
        say(f"{scene}: ATE {', '.join(f'{e:.2f}' for e in errors)} cm, median {statistics.median(errors):.2f} cm\n")


main()
