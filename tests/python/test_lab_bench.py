"""The lab's bench and round trip as campaigns: the bench's own table, whatever happens; refusals."""

import dataclasses
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import traction
from conftest import CLI, ROOT
from test_campaign import digests
from traction.campaigns import LabSpec, plan_of
from traction.campaigns.lab_bench import GENERATORS, PROGRAMS, Programs

pytest.importorskip("pyarrow")
BUILD = Path(CLI).resolve().parents[2]
ROUND_TRIP = BUILD / PROGRAMS["round_trip"][0]
SMALL = {"kind": "lab_bench", "generator": ["independent", "apart"], "logs": 3, "seed": 1000, "duration_s": 20, "part": 2}

needs_build = pytest.mark.skipif(
    not all((BUILD / name).is_file() for names in PROGRAMS.values() for name in names), reason="the bench's programs are not built here"
)


@pytest.fixture(autouse=True)
def build(monkeypatch):
    monkeypatch.setenv("TRACTION_BUILD", str(BUILD))


@pytest.fixture(scope="module")
def reference(tmp_path_factory):
    os.environ["TRACTION_BUILD"] = str(BUILD)
    return traction.campaign(SMALL, tmp_path_factory.mktemp("bench") / "reference", workers=1)


def untimed(text: str) -> list[str]:
    """A table without the two lines that are another each time."""
    return [line for line in text.splitlines() if not line.startswith("seconds per 120 s")]


def bench(folder: Path, *words: object) -> tuple[str, dict]:
    """What `traction bench lab` prints, and its JSON."""
    file = folder / "bench.json"
    done = subprocess.run(
        [CLI, "bench", "lab", *map(str, words), "--json", str(file)],
        capture_output=True,
        text=True,
        env={**os.environ, "TRACTION_ROOT": str(ROOT)},
    )
    assert done.returncode == 0, done.stderr
    return done.stdout, json.loads(file.read_text())


def without_time(document: dict) -> dict:
    """The same without processor times."""
    timed = {"seconds_median", "seconds_p95"}
    parts = [document["lines"], *document["by_soil"].values(), *document.get("by_group", {}).values()]
    for lines in parts:
        lines[:] = [line for line in lines if line["key"] not in timed]
    for case in document["cases"]:
        del case["seconds"]
    return document


@needs_build
def test_the_table_is_the_benchs_for_every_generator(tmp_path):
    spec = {"kind": "lab_bench", "generator": list(GENERATORS["lab_bench"]), "logs": 2, "seed": 4203, "duration_s": 20}
    done = traction.campaign(spec, tmp_path / "c", workers=2)
    tables = done.tables()
    assert done.status.done == 10 and len(tables) == 5
    for generator, table in zip(spec["generator"], tables, strict=True):
        text, document = bench(tmp_path, "--generator", generator, "--logs", 2, "--seed", 4203, "--duration", 20)
        assert untimed(text) == untimed(table.text), generator
        assert without_time(document) == without_time(table.json), generator
        assert "2 sealed logs, generator: " + generator in text and len(document["cases"]) == 2


@needs_build
def test_the_table_is_the_benchs_for_every_category(tmp_path):
    spec = {
        "kind": "lab_bench",
        "generator": "apart",
        "category": ["clean", "one", "two", "outside"],
        "logs": 1,
        "seed": 7,
        "duration_s": 20,
    }
    done = traction.campaign(spec, tmp_path / "c", workers=2)
    rows = done.table().to_pylist()
    assert [row["hidden_category"] for row in rows] == spec["category"] == [row["category"] for row in rows]
    assert [len(json.loads(row["hidden"])) for row in rows] == [0, 1, 2, 1]
    for category, table in zip(spec["category"], done.tables(), strict=True):
        text, document = bench(tmp_path, "--generator", "apart", "--category", category, "--logs", 1, "--seed", 7, "--duration", 20)
        assert untimed(text) == untimed(table.text) and without_time(document) == without_time(table.json), category


@needs_build
def test_a_row_tells_the_truth_what_was_said_and_the_time_apart(reference):
    rows, times = reference.table().to_pylist(), reference.times().to_pylist()
    assert [(r["drive"], r["generator"], r["seed"]) for r in rows] == [
        (n, g, s) for n, (g, s) in enumerate((g, s) for g in ("independent", "apart") for s in (1000, 1001, 1002))
    ]
    assert [t["drive"] for t in times] == list(range(6)) and all(t["lab_cpu_s"] > 0 for t in times)
    assert not any("cpu" in name or "seconds" in name for name in rows[0]) and "seconds" not in json.loads(rows[0]["judged"])
    for row in rows:
        assert row["status"] == "done" and row["error"] is None and row["verdict"] and row["text"] and row["error_after"] > 0
        assert isinstance(json.loads(row["named"]), list) and isinstance(json.loads(row["classes"]), list)
        for one in json.loads(row["intervals"]):
            assert {"effect", "wheel", "parameters"} <= set(one)
        if row["hidden_category"] == "one":
            assert row["floor"] > 0 and row["detectability"] > 0
    assert any(json.loads(row["intervals"]) for row in rows)
    assert not list(reference.folder.glob("scratch*")) and not list((reference.folder / "inbox").iterdir())


@needs_build
def test_a_run_begins_beside_what_a_killed_ones_programs_still_write(tmp_path, monkeypatch):
    spec = LabSpec.of(SMALL)
    left = Path(spec.task(tmp_path).scratch)
    (left / "under_way.csv").write_text("t_s")
    monkeypatch.setattr(shutil, "rmtree", lambda *_, **__: None)  # what somebody writes into is not taken away
    own = Path(spec.task(tmp_path).scratch)
    assert own != left and own.is_dir() and not list(own.iterdir()) and (left / "under_way.csv").is_file()
    monkeypatch.undo()
    spec.task(tmp_path)
    assert not left.is_dir() and not own.is_dir()


@needs_build
def test_the_table_is_the_same_for_two_workers_and_after_a_kill(reference, tmp_path):
    folder, file = tmp_path / "c", tmp_path / "spec.json"
    file.write_text(json.dumps(SMALL))
    code = "import json,sys,traction; traction.campaign(json.load(open(sys.argv[1])), sys.argv[2], workers=2)"
    process = subprocess.Popen([sys.executable, "-c", code, str(file), str(folder)])
    deadline = time.monotonic() + 120
    while process.poll() is None and time.monotonic() < deadline:
        if any(b"\n" in inbox.read_bytes() for inbox in folder.glob("inbox/*.jsonl")):  # a drive is done, not only begun to be written
            break
        time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    assert process.wait() == -signal.SIGKILL  # it was under way
    before = {row["drive"]: row["lab_cpu_s"] for row in traction.Campaign(folder).times().to_pylist()}
    assert 0 < len(before) < 6
    whole = traction.campaign(SMALL, folder, workers=2)
    after = {row["drive"]: row["lab_cpu_s"] for row in whole.times().to_pylist()}
    assert before.items() <= after.items()  # what was done is not done again
    assert digests(whole.folder) == digests(reference.folder) and len(digests(whole.folder)) == 3
    for one, other in zip(whole.tables(), reference.tables(), strict=True):
        assert untimed(one.text) == untimed(other.text)


@needs_build
def test_the_command_line_runs_the_bench_as_a_campaign(tmp_path):
    env = {**os.environ, "TRACTION_PYTHON": sys.executable}
    words = ["--logs", "2", "--seed", "1000", "--duration", "20", "--generator", "apart"]

    def run(*more):
        return subprocess.run([CLI, "bench", "lab", *words, *more], cwd=tmp_path, env=env, capture_output=True, text=True)

    done = run("--out", "c", "--json", "c.json")
    assert done.returncode == 0, done.stderr
    text, document = bench(tmp_path, *words)
    assert "2 of 2 drives" in done.stdout and untimed(text) == untimed(done.stdout)[2:]
    assert without_time(json.loads((tmp_path / "c.json").read_text())) == without_time(document)
    status = subprocess.run([CLI, "campaign", "--status", "--out", "c"], cwd=tmp_path, env=env, capture_output=True, text=True)
    assert status.returncode == 0 and untimed(status.stdout) == untimed(done.stdout)
    assert run("--out", "c", "--keep", "d").returncode == 2 and run("--scheduler", "tcp://127.0.0.1:1").returncode == 2
    words[3] = "1001"
    other = run("--out", "c")
    assert other.returncode == 3 and "holds the campaign 'bench lab, apart'" in other.stderr


@needs_build
@pytest.mark.parametrize("generator", GENERATORS["round_trip"])
def test_the_round_trips_table_is_its_programs(tmp_path, generator):
    spec = {"kind": "round_trip", "generator": generator, "seed": 201, "logs": 2, "duration_s": 20}
    done = traction.campaign(spec, tmp_path / "c", workers=2)
    alone = subprocess.run([ROUND_TRIP, generator, "201", "202", "20"], cwd=ROOT, capture_output=True, text=True)
    (table,) = done.tables()
    assert table.text == alone.stdout and "seeds 201 to 202" in table.text and table.met == (alone.returncode == 0)
    for row in done.table().to_pylist():
        estimates = json.loads(row["estimates"])
        assert row["parameters"] == len(estimates) - 1 and estimates[-1]["key"] == "effect: " + row["effect"]
        assert row["effect_inside"] == (row["effect_low"] <= row["effect_truth"] <= row["effect_high"])


@needs_build
def test_another_build_on_a_worker_ends_the_campaign(tmp_path):
    spec = plan_of(SMALL)
    assert isinstance(spec, LabSpec)
    own = Programs.of("lab_bench", ["apart"])
    spec.__dict__["programs"] = dataclasses.replace(own, digests=((own.path("lab_bench"), "another"),))
    with pytest.raises(traction.CampaignError, match="lab_bench on .* is not the campaign's; to mend:"):
        traction.campaign(spec, tmp_path / "c", workers=1)
    assert not list((tmp_path / "c" / "inbox").iterdir())


def stand_in(folder: Path, script: str) -> None:
    """A build folder whose bench is a shell script."""
    for name in PROGRAMS["lab_bench"]:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text("#!/bin/sh\n" + script)
        (folder / name).chmod(0o755)
    (folder / "CMakeCache.txt").write_text(f"CMAKE_HOME_DIRECTORY:INTERNAL={folder}\n")


def test_a_log_whose_program_fails_is_a_row(tmp_path, monkeypatch):
    told = dict.fromkeys("soil hidden_category verdict text error_before error_after floor detectability error".split())
    answer = json.dumps({**told, "hidden": [], "named": [], "classes": [], "intervals": [], "judged": {}, "seconds": 0.5})
    unanswered = answer.replace('"error": null', '"error": "no wheel speed"')
    stand_in(
        tmp_path / "build",
        'while [ "$1" != --seed ]; do shift; done\ncase $2 in\n'
        "  1) echo 'lab_bench: this failed' >&2; exit 3 ;;\n  2) kill -9 $$ ;;\n"
        f"  3) printf '%s\\n' '{unanswered}' ;;\n  *) printf '%s\\n' '{answer}' ;;\nesac\n",
    )
    monkeypatch.setenv("TRACTION_BUILD", str(tmp_path / "build"))
    done = traction.campaign({"kind": "lab_bench", "logs": 4, "seed": 1}, tmp_path / "c", workers=2)
    rows = done.table().to_pylist()
    assert [row["status"] for row in rows] == ["failed", "failed", "failed", "done"]
    assert [row["error"] for row in rows] == ["lab_bench: this failed", "lab_bench was ended by SIGKILL", "no wheel speed", None]
    assert [row["judged"] for row in rows] == [None, None, "{}", "{}"]  # the bench counts a log that the lab cannot answer
    assert (done.status.done, done.status.failed) == (4, 3)
    assert [time["lab_cpu_s"] for time in done.times().to_pylist()] == [None, None, 0.5, 0.5]
    shutil.rmtree(tmp_path / "build")
    with pytest.raises(traction.CampaignError, match="lab_bench is not in .*to mend: build them"):
        traction.campaign({"kind": "lab_bench", "logs": 4, "seed": 1}, tmp_path / "d")


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"kind": "lab"}, "kind"),
        ({"kind": ["lab_bench"]}, "kind"),
        ({"generator": "moon"}, "generator"),
        ({"generator": []}, "generator"),
        ({"generator": ["apart", "apart"]}, "generator"),
        ({"kind": "round_trip", "generator": "fleet"}, "generator"),
        ({"kind": "round_trip", "category": "one"}, "category"),
        ({"kind": "round_trip", "seed": 0}, "seed"),
        ({"category": "three"}, "category"),
        ({"generator": ["apart", "plant"], "category": "one"}, "category"),
        ({"logs": 0}, "logs"),
        ({"logs": True}, "logs"),
        ({"seed": -1}, "seed"),
        ({"seed": 2**60}, "seed"),
        ({"duration_s": 5}, "duration_s"),
        ({"duration_s": "long"}, "duration_s"),
        ({"vary": {"ground.soil": ["sand"]}}, "vary"),
        ({"generators": "apart"}, "generators"),
    ],
)
def test_a_wrong_bench_is_refused_with_its_key(change, key):
    with pytest.raises(traction.CampaignError) as told:
        plan_of({"kind": "lab_bench", **change})
    assert told.value.key == key and "to mend:" in str(told.value)


def test_the_documented_benches_are_specifications(tmp_path):
    text = (ROOT / "docs" / "campaign.md").read_text(encoding="utf-8")
    examples = [part.split("```")[0] for part in text.split("```toml\n")[1:] if "kind = " in part.split("```")[0]]
    assert len(examples) == 1
    file = tmp_path / "bench.toml"
    file.write_text(examples[0], encoding="utf-8")
    spec = traction.campaigns.read_plan(file)
    assert isinstance(spec, LabSpec) and len(spec.rows) == spec.logs * len(spec.groups) and spec.rows == plan_of(spec.table).rows
