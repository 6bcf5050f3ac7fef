"""Time and memory of `trundle map` on ever longer logs of one room.

usage: long_logs.py --trundle T --bench B [--sizes 10000,100000,500000]

T is the program `trundle`, B the example `lasting_bench` of trundle-mapping, which writes the logs (both built for release). The robot
circles in a room of 10 x 8 m; each scan of 360 beams is processed. Prints for each size the processor time of a scan and the peak of the
resident memory, and the slopes between the sizes. A log of 500,000 scans takes 1.2 GB in the folder for temporary files.
"""
import argparse
import os
import pathlib
import subprocess
import sys
import tempfile


def mapped(trundle, log, out):
    """Processor time in seconds and peak memory in MB of one map."""
    process = subprocess.Popen([trundle, "map", log, "--out", out], stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"trundle map {log}: exit status {status}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1e3


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trundle", required=True, type=pathlib.Path)
    parser.add_argument("--bench", required=True, type=pathlib.Path)
    parser.add_argument("--sizes", default="10000,100000,500000")
    args = parser.parse_args()
    sizes = [int(size) for size in args.sizes.split(",")]
    rows = []
    with tempfile.TemporaryDirectory() as scratch:
        log = pathlib.Path(scratch) / "room.log"
        for size in sizes:
            subprocess.run([args.bench, str(size), "--log", log], check=True)
            seconds, megabytes = mapped(args.trundle, log, pathlib.Path(scratch) / "map")
            rows.append((size, seconds, megabytes))
            print(f"{size} scans: {seconds / size * 1e3:.3f} ms a scan, peak {megabytes:.1f} MB", flush=True)
    (small, time, _), (before, _, memory), (large, last_time, last_memory) = rows[0], rows[-2], rows[-1]
    ratio = (last_time / large) / (time / small)
    print(f"time of a scan, that of {large} by that of {small}: {ratio:.3f}")
    print(f"memory of a scan beyond {before}: {(last_memory - memory) * 1e6 / (large - before):.1f} bytes")


if __name__ == "__main__":
    main()
