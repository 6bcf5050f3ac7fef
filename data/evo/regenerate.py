"""Writes evo's numbers as fixtures: one JSON a pair of files, each entry with the command line that made it.

Needs the PyPI tool `evo` (`pip install evo==1.38.1`) on PATH; run in a folder with the trajectories:
    python3 .../data/evo/regenerate.py OUT_DIR NAME REFERENCE ESTIMATE
"""

import json
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

APE = {
    "ape_none": [],
    "ape_rigid": ["-a"],
    "ape_similarity": ["-as"],
    "ape_angle_deg": ["-r", "angle_deg"],
}
RPE = {
    "rpe_frames_1_translation": ["-r", "trans_part", "-d", "1", "-u", "f"],
    "rpe_frames_1_angle_deg": ["-r", "angle_deg", "-d", "1", "-u", "f"],
    "rpe_frames_7_translation": ["-r", "trans_part", "-d", "7", "-u", "f"],
    "rpe_frames_7_angle_deg": ["-r", "angle_deg", "-d", "7", "-u", "f"],
    "rpe_frames_7_all_translation": ["-r", "trans_part", "-d", "7", "-u", "f", "--all_pairs"],
    "rpe_metres_translation": ["-r", "trans_part", "-d", "0.3", "-u", "m"],
    "rpe_metres_angle_deg": ["-r", "angle_deg", "-d", "0.3", "-u", "m"],
}


def statistics(program, reference, estimate, options):
    command = [program, "tum", reference, estimate, *options]
    with tempfile.TemporaryDirectory() as folder:
        archive = Path(folder) / "result.zip"
        run = subprocess.run([*command, "--save_results", archive, "--silent"], capture_output=True, text=True)
        if run.returncode != 0:
            return {"command": " ".join(command), "error": run.stderr.strip().splitlines()[-1:]}
        with zipfile.ZipFile(archive) as result:
            stats = json.loads(result.read("stats.json"))
            import io
            import numpy
            count = len(numpy.load(io.BytesIO(result.read("error_array.npy"))))
    return {"command": " ".join(command), "count": count, **stats}


def main(out, name, reference, estimate):
    entries = {key: statistics("evo_ape", reference, estimate, options) for key, options in APE.items()}
    entries |= {key: statistics("evo_rpe", reference, estimate, options) for key, options in RPE.items()}
    fixture = {"evo": "1.38.1", "reference": reference, "estimate": estimate, "results": entries}
    Path(out, f"{name}.json").write_text(json.dumps(fixture, indent=1) + "\n")


main(*sys.argv[1:])
