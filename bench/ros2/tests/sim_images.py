"""Image pairs of `trundle sim office --ros2` that reach rclpy, with the receive buffer that docs/how-to/ros2.md gives it.

sim_images.py --trundle PATH [--seconds 6] [--raw]. Exit 0: nearly all arrive, or the system refuses the buffer (a line begins with
"skipped: "). `--default-buffer` shows what arrives without it; nothing is checked then.
"""
import argparse
import os
import pathlib
import sys
import tempfile

PROFILE = pathlib.Path(__file__).resolve().parents[3] / "docs/how-to/fastdds-images.xml"
if "--default-buffer" not in sys.argv:
    # Read when Fast DDS is loaded.
    os.environ["FASTDDS_DEFAULT_PROFILES_FILE"] = str(PROFILE)

import goals  # noqa: E402
from harness import Checks, Listener, start_trundle  # noqa: E402
from rclpy.qos import QoSProfile, ReliabilityPolicy  # noqa: E402
from sensor_msgs.msg import CameraInfo, CompressedImage, Image  # noqa: E402

# Receive buffer that the profile asks for, bytes.
BUFFER_BYTES = 4_194_304
# Smallest share of the images that has to arrive (ours).
MIN_SHARE = 0.8
# Best effort, and no message is lost in the reader where this program is slow.
QOS = QoSProfile(depth=1000, reliability=ReliabilityPolicy.BEST_EFFORT)


def main():
    parser = goals.options_of(argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter))
    parser.add_argument("--seconds", type=float, default=6.0)
    parser.add_argument("--raw", action="store_true", help="raw images")
    parser.add_argument("--default-buffer", action="store_true")
    options = parser.parse_args()
    granted = int(pathlib.Path("/proc/sys/net/core/rmem_max").read_text())
    if granted < BUFFER_BYTES and not options.default_buffer:
        print(f"skipped: sim_images: net.core.rmem_max is {granted}, expected {BUFFER_BYTES}: sysctl -w net.core.rmem_max={BUFFER_BYTES}")
        return 0
    options.trundle_arguments = "sim office --ros2" + (" --raw-images" if options.raw else "")
    kind, names = (Image, ("image_raw", "image_raw")) if options.raw else (CompressedImage, ("image_raw/compressed", "image_raw/compressedDepth"))
    topics = [f"camera/{stream}/{name}" for stream, name in zip(("color", "depth"), names)]
    checks, listener = Checks("sim_images"), Listener("sim_images")
    trundle = start_trundle(options, options.out or pathlib.Path(tempfile.mkdtemp(prefix="sim-images-")))
    try:
        for topic in topics:
            listener.listen(kind, topic, QOS, keep=True)
        listener.listen(CameraInfo, "camera/depth/camera_info", 1000, keep=True)
        checks.check("images come", listener.until(lambda: set(topics) <= set(listener.kept), 60))
        listener.kept.clear()
        listener.spin(options.seconds)
    finally:
        trundle.end()
    sent = len(listener.kept.get("camera/depth/camera_info", []))
    for topic in topics:
        arrived = listener.kept.get(topic, [])
        size = sum(len(m.data) for m in arrived) / max(1, len(arrived)) / 1000
        detail = f"{len(arrived)} of {sent}, {size:.0f} kB each"
        checks.check(f"{topic} arrives", options.default_buffer or len(arrived) >= MIN_SHARE * sent - 1, detail)
    return checks.report()


if __name__ == "__main__":
    sys.exit(main())
