"""SLAM: arrays in, poses out, bit-identical to the Rust crate."""

import itertools

import numpy as np
import pytest
import trundle


def test_tracks_simulated_images(images):
    simulator, found = images
    slam = trundle.RgbdSlam(simulator.camera, seed=1)
    for image in found:
        pose, state, covariance = slam.track(image.rgb, image.depth, image.stamp)
        assert state == "ok"
        assert pose.shape == (4, 4) and covariance.shape == (6, 6)
    assert np.linalg.norm(pose[:3, 3]) > 0.02, "the camera has moved"
    trajectory = slam.trajectory()
    assert trajectory.shape == (8, 8) and trajectory.dtype == np.float64
    np.testing.assert_array_equal(trajectory[:, 0], [image.stamp for image in found])
    np.testing.assert_allclose(np.linalg.norm(trajectory[:, 4:], axis=1), 1.0, atol=1e-12)
    assert slam.points().shape[0] > 100 and slam.points().shape[1] == 3
    assert len(slam.keyframes()) >= 1


def test_depth_of_16_bits_is_that_of_floats(images):
    simulator, found = images
    by_units, by_metres = (trundle.RgbdSlam(simulator.camera, depth_scale=5000) for _ in range(2))
    for image in found[:3]:
        units = np.round(image.depth * 5000).astype(np.uint16)
        by_units.track(image.rgb, units, image.stamp)
        by_metres.track(image.rgb, (units / 5000).astype(np.float32), image.stamp)
    np.testing.assert_array_equal(by_units.trajectory(), by_metres.trajectory())


def test_arrays_of_any_layout_are_read(images):
    simulator, found = images
    whole, strided = (trundle.RgbdSlam(simulator.camera) for _ in range(2))
    for image in found[:3]:
        whole.track(image.rgb, image.depth, image.stamp)
        wide = np.repeat(image.rgb, 2, axis=1)[:, ::2]
        strided.track(wide, np.asfortranarray(image.depth), image.stamp)
    np.testing.assert_array_equal(whole.trajectory(), strided.trajectory())


def test_odometry_of_the_base_is_a_prior(images):
    simulator, found = images
    slam = trundle.RgbdSlam(simulator.camera, base_from_camera=simulator.base_from_camera)
    for image in found:
        track = slam.track_rgbd(image, odometry=[0.02 * image.stamp, 0.0, 0.01 * image.stamp])
        assert track.is_located
    without = trundle.RgbdSlam(simulator.camera)
    with pytest.raises(ValueError, match="base_from_camera"):
        without.track_rgbd(found[0], odometry=[0, 0, 0])
    assert without.track_rgbd(found[0], odometry=np.eye(4)).state == "ok"


def test_a_saved_map_is_loaded(images, tmp_path):
    simulator, found = images
    slam = trundle.RgbdSlam(simulator.camera, seed=3)
    for image in found:
        slam.track_rgbd(image)
    slam.finish()
    file = tmp_path / "visual.map"
    slam.save(file)
    again = trundle.RgbdSlam.load(file, simulator.camera, seed=3)
    np.testing.assert_array_equal(again.points(), slam.points())
    again.mapping = False
    assert not again.mapping
    states = [again.track_rgbd(image).state for image in found]
    assert states[-1] == "ok", states
    again.save(tmp_path / "again.map")
    assert (tmp_path / "again.map").read_bytes() == file.read_bytes(), "the map stays as it is"


def test_broken_map_files_are_refused(tmp_path, images):
    camera = images[0].camera
    with pytest.raises(FileNotFoundError, match="none.map"):
        trundle.RgbdSlam.load(tmp_path / "none.map", camera)
    (tmp_path / "bad.map").write_bytes(b"trundlM\x01" + bytes(100))
    with pytest.raises(ValueError, match="bad.map"):
        trundle.RgbdSlam.load(tmp_path / "bad.map", camera)


def test_python_and_rust_give_the_same_bits(tum_folder, tmp_path):
    short = tmp_path / "short"
    short.mkdir()
    for folder in ["rgb", "depth"]:
        (short / folder).symlink_to(tum_folder / folder)
    for name in ["rgb.txt", "depth.txt"]:
        lines = (tum_folder / name).read_text().splitlines(keepends=True)
        (short / name).write_text("".join(itertools.islice(lines, 45)))
    sequence, slam = trundle.TumSequence(short), trundle.RgbdSlam("freiburg1")
    for image in sequence:
        slam.track(image.rgb, image.depth, image.stamp)
    assert len(sequence) >= 35
    np.testing.assert_array_equal(slam.trajectory(), trundle.slam_folder(short, "freiburg1"))


def test_sequences_index_like_lists(tum_folder):
    sequence = trundle.TumSequence(tum_folder)
    assert sequence[-1].stamp == sequence[len(sequence) - 1].stamp == sequence.stamps()[-1]
    for index in [len(sequence), -len(sequence) - 1, 2**40]:
        with pytest.raises(IndexError):
            sequence[index]
    assert sequence.ground_truth.shape[1] == 8 and sequence.odometry is None


def test_pixels_are_borrowed_and_cannot_be_written(images):
    image = images[1][0]
    assert image.rgb.base is not None and np.shares_memory(image.rgb, image.rgb)
    assert not image.rgb.flags.writeable and not image.depth.flags.writeable
    with pytest.raises(ValueError):
        image.rgb[0, 0, 0] = 1
    with pytest.raises(ValueError):
        image.rgb.flags.writeable = True
    pixels = trundle.Simulator("room", 1).step([0, 0], 0.1)
    depth = next(event for event in pixels if isinstance(event, trundle.Rgbd)).depth
    del pixels
    assert np.isfinite(depth).all(), "the array keeps its image alive"


def test_cameras(tmp_path):
    camera = trundle.Camera.named("freiburg1")
    assert (camera.width, camera.height, camera.depth_scale) == (640, 480, 5000)
    file = tmp_path / "camera.toml"
    file.write_text(camera.to_toml())
    again = trundle.Camera.named(file)
    assert again.distortion == camera.distortion and again.readout == camera.readout
    with pytest.raises(ValueError, match="freiburg1, freiburg2"):
        trundle.Camera.named("no-such-camera")
