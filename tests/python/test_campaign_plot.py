"""A campaign's picture and the effects in it: known answers, what is left out, refusals, exit codes."""

import json
import os
import re
import subprocess
import sys

import numpy as np
import pytest

import traction
from conftest import CLI
from traction.campaigns import picture, pool
from traction.campaigns.points import read_points
from traction.campaigns.store import Store

for needed in ("pyarrow", "scipy", "SALib", "matplotlib"):
    pytest.importorskip(needed)
ENV = {**os.environ, "TRACTION_PYTHON": sys.executable}
TWO = {"x1": {"low": -1.0, "high": 1.0}, "x2": {"low": 0.0, "high": 5.0}}


def made(monkeypatch, folder, law, **spec):
    """A campaign whose drives are a law of their row: {figure: value}, or an exception that makes it a failed one."""

    def run(job, row):
        try:
            return {"status": "done", "error": None, **law(row)}
        except ZeroDivisionError as error:
            return {"status": "failed", "error": str(error)}

    monkeypatch.setattr(pool, "run_row", run)
    names = spec.pop("figures", ["y"])
    keep = {"figures": {name: "duration_s" for name in names}}
    given = {"title": "law", "scenario": {"duration_s": 1.0}, "seed": 3, "vary": TWO, "keep": keep, **spec}
    return traction.campaign(given, folder, workers=0)


def told_in(svg):
    """The texts of a picture: matplotlib draws them as outlines and keeps the words as comments."""
    return "\n".join(re.findall(r"<!--\s*(.*?)\s*-->", svg.read_text(), re.S))


def test_a_saltelli_design_gives_the_closed_form_of_a_line(monkeypatch, tmp_path):
    c = made(monkeypatch, tmp_path / "c", lambda row: {"y": 3 * row["x1"] + 0 * row["x2"]}, method="saltelli", base=128)
    assert c.table().num_rows == 128 * 4
    told = c.sensitivity()
    x1, x2 = (told.figures["y"].indices[name] for name in ("x1", "x2"))
    assert told.method == "sobol" and "128 blocks of 4 rows" in told.words and told.figures["y"].rows == 512
    assert abs(x1.first - 1) < 0.05 and abs(x1.total - 1) < 0.05  # scrambled Sobol points: the error falls about as 1 / base
    assert x2.first == 0 and x2.total == 0 and x2.total_conf == 0  # a row and its partner are equal to the bit
    assert 0 < x1.first_conf < 0.3


def test_a_saltelli_design_gives_the_closed_form_of_ishigami(monkeypatch, tmp_path):
    # Ishigami and Homma 1990, a = 7, b = 0.1: V1 = 0.5 (1 + b pi^4 / 5)^2, V2 = a^2 / 8, V13 = b^2 pi^8 (1 / 18 - 1 / 50), V3 = 0
    pi = np.pi
    v1, v2, v13 = 0.5 * (1 + 0.1 * pi**4 / 5) ** 2, 49 / 8, 0.01 * pi**8 * (1 / 18 - 1 / 50)
    v = v1 + v2 + v13

    def law(row):
        a, b, c = (row[name] for name in ("a", "b", "c"))
        return {"y": np.sin(a) + 7 * np.sin(b) ** 2 + 0.1 * c**4 * np.sin(a)}

    vary = {name: {"low": -float(pi), "high": float(pi)} for name in ("a", "b", "c")}
    effects = made(monkeypatch, tmp_path / "c", law, method="saltelli", base=512, vary=vary, part=2560).sensitivity().figures["y"]
    want = {"a": (v1 / v, (v1 + v13) / v), "b": (v2 / v, v2 / v), "c": (0, v13 / v)}
    for name, (first, total) in want.items():
        got = effects.indices[name]
        assert abs(got.first - first) < got.first_conf + 0.02 and abs(got.total - total) < got.total_conf + 0.02
        assert got.first_conf < 0.15 and got.total_conf < 0.15  # the intervals that it may stay within are narrow


def test_rows_of_a_saltelli_design_in_a_list_are_known_as_one(monkeypatch, tmp_path):
    from SALib.sample import sobol

    problem = {"num_vars": 2, "names": ["x1", "x2"], "bounds": [[-1, 1], [0, 5]]}
    rows = [{"x1": float(a), "x2": float(b)} for a, b in sobol.sample(problem, 64, calc_second_order=True, seed=1)]
    law = lambda row: {"y": row["x1"] * row["x2"]}  # noqa: E731
    effects = made(monkeypatch, tmp_path / "c", law, row=rows, vary={}).sensitivity()
    assert effects.method == "sobol" and "64 blocks of 6 rows" in effects.words
    # y = x1 x2, x1 even about 0: S1(x1) = E[x2]^2 / E[x2^2] = 3/4, ST(x1) = 1, S1(x2) = 0, ST(x2) = 1/4
    x1, x2 = (effects.figures["y"].indices[name] for name in ("x1", "x2"))
    assert abs(x1.first - 0.75) < 0.1 and abs(x1.total - 1) < 0.1 and abs(x2.first) < 0.1 and abs(x2.total - 0.25) < 0.1
    spoilt = [{**row, "x1": row["x1"] + 1e-9 * (i == 7)} for i, row in enumerate(rows)]
    assert made(monkeypatch, tmp_path / "d", law, row=spoilt, vary={}).sensitivity().method == "rbd_fast"


@pytest.mark.parametrize("method", ["latin_hypercube", "sobol"])
def test_other_samples_give_first_order_indices_from_given_data_and_say_so(monkeypatch, tmp_path, method):
    told = made(monkeypatch, tmp_path / "c", lambda row: {"y": 2 - row["x1"]}, method=method, drives=256).sensitivity()
    x1, x2 = (told.figures["y"].indices[name] for name in ("x1", "x2"))
    assert told.method == "rbd_fast" and "no Saltelli design" in told.words
    assert x1.first > 0.95 and abs(x2.first) < 0.15 and x1.total is None  # noise of 20 harmonics' powers in 256 points: 0.03


@pytest.mark.parametrize("order", ["x1 x2", "x2 x1"])
def test_a_grid_lends_no_effect_to_the_factor_that_goes_along_in_the_table(monkeypatch, tmp_path, order):
    """Equal values of one factor stand in the order of the other: sorted as they come they would show its effect."""
    count = {"x1": 40, "x2": 3}  # each value of x2 meets x1 rising: three slow waves, as the effect of x2 would be
    vary = {name: {"low": 0.0, "high": 1.0, "count": count[name]} for name in order.split()}
    told = made(monkeypatch, tmp_path / "c", lambda row: {"y": row["x1"]}, method="grid", vary=vary).sensitivity()
    x1, x2 = (told.figures["y"].indices[name] for name in ("x1", "x2"))
    assert x1.first > 0.9 and abs(x2.first) < 0.2 and told.figures["y"].rows == 120


def test_failed_rows_and_figures_that_are_no_number_are_left_out_and_counted(monkeypatch, tmp_path):
    def law(row):
        if row["drive"] % 10 == 3:
            raise ZeroDivisionError("broke")
        return {"y": row["x1"], "z": float("nan") if row["drive"] % 10 == 4 else row["x2"]}

    c = made(monkeypatch, tmp_path / "c", law, method="latin_hypercube", drives=100, figures=["y", "z"])
    told = c.plot(tmp_path / "c.svg")
    words = told_in(tmp_path / "c.svg")
    assert "90 of 100 drives, 10 failed and left out" in words and "z: 10 rows are no number and left out" in words
    assert "effect on y, 90 rows" in words and "effect on z, 80 rows" in words and "SALib.analyze.rbd_fast" in words
    assert (told.figures["y"].rows, told.figures["z"].rows) == (90, 80)
    assert words.count("factors and figures of 80 rows") == 1  # a line needs all its numbers


def test_a_saltelli_block_with_a_failed_row_is_left_out_whole(monkeypatch, tmp_path):
    def law(row):
        if row["drive"] in (0, 1, 41):
            raise ZeroDivisionError("broke")
        return {"y": row["x1"]}

    effects = made(monkeypatch, tmp_path / "c", law, method="saltelli", base=64).sensitivity().figures["y"]
    assert effects.rows == 62 * 4 and abs(effects.indices["x1"].first - 1) < 0.2 and effects.indices["x2"].total == 0
    nearly_all = lambda row: {"y": row["x1"] if row["drive"] < 28 else 1 // 0}  # noqa: E731
    few = made(monkeypatch, tmp_path / "d", nearly_all, method="saltelli", base=64).sensitivity().figures["y"]
    assert few.indices == {} and few.why_not == "7 of 64 blocks are whole; 8 are needed"


def test_a_constant_figure_has_no_effects_and_is_drawn(monkeypatch, tmp_path):
    law = lambda row: {"y": 0.1 + 0.2, "z": row["x1"]}  # noqa: E731
    for name, spec in {"s": {"method": "saltelli", "base": 16}, "l": {"method": "latin_hypercube", "drives": 20}}.items():
        told = made(monkeypatch, tmp_path / name, law, figures=["y", "z"], **spec).plot(tmp_path / f"{name}.svg")
        assert told.figures["y"].indices == {} and told.figures["y"].why_not == "constant: no factor has an effect"
        assert set(told.figures["z"].indices) == {"x1", "x2"}
        assert "constant:" in told_in(tmp_path / f"{name}.svg") and "colour: z" in told_in(tmp_path / f"{name}.svg")


def test_seeds_become_bars_of_their_standard_deviation(monkeypatch, tmp_path):
    noise = [-1.0, 0.0, 4.0]
    law = lambda row: {"y": row["x1"] + noise[row["repeat"]] if row["drive"] != 5 else 1 // 0}  # noqa: E731
    c = made(monkeypatch, tmp_path / "c", law, method="latin_hypercube", drives=20, repeats=3)
    points = read_points(Store(c.folder))
    x, mean, std, seeds = picture.over_seeds(points, np.arange(points.done), points.factors[0].values, points.figures["y"])
    values = [row["x1"] for row in c.table().to_pylist() if row["repeat"] == 0]
    assert x.tolist() == values and seeds.tolist() == [3, 2, *[3] * 18]
    assert np.allclose(std, [np.std(noise[:2] if i == 1 else noise, ddof=1) for i in range(20)])
    assert np.allclose(mean - x, [-0.5 if i == 1 else 1.0 for i in range(20)])
    c.plot(tmp_path / "c.svg")
    assert "bar: its standard deviation over seeds" in told_in(tmp_path / "c.svg")


def test_saltelli_with_repeats_uses_the_mean_over_seeds(monkeypatch, tmp_path):
    law = lambda row: {"y": row["x1"] + (1000 if row["repeat"] else -1000)}  # noqa: E731
    told = made(monkeypatch, tmp_path / "c", law, method="saltelli", base=64, repeats=2).sensitivity()
    assert told.figures["y"].rows == 512 and "each row the mean of 2 seeds" in told.words
    assert abs(told.figures["y"].indices["x1"].first - 1) < 0.1 and told.figures["y"].indices["x2"].total == 0


def test_texts_and_logarithms_have_axes_and_effects(monkeypatch, tmp_path):
    vary = {"ground.soil": ["sand", "gravel"], "m": {"low": 1, "high": 100, "log": True}, "one": ["alone"]}
    law = lambda row: {"y": float(row["ground.soil"] == "sand")}  # noqa: E731
    told = made(monkeypatch, tmp_path / "c", law, method="latin_hypercube", drives=200, vary=vary).plot(tmp_path / "c.svg")
    assert told.figures["y"].indices["ground.soil"].first > 0.9 and abs(told.figures["y"].indices["m"].first) < 0.2
    words = told_in(tmp_path / "c.svg")
    assert "gravel" in words and "one does not vary: left out" in words and "one" not in told.figures["y"].indices


def test_the_same_rows_make_the_same_bytes_in_every_process(monkeypatch, tmp_path):
    made(monkeypatch, tmp_path / "c", lambda row: {"y": row["x1"] ** 2}, method="latin_hypercube", drives=30, repeats=2)
    code = "import sys, traction; [traction.plot_campaign(sys.argv[1], f) for f in sys.argv[2:]]"
    for at in "ab":
        env = {**os.environ, "PYTHONHASHSEED": str(ord(at)), "MPLCONFIGDIR": str(tmp_path / at)}
        (tmp_path / at).mkdir()
        (tmp_path / at / "matplotlibrc").write_text(f"axes.facecolor: 0.{ord(at)}\n")  # nobody's settings count
        words = [str(tmp_path / "c"), str(tmp_path / f"{at}.svg"), str(tmp_path / f"{at}.png")]
        subprocess.run([sys.executable, "-c", code, *words], env=env, check=True)
    traction.plot_campaign(tmp_path / "c", tmp_path / "here.svg")  # a process that has done other things
    assert (tmp_path / "here.svg").read_bytes() == (tmp_path / "a.svg").read_bytes()
    for kind in ("svg", "png"):
        assert (tmp_path / f"a.{kind}").read_bytes() == (tmp_path / f"b.{kind}").read_bytes()
    text = (tmp_path / "a.svg").read_text()
    assert 'href="http' not in text and "<script" not in text and (tmp_path / "a.png").read_bytes()[:4] == b"\x89PNG"


def test_many_rows_stay_a_small_file(monkeypatch, tmp_path):
    made(monkeypatch, tmp_path / "c", lambda row: {"y": row["x1"]}, method="sobol", drives=4096, part=4096).plot(tmp_path / "c.svg")
    assert (tmp_path / "c.svg").stat().st_size < 1e6  # 4096 marks in each of two panels and 2000 lines as outlines: 1.3 MB and more
    assert "2000 of 4096 rows, evenly taken" in told_in(tmp_path / "c.svg")


def _broken(row):
    raise ZeroDivisionError("no ground")


@pytest.mark.parametrize(
    ("law", "spec", "what"),
    [
        (lambda row: {"y": 1.0}, {"vary": {"ground.soil": ["sand", "gravel"]}}, "has no number that varies"),
        (lambda row: {"y": 1.0}, {"vary": {"a": [1.0], "b": ["s", "t"]}}, r"no number that varies \(a does not vary: left out\)"),
        (lambda row: {}, {"vary": {"a": [1.0, 2.0]}, "figures": []}, "keeps no figure"),
        (_broken, {"vary": {"a": [1.0, 2.0]}}, "all 2 finished drives failed, the first with: no ground"),
    ],
)
def test_what_cannot_be_plotted_is_refused_with_place_and_mend(monkeypatch, tmp_path, law, spec, what):
    c = made(monkeypatch, tmp_path / "c", law, **spec)
    with pytest.raises(traction.CampaignError, match=rf"/c: .*{what}.*; to mend: ") as told:
        c.plot(tmp_path / "c.svg")
    assert told.value.mend and str(told.value).count("\n") == 0 and not (tmp_path / "c.svg").exists()


def test_a_folder_without_a_finished_drive_is_refused_and_one_midway_is_drawn(monkeypatch, tmp_path):
    def stop_at(last):
        def law(row):
            if row["drive"] == last:
                raise KeyboardInterrupt
            return {"y": row["x1"]}

        return law

    with pytest.raises(KeyboardInterrupt):
        made(monkeypatch, tmp_path / "c", stop_at(0), method="latin_hypercube", drives=40)
    with pytest.raises(traction.CampaignError, match="none of its 40 drives is finished"):
        traction.plot_campaign(tmp_path / "c", tmp_path / "c.svg")
    with pytest.raises(KeyboardInterrupt):
        made(monkeypatch, tmp_path / "c", stop_at(20), method="latin_hypercube", drives=40)
    assert traction.plot_campaign(tmp_path / "c", tmp_path / "c.svg").figures["y"].rows == 20
    assert "20 of 40 drives, 20 not driven yet" in told_in(tmp_path / "c.svg")


@pytest.mark.parametrize("missing", ["SALib", "matplotlib"])
def test_a_missing_package_is_named_with_its_extra_before_anything_is_driven(tmp_path, missing):
    (tmp_path / "c.toml").write_text('scenario = "cruise"\n[vary]\nground.slope_rad = [0.0, 0.1]\n[keep.figures]\nv = "duration_s"\n')
    code = f"import sys; sys.modules[{missing!r}] = None\nfrom traction.campaigns.__main__ import main; sys.exit(main(sys.argv[1:]))"
    words = ["c.toml", "--out", "c", "--plot", "c.svg"]
    done = subprocess.run([sys.executable, "-c", code, *words], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 4 and missing in done.stderr and "to mend: pip install './python[plot]'" in done.stderr
    assert done.stderr.count("\n") == 1 and not (tmp_path / "c").exists()


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"base": 100}, "base"),
        ({"base": 0}, "base"),
        ({}, "base"),
        ({"base": 16, "vary": {}}, "base"),
        ({"base": 16, "vary": {"x1": TWO["x1"], "s": ["sand"]}}, "vary.s"),
    ],
)
def test_a_saltelli_design_that_cannot_be_is_refused(change, key):
    spec = {"scenario": {"duration_s": 1.0}, "method": "saltelli", "vary": TWO, **change}
    with pytest.raises(traction.CampaignError, match="to mend:") as told:
        traction.Spec.of(spec)
    assert told.value.key == key


def test_the_command_line_drives_plots_and_tells(tmp_path):
    (tmp_path / "c.toml").write_text(
        'scenario = "cruise"\nmethod = "saltelli"\nbase = 8\n[set]\nduration_s = 1.0\n'
        "[vary]\nground.slope_rad = { low = 0.0, high = 0.1 }\nrover.mass_kg = { low = 2.4, high = 3.6 }\n"
        '[keep.figures]\nv = "mean(estimate.speed_m_s)"\n'
    )

    def run(*words):
        return subprocess.run([CLI, "campaign", *words], cwd=tmp_path, env=ENV, capture_output=True, text=True)

    done = run("c.toml", "--out", "r", "--plot", "a.svg", "--json", "a.json")
    assert done.returncode == 0, done.stderr
    told = json.loads((tmp_path / "a.json").read_text())
    assert told["schema"] == "traction.campaign/1" and told["drives"] == told["done"] == 32 and told["plot"] == "a.svg"
    effects = told["sensitivity"]["figures"]["v"]
    assert (
        told["sensitivity"]["method"] == "sobol"
        and effects["rows"] == 32
        and set(effects["indices"])
        == {
            "ground.slope_rad",
            "rover.mass_kg",
        }
    )
    again = run("--plot", "b.svg", "--out", "r")
    assert again.returncode == 0 and "8 blocks of 4 rows" in again.stdout and "S1" in again.stdout
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()
    for words, code, what in (
        (("--plot", "b.pdf", "--out", "r"), 2, ".svg or .png"),
        (("--plot", "b.svg", "--out", "r", "--status"), 2, "exclude"),
        (("--plot", "b.svg"), 2, "--out is missing"),
        (("--plot", "b.svg", "--out", "nowhere"), 3, "holds no campaign"),
        (("--plot", "no/such/b.svg", "--out", "r"), 4, "no/such"),
    ):
        wrong = run(*words)
        assert wrong.returncode == code and what in wrong.stderr, wrong.stderr


def test_the_cost_of_a_drive_is_measured(tmp_path):
    words = ["--drives", "4", "12", "--duration", "1", "--parent", "10000", "--json", "cost.json"]
    done = subprocess.run([sys.executable, "-m", "traction.campaigns.cost", *words], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    told = json.loads((tmp_path / "cost.json").read_text())
    assert [row["drives"] for row in told["campaigns"]] == [4, 12] and len(told["single"]) == 3
    for row in told["campaigns"]:
        alone = told["workers"] / np.mean(
            [told["single"][at]["wall_s"] for at in (told["campaigns"].index(row), told["campaigns"].index(row) + 1)]
        )
        assert row["failed"] == 0 and row["of_cores_x_single"] == pytest.approx(row["drives"] / row["wall_s"] / alone)
        assert row["workers_cpu_s"] >= 0.5 * row["drives"] * min(one["cpu_s"] for one in told["single"])  # the drives are in it
        assert 0 < row["parent_cpu_s"] < row["wall_s"] and 20 < row["first_MB"] <= row["last_MB"] + 5 < 1000
        cpu = np.mean([told["single"][at]["cpu_s"] for at in (told["campaigns"].index(row), told["campaigns"].index(row) + 1)])
        assert row["cpu_of_single"] == pytest.approx(cpu * row["drives"] / (row["workers_cpu_s"] + row["parent_cpu_s"]))
    assert 0 < told["parent"]["cpu_s"] <= 1.1 * told["parent"]["wall_s"]  # one process: its clock's grain apart
    lines = done.stdout.splitlines()
    assert (
        lines[-2].split()[0] == "12"
        and lines[-1].startswith("the parent alone, 10000 drives")
        and "of cores x single" in done.stdout
        and "the drive alone" in done.stdout
    )
