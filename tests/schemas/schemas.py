"""Every verb's --json output against its schema (schemas/), on small real input.

usage: schemas.py ROOT BUILD CLI TRACTIOND WORK; schemas.py --validate ROOT FILE...; schemas.py --table ROOT (for docs/json.md)

A verb without a schema, or without a run below, fails. So does a key that the schema does not know, and one that it misses: both are tried
on copies of every document that was validated. docs/json.md must list what the files say.
"""

from __future__ import annotations

import concurrent.futures
import copy
import json
import os
import re
import shutil
import subprocess
import sys
import time
import urllib.request
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator
from referencing import Registry, Resource

NO_JSON = {"firmware", "model", "rover", "regressors"}  # `format` of TOML files, and the header of a binary table
OPEN = {"cases.*.hidden.*", "cases.*.hidden.*.parameters"}  # the lab_bench generator's own seal
MAPS = r"(^|\.)(parameters|variant|fitted|firmware|confusion(\.[^.]+)?|by_soil|by_group)$"  # their keys are names, any number of them
ELSEWHERE = {"emulate"}  # needs the emulated board (./traction emulate --test): its keys are compared with its source

failures: list[str] = []


def bad(text: str) -> None:
    failures.append(text)
    print("FAILED:", text)


class Schemas:
    def __init__(self, folder: Path) -> None:
        self.by_name: dict[str, dict[str, Any]] = {}
        for file in sorted(folder.glob("*.json")):
            schema = json.loads(file.read_text(encoding="utf-8"))
            Draft202012Validator.check_schema(schema)
            name = schema["properties"]["schema"]["const"]
            self.by_name[name] = schema
            kind, major = name.removeprefix("traction.").split("/")
            if file.name != f"traction.{kind}.{major}.schema.json":
                bad(f"{file.name}: is the schema {name}")
            if schema.get("$id") != f"urn:traction:{kind}:{major}":
                bad(f"{file.name}: $id is {schema.get('$id')}")
            if not re.fullmatch(major + r"\.\d+", schema.get("x-version", "")):
                bad(f"{file.name}: x-version must be {major}.N")
            if not schema.get("title") or not schema.get("description"):
                bad(f"{file.name}: needs title and description")
            if not schema["x-verbs"] and not schema.get("x-written-by"):
                bad(f"{file.name}: neither x-verbs nor x-written-by says who writes it")
            self.lint(file.name, schema, "")
        self.registry: Registry[Any] = Registry().with_resources((s["$id"], Resource.from_contents(s)) for s in self.by_name.values())

    def lint(self, file: str, node: Any, where: str) -> None:
        """Each key is described; a number's description has its unit in brackets; an object says whether it is closed."""
        if isinstance(node, list):
            for one in node:
                self.lint(file, one, where)
        if not isinstance(node, dict):
            return
        for name, part in node["properties"].items() if "type" in node and "properties" in node else ():
            kinds = part.get("type", [])
            if "description" not in part and "$ref" not in part:
                bad(f"{file}: {where}.{name} has no description")
            if {"number", "integer"} & set([kinds] if isinstance(kinds, str) else kinds) and "[" not in part["description"]:
                bad(f"{file}: {where}.{name} is a number without a unit")
        if "type" in node and "properties" in node and "additionalProperties" not in node:
            bad(f"{file}: {where or 'the top'} does not say whether it is closed")
        for key, part in node.items():
            self.lint(file, part, f"{where}.{key}" if key not in ("properties", "items") else where)

    def errors(self, document: Any) -> list[str]:
        name = document.get("schema") if isinstance(document, dict) else None
        if name not in self.by_name:
            return [f"schema {name!r} has no file in schemas/"]
        found = Draft202012Validator(self.by_name[name], registry=self.registry).iter_errors(document)
        return [f"{error.json_path}: {error.message[:300]}" for error in found]


def thinned(node: Any) -> Any:
    """Long arrays by their first element: what follows is checked often."""
    if isinstance(node, dict):
        return {key: thinned(value) for key, value in node.items()}
    if isinstance(node, list):
        return [thinned(value) for value in (node if len(node) <= 24 else node[:1])]
    return node


def objects(node: Any, path: str = "", seen: set[str] | None = None) -> Any:
    """(path with * for indices, object), each path once."""
    seen = set() if seen is None else seen
    if isinstance(node, dict):
        if path not in seen:
            seen.add(path)
            yield path, node
        for key, value in node.items():
            yield from objects(value, f"{path}.{key}".lstrip("."), seen)
    elif isinstance(node, list):
        for value in node:
            yield from objects(value, f"{path}.*".lstrip("."), seen)


def is_strict(schemas: Schemas, label: str, document: dict[str, Any]) -> int:
    """A surplus key anywhere, a missing one anywhere, a key renamed at the top: each is refused. How many copies were tried."""
    small = thinned(document)
    if schemas.errors(small):
        return 0  # told already
    tried = 0
    for path, node in list(objects(small)):
        if path in OPEN:
            continue
        node["surplus_key"] = "x"
        if not schemas.errors(small):
            bad(f"{label}: an unknown key in {path or 'the top'} passes")
        del node["surplus_key"]
        tried += 1
        if not node or re.search(MAPS, path):
            continue
        kept = dict(node)
        node.clear()
        if not schemas.errors(small):
            bad(f"{label}: {path or 'the top'} without any of its keys passes")
        node.update(kept)
        tried += 1
    for key in small:
        renamed = copy.copy(small)
        renamed["renamed_" + key] = renamed.pop(key)
        if not schemas.errors(renamed):
            bad(f"{label}: {key} renamed passes")
        tried += 1
    return tried


class Runs:
    def __init__(self, root: Path, build: Path, cli: Path, tractiond: Path, work: Path, schemas: Schemas) -> None:
        self.root, self.build, self.cli, self.tractiond, self.work, self.schemas = root, build, cli, tractiond, work, schemas
        self.verbs: set[str] = set()  # that wrote a document
        self.excused: dict[str, str] = {}
        self.documents: dict[str, dict[str, Any]] = {}  # the first of each verb and set of keys
        self.environment = {**os.environ, "TRACTION_ROOT": str(root)}
        python = build / "python-venv/bin/python"
        if python.exists():
            self.environment["TRACTION_PYTHON"] = str(python)
        self.count = 0
        self.seconds: dict[str, float] = {}

    def call(self, *words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([self.cli, *words], cwd=self.work, env=self.environment, capture_output=True, text=True, stdin=subprocess.DEVNULL)

    def judge(self, verb: str, label: str, document: Any) -> None:
        for error in self.schemas.errors(document)[:5]:
            bad(f"{label}: {error}")
        if not isinstance(document, dict) or document.get("schema") not in self.schemas.by_name:
            return
        if verb and verb not in self.schemas.by_name[document["schema"]]["x-verbs"]:
            bad(f"{label}: {document['schema']} does not name the verb in x-verbs")
        self.verbs.add(verb)
        self.documents.setdefault(verb + " " + ",".join(sorted(document)), document)

    def run(self, verb: str, *words: str, codes: tuple[int, ...] = (0,)) -> None:
        self.count += 1
        file = self.work / f"{self.count}_{verb.replace(' ', '_')}.json"
        label = " ".join([verb, *words])
        began = time.monotonic()
        done = self.call(*verb.split(), *words, "--json", str(file))
        self.seconds[label] = time.monotonic() - began
        if done.returncode not in codes or not file.exists():
            bad(f"{label}: exit {done.returncode}, {'no ' if not file.exists() else ''}result: {done.stderr.strip()[-400:]}")
            return
        self.judge(verb, label, json.loads(file.read_text(encoding="utf-8")))

    def killed(self) -> Path:
        """What a simulation leaves that is killed."""
        part = self.work / "killed.csv.part"
        words = [self.cli, "simulate", "cruise", "--realtime", "--out", "killed.csv"]
        with subprocess.Popen(words, cwd=self.work, env=self.environment, stdout=subprocess.DEVNULL) as run:
            until = time.monotonic() + 60
            while (not part.exists() or part.stat().st_size < 5000) and time.monotonic() < until:
                time.sleep(0.1)
            run.kill()
        return part

    def lab(self) -> None:
        gravel = ("--model", "rover_gravel", "run.csv")
        self.run("simulate", "cruise", "--out", "run.csv", "--hide", "3", "--seal", "seal.json", codes=(0, 1))
        self.judge("", "simulate --seal", json.loads((self.work / "seal.json").read_text()))
        self.run("simulate", "cruise", "--seeds", "5..6", "--out", "other.csv", "--self-test")
        self.run("check", "run.csv", codes=(0, 1))
        self.run("compare", *gravel)
        self.run("compare", *gravel, "--fitted", "--report", "page.html")
        self.run("fit", *gravel, "--out", "fitted.toml", "--validate", "other.5.csv", "--profile", "soil.mu")
        self.run("add", "viscous_friction", *gravel, "--out", "added.toml", codes=(0, 1))
        self.run("history", "--model", "added.toml")
        self.run("drop", "viscous_friction", "--model", "added.toml", "--out", "dropped.toml")
        self.run("diagnose", *gravel, codes=(0, 1))
        self.run("next", "--model", "rover_sand", "--effects", "slip_sinkage", "mesh_loss", codes=(0, 1))
        self.run("next", *gravel, "--effects", "grade", codes=(0, 1))
        self.run("export", *gravel, "--residuals", "residuals.csv", "--firmware", "firmware.toml")
        self.run("export", "--model", "rover_gravel", "--firmware", "firmware.toml")
        self.run("replay", "run.csv")
        self.run("convert", "run.csv", "--out", "converted.csv")
        self.run("recover", str(self.killed()), "--out", "recovered.csv")
        self.run("plot", "run.csv", "--signals", "estimate.speed_m_s", "--out", "plot.svg")
        self.run("speed", "run.csv", "--reference", "estimate.speed_m_s")
        self.run("calibrate", "run.csv", "--truth", "wheels")
        written = sorted(str(file.name) for file in self.work.glob("*_compare.json"))
        self.run("report", written[0], "--out", "one.html")
        self.run("report", *written, "--out", "page.html")
        page = re.search(r'<script type="application/json" id="result">(.*?)</script>', (self.work / "page.html").read_text(), re.DOTALL)
        self.judge("", "report of two results", json.loads(page[1]) if page else None)
        for verb, *words in (
            ["rover", "heavy"], ["tune", "cruise"], ["effects"], ["effects", "slip_sinkage"],
            ["completion", "bash"], ["man", "check"], ["man", "--folder", "."],
        ):  # fmt: skip
            self.run(verb, *words)
        self.run("game", "--new", "4")  # as for the demo
        self.run("game", "--guess", "grade", codes=(0, 1))
        self.run("game", "--open")

    def whole(self) -> None:
        self.run("demo", "--seed", "4", "--out", "demo")  # seed 4: named, and of the cheapest to diagnose
        self.judge("", "the demo's seal", json.loads((self.work / "demo/sealed.json").read_text()))
        self.run("reproduce", "--seeds", "2", codes=(0, 1))
        for program, words in (("lab_bench", "lab --logs 2 --duration 20"), ("speed_bench", "speed --seeds 1"), ("sim_bench", "sim --rounds 1")):
            verb, *options = words.split()
            if (self.build / "tests/bench" / program).exists():
                self.run("bench " + verb, *options, codes=(0, 1))
            else:
                self.excused["bench " + verb] = f"{program} is not built here"
        self.campaign()
        self.drive()
        self.serve()
        self.flash()

    def campaign(self) -> None:
        (self.work / "campaign.toml").write_text(
            'title = "two drives"\nscenario = "cruise"\nmethod = "list"\nhide = 0\n[set]\nduration_s = 2.0\n'
            '[[row]]\nground.soil = "sand"\n[[row]]\nground.soil = "gravel"\n'
        )
        python = self.environment.get("TRACTION_PYTHON")
        if python is None or subprocess.run([python, "-c", "import pyarrow, scipy, traction"], capture_output=True, cwd="/").returncode != 0:
            self.excused["campaign"] = "the Python package is not installed in the build folder (python_package_is_built_and_installed_by_pip)"
            return
        self.run("campaign", "campaign.toml", "--dry-run")
        self.run("campaign", "campaign.toml", "--out", "campaign", "--workers", "0")

    def serve(self) -> None:
        (self.work / "served").mkdir()
        if (made := self.call("serve", "nowhere")).returncode == 2 and "not in this build" in made.stderr:
            self.excused["serve"] = "this build has no cpp-httplib"
            return
        document = self.work / "served.json"
        command = [self.cli, "serve", "served", "--port", "0", "--json", str(document)]
        server = subprocess.Popen(command, cwd=self.work, stdout=subprocess.PIPE, text=True)
        try:
            assert server.stdout is not None
            found = re.search(r"(http://\S+)/\?token=(\S+)", server.stdout.readline() + server.stdout.readline())
            if found is None:
                bad("traction serve does not print its address")
                return
            headers = {"X-Traction-Token": found[2], "Content-Type": "application/json"}
            body = json.dumps({"verb": "simulate", "scenario": "shipped/cruise.toml", "seconds": 2, "hidden": True})
            request = urllib.request.Request(found[1] + "/api/run", body.encode(), headers)
            urllib.request.urlopen(request, timeout=20).close()
            for _ in range(240):
                history = self.work / "served/traction_serve/history.json"
                if history.exists() and '"done"' in history.read_text():
                    break
                time.sleep(0.25)
        finally:
            server.terminate()
            server.wait(20)
        self.judge("serve", "serve", json.loads(document.read_text()))
        self.judge("", "the history of serve", json.loads((self.work / "served/traction_serve/history.json").read_text()))

    def flash(self) -> None:
        self.run("flash", "--new-key", "signer")
        rover = ("--rover", "lhomme_desages")
        self.run("flash", "--pack", "p.tar", "--key", "signer", "--program", str(self.tractiond), *rover)
        self.run("flash", "p.tar", "--key", "signer.pub")
        packed = next(document for key, document in self.documents.items() if key.startswith("flash ") and document["action"] == "pack")
        self.run("flash", "p.tar", "--image", "p.img", "--key", "signer.pub", "--architecture", packed["package"]["architecture"])
        # in place of a board: this machine, and an installer that always has just taken the package
        (self.work / "ssh").write_text('#!/bin/sh\nwhile [ "$1" != -- ]; do shift; done\nshift 2\nexec sh -c "$*"\n', encoding="utf-8")
        says = "cat >/dev/null; echo 'signature and checksums hold: number 0'; echo 'confirmed 0'\n"
        (self.work / "slot").write_text("#!/bin/sh\n" + says, encoding="utf-8")
        for name in ("ssh", "slot"):
            (self.work / name).chmod(0o755)
        board = ("--host", "board", "--ssh", str(self.work / "ssh"), "--installer", str(self.work / "slot"))
        self.run("flash", "p.tar", *board)
        self.run("flash", "--status", *board)

    def drive(self) -> None:
        made = self.call("drive", "--new-key", "probe")
        if made.returncode == 2 and "not in this build" in made.stderr:
            self.excused["drive"] = "this build has no supervision link (pymavlink)"
            return
        self.run("drive", "--new-key", "key")
        (self.work / "stand.toml").write_text(
            'title = "Stands"\nduration_s = 60.0\nseed = 7\n[ground]\nsoil = "concrete"\n[[drive]]\nfor_s = 60.0\nmode = "stop"\n'
        )
        words = [self.tractiond, "--hal", "sim", "stand.toml", "--link", "127.0.0.1:0", "--link-key", "key", "--log", "logs"]
        with open(self.work / "rover.txt", "w") as said:
            daemon = subprocess.Popen(words, cwd=self.work, stderr=said, stdout=subprocess.DEVNULL)
        try:
            port = None
            for _ in range(80):
                if port := re.search(r"listens on 127\.0\.0\.1:(\d+) ", (self.work / "rover.txt").read_text()):
                    break
                time.sleep(0.25)
            if port is None:
                bad("tractiond does not listen: " + (self.work / "rover.txt").read_text()[-300:])
                return
            host = ("--host", "127.0.0.1:" + port[1], "--key", "key")
            # 1: a machine that is busy for 80 ms stops the rover, rightly; the result is whole all the same
            self.run("drive", *host, "--speed", "0.3", "--for", "1", codes=(0, 1))
            self.run("drive", *host, "--logs", "--parameters")
        finally:
            daemon.terminate()
            daemon.wait(10)


def same_as_source(schemas: Schemas, kind: str, file: Path, function: str, key: str) -> None:
    """Of verbs that may not run here: the keys in the function that writes the result are those of the schema."""
    body = file.read_text(encoding="utf-8").split(function)[1]
    keys = set(re.findall(key, re.split(r"\n(?:\}|def )", body)[0]))
    differ = keys ^ set(schemas.by_name[f"traction.{kind}/1"]["properties"])
    if differ:
        bad(f"{kind}: schema and {file.name} differ in {', '.join(sorted(differ))}")


def page_is_true(root: Path, schemas: Schemas) -> None:
    """The table of docs/json.md is what the files say; the reference names every schema."""
    text = (root / "docs/json.md").read_text(encoding="utf-8")
    for line in table(schemas).splitlines():
        if line not in text.splitlines():
            bad(f"docs/json.md lacks the line: {line}")
    listed = {row for row in re.findall(r"^\| `(traction\.[a-z_]+/\d+)` \|", text, re.MULTILINE)}
    for name in listed - set(schemas.by_name):
        bad(f"docs/json.md lists {name}, which has no file")
    words = (root / "docs/json_schema.md").read_text(encoding="utf-8")
    for name in set(re.findall(r"`(traction\.[a-z_]+/\d+)`", words)) - set(schemas.by_name):
        bad(f"docs/json_schema.md names {name}, which has no file")


def table(schemas: Schemas) -> str:
    lines = ["| schema | version | what | written by |", "|---|---|---|---|"]
    for name, schema in sorted(schemas.by_name.items()):
        written = ", ".join(f"`{verb}`" for verb in schema["x-verbs"]) or schema["x-written-by"]
        lines.append(f"| `{name}` | {schema['x-version']} | {schema['title']} | {written} |")
    return "\n".join(lines)


def main(root: Path, build: Path, cli: Path, tractiond: Path, work: Path) -> int:
    schemas = Schemas(root / "schemas")
    page_is_true(root, schemas)
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    for folder in ("host_tools", "sim", "python", "tests/bench"):
        for file in (root / folder).rglob("*"):
            if file.suffix in (".cpp", ".h", ".py"):
                for name in re.findall(r'"(traction\.([a-z_]+)/\d+)\b', file.read_text(encoding="utf-8")):
                    if name[0] not in schemas.by_name and name[1] not in NO_JSON:
                        bad(f"{file.relative_to(root)}: {name[0]} has no file in schemas/")
    runs = Runs(root, build, cli, tractiond, work, schemas)
    (work / "man").mkdir()
    if runs.call("man", "--folder", "man").returncode != 0:
        bad("traction man --folder fails: the verbs cannot be listed")
    dashed = {file.name.removeprefix("traction-").removesuffix(".1") for file in (work / "man").glob("traction-*.1")}
    claimed = [verb for schema in schemas.by_name.values() for verb in schema["x-verbs"]]
    for verb in sorted(dashed ^ {verb.replace(" ", "-") for verb in claimed}):
        bad(f"traction {verb}: {'has no schema in schemas/ (x-verbs)' if verb in dashed else 'is named by x-verbs, and there is no such verb'}")
    if len(claimed) != len(set(claimed)):
        bad("a verb stands in x-verbs of two schemas")

    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for part in [pool.submit(runs.lab), pool.submit(runs.whole)]:
            part.result()

    same_as_source(schemas, "emulate", root / "host_tools/cli/verb_emulate.cpp", "nlohmann::json run_json(", r'\{"(\w+)",')
    same_as_source(schemas, "campaign", root / "python/traction/campaigns/__main__.py", "def _write(", r'"(\w+)":')
    for verb, why in runs.excused.items():
        print(f"not run here: {verb}: {why}")
    print("not run here: emulate: it needs the board; its keys were compared with its source")
    for verb in sorted(set(claimed) - runs.verbs - set(runs.excused) - ELSEWHERE):
        bad(f"traction {verb}: no run of it in tests/schemas/schemas.py")
    slowest = sorted(runs.seconds.items(), key=lambda one: -one[1])[:5]
    print("slowest: " + ", ".join(f"{label} {seconds:.1f} s" for label, seconds in slowest))
    tried = sum(is_strict(schemas, label, document) for label, document in runs.documents.items())
    print(f"{len(schemas.by_name)} schemas, {runs.count} results of {len(runs.verbs - {''})} verbs; {tried} spoilt copies were refused" if not failures else "")
    return 1 if failures else 0


if __name__ == "__main__":
    if sys.argv[1:2] == ["--validate"]:
        known = Schemas(Path(sys.argv[2]) / "schemas")
        for name in sys.argv[3:]:
            for one in known.errors(json.loads(Path(name).read_text(encoding="utf-8"))):
                bad(f"{name}: {one}")
        sys.exit(1 if failures else 0)
    if sys.argv[1:2] == ["--table"]:
        print(table(Schemas(Path(sys.argv[2]) / "schemas")))
        sys.exit(0)
    sys.exit(main(*(Path(word).absolute() for word in sys.argv[1:6])))
