"""The lab's own bench and round trip as campaigns: a row a log, made, answered and judged by the bench's own programs.

Nothing is judged here. `lab_bench --row` makes one sealed log, lets the lab answer, opens the seal and writes a line; `lab_bench --judge`
makes the bench's table of such lines. `lab_round_trip` does the same for the intervals of its fits.
"""

from __future__ import annotations

import difflib
import functools
import hashlib
import itertools
import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import uuid
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .._data import roots
from .._errors import CampaignError
from .plan import LAYOUT, Row, apart, plain
from .spec import Spec, read_table, wrong
from .store import Store

GENERATORS = {
    "lab_bench": ("independent", "apart", "fleet", "strange", "bent", "plant"),
    "round_trip": ("independent", "apart", "plant"),
}
CATEGORIES = ("clean", "one", "two", "outside")
SIMULATOR = "host_tools/cli/traction"  # in the build folder: it drives the plant, and tells its commit, so it is another after each
PROGRAMS = {  # what makes the rows, and what that runs
    "lab_bench": ("tests/bench/lab_bench", "tests/lab/generator/lab_generate"),
    "round_trip": ("tests/lab/round_trip/lab_round_trip",),
}
DATA = ("tests/lab/campaign/machine_*.toml", "models/rover_*.toml", "scenarios/identification.toml")  # that these read, of the checkout
_KEYS = ("title", "about", "kind", "generator", "category", "seed", "logs", "duration_s", "part")
_TEXTS = ("soil", "hidden_category", "hidden", "verdict", "text", "named", "classes", "intervals", "judged")
_NUMBERS = ("error_before", "error_after", "floor", "detectability")
_EFFECT = ("truth", "value", "low", "high")


@dataclass(frozen=True)
class Programs:
    """What makes the rows. It can be pickled; a worker sees that its own are the same.

    Attributes:
        build: the build folder; source: its checkout.
        digests: of each program, SHA-256 by its path in the build folder, and of the files that they read by theirs in the checkout.

    """

    build: str
    source: str
    digests: tuple[tuple[str, str], ...]

    @staticmethod
    def of(kind: str, generators: list[str]) -> Programs:
        """Those of $TRACTION_BUILD, or of build/host of the checkout. Raises CampaignError where they are not built."""
        given = os.environ.get("TRACTION_BUILD")
        builds = [Path(given)] if given else [root / "build/host" for root in roots()]
        build = next((b.resolve() for b in builds if (b / PROGRAMS[kind][0]).is_file()), None)
        if build is None:
            mend = "build them (./traction bench builds them) and name the build folder in $TRACTION_BUILD"
            raise CampaignError(f"kind = {kind!r}: {PROGRAMS[kind][0]} is not in {builds[0]}; to mend: {mend}", key="kind", mend=mend)
        home = re.search(r"^CMAKE_HOME_DIRECTORY:INTERNAL=(.*)$", (build / "CMakeCache.txt").read_text(encoding="utf-8"), re.MULTILINE)
        source = Path(home[1]) if home else build
        files = [build / name for name in PROGRAMS[kind] + ((SIMULATOR,) if "plant" in generators else ())] + sorted(
            file for pattern in DATA for file in source.glob(pattern)
        )
        return Programs(str(build), str(source), tuple((str(file), _digest(str(file))) for file in files))

    def path(self, kind: str) -> str:
        """The program of this kind."""
        return str(Path(self.build) / PROGRAMS[kind][0])

    def changed(self) -> str:
        """The first file that is not here as it was when the campaign was read; empty: all are."""
        return next((file for file, digest in self.digests if _digest(file) != digest), "")


@functools.cache
def _digest(file: str) -> str:
    try:
        return hashlib.sha256(Path(file).read_bytes()).hexdigest()
    except OSError:
        return ""


@dataclass(frozen=True)
class LabTask:
    """A log of a bench, on whatever machine the same programs lie at the same place."""

    kind: str
    programs: Programs
    duration_s: float
    scratch: str  # folder for the logs, where it is there; else the machine's own for temporary files

    def run(self, row: Row) -> Row:
        """One log. A program that fails is a failed row; one that is another than the campaign's ends the campaign."""
        if file := self.programs.changed():
            mend = "the same build at the same place on every machine"
            return {"status": "broken", "error": f"{file} on {os.uname().nodename} is not the campaign's; to mend: {mend}"}
        env = {**os.environ, "TRACTION_ROOT": self.programs.source}
        if os.path.isdir(self.scratch):
            env["TMPDIR"] = self.scratch
        words = _words(self.kind, self.programs, row, self.duration_s)
        done = subprocess.run(words, cwd=self.programs.source, env=env, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if done.returncode < 0:
            return {"status": "failed", "error": f"{Path(words[0]).name} was ended by {signal.Signals(-done.returncode).name}"}
        if done.returncode:
            said = done.stderr.strip().replace(env.get("TMPDIR", "/tmp") + "/", "") or f"exit code {done.returncode}"
            return {"status": "failed", "error": re.sub(r"traction_bench_\w+/", "", said)}
        told = json.loads(done.stdout)
        return _bench_row(told) if self.kind == "lab_bench" else _round_trip_row(told)


def _words(kind: str, programs: Programs, row: Row, duration_s: float) -> list[str]:
    seed, generator = str(row["seed"]), str(row["generator"])
    if kind == "round_trip":
        return [programs.path(kind), generator, seed, seed, repr(duration_s), "--row"]
    words = [programs.path(kind), "--traction", str(Path(programs.build) / SIMULATOR), "--row", "--seed", seed]
    words += ["--generator", generator, "--duration", repr(duration_s)]
    return words + (["--category", str(row["category"])] if row["category"] else [])


def _bench_row(told: Row) -> Row:
    out = {key: told[key] for key in (*_TEXTS, *_NUMBERS, "error")}
    return {**out, "status": "done" if told["error"] is None else "failed", "lab_cpu_s": told["seconds"]}


def _round_trip_row(told: Row) -> Row:
    *parameters, effect = told["estimates"]
    out: Row = {"status": "done", "error": None, "effect": effect["key"].removeprefix("effect: "), "effect_inside": effect["inside"]}
    out |= {f"effect_{key}": float(effect[key]) for key in _EFFECT}  # the program writes what is not finite as text
    out |= {"parameters": len(parameters), "parameters_inside": sum(one["inside"] for one in parameters)}
    return {**out, "estimates": told["estimates"], "lab_cpu_s": told["seconds"]}


@dataclass(frozen=True)
class LabSpec:
    """A bench of the lab that was read and found sound. Make one by `read_plan`, `plan_of`."""

    table: dict[str, Any]
    file: str = ""

    @staticmethod
    def of(table: Mapping[str, Any], file: str = "") -> LabSpec:
        """From a dict of the file's keys. Raises CampaignError with key, value, mend."""
        spec = LabSpec(json.loads(json.dumps(table)), file)
        for key in spec.table:
            if key not in _KEYS or (key == "category" and spec.kind == "round_trip"):
                near = difflib.get_close_matches(key, [k for k in _KEYS if k != key], 1)
                mend = f"is {near[0]!r} meant?" if near else "the keys are " + " ".join(_KEYS)
                raise wrong(file, key, None, f"is no key of a campaign of kind {spec.kind!r}", mend)
        for key, low in (("logs", 1), ("seed", 1 if spec.kind == "round_trip" else 0), ("part", 1)):
            value = spec.table.get(key, 1)
            if not isinstance(value, int) or isinstance(value, bool) or not low <= value < 2**53:
                raise wrong(file, key, value, "cannot be", f"give a whole number of {low} or more")
        duration = spec.table.get("duration_s", 120)
        if isinstance(duration, bool) or not isinstance(duration, (int, float)) or not 20 <= duration <= 3600:
            raise wrong(file, "duration_s", duration, "cannot be", "give 20 to 3600, in seconds")
        spec._check_choice("generator", GENERATORS[spec.kind])
        spec._check_choice("category", ("drawn", *CATEGORIES))
        if "plant" in spec.generators and spec.categories != [None]:
            mend = "leave category out, or take generator = 'apart'"
            raise wrong(file, "category", spec.table["category"], "is not for the plant, which hides by seed", mend)
        return spec

    def _check_choice(self, key: str, known: tuple[str, ...]) -> None:
        given = self._list(key, known[0])
        if not given or len(set(map(str, given))) < len(given):
            raise wrong(self.file, key, self.table[key], "is no choice", "give one name or a list of different ones: " + ", ".join(known))
        for value in given:
            if value not in known:
                raise wrong(self.file, key, value, "is none", "give " + ", ".join(known))

    def _list(self, key: str, otherwise: str) -> list[Any]:
        given = self.table.get(key, otherwise)
        return given if isinstance(given, list) else [given]

    @property
    def kind(self) -> str:
        """lab_bench or round_trip."""
        return str(self.table["kind"])

    @property
    def generators(self) -> list[str]:
        """Whose rovers."""
        return [str(name) for name in self._list("generator", "independent")]

    @property
    def categories(self) -> list[str | None]:
        """What is hidden: that alone; None: as it is drawn."""
        return [None if name == "drawn" else str(name) for name in self._list("category", "drawn")]

    @property
    def groups(self) -> list[tuple[str, str | None]]:
        """Generator and category of each table."""
        return list(itertools.product(self.generators, self.categories))

    @property
    def seed(self) -> int:
        """Of the first log; the others follow."""
        return int(self.table.get("seed", 1 if self.kind == "round_trip" else 1000))

    @property
    def logs(self) -> int:
        """Of each generator and category."""
        return int(self.table.get("logs", 100 if self.kind == "round_trip" else 250))

    @property
    def duration_s(self) -> float:
        """Of a log; fleet, strange and bent draw their own."""
        return float(self.table.get("duration_s", 120))

    @property
    def title(self) -> str:
        """For people."""
        return str(self.table.get("title", Path(self.file).stem or self.kind))

    @property
    def part(self) -> int:
        """Rows of a Parquet file."""
        return int(self.table.get("part", 1000))

    @functools.cached_property
    def programs(self) -> Programs:
        """What makes the rows."""
        return Programs.of(self.kind, self.generators)

    @property
    def fingerprint(self) -> str:
        """Of the specification, the programs, and the files that they read."""
        whole = json.dumps([plain(self.table), [digest for _, digest in self.programs.digests], LAYOUT], sort_keys=True)
        return hashlib.sha256(whole.encode()).hexdigest()

    @functools.cached_property
    def rows(self) -> list[Row]:
        """Every log: `drive`, `generator`, `category`, `seed`."""
        logs = ((*group, self.seed + i) for group in self.groups for i in range(self.logs))
        return [{"drive": n, "generator": g, "category": c, "seed": s} for n, (g, c, s) in enumerate(logs)]

    def schema(self) -> Any:
        """The table's columns (pyarrow); the processor time is kept apart from them."""
        import pyarrow as pa

        text, number = pa.string(), pa.float64()
        fields = [("drive", pa.int64()), ("generator", text), ("category", text), ("seed", pa.int64()), ("status", text), ("error", text)]
        if self.kind == "lab_bench":
            fields += [(name, text) for name in _TEXTS[:-1]] + [(name, number) for name in _NUMBERS] + [("judged", text)]
        else:
            fields += [("effect", text), *((f"effect_{name}", number) for name in _EFFECT), ("effect_inside", pa.bool_())]
            fields += [("parameters", pa.int32()), ("parameters_inside", pa.int32()), ("estimates", text)]
        return pa.schema([*fields, apart("lab_cpu_s", number)])

    def task(self, folder: str | os.PathLike[str]) -> LabTask:
        """What its workers are given. Logs lie in a `scratch-*` of this run: those of a killed one may still be written."""
        clear_scratch(folder)
        scratch = Path(folder).resolve() / f"scratch-{uuid.uuid4().hex}"
        scratch.mkdir()
        return LabTask(self.kind, self.programs, self.duration_s, str(scratch))


def clear_scratch(folder: str | os.PathLike[str]) -> None:
    """Takes away the logs that a bench's runs left in a campaign's folder, as far as nobody writes there any more."""
    for left in Path(folder).glob("scratch-*"):
        shutil.rmtree(left, ignore_errors=True)


@dataclass(frozen=True)
class LabTable:
    """What the judge makes of the rows of one generator and category.

    Attributes:
        text: as the bench prints it.
        json: traction.bench_lab/1; of a round trip an empty dict.
        missing: rows that have no answer to judge, for their program failed.
        met: whether the program that prints it ends with 0.

    """

    text: str
    json: dict[str, Any]
    missing: int
    met: bool


def read_plan(file: str | os.PathLike[str]) -> Spec | LabSpec:
    """A campaign's TOML file, of whatever kind."""
    return plan_of(read_table(file), os.fspath(file))


def plan_of(table: Mapping[str, Any], file: str = "") -> Spec | LabSpec:
    """The same from a dict of the file's keys."""
    kind = table.get("kind")
    if kind is None:
        return Spec.of(table, file)
    if not isinstance(kind, str) or kind not in GENERATORS:
        raise wrong(file, "kind", kind, "is none", "leave it out for drives of your own, or give " + ", ".join(GENERATORS))
    return LabSpec.of(table, file)


def tables_of(table: Mapping[str, Any], store: Store) -> list[LabTable]:
    """The tables of a bench's rows; none of another campaign."""
    if "kind" not in table:
        return []
    spec = LabSpec.of(table)
    judge = _judge_bench if spec.kind == "lab_bench" else _judge_round_trip
    source = "judged" if spec.kind == "lab_bench" else "estimates"
    rows = store.table(["drive", "generator", "category", source]).to_pylist()
    seconds = {row["drive"]: row["lab_cpu_s"] for row in store.times().to_pylist()}
    out = []
    for generator, category in spec.groups:
        own = [row for row in rows if (row["generator"], row["category"]) == (generator, category)]
        lines = [
            f'{{"{source}": {row[source]}, "seconds": {json.dumps(seconds[row["drive"]])}}}\n' for row in own if row[source] is not None
        ]
        if lines:
            out.append(judge(spec, generator, category, lines, len(own) - len(lines)))
    return out


def _judge_bench(spec: LabSpec, generator: str, category: str | None, lines: list[str], missing: int) -> LabTable:
    def words(folder: Path) -> list[str]:
        given = ["--generator", generator, "--logs", str(spec.logs), "--seed", str(spec.seed), "--duration", repr(spec.duration_s)]
        return [*given, "--json", str(folder / "table.json"), *(["--category", category] if category else [])]

    return _judged(spec, lines, missing, lambda rows: [spec.programs.path(spec.kind), "--judge", str(rows), *words(rows.parent)])


def _judge_round_trip(spec: LabSpec, generator: str, category: str | None, lines: list[str], missing: int) -> LabTable:
    span = [str(spec.seed), str(spec.seed + spec.logs - 1), repr(spec.duration_s)]
    return _judged(spec, lines, missing, lambda rows: [spec.programs.path(spec.kind), generator, *span, "--judge", str(rows)])


def _judged(spec: LabSpec, lines: list[str], missing: int, words: Callable[[Path], list[str]]) -> LabTable:
    with tempfile.TemporaryDirectory() as name:
        rows = Path(name) / "rows.jsonl"
        rows.write_text("".join(lines), encoding="utf-8")
        done = subprocess.run(words(rows), cwd=spec.programs.source, capture_output=True, text=True)
        if done.returncode not in (0, 1):
            raise CampaignError(f"{spec.title}: its rows cannot be judged: {done.stderr.strip()}")
        document = Path(name) / "table.json"
        told = json.loads(document.read_text(encoding="utf-8")) if document.exists() else {}
    return LabTable(done.stdout, told, missing, done.returncode == 0)
