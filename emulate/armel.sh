#!/bin/sh
# armel.sh FOLDER - the Debian programs of the board that is flashed (busybox, dropbear and its libraries) for armel, unpacked into FOLDER/root,
# by this system's apt and its sources, beside its own state. Once; a folder that has them is left as it is.
set -eu
folder=$1
[ ! -e "$folder/complete" ] || exit 0
work=$folder.$$
rm -rf "$work"
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/lists/partial" "$work/archives/partial" "$work/root"
: >"$work/status"
apt() {
    apt-get -qq -o APT::Architecture=armel -o APT::Architectures=armel -o Dir::State::Lists="$work/lists" -o Dir::State::Status="$work/status" \
        -o Dir::Cache="$work" -o APT::Sandbox::User=root -o APT::Install-Recommends=false "$@" >>"$work/log" 2>&1
}
if ! apt update; then
    grep '^E:' "$work/log" | head -n 3 >&2
    echo "armel.sh: apt's index of armel cannot be fetched, as while a mirror is being renewed; try again later (the rest of the emulated board needs none of it)" >&2
    exit 1
fi
if ! apt install -y --download-only busybox-static dropbear-bin; then
    tail -n 3 "$work/log" >&2
    echo "armel.sh: apt brings no busybox-static and dropbear-bin for armel (Debian 12 has them)" >&2
    exit 1
fi
for package in "$work"/archives/*.deb; do dpkg-deb -x "$package" "$work/root"; done
rm -rf "$work/lists" "$work/archives" "$work/root/usr/share" "$work/root"/usr/lib/arm-linux-gnueabi/gconv
: >"$work/complete"
rm -rf "$folder"
mv "$work" "$folder"
