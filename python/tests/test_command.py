"""The command `trundle` of the package."""

import json
import subprocess
import sys

import pytest
import trundle


def command(*arguments, folder=None):
    return subprocess.run([sys.executable, "-m", "trundle", *arguments], capture_output=True, text=True, cwd=folder)


def test_version_help_and_wrong_words():
    version = command("--version")
    assert version.returncode == 0 and version.stdout.startswith("trundle ")
    assert "slam" in command("--help").stdout
    wrong = command("no-such-command")
    assert wrong.returncode == 2 and "no-such-command" in wrong.stderr


def test_a_plan_is_written(tmp_path, room):
    room.save(tmp_path / "map.yaml")
    done = command("plan", "map.yaml", "--from=0.5,0.4,0", "--goal=2.5,0.4,0", "--out", "out", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    summary = json.loads((tmp_path / "out/summary.json").read_text())
    plan = trundle.plan(room, (0.5, 0.4, 0), (2.5, 0.4, 0))
    assert plan["length"] == pytest.approx(summary["length_m"], abs=1e-3), summary


def test_the_exit_code_says_what_went_wrong(tmp_path):
    assert command("plan", str(tmp_path / "none.yaml"), "--from=0,0,0", "--goal=1,0,0").returncode == 2
