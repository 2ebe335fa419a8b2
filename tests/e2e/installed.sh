#!/bin/sh
# Installs the tools below a folder, and calls them from another folder with an empty environment.
# usage: installed.sh CMAKE BUILD_FOLDER WORK_FOLDER
set -eu
cmake=$1 build=$2 work=$3
rm -rf "$work"
mkdir -p "$work/elsewhere"
DESTDIR="$work/root" "$cmake" --install "$build" --prefix /usr >"$work/install.log" 2>&1 || { tail -n 5 "$work/install.log"; exit 1; }
usr=$work/root/usr
for file in share/traction/scenarios/demo_sand.toml share/traction/models/rover_sand.toml share/traction/schemas/traction.lab.1.schema.json share/doc/traction/README.md \
    share/doc/traction/docs/tutorial.md share/doc/traction/copyright share/man/man1/traction.1 share/man/man1/traction-simulate.1 \
    share/man/man1/traction-bench-lab.1 share/bash-completion/completions/traction share/zsh/vendor-completions/_traction; do
    [ -s "$usr/$file" ] || { echo "not installed: $file"; exit 1; }
done
cd "$work/elsewhere"
call() {
    code=0
    env -i "$usr/bin/traction" "$@" >out.txt 2>&1 </dev/null || code=$?
}
mv "$usr" "$work/root/opt" # the prefix does not matter: data are found beside the program
usr=$work/root/opt
call simulate cruise --out run.csv
[ $code -eq 0 ] && [ -s run.csv ] || { cat out.txt; exit 1; }
call compare --model rover_sand run.csv
[ $code -eq 0 ] || { cat out.txt; exit 1; }
call game --new 3 --soil sand
[ $code -eq 0 ] && [ -s out/game/run.csv ] || { cat out.txt; exit 1; }
[ ! -e /usr/share/traction ] && [ ! -e /usr/local/share/traction ] || { echo "installed, it runs from any folder"; exit 0; }
# alone, where no folder above it holds data
alone=$(mktemp -d)
trap 'rm -rf "$alone"' EXIT
mkdir "$alone/bin" && cp "$usr/bin/traction" "$alone/bin" && usr=$alone
call game --new 4 --folder out/other
[ $code -eq 3 ] && grep -q TRACTION_ROOT out.txt || { echo "without its data it says: $(cat out.txt)"; exit 1; }
echo "installed, it runs from any folder"
