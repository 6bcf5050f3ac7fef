"""Long calls release the interpreter's lock; two threads on one object are refused."""

import threading
import time

import pytest

import trundle


def test_other_threads_run_meanwhile():
    simulator, done = trundle.Simulator("room", 1), threading.Event()

    def work():
        simulator.step([0.1, 0.0], 2.0)
        done.set()

    thread = threading.Thread(target=work)
    begin, counted = time.perf_counter(), 0
    thread.start()
    while not done.is_set():
        counted += 1
        time.sleep(0.001)
    thread.join()
    assert time.perf_counter() - begin > 0.05, "long enough to tell"
    assert counted > 10, "this thread ran while the simulator drew its images"


def test_a_second_thread_in_one_object_is_refused():
    simulator, inside = trundle.Simulator("room", 1), threading.Event()

    def work():
        inside.set()
        simulator.step([0.1, 0.0], 3.0)

    thread = threading.Thread(target=work)
    thread.start()
    inside.wait()
    refused = 0
    while thread.is_alive():
        try:
            simulator.command([0.0, 0.0])
        except RuntimeError:
            refused += 1
        time.sleep(0.001)
    thread.join()
    assert refused > 0


def test_objects_of_their_own_work_side_by_side(images):
    results = {}

    def track(name):
        slam = trundle.RgbdSlam(images[0].camera)
        for image in images[1]:
            slam.track_rgbd(image)
        results[name] = slam.trajectory()

    threads = [threading.Thread(target=track, args=[name]) for name in "abc"]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 3
    assert all((results["a"] == results[name]).all() for name in "bc")
    with pytest.raises(ValueError):
        trundle.RgbdSlam("no-such-camera")
