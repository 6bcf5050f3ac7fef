"""SLAM on a TUM RGB-D folder: the camera's pose at each image.

python 01_slam_a_folder.py [FOLDER [CAMERA]]; without a folder, images of the simulator.
"""

import sys

import trundle


def track_folder(folder: str, camera: str) -> None:
    """Tracks all images of a folder, writes trajectory.txt, and prints the error if the folder has ground truth."""
    slam = trundle.RgbdSlam(camera)
    sequence = trundle.TumSequence(folder, trundle.Camera.named(camera).depth_scale)
    for image in sequence:
        pose, state, _ = slam.track(image.rgb, image.depth, image.stamp)
        print(f"{image.stamp:.6f} {state} at {pose[:3, 3].round(3)} m", end="\r")
    trajectory = slam.trajectory()
    trundle.write_trajectory("trajectory.txt", trajectory)
    print(f"\n{len(trajectory)} of {len(sequence)} images located, {len(slam.points())} landmarks")
    if sequence.ground_truth is not None:
        error = trundle.evaluate.ate(sequence.ground_truth, trajectory, max_difference=0.02)
        print(f"ATE {100 * error['rmse']:.2f} cm over {error['count']} poses")
        assert error["rmse"] < 0.1, "the trajectory is that of the camera"


def track_simulated_images() -> None:
    """Tracks the camera of a robot that drives an arc, and compares its poses with the truth."""
    simulator = trundle.Simulator("room", seed=1)
    slam = trundle.RgbdSlam(simulator.camera)
    for _ in range(10):
        for event in simulator.step([0.2, 0.1], duration=0.1):
            if isinstance(event, trundle.Rgbd):
                pose, state, covariance = slam.track(event.rgb, event.depth, event.stamp)
                print(f"{event.stamp:.3f} s {state}: {pose[:3, 3].round(3)} m +- {1000 * covariance[0, 0] ** 0.5:.1f} mm")
                assert state == "ok"
    print(f"driven: {simulator.truth()['path_length']:.3f} m")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        track_folder(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "freiburg1")
    else:
        track_simulated_images()
