#!/usr/bin/env python3
"""Do two programs give the same answers, byte by byte, and how long does each take?

    python3 tests/bench/same_answers.py --old OLD --new build/host/host_tools/cli/traction \\
        --generate build/host/tests/lab/generator/lab_generate --folder out/same [--seeds 3] [--seconds 120] [--first 710000]

Sealed logs of the independent generator (wheels drawn apart; fleet), every category with as many seeds, are diagnosed by both programs,
one after the other on one core, old and new in turn. Printed: verdict, user seconds of each, whether the JSON is the same; then the
medians and the median ratio. Exit code: 0 all the same, 1 not, or nothing was
answered, 2 wrong use.
"""

import argparse
import json
import resource
import statistics
import subprocess
import sys
from pathlib import Path

CATEGORIES = ("clean", "one", "two", "outside")


def user_seconds(command: list[str]) -> tuple[float, int]:
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    code = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False).returncode
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, code


def make_log(generate: str, folder: Path, kind: str, category: str, seed: int, seconds: float) -> tuple[str, list[str]]:
    name = f"{kind}-{category}-{seed}"
    log, model = folder / f"{name}.csv", folder / f"{name}.toml"
    how = ["--fleet"] if kind == "fleet" else ["--blind", "--apart", "--duration", str(seconds)]
    subprocess.run(
        [generate, *how, "--category", category, "--seed", str(seed), "--out", str(log), "--model", str(model),
         "--seal", str(folder / f"{name}.seal")], check=True)
    arguments = ["--model", str(model), "--log", str(log)]
    table = Path(f"{log}.map.toml")
    return name, [*arguments, "--map", str(table)] if table.exists() else arguments


def answer(program: str, arguments: list[str], where: Path, seconds: float) -> tuple[float, int, bytes]:
    where.unlink(missing_ok=True)
    took, code = user_seconds([program, "diagnose", *arguments, "--to", str(seconds), "--quiet", "--json", str(where)])
    return took, code, where.read_bytes() if where.exists() else b""


def verdict_of(text: bytes) -> str:
    return str(json.loads(text)["verdict"]["kind"]) if text else "no answer"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("old", "new", "generate", "folder"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--first", type=int, default=710000)
    parser.add_argument("--seconds", type=float, default=120, help="of each log that are looked at")
    options = parser.parse_args()
    folder = Path(options.folder)
    folder.mkdir(parents=True, exist_ok=True)
    old, new, other, answered = [], [], 0, 0
    for seed in range(options.first, options.first + options.seeds):
        for kind in ("apart", "fleet"):
            for category in CATEGORIES:
                name, arguments = make_log(options.generate, folder, kind, category, seed, options.seconds)
                was, was_code, before = answer(options.old, arguments, folder / f"{name}.old.json", options.seconds)
                took, code, after = answer(options.new, arguments, folder / f"{name}.new.json", options.seconds)
                same = before == after and was_code == code
                other += not same
                answered += bool(before)
                old.append(was)
                new.append(took)
                print(f"{name:28} {verdict_of(before):12} {was:7.2f} s {took:7.2f} s  {'same' if same else 'DIFFERENT'}", flush=True)
    ratio = statistics.median([b / a for a, b in zip(old, new) if a > 0] or [1.0])
    print(f"{len(old)} logs, {answered} answered, {other} different; median {statistics.median(old):.2f} s -> {statistics.median(new):.2f} s, median ratio {ratio:.2f}")
    return 1 if other or not answered else 0


if __name__ == "__main__":
    sys.exit(main())
