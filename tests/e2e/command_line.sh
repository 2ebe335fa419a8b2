#!/bin/sh
# What the command line says and returns: names of what was mistyped, standard output, exit codes, data from any folder.
# usage: command_line.sh CLI WORK_FOLDER PROJECT_ROOT
set -u
cli=$1 work=$2 root=$3
rm -rf "$work"
mkdir -p "$work/far away"
cd "$work/far away" || exit 1
unset TRACTION_ROOT
failures=0
bad() { echo "FAILED: $*"; failures=$((failures + 1)); }

# says CODE PATTERN ARGUMENT...: exits so, and standard error holds the pattern
says() {
    want=$1 pattern=$2
    shift 2
    "$cli" "$@" >stdout.txt 2>stderr.txt </dev/null
    code=$?
    [ "$code" -eq "$want" ] || bad "traction $* exits $code, not $want: $(cat stderr.txt)"
    grep -q -- "$pattern" stderr.txt || bad "traction $* does not say '$pattern': $(cat stderr.txt)"
}

# gives CODE PATTERN ARGUMENT...: exits so, and standard output holds the pattern
gives() {
    want=$1 pattern=$2
    shift 2
    "$cli" "$@" >stdout.txt 2>stderr.txt </dev/null
    code=$?
    [ "$code" -eq "$want" ] || bad "traction $* exits $code, not $want: $(cat stderr.txt)"
    grep -q -- "$pattern" stdout.txt || bad "traction $* does not show '$pattern': $(head -n 20 stdout.txt)"
}

# mistyped
cp "$root/models/rover_sand.toml" a.toml
cp "$root/models/rover_sand.toml" a.csv # is not read: what is wrong is the command line
ln -s a.toml link.toml
says 2 "no verb 'simulte'; did you mean 'simulate'?" simulte
says 2 "no option --ot; did you mean '--out'?" simulate cruise --ot x.csv
says 2 "no option --lgo; did you mean '--log'?" compare --lgo x
says 2 "no effect 'slip_sinkge'; did you mean 'slip_sinkage'?" simulate cruise --effect slip_sinkge:coefficient=0.2
says 2 "no effect 'bcklash'; did you mean 'backlash'?" effects bcklash
says 2 "no effect 'bcklash'; did you mean 'backlash'?" next --model rover_sand --effects bcklash
says 2 "there is no 'lap'; did you mean 'lab'?" bench lap
says 2 "--logs 0: give 1 to" bench lab --logs 0
says 2 "needs LOG or --log LOG" compare --model rover_sand
says 2 "give a whole number" simulate cruise --seed x
says 2 "is given twice" check a.csv --log b.csv
says 2 "one argument too many" effects backlash torque_ripple
says 2 "name the same file" simulate cruise --out same.csv --truth ./same.csv
says 2 "name the same file" simulate cruise --out same.csv --radar same.csv
for out in "--out a.toml" "--json ./a.toml" "--out link.toml"; do
    # shellcheck disable=SC2086 # two words
    says 2 "names a file that is read" fit --model a.toml --log a.csv $out
done
says 2 "names a file that is read" convert a.csv --out a.csv
says 2 "names a file that is read" simulate a.toml --out a.toml
says 2 "names a file that is read" recover a.csv --out a.csv
says 2 "names a file that is read" add backlash --model a.toml --log a.csv --out a.toml
cmp -s a.toml "$root/models/rover_sand.toml" || bad "a refused command line changed a file"
rm a.toml a.csv link.toml
says 2 "give one of default, paper; did you mean 'paper'?" simulate cruise --firmware papr
says 2 "give a verb" # nothing at all
[ -e same.csv ] && bad "a refused command line made a file"

# missing files are named
says 4 "no_model.toml" history --model no_model.toml
says 4 "No such file or directory" compare --model no_model.toml --log x.csv
says 4 "no_log.csv" check no_log.csv
says 4 "no_scenario.toml" simulate no_scenario.toml
says 4 "no_rover: cannot be read: No such file or directory" simulate cruise --believes no_rover
says 4 "no/such/run.csv: cannot be written: No such file" simulate cruise --out no/such/run.csv

# one drive given twice is no second one
gives 0 "log in drive.csv" simulate cruise --out drive.csv --for 8
cp drive.csv copy.csv
for option in "--log copy.csv" "--validate copy.csv" "--repeat drive.csv"; do
    # shellcheck disable=SC2086 # two words
    says 3 "holds the same samples as drive.csv" fit --model rover_sand --log drive.csv $option
done
rm drive.csv copy.csv

# the radar's samples apart
gives 0 "log in few.csv" simulate cruise --out few.csv --radar radar.csv --for 4
gives 0 "1 run, 4.0 s" simulate cruise --seed 9 --radar radar9.csv --for 4
says 3 "give the file that has them with --radar" replay few.csv
says 3 "seed is 9, of the log 4" replay few.csv --radar radar9.csv
says 3 "there is no column radar.adc_count" replay few.csv --radar few.csv
gives 0 "400 ticks replayed: every trace equals" replay few.csv --radar radar.csv
gives 0 "2048 samples at 512 Hz" speed radar.csv

# scenarios and models from any folder; what was not kept is told
gives 0 "the log was not kept; --out LOG keeps it" simulate scenarios/cruise.toml
gives 0 "log in run.csv" simulate cruise --out run.csv
"$cli" simulate "$root/scenarios/cruise.toml" --out again.csv >/dev/null && cmp run.csv again.csv || bad "a short name drives another run"
mkdir cruise
gives 0 "log in run.csv" simulate cruise --out run.csv # a folder of that name is no scenario
rmdir cruise
gives 0 "no history" history --model models/rover_sand.toml
gives 0 "wrote heavy_model.toml" rover heavy --soil gravel --model heavy_model.toml
gives 0 "log in heavy.csv" simulate cruise --rover heavy --out heavy.csv
sed 's/^radius_m = { value = 0.057/radius_m = { value = 0.063/' "$root/rovers/lhomme_desages.toml" >wrong.toml
gives 0 "log in wrong.csv" simulate cruise --believes wrong.toml --out wrong.csv
cmp -s wrong.csv run.csv && bad "a firmware that is wrong about its wheels drives as one that is right"
says 2 "there is no verb" ""

# a search that finds nothing is a negative answer
"$cli" simulate demo_sand --seed 5 --out clean.csv >/dev/null
status=0
"$cli" diagnose --model rover_sand clean.csv >out.txt 2>&1 || status=$?
[ $status -eq 1 ] && grep -q "Nothing found" out.txt || bad "diagnose of a clean log ends with $status: $(tail -n 1 out.txt)"

# the log as argument and as --log
for verb in check replay "compare --model rover_sand" "plot --out p.svg --signals estimate.speed_m_s" "convert --out c.csv"; do
    "$cli" $verb run.csv >as_argument.txt 2>&1
    one=$?
    "$cli" $verb --log run.csv >as_option.txt 2>&1
    [ $? -eq $one ] && [ $one -le 1 ] && cmp -s as_argument.txt as_option.txt || bad "$verb LOG and $verb --log LOG differ"
done
says 3 "clean.csv: --from: 500 s is behind the log's end; the log goes from 0" diagnose --model rover_sand clean.csv --from 500
says 3 "clean.csv: --from: 30 s is not before --to 10" compare --model rover_sand clean.csv --from 30 --to 10
says 3 "clean.csv: --to: -3 s is no time" fit --model rover_sand clean.csv --to -3
says 3 "nearest are estimate.speed_m_s" plot run.csv --signals estimat.speed_m_s --out p.svg

# standard output
"$cli" simulate cruise --out - 2>words.txt >out.csv || bad "--out - fails"
cmp -s out.csv run.csv || bad "--out - gives another log"
grep -q "simulated in" words.txt || bad "the words are lost when the log goes to standard output"
"$cli" effects backlash --json - 2>/dev/null | head -n 1 | grep -qx '{' || bad "--json - is no JSON alone"
[ -e ./- ] && bad "a file named - was made"
"$cli" simulate cruise --out /dev/stdout 2>/dev/null | cmp -s - run.csv || bad "--out /dev/stdout gives another log"
"$cli" check run.csv --quiet >quiet.txt 2>&1
[ $? -le 1 ] && [ ! -s quiet.txt ] || bad "--quiet speaks: $(cat quiet.txt)"
if [ -c /dev/full ]; then
    "$cli" effects >/dev/full 2>stderr.txt
    [ $? -eq 4 ] && grep -q "No space left" stderr.txt || bad "a full disk on standard output is no error"
    for words in man "man simulate" "completion bash" "--help"; do # longer than a buffer, and shorter
        "$cli" $words >/dev/full 2>stderr.txt
        [ $? -eq 4 ] && grep -q "standard output: cannot be written: No space left" stderr.txt || bad "$words on a full disk says $(cat stderr.txt)"
    done
    "$cli" simulate cruise --out /dev/full >/dev/null 2>stderr.txt
    [ $? -eq 4 ] && grep -q "/dev/full: cannot be written: No space left" stderr.txt || bad "--out /dev/full is no error"
    [ -c /dev/full ] || bad "/dev/full was replaced"
fi
"$cli" effects >&- 2>/dev/null
[ $? -eq 4 ] || bad "a closed standard output is no error"
"$cli" --help >&- 2>/dev/null
[ $? -eq 4 ] || bad "--help on a closed standard output is no error"
mkfifo reader_gone
(exec 3<reader_gone) & # opens, closes, reads nothing
("$cli" effects --json - ; echo $? >code.txt) 2>/dev/null >reader_gone
wait
[ "$(cat code.txt)" -ne 0 ] || bad "a reader that goes away is no error"

# two runs, one name: one of them is refused or comes later; what stands there is one whole log
"$cli" simulate cruise --seed 1 --out both.csv >/dev/null 2>one.txt &
first=$!
"$cli" simulate cruise --seed 2 --out both.csv >/dev/null 2>two.txt
second_code=$?
wait $first
first_code=$?
for seed in 1 2; do "$cli" simulate cruise --seed $seed --out seed$seed.csv >/dev/null; done
cmp -s both.csv seed1.csv || cmp -s both.csv seed2.csv || bad "two runs mixed their log"
case "$first_code $second_code" in
    "0 0") ;;
    "4 0") grep -q "is being written by another run" one.txt || bad "refused without a word" ;;
    "0 4") grep -q "is being written by another run" two.txt || bad "refused without a word" ;;
    *) bad "two runs with one name exit $first_code and $second_code" ;;
esac

# a run that is ended by the loss of its terminal leaves no log, and what makes one
"$cli" simulate cruise --realtime --out ended.csv >/dev/null 2>&1 &
run=$!
for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do [ -e .ended.csv.lock ] && break; sleep 0.2; done
[ -e .ended.csv.lock ] || bad "a run does not lock its log"
"$cli" simulate cruise --out ended.csv >/dev/null 2>stderr.txt
[ $? -eq 4 ] && grep -q "is being written by another run" stderr.txt || bad "a second run is not refused: $(cat stderr.txt)"
kill -HUP $run
wait $run 2>/dev/null
[ $? -eq 0 ] && bad "a killed run exits 0"
left=$(ls -A | grep "ended.csv" | tr '\n' ' ')
[ -z "$left" ] || [ "$left" = "ended.csv.part " ] || bad "a killed run leaves $left"
"$cli" simulate cruise --realtime --out ended.csv >/dev/null 2>&1 &
run=$!
for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do [ -s ended.csv.part ] && break; sleep 0.2; done
kill -HUP $run
wait $run 2>/dev/null
gives 0 "ended: interrupted" recover ended.csv.part --out ended.csv # a run at the clock's pace keeps what it has every second
rm -f ended.csv.part

# a full disk: a small file system of its own, where the system lets us make one
mkdir tiny
if [ "$(id -u)" -eq 0 ] && unshare -m true 2>/dev/null; then
    unshare -m sh -c 'mount -t tmpfs -o size=200k none tiny || exit 77
        echo old >tiny/run.csv
        "$1" simulate cruise --out tiny/run.csv >/dev/null 2>stderr.txt
        code=$?
        [ "$(ls -A tiny | tr "\n" " ")" = "run.csv run.csv.part " ] && [ "$(cat tiny/run.csv)" = old ] || exit 5
        "$1" recover tiny/run.csv.part --out saved.csv >/dev/null || exit 6
        exit $code' sh "$cli"
    code=$?
    case $code in
        77) ;; # no mounts here
        4) grep -q "tiny/run.csv: cannot be written: No space left on device.* traction recover .*tiny/run.csv.part" stderr.txt || bad "a full disk is told as $(cat stderr.txt)" ;;
        *) bad "a full disk ends with $code" ;;
    esac
fi

# answers
"$cli" simulate "$root/scenarios/fig16_blocked_wheels.toml" --quiet --json fault.json
code=$?
if grep -q '"fault_names": ""' fault.json; then want=0; else want=1; fi
[ $code -eq $want ] || bad "a run with $(grep fault_names fault.json) exits $code"
sed 's/^name = .*/name = "cut off"/' "$root/scenarios/cruise.toml" >fault.toml
printf '\n[[fault]]\nwhat = "emergency_stop"\nfrom_s = 2\nto_s = 60\n' >>fault.toml
gives 1 "ended with a latched fault: emergency stop" simulate fault.toml

# a signal ends a run, and its log is whole and says so; each run of several hides an effect of its own
sed 's/^duration_s = .*/duration_s = 3000/' "$root/scenarios/cruise.toml" >long.toml
"$cli" simulate long.toml --quiet --out long.csv --truth long_truth.csv 2>/dev/null &
sleep 1
kill -TERM $!
code=0
wait $! || code=$?
[ $code -eq 143 ] || bad "a run stopped by SIGTERM exits $code"
grep -q '^# ended: interrupted$' long.csv || bad "the log does not say that it was interrupted"
gives 0 '"interrupted"' check long.csv --json -
[ "$(ls -A | grep long | tr '\n' ' ')" = "long.csv long.toml long_truth.csv " ] || bad "a stopped run leaves $(ls -A | grep long)"
[ "$(head -n 100 long.csv | grep '^t_s' | tr -cd , | wc -c)" -eq "$(tail -n 1 long.csv | tr -cd , | wc -c)" ] || bad "the last row is cut"
# and takes no place of a log that stood already: the run is kept as its part
cp long.csv stood.csv
cp long_truth.csv stood_truth.csv
code=0
"$cli" simulate long.toml --out long.csv --truth long_truth.csv >stopped.txt 2>&1 &
sleep 1
kill -TERM $!
wait $! || code=$?
[ $code -eq 143 ] || bad "a run stopped by SIGTERM exits $code, beside a log"
cmp -s stood.csv long.csv && cmp -s stood_truth.csv long_truth.csv || bad "a run that was stopped replaces a log"
grep -q 'long.csv stood already and is as it was; what this run had: traction recover .long.csv.part. --out NEW' stopped.txt || bad "not told where the run went: $(cat stopped.txt)"
gives 0 "ended: interrupted" recover long.csv.part --out anew.csv
gives 0 '"interrupted"' check anew.csv --json -
rm -f long.csv.part long_truth.csv.part anew.csv stood.csv stood_truth.csv stopped.txt
# 1000 s with log and truth, and of the radar's samples alone, in 100 MB of address space
sed 's/^duration_s = .*/duration_s = 1000/' "$root/scenarios/cruise.toml" >long.toml
(ulimit -v 100000 && "$cli" simulate long.toml --quiet --out long.csv --truth long_truth.csv) || bad "memory grows with the run"
(ulimit -v 100000 && "$cli" simulate long.toml --quiet --radar long_radar.csv) || bad "memory grows with a run of which the radar alone is kept"
rm -f long.csv long_truth.csv long_radar.csv
gives 0 '' simulate "$root/scenarios/cruise.toml" --seeds 3..5 --jobs 2 --hide 7 --seal seal.json --out many.csv
"$cli" simulate "$root/scenarios/cruise.toml" --quiet --seed 4 --hide 8 --seal alone.json --out alone.csv
cmp many.4.csv alone.csv && cmp seal.4.json alone.json || bad "the second run does not hide what the next seed says"
! cmp -s seal.3.json seal.4.json || bad "two runs hide the same"

# a benchmark is a program of its own: its table, its JSON and its exit code come through
gives 0 '"schema": "traction.bench_lab/1"' bench lab --logs 1 --duration 20 --json -
grep -q '1 sealed logs, generator: independent, 20 s each' stderr.txt || bad "bench lab shows no table: $(cat stderr.txt)"

# pages
gives 0 "^traction [0-9.]* (commit " --version
gives 0 "Usage: traction simulate SCENARIO" simulate --help
gives 0 "Usage: traction bench lab" help bench lab
"$cli" completion bash >completion.bash && bash -n completion.bash || bad "the completion is no bash"
bash -c '. ./completion.bash; COMP_WORDS=(traction simulate cruise --effect slip_s); COMP_CWORD=4; _traction; [ "${COMPREPLY[*]}" = slip_sinkage ]' ||
    bad "bash completes no effect"
bash -c '. ./completion.bash; COMP_WORDS=(traction sim); COMP_CWORD=1; _traction; [ "${COMPREPLY[*]}" = simulate ]' || bad "bash completes no verb"
bash -c '. ./completion.bash; COMP_WORDS=(traction bench lab --ge); COMP_CWORD=3; _traction; [ "${COMPREPLY[*]}" = --generator ]' ||
    bad "bash completes no option"
"$cli" completion zsh >_traction || bad "no zsh completion"
if command -v zsh >/dev/null 2>&1; then zsh -n _traction || bad "the completion is no zsh"; fi
for verb in $("$cli" --help | sed -n 's/^  \([a-z][a-z]*\) .*/\1/p'); do
    [ "$verb" = bench ] && continue
    grep -q "'$verb')" completion.bash && grep -q "'$verb')" _traction || bad "$verb is not completed"
    "$cli" man "$verb" | grep -q '^\.SH OPTIONS' || bad "no manual page of $verb"
    "$cli" "$verb" --help | grep -q -- "--json FILE" || bad "no --json in the help of $verb"
done
if command -v groff >/dev/null 2>&1; then
    "$cli" man simulate | groff -man -Tascii -ww 2>groff.txt >/dev/null
    [ ! -s groff.txt ] || bad "the manual page is no roff: $(head -n 3 groff.txt)"
fi

# one writer, one file that knows the parser
grep -rnE 'ofstream|fopen\([^)]*"[wa]' "$root/host_tools" "$root/sim" "$root/hal" --include='*.cpp' --include='*.c' --include='*.h' &&
    bad "a file is written without host_tools/log/write_file.h"
[ "$(grep -rl 'CLI/CLI.hpp' "$root/host_tools" | wc -l)" -eq 1 ] || bad "more than one file includes CLI11"

ls -A | grep -E '\.part$|\.lock$' && bad "temporaries are left"
[ "$failures" -eq 0 ] || { echo "$failures failed"; exit 1; }
echo "the command line answers as written"
