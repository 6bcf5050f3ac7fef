"""ATE and RPE against evo, on real and on synthetic trajectories."""

import copy

import numpy as np
import pytest
from conftest import ROOT, shared

import trundle
from trundle import evaluate

metrics = pytest.importorskip("evo.core.metrics")
from evo.core import sync  # noqa: E402
from evo.core.trajectory import PoseTrajectory3D  # noqa: E402

#: Largest relative difference from evo's numbers: both sum the same f64 in another order.
AGREEMENT = 1e-9


def evo_trajectory(rows):
    return PoseTrajectory3D(rows[:, 1:4], rows[:, [7, 4, 5, 6]], rows[:, 0])


def associated(reference, estimate):
    return sync.associate_trajectories(evo_trajectory(reference), evo_trajectory(estimate), max_diff=0.01)


def made_up():
    chance = np.random.default_rng(4)
    t = 1305031102.175304 + np.arange(200) / 30
    angle = np.cumsum(chance.normal(0, 0.02, 200))
    zero = np.zeros(200)
    position = np.cumsum(chance.normal(0, 0.02, (200, 3)), axis=0)
    reference = np.column_stack([t, position, zero, zero, np.sin(angle / 2), np.cos(angle / 2)])
    estimate = reference.copy()
    estimate[:, 0] += 0.004
    estimate[:, 1:4] += chance.normal(0, 0.03, (200, 3)) + [1, 2, 3]
    return reference, estimate


def pairs():
    folder = ROOT / "data/trajectories"
    truth = trundle.read_trajectory(folder / "freiburg1_xyz-groundtruth.txt")
    names = ["rgbdslam", "rgbdslam_drift", "ORB_kf_mono"]
    return [made_up()] + [(truth, trundle.read_trajectory(folder / f"freiburg1_xyz-{name}.txt")) for name in names]


def agree(ours, theirs):
    for name in ["rmse", "mean", "median", "std", "min", "max"]:
        assert ours[name] == pytest.approx(theirs[name], rel=AGREEMENT, abs=1e-11), name


@pytest.mark.parametrize("align", ["none", "se3", "sim3"])
@pytest.mark.parametrize("case", range(4))
def test_ate_is_that_of_evo(case, align):
    reference, estimate = pairs()[case]
    truth, found = associated(reference, estimate)
    if align != "none":
        found = copy.deepcopy(found)
        found.align(truth, correct_scale=align == "sim3")
    ours = evaluate.ate(reference, estimate, align=align)
    assert ours["count"] == len(found.timestamps)
    for part, statistics in [("translation_part", ours), ("rotation_angle_rad", ours["rotation"])]:
        ape = metrics.APE(metrics.PoseRelation[part])
        ape.process_data((truth, found))
        tolerance = AGREEMENT if part == "translation_part" else 1e-6
        for name in ["rmse", "mean", "median", "max"]:
            assert statistics[name] == pytest.approx(ape.get_all_statistics()[name], rel=tolerance, abs=1e-7), (part, name)
    ape = metrics.APE(metrics.PoseRelation.translation_part)
    ape.process_data((truth, found))
    agree(ours, ape.get_all_statistics())
    np.testing.assert_allclose(ours["errors"], ape.error, rtol=1e-8, atol=1e-11)


@pytest.mark.parametrize("delta,unit,all_pairs", [(1, "frames", False), (7, "frames", False), (7, "frames", True), (0.3, "m", False)])
@pytest.mark.parametrize("case", range(4))
def test_rpe_is_that_of_evo(case, delta, unit, all_pairs):
    reference, estimate = pairs()[case]
    truth, found = associated(reference, estimate)
    rpe = metrics.RPE(metrics.PoseRelation.translation_part, delta, metrics.Unit.meters if unit == "m" else metrics.Unit.frames, all_pairs=all_pairs)
    rpe.process_data((truth, found))
    ours = evaluate.rpe(reference, estimate, delta=delta, unit=unit, all_pairs=all_pairs)
    agree(ours, rpe.get_all_statistics())


def test_slam_on_a_real_sequence(tum_folder):
    trajectory = trundle.slam_folder(tum_folder, "freiburg1")
    truth = trundle.TumSequence(tum_folder).ground_truth
    assert evaluate.ate(truth, trajectory, max_difference=0.02)["rmse"] < 0.03


def test_trajectory_files(tmp_path):
    reference, _ = made_up()
    file = tmp_path / "poses.txt"
    trundle.write_trajectory(file, reference)
    np.testing.assert_allclose(trundle.read_trajectory(file), reference, atol=1e-9)
    assert shared("tum_fr1_rpy_400").exists()


def test_what_cannot_be_compared_is_refused():
    reference, estimate = made_up()
    with pytest.raises(ValueError, match="no pose of the estimate"):
        evaluate.ate(reference, estimate + np.eye(8)[0] * 1e4)
    with pytest.raises(ValueError, match="stamp of estimate pose"):
        evaluate.ate(reference, estimate[::-1].copy())
    bad = estimate.copy()
    bad[3, 2] = np.nan
    with pytest.raises(ValueError, match="estimate pose 3 is not finite"):
        evaluate.ate(reference, bad)
    bad = estimate.copy()
    bad[3, 4:] = 0
    with pytest.raises(ValueError, match="row 3 of estimate"):
        evaluate.ate(reference, bad)
    with pytest.raises(ValueError, match="frames, s, m"):
        evaluate.rpe(reference, estimate, unit="km")
    with pytest.raises(ValueError, match="se3, sim3, none"):
        evaluate.ate(reference, estimate, align="best")
