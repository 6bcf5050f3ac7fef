"""SLAM under degraded images: `trundle slam` and ORB-SLAM3 on the same degraded copies of a TUM RGB-D folder of freiburg1.

usage: degradation.py FOLDER --trundle PROGRAM [--vocabulary VOC.txt] [--only WORD] [--runs 3] [--core 1] [--out out/degradation]

Each case of degraded.py is written, tracked by both programs on one core, and deleted. The table begins with the case in which trundle's
error is the largest multiple of ORB-SLAM3's. A program's error is the ATE RMSE of the images that it locates; a case counts as lost if it
locates less than 0.9 of them. ORB-SLAM3 is not deterministic: its row is the median of `--runs` runs. Without --vocabulary trundle runs alone.
Writes OUT/degradation.json. Needs the Python environment of compare.py.
"""
import argparse
import json
import pathlib
import shutil
import statistics

import compare
import degraded

# Share of the images that a program must locate.
MIN_LOCATED = 0.9
# Errors below this are equal to that of the peer [cm]: the ground truth and the alignment are not better.
EQUAL_CM = 0.05


def median(rows):
    """The row of the median error; rows in which the camera is lost come last."""
    return sorted(rows, key=error)[(len(rows) - 1) // 2]


def error(row):
    """ATE [cm], infinite if too few images are located."""
    located = row["tracked"] / row["frames"]
    return row["ate_cm"] if located >= MIN_LOCATED and row["ate_cm"] == row["ate_cm"] else float("inf")


def compare_case(args, name):
    """Rows of both programs for one case."""
    folder = args.out / "images"
    shutil.rmtree(folder, ignore_errors=True)
    degraded.make(name, args.folder, folder)
    result = {"case": name, "trundle": compare.ours(args, folder, args.out / "trundle")}
    if args.vocabulary:
        runs = [attempt(args, folder) for _ in range(args.runs)]
        result["ORB-SLAM3"] = median(runs)
    shutil.rmtree(folder)
    return result


def attempt(args, folder):
    """A run of ORB-SLAM3; a run that ends in an error locates nothing."""
    try:
        return compare.theirs(args, folder, args.out / "orbslam3")
    except Exception as why:  # the peer may crash, or save no trajectory
        print(f"ORB-SLAM3 fails: {why}")
        frames = len(degraded.read_rows(folder / "rgb.txt"))
        return {"frames": frames, "tracked": 0, "ate_cm": float("nan"), "median_ms": float("nan")}


def multiple(result):
    """Error of trundle over that of ORB-SLAM3; both lost is 1."""
    ours, theirs = error(result["trundle"]), error(result["ORB-SLAM3"])
    if ours == theirs or ours - theirs <= EQUAL_CM:
        return min(1.0, ours / theirs) if theirs not in (0.0, float("inf")) else 1.0
    return ours / theirs


def cell(row):
    return f"{row['ate_cm']:.2f} | {row['tracked']} of {row['frames']} | {row['median_ms']:.1f}"


def table(results):
    """Prints the cases, the worst first, and the figures of docs/results."""
    if "ORB-SLAM3" in results[0]:
        results = sorted(results, key=multiple, reverse=True)
    print("| case | trundle: ATE cm | located | ms | ORB-SLAM3: ATE cm | located | ms |\n|---|---|---|---|---|---|---|")
    for result in results:
        peer = cell(result["ORB-SLAM3"]) if "ORB-SLAM3" in result else " | | "
        print(f"| {result['case']} | {cell(result['trundle'])} | {peer} |")
    located = sum(error(r["trundle"]) < float("inf") for r in results)
    print(f"cases: {len(results)}\nlocated by trundle: {located}")
    if "ORB-SLAM3" in results[0]:
        print(f"no worse than ORB-SLAM3: {sum(multiple(r) <= 1.0 for r in results)}")
        print(f"located by ORB-SLAM3: {sum(error(r['ORB-SLAM3']) < float('inf') for r in results)}")
        print(f"largest multiple: {multiple(results[0]):.2f} ({results[0]['case']})")
        ratios = [r["ORB-SLAM3"]["median_ms"] / r["trundle"]["median_ms"] for r in results if r["ORB-SLAM3"]["tracked"]]
        print(f"median ratio of times: {statistics.median(ratios):.2f}")
    return results


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--trundle", type=pathlib.Path, required=True)
    parser.add_argument("--vocabulary", type=pathlib.Path, help="DBoW2 text, for ORB-SLAM3")
    parser.add_argument("--only", default="", help="only cases whose name holds this word")
    parser.add_argument("--runs", type=int, default=3, help="runs of ORB-SLAM3")
    parser.add_argument("--core", type=int, default=1)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/degradation"))
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    results = []
    for name in (name for name in degraded.CASES if args.only in name):
        results.append(compare_case(args, name))
        print(json.dumps(results[-1]), flush=True)
        (args.out / "degradation.json").write_text(json.dumps(results, indent=1) + "\n")
    table(results)


if __name__ == "__main__":
    main()
