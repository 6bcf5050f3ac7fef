#!/usr/bin/env bash
# Prints the path of Debian's mosquitto: the installed one, or one that is unpacked into FOLDER without installing it.
# usage: get-broker.sh FOLDER
set -euo pipefail
folder=$1
if command -v mosquitto || [ -x /usr/sbin/mosquitto ]; then
    [ -x /usr/sbin/mosquitto ] && ! command -v mosquitto >/dev/null && echo /usr/sbin/mosquitto
    exit 0
fi
mkdir -p "$folder"
cd "$folder"
if [ ! -x root/usr/sbin/mosquitto ]; then
    apt-get download mosquitto libdlt2 libwrap0 >&2
    for package in *.deb; do dpkg-deb -x "$package" root; done
fi
broker=$PWD/root/usr/sbin/mosquitto
libraries=$(echo "$PWD"/root/usr/lib/*-linux-gnu)
LD_LIBRARY_PATH=$libraries "$broker" -h >/dev/null 2>&1 || [ $? -eq 3 ] || exit 1
printf '#!/bin/sh\nLD_LIBRARY_PATH=%s exec %s "$@"\n' "$libraries" "$broker" > mosquitto
chmod +x mosquitto
echo "$PWD/mosquitto"
