"""Drives: the command line's bits, changed keys, interruption."""

import os
import signal
import threading
import time

import numpy as np
import pytest

import traction
from test_log import SHORT


def test_the_log_is_the_command_lines_byte_for_byte(cli, tmp_path):
    run = cli(
        "simulate",
        "cruise",
        "--seed",
        3,
        "--effect",
        "multi_pass",
        "--hide",
        5,
        "--seal",
        "seal.json",
        "--truth",
        "truth.csv",
        "--out",
        "cli.csv",
    )
    log = traction.simulate("cruise", seed=3, effects=["multi_pass"], hide=5, truth=True)
    log.write(tmp_path / "python.csv")
    assert (tmp_path / "python.csv").read_bytes() == (tmp_path / "cli.csv").read_bytes()
    assert log.run.trace_hash == run["runs"][0]["trace_hash"]
    assert log.run.seal == (tmp_path / "seal.json").read_text()
    log.run.truth.write(tmp_path / "python_truth.csv")
    assert (tmp_path / "python_truth.csv").read_bytes() == (tmp_path / "truth.csv").read_bytes()


def test_text_dict_and_changes_say_the_same():
    table = {
        "duration_s": 3.0,
        "seed": 4,
        "ground": {"soil": "sand"},
        "drive": [{"for_s": 3.0, "mode": "platform_speed", "speed_m_s": np.float64(0.2)}],
    }
    hashes = {
        traction.simulate(SHORT).run.trace_hash,
        traction.simulate(table).run.trace_hash,
        traction.simulate(SHORT, **{"drive[0].speed_m_s": 0.2}).run.trace_hash,
        traction.simulate(SHORT.replace("sand", "gravel"), ground__soil="sand").run.trace_hash,
    }
    assert len(hashes) == 1
    assert traction.simulate(SHORT, ground__soil="gravel").run.trace_hash not in hashes


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"ground.sole": "sand"}, "sole"),
        ({"ground.soil": "butter"}, "soil"),
        ({"drive[4].speed_m_s": 1}, "drive[4]"),
        ({"ground.soil": object()}, "ground.soil"),
        ({"duration_s.x": 1}, "duration_s"),
    ],
)
def test_a_wrong_change_is_told_with_key_and_mend(changes, key):
    with pytest.raises(traction.ScenarioError) as told:
        traction.simulate(SHORT, **changes)
    assert key in told.value.key and told.value.mend


def test_a_mistake_in_text_keeps_its_line():
    with pytest.raises(traction.ScenarioError) as told:
        traction.simulate(SHORT.replace("platform_speed", "platform_sped"))
    assert told.value.line == 8
    with pytest.raises(traction.ScenarioError, match="nowhere.toml"):
        traction.simulate("nowhere.toml")
    for options in ({"seed": -1}, {"hide": 1, "hide_count": 9}, {"firmware": "old"}, {"effects": ["slip_sinkag"]}):
        with pytest.raises(traction.ScenarioError):
            traction.simulate(SHORT, **options)


def test_ctrl_c_ends_a_long_drive_and_other_threads_run_meanwhile():
    ticks = []
    stop = threading.Event()

    def other() -> None:
        while not stop.wait(0.01):
            ticks.append(time.monotonic())

    thread = threading.Thread(target=other, daemon=True)
    thread.start()
    threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        traction.simulate(SHORT, duration_s=36000.0)
    spent = time.monotonic() - began
    stop.set()
    thread.join()
    assert 0.4 < spent < 3  # a second of simulated time takes 3 ms, and is asked every 50 ms; the rest is a loaded machine
    assert len([t for t in ticks if t < began + 0.5]) >= 10  # of 50: the lock is free


def test_a_rover_drives_as_its_file_says(cli, tmp_path):
    cli("simulate", "cruise", "--rover", "rovers/heavy.toml", "--out", "heavy.csv")
    traction.simulate("cruise", rover="heavy").write(tmp_path / "python.csv")
    assert (tmp_path / "python.csv").read_bytes() == (tmp_path / "heavy.csv").read_bytes()
    rover = traction.Rover.read("heavy")
    mass = next(p for key, p in rover.parameters.items() if key.endswith("mass_kg"))
    assert mass.unit == "kg" and mass.given and rover._repr_html_() and rover.firmware_text()


def test_effects_are_the_catalogue(cli):
    given = cli("effects")["effects"]
    effects = traction.effects()
    assert list(effects) == [e["name"] for e in given]
    assert effects["slip_sinkage"].parameters[0].unit == given[list(effects).index("slip_sinkage")]["parameters"][0]["unit"]
    assert "slip_sinkage" in effects["slip_sinkage"]._repr_html_()
