#!/bin/sh
# Gets the libraries of camera makers for the tests of trundle-drivers, without installing them.
# Usage: bench/drivers/get-native-libraries.sh [FOLDER]
# FOLDER: default target/native-libraries. Needs python3 with pip, apt-get and dpkg-deb, and a network.
# A library that cannot be had is named; its tests are then skipped by name.
set -u
folder=${1:-${CARGO_TARGET_DIR:-target}/native-libraries}
mkdir -p "$folder/python" "$folder/packages" "$folder/debian"
folder=$(cd "$folder" && pwd)
missing=0

for wheel in pyrealsense2==2.59.1.11053 pyorbbecsdk2==2.1.2; do
    python3 -m pip install --quiet --no-deps --upgrade --target "$folder/python" "$wheel" ||
        { echo "get-native-libraries: no wheel $wheel for $(python3 --version)" >&2; missing=1; }
done

# An older librealsense, which records .bag; the newer one records .db3 and plays both.
wheel=pyrealsense2==2.55.1.6486
python3 -m pip install --quiet --no-deps --upgrade --target "$folder/python-bag" "$wheel" ||
    { echo "get-native-libraries: no wheel $wheel for $(python3 --version)" >&2; missing=1; }

cd "$folder/packages" || exit 1
for package in libusb-1.0-0 libfreenect0.5 libopenni2-0 libjpeg62-turbo; do
    apt-get download "$package" ||
        { echo "get-native-libraries: no Debian package $package" >&2; missing=1; }
done
for file in *.deb; do
    [ -e "$file" ] && dpkg-deb -x "$file" "$folder/debian"
done
exit $missing
