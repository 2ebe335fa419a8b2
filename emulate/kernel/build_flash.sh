#!/bin/sh
# build_flash.sh CACHE_FOLDER [--if-built] - the kernel of build.sh with flash.config too, in a cache folder of its own; prints that folder.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$here/build.sh" "$here/traction_adc.c" "$work/"
awk -v more="$here/flash.config" '/^# --- only in some/ { while ((getline line < more) > 0) print line } { print }' "$here/board.config" >"$work/board.config"
sh "$work/build.sh" "$@"
