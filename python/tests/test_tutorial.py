"""The Python blocks of docs/tutorials/python.md run as they stand there, in order, in one folder and with one namespace."""

import os
import re

import pytest
from conftest import ROOT, shared

PAGE = ROOT / "docs/tutorials/python.md"
# The folder that the block on a recorded sequence reads, and the number of its images for a quick test.
SEQUENCE = "rgbd_dataset_freiburg1_rpy"
IMAGES = 60


def blocks():
    """Line and text of each Python block, without its indentation."""
    page = PAGE.read_text()
    for found in re.finditer(r"^( *)```python\n(.*?)^ *```$", page, re.MULTILINE | re.DOTALL):
        lines = found[2].splitlines()
        yield page.count("\n", 0, found.start()) + 1, "\n".join(line[len(found[1]) :] for line in lines)


LINES = [line for line, _ in blocks()]


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """Runs blocks of the page once each: a function of the block's line."""
    folder, namespace, done = tmp_path_factory.mktemp("page"), {}, set()
    present = os.getcwd()
    os.chdir(folder)

    def run(line):
        if line not in done:
            exec(compile(dict(blocks())[line], f"{PAGE}:{line}", "exec"), namespace)
            done.add(line)
        return namespace

    yield run
    os.chdir(present)


def link_sequence(source):
    """The first images of a sequence under the name that the page uses."""
    os.mkdir(SEQUENCE)
    for name in ["rgb", "depth"]:
        os.symlink(source / name, f"{SEQUENCE}/{name}")
        rows = [row for row in (source / f"{name}.txt").read_text().splitlines() if not row.startswith("#")]
        with open(f"{SEQUENCE}/{name}.txt", "w") as file:
            file.write("\n".join(rows[:IMAGES]) + "\n")


@pytest.mark.parametrize("line", LINES)
def test_block_of_the_tutorial(page, line):
    page(LINES[0])
    if SEQUENCE in dict(blocks())[line]:
        link_sequence(shared("tum_fr1_rpy_400"))
    namespace = page(line)
    if line == LINES[0]:
        assert namespace["step"].is_finished and namespace["body"].truth()["contacts"] == 0
        assert os.path.exists("map.yaml") and os.path.exists("map.png")
    if "plan" in namespace:
        assert namespace["plan"]["found"], namespace["plan"]["message"]
    if "slam" in namespace:
        assert os.path.exists("trajectory.txt")


def test_every_block_of_the_tutorial_is_found():
    assert len(LINES) == PAGE.read_text().count("```python") == 4
