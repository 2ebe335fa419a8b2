"""mutate - how many small faults in firmware/core do the unit tests notice? Started by mutate.sh.

Mutants of every .c file and of fixed.h are made by universalmutator, shuffled by the seed, and judged until the wanted number has been
compiled and differs from the original in its machine code (the others are no faults: comments, annotations, the same program).
A mutant is killed when a unit test fails, a sanitizer (address, undefined behaviour: as in the preset dev) speaks up, or it does not end. The committed replay hash is no judge: it knows yesterday's
output, not the truth. Verdicts are kept in OUT/verdicts.tsv: a run that was broken off, or whose minutes were over, goes on from there as long as
firmware and tests are the same. Survivors that are known to be equivalent are listed with their reason in mutants_equivalent.txt.
"""

import argparse
import concurrent.futures
import difflib
import hashlib
import os
import pathlib
import random
import resource
import shutil
import subprocess
import sys
import time

C_FLAGS = ["-std=gnu11", "-O2", "-fPIC", "-ffp-contract=off", "-w"]
SANITIZE = ["-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
CXX_FLAGS = ["-std=c++20", "-O2", "-ffp-contract=off", "-w"]
RADARS = ["mdu1130", "dj_radar_2", "dj_radar_3", "drs1000"]
LIMIT_S = 60  # of processor time, whatever else the machine does; the judge takes about 2 s


def run(command, **options):
    return subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)


def must(command, **options):
    done = run(command, **options)
    if done.returncode != 0:
        sys.exit(f"mutate: {' '.join(str(part) for part in command)} failed:\n{done.stdout[-3000:]}")


def build_judge(root, out, jobs):
    """Base objects of the firmware, and its unit tests as two programs: fixed_test, which compiles fixed.h itself, and all the others."""
    base = out / "base"
    base.mkdir(parents=True, exist_ok=True)
    must(["cc", "-std=c11", "-O2", "-o", out / "template_gen", root / "firmware/template/doppler_template_gen.c",
          root / "firmware/template/radar_template.c", f"-I{root}", "-lm"])
    commands = []
    for radar in RADARS:
        must([out / "template_gen", radar, out / f"{radar}.c"])
        commands.append(["cc", *C_FLAGS, f"-I{root}", "-c", out / f"{radar}.c", "-o", base / f"template_{radar}.o"])
    for source in sorted((root / "firmware/app").glob("*.c")):
        if source.stem != "tractiond": # the program itself: it has a main of its own
            commands.append(["cc", *C_FLAGS, f"-I{root}", "-c", source, "-o", base / f"shell_{source.stem}.o"])
    tests = sorted((root / "tests/unit").glob("*_test.cpp"))
    for source in tests:
        commands.append(["c++", *CXX_FLAGS, f"-I{root}", "-c", source, "-o", base / f"{source.stem}.o"])
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        list(pool.map(must, commands))
    return [base / f"{source.stem}.o" for source in tests if source.stem != "fixed_test"]


class Worker:
    """A folder with a copy of the firmware in which one file at a time is replaced."""

    def __init__(self, root, out, name):
        self.root, self.base = root, out / "base"
        self.folder = out / name
        shutil.rmtree(self.folder, ignore_errors=True)
        shutil.copytree(root / "firmware/core", self.folder / "firmware/core")
        (self.folder / "plain").mkdir()
        (self.folder / "sanitized").mkdir()
        self.original = {}
        for source in sorted((self.folder / "firmware/core").glob("*.c")):
            self.compile(source, "plain")
            self.compile(source, "sanitized")
            self.original[source.stem] = [(self.folder / kind / f"{source.stem}.o").read_bytes() for kind in ("plain", "sanitized")]

    def compile(self, source, kind):
        return run(["cc", *C_FLAGS, *(SANITIZE if kind == "sanitized" else []), f"-I{self.folder}", f"-I{self.root}", "-c",
                    f"firmware/core/{source.name}", "-o", f"{kind}/{source.stem}.o"], cwd=self.folder).returncode == 0

    def link(self):
        objects = sorted((self.folder / "sanitized").glob("*.o")) + sorted(self.base.glob("template_*.o"))
        must(["cc", "-shared", *SANITIZE, "-o", self.folder / "libcore.so", *objects, "-lm"])

    def link_judge(self, tests):
        must(["c++", *SANITIZE, "-o", self.folder / "judge", *tests, *sorted(self.base.glob("shell_*.o")), f"-L{self.folder}", "-lcore", "-lrapidcheck",
              "-lgtest", "-lgtest_main", "-lpthread", "-lm"])

    def passes(self, program):
        environment = dict(os.environ, LD_LIBRARY_PATH=str(self.folder), RC_PARAMS="seed=20261121 max_success=200",
                           ASAN_OPTIONS="detect_leaks=0")
        try:
            limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (LIMIT_S, LIMIT_S))
            return run([program, "--gtest_fail_fast", "--gtest_brief=1"], cwd=self.root, env=environment, timeout=20 * LIMIT_S,
                       preexec_fn=limit).returncode == 0
        except subprocess.TimeoutExpired:
            return False

    def judge(self, name, mutant):
        """'invalid', 'same', 'killed' or 'survived'."""
        target = self.folder / "firmware/core" / name
        try:
            shutil.copyfile(mutant, target)
            sources = sorted((self.folder / "firmware/core").glob("*.c")) if name.endswith(".h") else [target]
            if not all(self.compile(source, "plain") for source in sources):
                return "invalid"
            header_test_ok = True
            if name == "fixed.h":
                header_test_ok = self.header_test()
                if header_test_ok is None:
                    return "invalid"
            same = all((self.folder / "plain" / f"{source.stem}.o").read_bytes() == self.original[source.stem][0] for source in sources)
            if same and header_test_ok:
                return "same"
            for source in sources:
                self.compile(source, "sanitized")
            self.link()
            return "survived" if header_test_ok and self.passes(self.folder / "judge") else "killed"
        finally:
            shutil.copyfile(self.root / "firmware/core" / name, target)
            for stem, contents in self.original.items():
                for kind, content in zip(("plain", "sanitized"), contents):
                    (self.folder / kind / f"{stem}.o").write_bytes(content)

    def header_test(self):
        done = run(["c++", *CXX_FLAGS, *SANITIZE, f"-I{self.folder}", f"-I{self.root}", self.root / "tests/unit/fixed_test.cpp", "-o", self.folder / "header_test",
                    "-lgtest", "-lgtest_main", "-lpthread"])
        return self.passes(self.folder / "header_test") if done.returncode == 0 else None


def change(original, mutant):
    """(line number, old, new) of the first difference."""
    old, new = original.read_text().splitlines(), mutant.read_text().splitlines()
    for tag, i, i_end, j, j_end in difflib.SequenceMatcher(None, old, new, autojunk=False).get_opcodes():
        if tag != "equal":
            return i + 1, " ".join(line.strip() for line in old[i:i_end]), " ".join(line.strip() for line in new[j:j_end])
    return 0, "", ""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--root", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--mutants", type=int, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--minutes", type=float, default=1e6, help="judge no more after these")
    options = parser.parse_args()
    root, out = options.root.resolve(), options.out.resolve()

    tests = build_judge(root, out, options.jobs)
    workers = [Worker(root, out, f"worker{k}") for k in range(options.jobs)]
    for worker in workers:
        worker.link()
        worker.link_judge(tests)
        if not worker.passes(worker.folder / "judge") or not worker.header_test():
            sys.exit(f"mutate: the unit tests fail without any mutant: run  LD_LIBRARY_PATH={worker.folder} {worker.folder / 'judge'}")

    files = sorted((root / "firmware/core").glob("*.c")) + [root / "firmware/core/fixed.h"]
    mutants = []
    shutil.rmtree(out / "mutants", ignore_errors=True)
    for source in files:
        folder = out / "mutants" / source.name
        folder.mkdir(parents=True)
        must([out / "venv/bin/mutate", source, "c", "--noCheck", "--mutantDir", folder], cwd=folder)
        made = sorted(folder.glob(f"{source.stem}.mutant.*"), key=lambda path: int(path.name.split(".")[2]))
        mutants += [(source, path) for path in made]
    random.Random(options.seed).shuffle(mutants)
    print(f"mutate: {len(mutants)} mutants of {len(files)} files; {options.mutants} are judged, seed {options.seed}", flush=True)

    equivalent = {}
    for line in (root / "tests/fuzz/mutants_equivalent.txt").read_text().splitlines():
        if line and not line.startswith("#"):
            name, *new, reason = line.split(" | ") # the line may hold a | of its own
            equivalent[name, " | ".join(new)] = reason
    table, survivors, judged, others = {}, [], 0, {"invalid": 0, "same": 0}
    idle = list(workers)
    digest = hashlib.sha256()
    for source in sorted([*(root / "firmware").rglob("*.[ch]"), *(root / "tests/unit").glob("*.*")]):
        digest.update(source.read_bytes())
    kept, stamp, known = out / "verdicts.tsv", digest.hexdigest(), {}
    if kept.exists() and kept.read_text().startswith(stamp):
        known = dict(line.split("\t") for line in kept.read_text().splitlines()[1:])
    else:
        kept.write_text(stamp + "\n")

    def judge(item):
        key = hashlib.sha256(item[0].name.encode() + item[1].read_bytes()).hexdigest()
        if key in known:
            return known[key]
        worker = idle.pop()
        try:
            verdict = worker.judge(item[0].name, item[1])
            with kept.open("a") as log:
                log.write(f"{key}\t{verdict}\n")
            return verdict
        finally:
            idle.append(worker)

    began = time.monotonic()

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        at = 0
        while judged < options.mutants and at < len(mutants) and time.monotonic() - began < 60 * options.minutes:
            batch = mutants[at:at + min(8 * options.jobs, options.mutants - judged)]
            at += len(batch)
            for (source, path), verdict in zip(batch, pool.map(judge, batch)):
                if verdict in others:
                    others[verdict] += 1
                    continue
                judged += 1
                row = table.setdefault(source.name, {"killed": 0, "equivalent": 0, "survived": 0})
                if verdict == "survived":
                    number, old, new = change(source, path)
                    reason = equivalent.get((source.name, new))
                    verdict = "equivalent" if reason else "survived"
                    survivors.append(f"{source.name}:{number}: {old}  =>  {new}" + (f"  [equivalent: {reason}]" if reason else ""))
                row[verdict] += 1

    if judged < options.mutants and at < len(mutants):
        print(f"mutate: the {options.minutes:g} minutes are over after {judged} of {options.mutants}; the same command goes on from here")
    (out / "survivors").write_text("".join(f"{line}\n" for line in sorted(survivors)))
    print(f"{'file':<20} {'killed':>8} {'equivalent':>11} {'survived':>9}")
    total = {"killed": 0, "equivalent": 0, "survived": 0}
    for name in sorted(table):
        print(f"{name:<20} {table[name]['killed']:>8} {table[name]['equivalent']:>11} {table[name]['survived']:>9}")
        for key in total:
            total[key] += table[name][key]
    real = total["killed"] + total["survived"]
    print(f"{'all':<20} {total['killed']:>8} {total['equivalent']:>11} {total['survived']:>9}")
    print(f"mutate: {total['killed']} of {real} killed, {100 * total['killed'] / max(real, 1):.1f} %; {total['equivalent']} known to be equivalent; not counted: "
          f"{others['invalid']} that do not compile, {others['same']} with the same machine code. Survivors: {out / 'survivors'}")


if __name__ == "__main__":
    main()
