"""mutate_lab - how many small faults in the lab's decision code (mutate_lab.sh) or in the simulator (mutate_sim.sh) do their tests notice?

Every file is rewritten once with all its faults in it, each asleep behind a switch (mutant.h), so that they are compiled once and a fault costs
one run of the tests. Faults: relation, logic, sign and product exchanged, a constant doubled, halved, one more or less, a condition always or
never true, std::min for std::max, a statement left out. What does not compile is dropped; what no test comes by counts as survived, "not
reached". Each test is run once without a fault to learn which it comes by and how long it takes; a fault is then shown to those tests alone, the quickest
first, until one fails. A seeded sample is judged, within a budget of minutes; verdicts are kept in OUT/verdicts.tsv, and the next run goes on
from there as long as neither sources nor tests have changed.
"""

import argparse
import hashlib
import json
import os
import pathlib
import random
import re
import shlex
import subprocess
import sys
import time

FOLDERS = ["host_tools/lab/decision", "host_tools/lab/fit"]
EXCHANGE = {" < ": [" <= ", " >= "], " <= ": [" < "], " > ": [" >= ", " <= "], " >= ": [" > "], " == ": [" != "], " != ": [" == "],
            " && ": [" || "], " || ": [" && "], " + ": [" - "], " - ": [" + "], " * ": [" / "], " / ": [" * "],
            "std::max(": ["std::min("], "std::min(": ["std::max("], "true": ["false"], "false": ["true"]}
PIECE = re.compile("|".join(sorted((re.escape(key) if key.strip() != key or key.endswith("(") else rf"\b{key}\b" for key in EXCHANGE),
                                   key=len, reverse=True)))
QUICK_S = 0.5  # of a test's run by itself
NUMBER = re.compile(r"(?<![\w.\"])(\d+\.\d*(?:[eE][-+]?\d+)?|\d+[eE][-+]?\d+|\d+)(?![\w.])")


def strip_comment(line):
    inside = False
    for at, char in enumerate(line):
        if char == '"' and line[at - 1] != "\\":
            inside = not inside
        if not inside and line.startswith("//", at):
            return line[:at].rstrip()
    return line.rstrip()


def balanced_end(text, start):
    """Index behind the bracket that closes the one at `start`; -1 where none does."""
    depth, inside = 0, False
    for at in range(start, len(text)):
        char = text[at]
        if char == '"' and text[at - 1] != "\\":
            inside = not inside
        if inside:
            continue
        depth += (char in "([{") - (char in ")]}")
        if depth == 0:
            return at + 1
    return -1


def split_top(text, separator):
    """(start, end) of the parts of `text` between separators that stand in no bracket."""
    parts, start, depth = [], 0, 0
    for at, char in enumerate(text):
        depth += (char in "([{") - (char in ")]}")
        if char == separator and depth == 0:
            parts.append((start, at))
            start = at + 1
    return parts + [(start, len(text))]


def changes(expression, is_condition):
    """Mutated forms of an expression."""
    quoted = [match.span() for match in re.finditer(r'"(?:[^"\\]|\\.)*"', expression)]
    free = lambda at: not any(low <= at < high for low, high in quoted)
    out = []
    for match in PIECE.finditer(expression):
        if free(match.start()):
            out += [expression[:match.start()] + new + expression[match.end():] for new in EXCHANGE[match.group(0)]]
    for match in NUMBER.finditer(expression):
        if not free(match.start()):
            continue
        old = match.group(1)
        if "." in old and float(old) == 0:  # neither doubled nor halved it is another
            out.append(expression[:match.start()] + "1.0" + expression[match.end():])
            continue
        news = [f"{2 * float(old):g}" if "." in old or "e" in old.lower() else str(int(old) + 1)]
        news += [f"{0.5 * float(old):g}"] if "." in old or "e" in old.lower() else [str(int(old) - 1)] if int(old) > 0 else []
        out += [expression[:match.start()] + (new if "." in new or "e" in new or "." not in old and "e" not in old.lower() else new + ".0")
                + expression[match.end():] for new in news]
    return out + (["true", "false"] if is_condition else [])


def expressions(text):
    """(start, end, is_condition) of what may be exchanged in a statement; [] and a deletion where it may be left out."""
    body = text.lstrip()
    lead = len(text) - len(body)
    found = re.match(r"(?:\} else )?(?:if|while) \(|for \(", body)
    if found:
        opening = lead + body.index("(")
        end = balanced_end(text, opening)
        if end < 0:
            return [], False
        inner = text[opening + 1:end - 1]
        parts = split_top(inner, ";")
        out = []
        if body.startswith("for"):
            if len(parts) == 3 and inner[parts[1][0]:parts[1][1]].strip():
                low, high = parts[1]
                out.append((opening + 1 + low + 1, opening + 1 + high, False))
        elif len(parts) == 1:
            out.append((opening + 1, end - 1, True))
        rest = text[end:]
        if rest.strip() and rest.strip() != "{":
            more, _ = expressions(rest)
            out += [(low + end, high + end, condition) for low, high, condition in more]
        return out, False
    if not body.endswith(";") or "[&" in body or "[=" in body or "[this" in body or body.startswith(("using", "#", "class", "struct", "case")):
        return [], False
    if body.startswith("return "):
        return [(lead + 7, len(text) - 1, False)], False
    if re.match(r"(?:static |inline |constexpr |const )*[\w:<>, *&]+? [*&]?\w+(?:\[\])? = ", body) and not re.match(r"[\w.\->\[\]()]+ [-+*/|&]?= ", body):
        out, at = [], lead
        for low, high in split_top(text[lead:-1], ","):
            part = text[lead + low:lead + high]
            sign = part.find(" = ")
            if sign >= 0 and "{" not in part:
                out.append((lead + low + sign + 3, lead + high, False))
        return out, False
    assigned = re.match(r"[\w.\->\[\]()*]+ [-+*/|&]?= ", body)
    if assigned:
        return ([] if "{" in body or len(split_top(body, ",")) > 1 else [(lead + assigned.end(), len(text) - 1, False)]), True
    return [], bool(re.match(r"(?:\+\+|--)?[\w.:\->\[\]()*]+(?:\(.*\))?(?:\+\+|--)?;$", body)) and not body.startswith(("return", "break", "continue"))


def statements(lines):
    """(first line, number of lines, text) of what begins on a line and is closed."""
    at = 0
    while at < len(lines):
        text, used = strip_comment(lines[at]), 1
        while text.strip() and not text.rstrip().endswith((";", "{", "}", ":", ">")) and not text.lstrip().startswith("#") and used < 6 and at + used < len(lines):
            text += " " + strip_comment(lines[at + used]).strip()
            used += 1
        while text.count("(") != text.count(")") and used < 6 and at + used < len(lines) and text.rstrip().endswith(";"):
            text += " " + strip_comment(lines[at + used]).strip()
            used += 1
        yield at, used, text
        at += used


class Source:
    def __init__(self, path, root, first_number):
        self.path, self.name = path, str(path.relative_to(root))
        self.lines = path.read_text().splitlines()
        self.mutants = {}  # number: (line, old, new)
        self.plan = {}     # line: (used, text, [(low, high, [(number, new)])], number that leaves it out or 0)
        number, in_table = first_number, False
        for at, used, text in statements(self.lines):
            if in_table or re.search(r"\] = \{", text):  # a table of numbers: data, and constant
                in_table = not text.rstrip().endswith("};")
                continue
            places, may_go = expressions(text)
            entries = []
            for low, high, condition in places:
                these = []
                for new in changes(text[low:high], condition):
                    these.append((number, new))
                    self.mutants[number] = (at + 1, text[low:high].strip(), new.strip())
                    number += 1
                if these:
                    entries.append((low, high, these))
            gone = 0
            if may_go:
                gone = number
                self.mutants[number] = (at + 1, text.strip(), "(left out)")
                number += 1
            if entries or gone:
                self.plan[at] = (used, text, entries, gone)
        self.next_number = number

    def write(self, target):
        out, at = ['#include "tests/mutate/mutant.h"', f'#line 1 "{self.name}"'], 0
        while at < len(self.lines):
            if at not in self.plan:
                out.append(self.lines[at])
                at += 1
                continue
            used, text, entries, gone = self.plan[at]
            for low, high, these in sorted(entries, reverse=True):
                switch = " : ".join(f"traction::mutant::on({number}) ? ({new.strip()})" for number, new in these)
                text = f"{text[:low]}({switch} : ({text[low:high].strip()})){text[high:]}"
            text = text.replace("static constexpr ", "inline static const ") if entries else text
            text = text.replace("constexpr ", "const ") if entries else text
            if gone:
                text = f"if (!traction::mutant::on({gone})) {text.strip()}"
            out += [text] + [""] * (used - 1)
            at += used
        target.write_text("\n".join(out) + "\n")

    def drop(self, lines):
        """Leaves out what does not compile: the statements on these lines."""
        for at in [at for at, (used, *_) in self.plan.items() if any(at < line <= at + used for line in lines)]:
            for low, high, these in self.plan[at][2]:
                for number, _ in these:
                    self.mutants.pop(number, None)
            self.mutants.pop(self.plan[at][3], None)
            del self.plan[at]


def run(command, timeout=None, **environment):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", timeout=timeout, env=dict(os.environ, **environment))


def compile_mutated(source, command, target, name, headers):
    """Rewrites and compiles until what is left compiles. Returns the object; the one that is there, where nothing has changed."""
    object_file = target.with_suffix(".o")
    kept = target.with_suffix(".kept")  # stamp of what the object was made of, and the lines that were dropped on the way
    known = json.loads(kept.read_text()) if kept.exists() and object_file.exists() else {}
    source.write(target)
    stamp = hashlib.sha256((headers + " ".join(command) + target.read_text()).encode()).hexdigest()
    dropped = []
    if known.get("stamp") == stamp:
        for lines in known["dropped"]:
            source.drop(set(lines))
        source.write(target)
        return object_file
    for _ in range(40):
        source.write(target)
        words = [word for word in command if not word.endswith("ccache")] + ["-fmax-errors=0", "-w"]
        done = run(words + ["-fsyntax-only", str(target)])
        if done.returncode == 0:
            done = run(words + ["-O1", "-c", str(target), "-o", str(object_file)])
        if done.returncode == 0:
            kept.write_text(json.dumps({"stamp": stamp, "dropped": dropped}))
            return object_file
        bad = {int(match.group(1)) for match in re.finditer(re.escape(source.name) + r":(\d+):\d+: (?:fatal )?error", done.stdout)}
        bad |= {int(match.group(1)) for match in re.finditer(re.escape(source.name) + r":(\d+):\d+:   required from", done.stdout)}
        before = len(source.plan)
        source.drop(bad)
        dropped.append(sorted(bad))
        if len(source.plan) == before:  # said of a line that bears no fault: the nearest above it
            above = [at for at in source.plan if any(at < line for line in bad)]
            source.drop({max(above) + 1} if above else set())
            dropped.append([max(above) + 1] if above else [])
        if len(source.plan) == before:
            sys.exit(f"{name}: {source.name} does not compile:\n{done.stdout[:3000]}")
    sys.exit(f"{name}: {source.name} does not come to compile")


def build_commands(build, target):
    text = run(["ninja", "-C", str(build), "-t", "commands", target]).stdout
    return text.splitlines()


def tests_of(program):
    """Names of a program's tests, as --gtest_filter takes them."""
    names, suite = [], ""
    for line in run([str(program), "--gtest_list_tests"]).stdout.splitlines():
        name = line.split("#")[0].strip()
        if line.startswith("  "):
            names.append(suite + name)
        elif name.endswith("."):
            suite = name
    return names


def rounds_of(tests, seconds):
    """[(program, names)] that a fault is shown to in turn: what is quick, a program at once; then one by one, the quickest first."""
    quick, slow = {}, []
    for program, name in sorted(tests, key=lambda test: seconds[test]):
        if seconds[program, name] < QUICK_S:
            quick.setdefault(program, []).append(name)
        else:
            slow.append((program, [name]))
    return sorted(quick.items(), key=lambda one: sum(seconds[one[0], name] for name in one[1])) + slow


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--root", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--build", type=pathlib.Path, required=True, help="a configured and built tree")
    parser.add_argument("--tests", nargs="+", required=True, help="judges, the quickest first")
    parser.add_argument("--mutants", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=60)
    parser.add_argument("--folders", nargs="+", default=FOLDERS)
    parser.add_argument("--slowest", type=float, default=1e9, help="seconds: a test that takes longer is no judge")
    parser.add_argument("--name", default="mutate_lab", help="how the run calls itself")
    parser.add_argument("--only", default="", help="files whose name holds this (a regular expression)")
    options = parser.parse_args()
    root, out, build = options.root.resolve(), options.out.resolve(), options.build.resolve()
    began = time.monotonic()
    out.mkdir(parents=True, exist_ok=True)

    commands = [line for test in options.tests for line in build_commands(build, test)]
    sources, number = [], 1
    headers = "".join(path.read_text() for folder in ("host_tools/lab", "sim", "tests/mutate") for path in sorted((root / folder).rglob("*.h")))
    for folder in options.folders:
        for path in sorted((root / folder).rglob("*.cpp")):
            source = Source(path, root, number)
            sources.append(source)
            number += max(4000, source.next_number - number)  # a file's faults keep their numbers when another changes
    objects = []
    for source in sources:
        if not re.search(options.only, source.name):  # not asked for: as built, and its faults keep their numbers
            continue
        line = next((line for line in commands if line.rstrip().endswith(f"-c {root / source.name}")), None)
        if line is None:
            continue
        words = shlex.split(line)
        keep, skip = [], False
        for word in words[:words.index("-c")]:  # flags alone: no outputs, no dependency files, no -E env prefix of the launcher
            if skip or word in ("-MD",):
                skip = False
                continue
            if word in ("-MT", "-MF", "-o"):
                skip = True
                continue
            keep.append(word)
        compiler = next(at for at, word in enumerate(keep) if re.search(r"(?:c\+\+|g\+\+|clang\+\+)(?:-\d+)?$", word))
        flags = [word for word in keep[compiler:] if word not in ("-Winvalid-pch",)]
        flags = [flag for at, flag in enumerate(flags) if not flag.endswith("cmake_pch.hxx") and not (flag == "-include" and flags[at + 1].endswith("cmake_pch.hxx"))]
        target = out / (source.name.replace("/", "_"))
        library = re.search(r"-o \S*/(\w+)\.dir/", line).group(1)
        objects.append((library, str(compile_mutated(source, flags + [f"-I{(root / source.name).parent}", f"-I{root}"], target, options.name, headers))))
        print(f"{options.name}: {source.name}: {len(source.mutants)} faults", flush=True)

    judges = []
    for test in options.tests:
        link = shlex.split(build_commands(build, test)[-1].removeprefix(": && ").removesuffix(" && :"))
        at = link.index("-o")
        program = out / test
        link[at + 1] = str(program)
        used = [path for library, path in objects if any(word.endswith(f"lib{library}.a") for word in link)]
        done = subprocess.run(link[:at] + used + link[at:], cwd=build, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != 0:
            sys.exit(f"{options.name}: {test} cannot be linked:\n{done.stdout[-3000:]}")
        judges.append(program)

    os.chdir(root)
    reached, seconds = {}, {}  # of each test
    for program in judges:
        for name in tests_of(program):
            start = time.monotonic()
            (out / "reached").unlink(missing_ok=True)
            done = run([str(program), "--gtest_brief=1", f"--gtest_filter={name}"], TRACTION_MUTANT_REACHED=str(out / "reached"))
            if done.returncode != 0:
                sys.exit(f"{options.name}: {program.name} {name} fails without any fault:\n{done.stdout[-1500:]}")
            seconds[program, name] = time.monotonic() - start
            if seconds[program, name] > options.slowest:
                continue
            there = (out / "reached").exists()  # a test that comes by no fault writes none
            reached[program, name] = {int(line) for line in (out / "reached").read_text().split()} if there else set()
    # a constant is come by before main(): it is shown to the tests that come by anything else of its file
    at_start = set()
    for program in judges:
        (out / "reached").unlink(missing_ok=True)
        run([str(program), "--gtest_filter=-*"], TRACTION_MUTANT_REACHED=str(out / "reached"))
        at_start |= {int(line) for line in (out / "reached").read_text().split()} if (out / "reached").exists() else set()
    for source in sources:
        constants = at_start & source.mutants.keys()
        others = source.mutants.keys() - constants
        for test in reached:
            if constants and not reached[test] & others:
                reached[test] -= constants
    mutants = {number: (source.name, *what) for source in sources for number, what in source.mutants.items()}
    content = "".join(source.path.read_text() for source in sources)
    stamp = hashlib.sha256((content + "".join(str((build / "x", test)) for test in options.tests)).encode()
                           + b"".join(program.read_bytes() for program in judges)).hexdigest()[:16]
    kept = out / "verdicts.tsv"
    known = {}
    if kept.exists() and kept.read_text().startswith(stamp):
        known = {int(line.split("\t")[0]): line.split("\t")[1] for line in kept.read_text().splitlines()[1:]}
    else:
        kept.write_text(stamp + "\n")
    order = sorted(number for number in mutants if re.search(options.only, mutants[number][0]))
    random.Random(options.seed).shuffle(order)
    chosen, judged = order[:options.mutants], {}
    print(f"{options.name}: {len(mutants)} faults of {len(objects)} files; a sample of {len(chosen)}, seed {options.seed}", flush=True)
    with kept.open("a") as log:
        for number in chosen:
            if time.monotonic() - began > 60 * options.minutes:
                break
            verdict = known.get(number)
            if verdict is None:
                verdict = "not reached"
                for program, names in rounds_of([test for test in reached if number in reached[test]], seconds):
                    verdict = "survived"
                    try:
                        limit = 10 * sum(seconds[program, name] for name in names) + 10
                        done = run([str(program), "--gtest_brief=1", "--gtest_fail_fast", "--gtest_filter=" + ":".join(names)], timeout=limit,
                                   TRACTION_MUTANT=str(number))
                        verdict = "killed" if done.returncode != 0 else "survived"
                    except subprocess.TimeoutExpired:
                        verdict = "killed"
                    if verdict == "killed":
                        break
                log.write(f"{number}\t{verdict}\t{mutants[number]}\n")
                log.flush()
            judged[number] = verdict

    table = {}
    for number, verdict in judged.items():
        row = table.setdefault(mutants[number][0], {"killed": 0, "survived": 0, "not reached": 0})
        row[verdict] += 1
    print(f"{'file':<40} {'killed':>8} {'survived':>9} {'not reached':>12}")
    for name in sorted(table):
        print(f"{name:<40} {table[name]['killed']:>8} {table[name]['survived']:>9} {table[name]['not reached']:>12}")
    for folder in options.folders + [""]:
        rows = [row for name, row in table.items() if name.startswith(folder)]
        killed, count = sum(row["killed"] for row in rows), sum(sum(row.values()) for row in rows)
        if count:
            share = killed / count
            error = 100 * (share * (1 - share) / count) ** 0.5  # of the sample, one sigma
            print(f"{options.name}: {folder or 'all'}: {killed} of {count} noticed, {100 * share:.1f} % ({error:.1f} % of sampling error)")
    if len(judged) < len(chosen):
        print(f"{options.name}: the {options.minutes:g} minutes are over after {len(judged)} of {len(chosen)}; the same command goes on from here")
    (out / "survivors").write_text("".join(f"{mutants[n][0]}:{mutants[n][1]}: {mutants[n][2]}  =>  {mutants[n][3]}  [{v}]\n"
                                           for n, v in sorted(judged.items()) if v != "killed"))
    print(f"{options.name}: survivors: {out / 'survivors'}")


if __name__ == "__main__":
    main()
