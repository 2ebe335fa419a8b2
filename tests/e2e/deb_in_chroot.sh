#!/bin/sh
# Packs a .deb, installs it with apt into a fresh minimal chroot of this system's release, runs it there from another folder. Needs
# root, debootstrap and a Debian mirror; run by hand, not by ctest:
#   sh tests/e2e/deb_in_chroot.sh build/host WORK_FOLDER [SUITE [MIRROR]]
set -eu
build=$(cd "$1" && pwd) work=$2 suite=${3-bookworm} mirror=${4-}
[ "$(id -u)" -eq 0 ] || { echo "needs root, for a chroot"; exit 77; }
command -v debootstrap >/dev/null 2>&1 || { echo "needs debootstrap"; exit 77; }
mkdir -p "$work"
work=$(cd "$work" && pwd)
(cd "$work" && cpack -G DEB --config "$build/CPackConfig.cmake" -B "$work") >"$work/cpack.log" 2>&1 || { tail -n 5 "$work/cpack.log"; exit 1; }
deb=$(ls "$work"/traction_*.deb)
dpkg-deb --field "$deb" Package Version Architecture Depends
[ -d "$work/chroot/usr" ] || debootstrap --variant=minbase "$suite" "$work/chroot" ${mirror:+"$mirror"} >"$work/debootstrap.log" 2>&1 ||
    { tail -n 5 "$work/debootstrap.log"; exit 1; }
cp "$deb" "$work/chroot/tmp/traction.deb"
[ ! -e /etc/apt/apt.conf.d ] || cp -n /etc/apt/apt.conf.d/*proxy* "$work/chroot/etc/apt/apt.conf.d/" 2>/dev/null || true
inside() { chroot "$work/chroot" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive "$@"; }
inside apt-get update >"$work/apt.log" 2>&1
inside apt-get install -y --no-install-recommends /tmp/traction.deb >>"$work/apt.log" 2>&1 || { tail -n 5 "$work/apt.log"; exit 1; }
inside sh -euc 'mkdir -p /tmp/elsewhere; cd /tmp/elsewhere; traction --version; traction simulate cruise --out run.csv
    traction compare --model rover_sand run.csv >/dev/null; traction game --new 3 >/dev/null; traction check run.csv | tail -n 1
    test -s /usr/share/bash-completion/completions/traction'
echo "the package runs in a bare $suite"
