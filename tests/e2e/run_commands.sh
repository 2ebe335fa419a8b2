#!/bin/sh
# Runs every ./traction command of a Markdown file's ```sh blocks, in order, in a folder of its own that sees scenarios/ and
# models/; stops at the first that fails. `test` and `build` are left out: they are what runs this.
# With SCENARIO and SECONDS that scenario ends earlier: the commands are the same, and take less time.
# usage: run_commands.sh DOCUMENT CLI WORK_FOLDER PROJECT_ROOT [SCENARIO SECONDS]
set -eu
file=$1 cli=$2 work=$3 root=$4
rm -rf "$work"
mkdir -p "$work/run"
ln -s "$root/../shared" "$work/" # the link is inside the folder of its own, so that two documents at once do not meet
cd "$work/run"
ln -s "$root/models" .
cp -R "$root/scenarios" .
[ $# -lt 6 ] || sed -i "s/^duration_s = .*/duration_s = $6/" "scenarios/$5.toml"
awk '/^```sh$/ { inside = 1; next } /^```/ { inside = 0 } inside && /^\.\/traction / { sub(/[ \t]+#.*$/, ""); print }' "$file" >commands
count=0
while read -r command; do
    set -- $command
    case $2 in test | build) continue ;; esac
    count=$((count + 1))
    echo "+ $command"
    sh -c "$(printf '%s' "$command" | sed "s|^\./traction|$cli|")" </dev/null || { echo "failed (exit $?): $command"; exit 1; }
done <commands
[ "$count" -gt 0 ] || { echo "no command found in $file"; exit 1; }
echo "$count commands of $(basename "$file") ran"
