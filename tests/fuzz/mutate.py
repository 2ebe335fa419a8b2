"""mutate - how many small faults in firmware/core do its tests notice? Started by mutate.sh.

Mutants of every .c file and of fixed.h are made by universalmutator, shuffled by the seed, and judged until the wanted number has been
compiled and differs from the original in its machine code (the others are no faults: comments, annotations, the same program).
A mutant is killed when a unit test or outdoors_test fails, a sanitizer (address, undefined behaviour: as in the preset dev) speaks up, or it does not end. The committed replay hash is no judge: it knows yesterday's
output, not the truth. Two judges, the cheap one first: the plain build, as it is shipped, and of what survives that the one in which the mutated file is sanitized; either runs the
tests of the mutant's own file before the others and stops at the first that fails. Only the mutated file is compiled. Verdicts are kept in OUT/verdicts.tsv: a run that was broken off, or whose minutes were over, goes on from there as long as
firmware and tests are the same. Survivors that are known to be equivalent are listed with their reason in mutants_equivalent.txt.
"""

import argparse
import concurrent.futures
import difflib
import hashlib
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import time

C_FLAGS = ["-std=gnu11", "-O2", "-fPIC", "-ffp-contract=off", "-w"]
SANITIZE = ["-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
CXX_FLAGS = ["-std=c++20", "-O1", "-ffp-contract=off", "-w"]
KINDS = {"plain": [], "sanitized": SANITIZE}
SHELL = ["daemon", "parameters", "store", "template_text", "thread", "trace_queue", "trace_text"] # what app_test calls
NO_JUDGE = ["ulog_test"] # asks nothing of firmware/core
RADARS = ["mdu1130", "dj_radar_2", "dj_radar_3", "drs1000"]
TIMES = 5  # a mutant that takes so many times the processor time of the original does not end; a busy machine changes nothing about it


def run(command, **options):
    return subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", **options)


def must(command, **options):
    done = run(command, **options)
    if done.returncode != 0:
        sys.exit(f"mutate: {' '.join(str(part) for part in command)} failed:\n{done.stdout[-3000:]}")


def cxx():
    return ["ccache", "c++"] if shutil.which("ccache") else ["c++"]


def outdoors_sources(root):
    """What outdoors_test is made of, as its CMakeLists.txt says: whole drives, which need nothing but firmware/core either."""
    folder = root / "tests/loop"
    words = re.search(r"traction_test\(outdoors_test\b.*? SOURCES (.*?) LIBS firmware_core\)", (folder / "CMakeLists.txt").read_text()).group(1).split()
    return [folder / word.replace("${PROJECT_SOURCE_DIR}", str(root)) for word in words]


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
    for stem in SHELL:
        source = root / f"firmware/app/{stem}.c"
        commands.append(["cc", *C_FLAGS, f"-I{root}", "-c", source, "-o", base / f"shell_{stem}.o"])
    tests = [source for source in sorted((root / "tests/unit").glob("*_test.cpp")) if source.stem not in NO_JUDGE]
    for source in tests:
        commands.append([*cxx(), *CXX_FLAGS, f"-I{root}", "-c", source, "-o", base / f"{source.stem}.o"])
    (base / "outdoors").mkdir(exist_ok=True)
    for source in outdoors_sources(root):
        commands.append([*cxx(), *CXX_FLAGS, f"-I{root}", "-c", source, "-o", base / "outdoors" / f"{source.stem}.o"])
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        list(pool.map(must, commands))
    return [base / f"{source.stem}.o" for source in tests if source.stem != "fixed_test"]


def suites(root):
    """The test suites of each file tests/unit/NAME_test.cpp."""
    found = {}
    for source in sorted((root / "tests/unit").glob("*_test.cpp")):
        found[source.stem] = set(re.findall(r"^(?:TEST|TEST_F|RC_GTEST_PROP)\((\w+)", source.read_text(), re.M))
    return found


def own_suites(name, found):
    """Of a file of the firmware: doppler_line.c has those of doppler_line_test and doppler_test, ground_speed_sign.c of ground_speed_test."""
    stem = pathlib.Path(name).stem
    return set().union(*(of for test, of in found.items() if stem.startswith(test.removesuffix("_test")) or test.startswith(stem)))


class Worker:
    """A folder with a copy of the firmware in which one file at a time is replaced."""

    def __init__(self, root, out, name, like=None):
        self.root, self.base = root, out / "base"
        self.folder = out / name
        self.limit_s = {}
        self.plain = False
        self.suites = suites(root)
        shutil.rmtree(self.folder, ignore_errors=True)
        shutil.copytree(root / "firmware/core", self.folder / "firmware/core")
        self.original = {}
        if like: # its programs, too
            for kind in KINDS:
                shutil.copytree(like.folder / kind, self.folder / kind)
            self.original, self.limit_s = like.original, like.limit_s
            return
        for kind in KINDS:
            (self.folder / kind).mkdir()
        for source in sorted((self.folder / "firmware/core").glob("*.c")):
            if not self.compile(source, "plain"):
                sys.exit(f"mutate: {source} does not compile")
            self.original[source.stem] = (self.folder / "plain" / f"{source.stem}.o").read_bytes()

    def compile(self, source, kind):
        return run(["cc", *C_FLAGS, *KINDS[kind], f"-I{self.folder}", f"-I{self.root}", "-c",
                    f"firmware/core/{source.name}", "-o", f"{kind}/{source.stem}.o"], cwd=self.folder).returncode == 0

    def link(self, kind, sources=()):
        """The firmware of plain objects, but for `sources`, which are of `kind`: a sanitizer watches what it has compiled."""
        stems = {source.stem for source in sources}
        objects = [self.folder / (kind if stem in stems else "plain") / f"{stem}.o" for stem in sorted(self.original)] + sorted(self.base.glob("template_*.o"))
        must(["cc", "-shared", *KINDS[kind], "-o", self.folder / kind / "libcore.so", *objects, "-lm"])

    def link_judge(self, tests, kind):
        must(["c++", *KINDS[kind], "-o", self.folder / kind / "judge", *tests, *sorted(self.base.glob("shell_*.o")), f"-L{self.folder / kind}", "-lcore",
              "-lrapidcheck", "-lgtest", "-lgtest_main", "-lpthread", "-lm"])

    def prepare(self, tests, plain):
        """The judges, and how long they take on the firmware as it is."""
        for kind in ["plain"] if plain else KINDS:
            self.link(kind)
            self.link_judge(tests, kind)
        must(["c++", "-o", self.folder / "plain/outdoors", *sorted((self.base / "outdoors").glob("*.o")), f"-L{self.folder / 'plain'}", "-lcore",
              "-lgtest", "-lgtest_main", "-lpthread", "-lm"])
        for kind, program in (("plain", "judge"), ("plain", "outdoors"), ("sanitized", "judge")):
            if plain and kind != "plain":
                continue
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            if not self.passes(kind, program):
                sys.exit(f"mutate: the tests fail without any mutant: run  LD_LIBRARY_PATH={self.folder / kind} {self.folder / kind / program}")
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            self.limit_s[kind, program] = int(TIMES * spent) + 2
        if not plain and not self.header_test():
            sys.exit("mutate: fixed_test fails without any mutant")

    def passes(self, kind, program, tests="*"):
        environment = dict(os.environ, LD_LIBRARY_PATH=str(self.folder / kind), RC_PARAMS="seed=20261121 max_success=200",
                           ASAN_OPTIONS="detect_leaks=0")
        limit_s = self.limit_s.get((kind, program), 600)
        try:
            limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit_s, limit_s))
            return run([self.folder / kind / program, "--gtest_fail_fast", "--gtest_brief=1", f"--gtest_filter={tests}"], cwd=self.root, env=environment,
                       timeout=20 * limit_s, preexec_fn=limit).returncode == 0
        except subprocess.TimeoutExpired:
            return False

    def survives(self, kind, name, sources):
        self.link(kind, sources)
        own = ":".join(f"{suite}.*" for suite in sorted(own_suites(name, self.suites)))
        return (not own or self.passes(kind, "judge", own)) and self.passes(kind, "judge", f"*-{own}" if own else "*")

    def judge(self, name, mutant):
        """'invalid', 'same', 'killed', 'outdoors' (killed, but not by the plain unit tests) or 'survived'."""
        target = self.folder / "firmware/core" / name
        sources = sorted((self.folder / "firmware/core").glob("*.c")) if name.endswith(".h") else [target]
        try:
            shutil.copyfile(mutant, target)
            if not all(self.compile(source, "plain") for source in sources):
                return "invalid"
            header_test_ok = self.header_test() if name == "fixed.h" else True
            if header_test_ok is None:
                return "invalid"
            same = all((self.folder / "plain" / f"{source.stem}.o").read_bytes() == self.original[source.stem] for source in sources)
            if same and header_test_ok:
                return "same"
            if not header_test_ok or not self.survives("plain", name, sources):
                return "killed"
            if not self.passes("plain", "outdoors"):
                return "outdoors"
            if self.plain:
                return "survived"
            for source in sources:
                self.compile(source, "sanitized")
            return "survived" if self.survives("sanitized", name, sources) else "killed"
        finally:
            shutil.copyfile(self.root / "firmware/core" / name, target)
            for source in sources:
                (self.folder / "plain" / f"{source.stem}.o").write_bytes(self.original[source.stem])

    def header_test(self):
        done = run([*cxx(), *CXX_FLAGS, *SANITIZE, f"-I{self.folder}", f"-I{self.root}", self.root / "tests/unit/fixed_test.cpp", "-o",
                    self.folder / "sanitized/header_test", "-lgtest", "-lgtest_main", "-lpthread"])
        return self.passes("sanitized", "header_test") if done.returncode == 0 else None


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
    parser.add_argument("--plain", action="store_true", help="leave the sanitizers out: quicker, and what they alone would notice counts as survived")
    parser.add_argument("--minutes", type=float, default=1e6, help="judge no more after these")
    options = parser.parse_args()
    root, out = options.root.resolve(), options.out.resolve()

    tests = build_judge(root, out, options.jobs)
    first = Worker(root, out, "worker0")
    first.prepare(tests, options.plain)
    workers = [first] + [Worker(root, out, f"worker{k}", first) for k in range(1, options.jobs)]
    for worker in workers:
        worker.plain = options.plain

    files = sorted((root / "firmware/core").glob("*.c")) + [root / "firmware/core/fixed.h"]
    mutants = []
    for source in files:
        folder = out / "mutants" / source.name
        if not (folder / source.name).exists() or (folder / source.name).read_bytes() != source.read_bytes():
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
            must([out / "venv/bin/mutate", source, "c", "--noCheck", "--mutantDir", folder], cwd=folder)
            shutil.copyfile(source, folder / source.name) # what they were made from
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
    for source in sorted([*(root / "firmware").rglob("*.[ch]"), *(root / "tests/unit").glob("*.*"), *(root / "tests/bench").glob("scatterers.*"),
                          *(root / "tests/bench").glob("outdoors.*"), root / "tests/loop/outdoors_test.cpp"]):
        digest.update(source.read_bytes())
    kept, stamp, known = out / "verdicts.tsv", digest.hexdigest() + (" plain" if options.plain else ""), {}
    if kept.exists() and kept.read_text().startswith(stamp + "\n"):
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
                row = table.setdefault(source.name, {"killed": 0, "outdoors": 0, "equivalent": 0, "survived": 0})
                if verdict == "survived":
                    number, old, new = change(source, path)
                    reason = equivalent.get((source.name, new))
                    verdict = "equivalent" if reason else "survived"
                    survivors.append(f"{source.name}:{number}: {old}  =>  {new}" + (f"  [equivalent: {reason}]" if reason else ""))
                    (out / "survivors").write_text("".join(f"{line}\n" for line in sorted(survivors)))
                row[verdict] += 1

    if judged < options.mutants and at < len(mutants):
        print(f"mutate: the {options.minutes:g} minutes are over after {judged} of {options.mutants}; the same command goes on from here")
    (out / "survivors").write_text("".join(f"{line}\n" for line in sorted(survivors)))
    print(f"{'file':<24} {'unit tests':>10} {'outdoors':>9} {'equivalent':>11} {'survived':>9}")
    total = {"killed": 0, "outdoors": 0, "equivalent": 0, "survived": 0}
    for name in sorted(table):
        print(f"{name:<24} {table[name]['killed']:>10} {table[name]['outdoors']:>9} {table[name]['equivalent']:>11} {table[name]['survived']:>9}")
        for key in total:
            total[key] += table[name][key]
    killed = total["killed"] + total["outdoors"]
    real = killed + total["survived"]
    share = killed / max(real, 1)
    print(f"{'all':<24} {total['killed']:>10} {total['outdoors']:>9} {total['equivalent']:>11} {total['survived']:>9}")
    print(f"mutate: {killed} of {real} killed, {100 * share:.1f} % +- {100 * (share * (1 - share) / max(real, 1)) ** 0.5:.1f} %, by the unit tests alone at least "
          f"{100 * total['killed'] / max(real, 1):.1f} %; {total['equivalent']} known to be equivalent; not counted: "
          f"{others['invalid']} that do not compile, {others['same']} with the same machine code. Survivors: {out / 'survivors'}")


if __name__ == "__main__":
    main()
