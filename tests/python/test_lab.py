"""The lab: the command line's numbers on ten logs, typed results, refusals."""

import json
import os
import signal
import threading

import numpy as np
import pytest

import traction
from conftest import ROOT

DATA = ROOT.parent / "shared" / "data"

GENERATED = [
    ("cruise", "rover_sand", []),
    ("sweep_sand", "rover_sand", []),
    ("sweep_gravel", "rover_gravel", ["multi_pass"]),
    ("sweep_concrete", "rover_concrete", []),
    ("demo_sand", "rover_sand", ["slip_sinkage:coefficient=0.2"]),
    ("fig17_slip_servo_gravel", "rover_gravel", []),
]
MEASURED = [
    ("robotino/one_gray_v0.1_dir000.csv", "robotino", "robotino"),
    ("robotino/one_table_v0.1_dir090.csv", "robotino", "robotino"),
    ("robotino/one_gray_v0.2_dir030.csv", "robotino", "robotino"),
    ("robotino/motor_data_for_identification_with_integral.csv", "robotino_unloaded", "robotino_unloaded"),
]


def same(python: dict, cli: dict) -> None:
    assert json.dumps(python, sort_keys=True) == json.dumps(cli, sort_keys=True)


@pytest.mark.parametrize(("scenario", "model", "effects"), GENERATED)
def test_numbers_are_the_command_lines_on_generated_logs(cli, tmp_path, scenario, model, effects):
    log = traction.simulate(scenario, seed=11, effects=effects)
    file = tmp_path / "log.csv"
    log.write(file)
    path = str(ROOT / f"models/{model}.toml")
    used = traction.Model.read(path)
    read = traction.Log.read(file)
    same(traction.check(str(file), used).json, cli("check", file, "--model", path))
    same({**traction.check(read, used).json}, cli("check", file, "--model", path))
    from_file = traction.compare(used, read)
    same(from_file.json, cli("compare", "--model", path, "--log", file))
    in_memory = traction.compare(used, log)  # never was a file
    assert in_memory.score == from_file.score and in_memory.json["balances"] == from_file.json["balances"]


@pytest.mark.parametrize(("name", "model", "chart"), MEASURED)
def test_numbers_are_the_command_lines_on_measured_logs(cli, name, model, chart):
    file = DATA / name
    if not file.is_file():
        pytest.skip(f"not here: {name}")
    path, chart_path = str(ROOT / f"models/{model}.toml"), str(ROOT / f"models/maps/{chart}.toml")
    words = ["compare", "--model", path, "--log", file, "--map", chart_path]
    log = traction.Log.read(file, map=chart)
    checked = traction.check(log, path)
    despite = [] if checked else sorted({f.id for f in checked.findings if f.severity == "error"})
    for finding in despite:
        words += ["--despite", finding]
    same(traction.compare(path, log, despite=despite).json, cli(*words))


def test_diagnose_add_fit_next_are_the_command_lines(cli, sand_log):
    path = str(ROOT / "models/rover_sand.toml")
    told = traction.diagnose(path, str(sand_log))
    given = cli("diagnose", "--model", path, "--log", sand_log, "--apply", "--out", "better.toml")
    same(told.json, given)
    assert told.verdict.effects == ("slip_sinkage",) and told.kind in ("named", "class")
    assert told.candidates[0].effect == "slip_sinkage" and told.accepted[0].parameters
    assert told.model.text.split("[[lineage]]")[0] == traction.Model.read(cli.folder / "better.toml").text.split("[[lineage]]")[0]
    assert told.ladder[-1].heldout < told.ladder[0].heldout
    added = traction.add(path, "slip_sinkage", str(sand_log))
    same(added.json, cli("add", "slip_sinkage", "--model", path, "--log", sand_log, "--out", "added.toml"))
    fitted = traction.fit(added.model, str(sand_log))
    assert fitted.fitted["soil.mu"].low < fitted.fitted["soil.mu"].value < fitted.fitted["soil.mu"].high
    assert not traction.drop(added.model, "slip_sinkage").effects and added.model.effects
    for result in (told, added, fitted):
        page = result._repr_html_()
        assert "ladder" in page and "<svg" in page and "<script" not in page


def test_fit_is_the_command_lines(cli, sand_log):
    path = str(ROOT / "models/rover_sand.toml")
    same(traction.fit(path, sand_log).json, cli("fit", "--model", path, "--log", sand_log))


def test_next_is_the_command_lines_and_can_be_driven(cli):
    path = str(ROOT / "models/rover_sand.toml")
    proposal = traction.next(path, effects=["multi_pass", "mass_offset_x"])
    same(proposal.json, cli("next", "--model", path, "--effects", "multi_pass", "mass_offset_x", "--out", "next.toml"))
    assert traction.simulate(proposal.scenario).duration_s > 1 and proposal.questions and "d' after" in proposal._repr_html_()


def test_balances_are_arrays_whose_residuals_give_the_stated_error(sand_log):
    compared = traction.compare("rover_sand", sand_log)
    for balance in compared.balances.values():
        assert balance.t_s.shape == balance.measured.shape == balance.model.shape
        if len(balance.t_s) < 3000:  # not thinned
            np.testing.assert_allclose(np.sqrt(np.nanmean(balance.residual**2)), balance.rmse, rtol=1e-3)  # values of 4 digits or more


def test_a_report_is_the_command_lines_page(cli, sand_log, tmp_path):
    path = str(ROOT / "models/rover_sand.toml")
    cli("compare", "--model", path, "--log", sand_log, "--report", "cli.html")
    traction.compare(path, sand_log).report(tmp_path / "python.html")
    assert (tmp_path / "python.html").read_bytes() == (tmp_path / "cli.html").read_bytes()
    traction.check(sand_log, path).report(tmp_path / "check.html")
    assert "traction.check/1" in (tmp_path / "check.html").read_text()


def test_a_spoilt_log_is_refused_and_taken_only_aloud(sand_log):
    log = traction.Log.read(sand_log)
    spoilt = {n: (c.t_s, -c.values if n.endswith("speed_rad_s") and n.startswith("wheel1") else c.values) for n, c in log.items()}
    bad = traction.Log.of(spoilt, header=log.header, name="mirrored")
    checked = traction.check(bad, "rover_sand")
    assert not checked and any(f.severity == "error" and f.mend for f in checked.findings) and "mend" in checked._repr_html_()
    with pytest.raises(traction.Refused, match="mirrored"):
        traction.compare("rover_sand", bad)
    despite = sorted({f.id for f in checked.findings if f.severity == "error"})
    assert traction.compare("rover_sand", bad, despite=despite).json["log"]["despite"]


def test_mistakes_are_told_with_their_parts(sand_log, tmp_path):
    with pytest.raises(traction.ModelError) as told:
        traction.Model.parse('format = "traction.model/1"\n[rover]\nmass_kgg = 3\n', "mine.toml")
    assert told.value.file == "mine.toml" and told.value.line == 3 and told.value.mend
    with pytest.raises(traction.ModelError, match="slip_sinkage"):
        traction.drop("rover_sand", "slip_sinkage")
    with pytest.raises(traction.ModelError):
        traction.add("rover_sand", "no_such_effect", sand_log)
    with pytest.raises(traction.ModelError):
        traction.next("rover_sand")
    with pytest.raises(traction.InputError):
        traction.compare("rover_sand", [])


def test_ctrl_c_ends_a_diagnosis(sand_log):
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        traction.diagnose("rover_sand", sand_log)
