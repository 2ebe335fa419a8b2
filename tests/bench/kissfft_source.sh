#!/bin/sh
# Brings KissFFT, the peer of the FFT bench, from the system's own package archive: its source package kissfft, checked by apt against
# the archive's signature. usage: kissfft_source.sh FOLDER; prints the folder that holds kiss_fft.c. Nothing on the system changes:
# apt works on a configuration of its own in FOLDER, made of the system's binary sources of this release turned into source ones.
set -eu
mkdir -p "$1"
out=$(cd "$1" && pwd)
found() { find "$out" -name kiss_fftr.c -not -path '*/test/*' 2> /dev/null | head -n 1; }
unreachable() { echo "KissFFT is left out: $1. KISSFFT=<folder with kiss_fft.c> names one by hand" >&2; exit 1; }
if [ -z "$(found)" ]; then
  command -v apt-get > /dev/null || unreachable "no apt-get here to fetch its source package"
  release=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
  mkdir -p "$out/apt/sources" "$out/apt/lists/partial" "$out/apt/cache/archives/partial"
  for file in /etc/apt/sources.list /etc/apt/sources.list.d/*; do
    [ -f "$file" ] || continue
    grep -Eq "(^|[[:space:]])$release([[:space:]]|$)" "$file" || continue
    sed -E 's/^deb([[:space:]])/deb-src\1/; s/^Types:.*/Types: deb-src/' "$file" > "$out/apt/sources/$(basename "$file")"
  done
  apt="apt-get -qq -o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts=$out/apt/sources -o Dir::State::Lists=$out/apt/lists -o Dir::Cache=$out/apt/cache"
  $apt update > "$out/apt/log" 2>&1 || true # one archive out of reach need not be the one that matters
  (cd "$out" && $apt source --download-only kissfft >> apt/log 2>&1) || unreachable "its source package kissfft cannot be fetched ($out/apt/log)"
  tar -xf "$(find "$out" -maxdepth 1 -name 'kissfft_*.orig.tar.*' -not -name '*.asc' | head -n 1)" -C "$out"
fi
[ -n "$(found)" ] || unreachable "its source package holds no kiss_fftr.c"
dirname "$(found)"
