"""Campaigns: rows, one table whatever happens, refusals."""

import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import traction
from conftest import CLI, ROOT
from traction.campaigns.formula import Formula

pytest.importorskip("pyarrow")
SPEC = {
    "title": "slopes",
    "scenario": {
        "duration_s": 2.0,
        "ground": {"soil": "sand"},
        "drive": [{"for_s": 2.0, "mode": "platform_speed", "speed_m_s": 0.2}],
    },
    "seed": 5,
    "repeats": 2,
    "hide": 1,
    "part": 4,
    "vary": {"ground.slope_rad": {"low": 0.0, "high": 0.1, "count": 3}, "ground.soil": ["sand", "butter"]},
    "keep": {
        "figures": {"off": "rms(estimate.speed_m_s - 0.2)", "slow": "share(estimate.speed_m_s < 0.1)"},
        "columns": ["estimate.speed_m_s"],
        "rate_Hz": 10,
    },
}


def digests(folder):
    return {p.name: p.read_bytes() for p in sorted((folder / "results").glob("*.parquet"))}


@pytest.fixture(scope="module")
def reference(tmp_path_factory):
    folder = tmp_path_factory.mktemp("campaign") / "reference"
    return traction.campaign(SPEC, folder, workers=0)


def test_the_table_has_a_row_a_drive_and_failures_are_rows(reference):
    rows = reference.table().to_pylist()
    assert (
        [r["drive"] for r in rows] == list(range(12)) and len({r["seed"] for r in rows}) == 12 and len({r["hide_seed"] for r in rows}) == 12
    )
    for row in rows:
        if row["ground.soil"] == "butter":
            assert row["status"] == "failed" and "butter" in row["error"] and row["off"] is None
        else:
            assert row["status"] == "done" and row["error"] is None and json.loads(row["hidden"])
            assert len(row["series.estimate.speed_m_s"]) == len(row["series.t_s"]) == 20
    one = rows[0]
    log = traction.simulate({**SPEC["scenario"], "ground": {"soil": "sand", "slope_rad": 0.0}}, seed=one["seed"], hide=one["hide_seed"])
    assert log.run.trace_hash == one["trace_hash"]  # a drive is a function of its row
    assert one["off"] == float(np.sqrt(np.mean((log["estimate.speed_m_s"].values - 0.2) ** 2)))
    status = reference.status
    assert (status.done, status.failed, status.total) == (12, 6, 12)


@pytest.mark.parametrize("workers", [1, 3])
def test_the_table_is_the_same_whatever_the_number_of_workers(reference, tmp_path, workers):
    again = traction.campaign(SPEC, tmp_path / "c", workers=workers)
    assert digests(again.folder) == digests(reference.folder) and len(digests(again.folder)) == 3


def test_a_stopped_campaign_goes_on_and_drives_nothing_twice(reference, tmp_path):
    seen = []

    class Enough(Exception):
        pass

    def stop_after_some(progress):
        seen.append(progress.done)
        if progress.done >= 6:
            raise Enough

    with pytest.raises(Enough):
        traction.campaign(SPEC, tmp_path / "c", workers=0, progress=lambda p: stop_after_some(p) if time.sleep(0.11) is None else None)
    stopped = traction.campaigns.Campaign(tmp_path / "c")
    assert stopped.status.done == 6 and stopped.table().num_rows == 6
    counted = []
    whole = traction.campaign(SPEC, tmp_path / "c", workers=0, progress=lambda p: counted.append(p))
    assert digests(whole.folder) == digests(reference.folder) and counted[-1].done == 12
    assert not list((tmp_path / "c" / "inbox").iterdir())


def was_killed_midway(spec, folder):
    """Whether a campaign with workers of its own was killed with some drives in and others not: on a busy machine it may end first."""
    code = "import json,sys,traction; traction.campaign(json.load(open(sys.argv[1])), sys.argv[2], workers=2)"
    process = subprocess.Popen([sys.executable, "-c", code, str(spec), str(folder)])
    deadline = time.monotonic() + 60
    while process.poll() is None and time.monotonic() < deadline:
        if any(file.read_bytes().count(b"\n") >= 2 for file in folder.glob("inbox/*.jsonl")):
            process.send_signal(signal.SIGKILL)
            break
        time.sleep(0.001)
    return process.wait() == -signal.SIGKILL


def test_killed_with_its_workers_midway_it_loses_nothing(tmp_path, reference):
    spec = tmp_path / "spec.json"
    spec.write_text(json.dumps(SPEC))
    folder = next((tmp_path / str(i) for i in range(10) if was_killed_midway(spec, tmp_path / str(i))), None)
    assert folder is not None
    whole = traction.campaign(SPEC, folder, workers=2)
    assert digests(whole.folder) == digests(reference.folder)


def test_a_torn_inbox_costs_its_torn_drives_alone(tmp_path, reference):
    class Enough(Exception):
        pass

    def stop(progress):
        if progress.done >= 3:
            raise Enough

    with pytest.raises(Enough):
        traction.campaign(SPEC, tmp_path / "c", workers=0, progress=lambda p: stop(p) if time.sleep(0.11) is None else None)
    (inbox,) = (tmp_path / "c" / "inbox").iterdir()
    first, second, third = inbox.read_bytes().splitlines(keepends=True)
    inbox.write_bytes(first + b"\0" * 200 + b"\n" + third[:-20])  # a power cut: a block that was not written, an end that is missing
    assert traction.campaigns.Campaign(tmp_path / "c").table().column("drive").to_pylist() == [0]
    driven = []
    whole = traction.campaign(SPEC, tmp_path / "c", workers=0, progress=lambda p: driven.append(p.done))
    assert digests(whole.folder) == digests(reference.folder)
    inbox.write_bytes(second)  # a stop between a part's writing and its inbox's removal
    assert whole.table().num_rows == 12 and traction.campaign(SPEC, whole.folder).table().num_rows == 12 and not inbox.exists()


def test_rows_too_long_for_a_pipe_and_quick_ones_come_back_each_with_its_own(tmp_path):
    from traction.campaigns.pool import drive_all

    (tmp_path / "echo_task.py").write_text(
        "import os, signal\n\n\nclass Echo:\n    def run(self, row):\n        if row['drive'] == 30:\n"
        "            os.kill(os.getpid(), signal.SIGKILL)\n        return {'status': 'done', 'said': row['drive'], 'text': row['text']}\n"
    )
    sys.path.insert(0, str(tmp_path))
    try:
        from echo_task import Echo

        rows = [{"drive": n, "text": "x" * (300_000 if n < 40 else 10)} for n in range(60)]
        told = list(drive_all(Echo(), rows, 3))
    finally:
        sys.path.remove(str(tmp_path))
    assert sorted(row["drive"] for row, _ in told) == list(range(60))
    for row, answer in told:
        if row["drive"] == 30:
            assert answer == {"status": "failed", "error": "its process ended (signal SIGKILL)"}
        else:
            assert (answer["said"], answer["text"]) == (row["drive"], row["text"])


def test_a_drive_that_ends_its_process_is_a_row(tmp_path, monkeypatch):
    from traction.campaigns import pool

    monkeypatch.setattr(pool, "WORKER", "import os, traction.campaigns.pool as p\n"
        "run = p.run_row\n"
        "p.run_row = lambda job, row: os.kill(os.getpid(), 9) if row['drive'] == 2 else run(job, row)\n"
        "p.serve()\n")  # fmt: skip
    rows = traction.campaign(SPEC, tmp_path / "c", workers=2).table().to_pylist()
    assert "SIGKILL" in rows[2]["error"] and rows[2]["status"] == "failed" and rows[3]["error"] != rows[2]["error"]
    assert len(rows) == 12


def test_two_campaigns_in_one_folder_are_refused_by_name(reference, tmp_path):
    with pytest.raises(traction.CampaignError, match="'slopes'"):
        traction.campaign({**SPEC, "seed": 6}, reference.folder)
    with traction.campaigns.store.Store(reference.folder).writing(traction.Spec.of(SPEC)):
        with pytest.raises(traction.CampaignError, match=rf"process {os.getpid()}.*'slopes'"):
            traction.campaign(SPEC, reference.folder)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").write_text("")
    with pytest.raises(traction.CampaignError, match="thesis.txt"):
        traction.campaign(SPEC, tmp_path / "mine")


def test_a_scenario_finds_the_rover_that_lies_beside_it(tmp_path):
    (tmp_path / "rovers").mkdir()
    (tmp_path / "rovers" / "own.toml").write_text((ROOT / "rovers" / "heavy.toml").read_text())
    text = 'rover = "rovers/own.toml"\nduration_s = 1.0\n[ground]\nsoil = "sand"\n[[drive]]\nfor_s = 1.0\nmode = "stop"\n'
    (tmp_path / "own.toml").write_text(text)
    (tmp_path / "c.toml").write_text('scenario = "own.toml"\n[vary]\nground.slope_rad = [0.0, 0.1]\n')
    rows = traction.campaign(tmp_path / "c.toml", tmp_path / "c", workers=1).table().to_pylist()
    assert [r["status"] for r in rows] == ["done", "done"], rows[0]["error"]
    alone = traction.simulate(tmp_path / "own.toml", seed=rows[1]["seed"], ground__slope_rad=0.1)
    assert alone.run.trace_hash == rows[1]["trace_hash"] != rows[0]["trace_hash"]


def test_rows_that_come_do_not_change_the_others(reference):
    more = json.loads(json.dumps(SPEC))
    more["vary"]["ground.soil"] = ["sand", "gravel", "butter"]
    known = {(r["ground.slope_rad"], r["ground.soil"], r["repeat"]): r["seed"] for r in reference.table().to_pylist()}
    seeds = {(r["ground.slope_rad"], r["ground.soil"], r["repeat"]): r["seed"] for r in traction.Spec.of(more).rows}
    assert known.items() <= seeds.items()


@pytest.mark.parametrize("method", ["latin_hypercube", "sobol"])
def test_samples_fill_their_ranges(method):
    pytest.importorskip("scipy")
    vary = {
        "ground.slope_rad": {"low": -0.1, "high": 0.3},
        "rover.mass_kg": {"low": 1, "high": 100, "log": True},
        "ground.soil": ["sand", "gravel"],
    }
    spec = {**SPEC, "method": method, "drives": 64, "repeats": 1, "vary": vary}
    rows = traction.Spec.of(spec).rows
    slope, mass = np.array([r["ground.slope_rad"] for r in rows]), np.array([r["rover.mass_kg"] for r in rows])
    assert np.array_equal(np.sort((slope + 0.1) / 0.4 * 64).astype(int), np.arange(64))  # one in each of 64 strata
    assert np.array_equal(np.sort(np.log(mass) / np.log(100) * 64).astype(int), np.arange(64))
    assert 25 <= sum(r["ground.soil"] == "sand" for r in rows) <= 39
    assert rows == traction.Spec.of(spec).rows


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"methd": "grid"}, "methd"),
        ({"method": "random"}, "method"),
        ({"vary": {"a": {"low": 1, "high": 1}}}, "vary.a"),
        ({"vary": {"a": {"low": 0, "high": 1}}}, "vary.a"),
        ({"vary": {"seed": [1]}}, "seed"),
        ({"keep": {"figures": {"f": "open('x')"}}}, "keep.figures.f"),
        ({"keep": {"figures": {"f": "mean(a.b"}}}, "keep.figures.f"),
        ({"keep": {"diagnosis": "no_model"}}, "keep.diagnosis"),
        ({"scenario": "nowhere"}, "scenario"),
        ({"drives": 0}, "drives"),
    ],
)
def test_a_wrong_specification_is_refused_with_its_key(change, key):
    with pytest.raises(traction.CampaignError) as told:
        traction.Spec.of({**SPEC, **change})
    assert told.value.key == key and "to mend:" in str(told.value)


def test_formulas_are_what_numpy_says():
    t = np.arange(4.0)
    a, b = traction.Column("o.a", t, np.array([3.0, -1.0, 4.0, 1.0]), "", "", ""), traction.Column("o.b", t[:2], t[:2], "", "", "")
    log = {"o.a": a, "o.b": b}

    def value(text: str) -> float:
        return Formula(text, "f")(log, None, 7.0)

    v = a.values
    assert value("max(o.a) - min(o.a)") == 5 and value("integral(o.a)") == 5.0 and value("mean(part(o.a, 1, 2))") == 1.5
    assert (
        value("rms(o.a)") == np.sqrt(np.mean(v**2))
        and value("quantile(o.a, 0.5)") == np.median(v)
        and value("-last(o.a) * 2 + duration_s") == 5
    )
    assert value("share(abs(o.a) > 2)") == 0.5 and value("count(o.b)") == 2
    for wrong in ("o.a", "mean(o.a + o.b)", "mean(o.c)"):
        with pytest.raises(traction.CampaignError):
            value(wrong)


def test_a_diagnosis_is_kept(tmp_path):
    point = {"effect.slip_sinkage.coefficient": 0.3}
    spec = {"scenario": "sweep_sand", "row": [point], "keep": {"diagnosis": "rover_sand"}}
    row = traction.campaign(spec, tmp_path / "c", workers=0).table().to_pylist()[0]
    assert row["status"] == "done", row["error"]
    told = traction.diagnose("rover_sand", traction.simulate("sweep_sand", seed=row["seed"], effects=["slip_sinkage:coefficient=0.3"]))
    assert (row["verdict"], json.loads(row["named"])) == (told.kind, list(told.verdict.effects))
    assert row["error_after"] == told.ladder[-1].heldout <= row["error_before"]


def test_the_command_line_runs_and_tells(cli, tmp_path):
    (tmp_path / "c.toml").write_text(
        'scenario = "cruise"\n[set]\nduration_s = 2.0\n[vary]\nground.soil = ["sand", "gravel"]\n'
        '[keep.figures]\nv = "mean(estimate.speed_m_s)"\n'
    )
    env = {**os.environ, "TRACTION_PYTHON": sys.executable}

    def run(*words):
        return subprocess.run([CLI, "campaign", *words], cwd=tmp_path, env=env, capture_output=True, text=True)

    done = run("c.toml", "--out", "r", "--workers", "2")
    assert done.returncode == 0, done.stderr
    assert "2 of 2 drives" in run("--status", "--out", "r").stdout
    wrong = run("nowhere.toml", "--out", "r")
    assert wrong.returncode == 3 and "nowhere.toml" in wrong.stderr


def test_the_documented_example_is_a_specification(tmp_path):
    text = (ROOT / "docs" / "campaign.md").read_text(encoding="utf-8")
    example = tmp_path / "slopes.toml"
    example.write_text(text.split("```toml\n")[1].split("```")[0], encoding="utf-8")
    assert len(traction.Spec.read(example).rows) == 5 * 2 * 3 * 3  # grid of three factors, each point three times
