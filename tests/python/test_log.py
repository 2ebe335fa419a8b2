"""Logs: views, times of their own, frames, bad input."""

import gc
import pickle
import weakref

import numpy as np
import pytest

import traction

SHORT = """
duration_s = 3.0
seed = 4
[ground]
soil = "sand"
[[drive]]
for_s = 3.0
mode = "platform_speed"
speed_m_s = 0.2
"""


@pytest.fixture(scope="module")
def log():
    return traction.simulate(SHORT)


def test_a_column_is_a_view_that_keeps_its_log_alive_and_cannot_be_written(log):
    own = traction.simulate(SHORT)
    values = own["estimate.speed_m_s"].values
    assert own["estimate.speed_m_s"].values.__array_interface__["data"] == values.__array_interface__["data"]  # no copy
    assert not values.flags.writeable and not values.flags.owndata
    kept, gone = values.copy(), weakref.ref(own)
    del own
    gc.collect()
    assert gone() is None
    np.testing.assert_array_equal(values, kept)


def test_columns_have_their_own_times_and_units(log):
    radar, speed = log["radar.adc_count"], log["estimate.speed_m_s"]
    assert len(radar) == 3 * 512 and len(speed) == 300  # 512 Hz and 100 Hz, the rates of docs/architecture.md
    assert np.all(np.diff(radar.t_s) > 0)
    assert (speed.unit, speed.kind) == ("m_s", "estimate") and speed.meaning
    assert np.asarray(speed).shape == (300,)


def test_a_name_that_is_not_there_is_told_with_the_near_one(log):
    with pytest.raises(KeyError, match="estimate.speed_m_s"):
        log["estimate.speed_ms"]


def test_a_log_reads_back_to_the_same_bits(log, tmp_path):
    log.write(tmp_path / "log.csv")
    again = traction.Log.read(tmp_path / "log.csv")
    assert list(again) == list(log) and again.header == log.header
    for name in log:
        np.testing.assert_array_equal(again[name].values, log[name].values)
        np.testing.assert_array_equal(again[name].t_s, log[name].t_s)


def test_a_frame_becomes_a_log_without_a_file(log):
    pandas = pytest.importorskip("pandas")
    frame = log.to_pandas(["estimate.speed_m_s", "wheel0.current_A"])
    assert frame.attrs["units"]["wheel0.current_A"] == "A"
    again = traction.Log.of(frame, header=log.header)
    np.testing.assert_array_equal(again["wheel0.current_A"].values, log["wheel0.current_A"].values)
    clock = frame.set_index(pandas.Timestamp("2026-01-01") + pandas.to_timedelta(frame.index, unit="s"))
    shifted = traction.Log.of(clock)["estimate.speed_m_s"]
    np.testing.assert_allclose(shifted.t_s, log["estimate.speed_m_s"].t_s - log["estimate.speed_m_s"].t_s[0], atol=1e-9)  # ns clock


def test_a_dict_becomes_a_log_and_is_mended_as_a_file_is():
    t = np.arange(5) / 100
    log = traction.Log.of({"t_s": t, "wheel0.speed_rpm": [60, 60, float("nan"), 60, float("inf")], "imu.accel_x_m_s2": (t[:2], [0, 1])})
    np.testing.assert_allclose(log["wheel0.speed_rad_s"].values, [2 * np.pi] * 3)  # 60 rpm is a turn a second
    assert len(log["imu.accel_x_m_s2"]) == 2
    assert any("infinite" in line for line in log.repairs) and any("rpm" in line for line in log.repairs)


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ({"wheel0.speed_rad_s": [1, 2]}, "has no times"),
        ({"t_s": [0, 1], "wheel0.speed_rad_s": [1, 2, 3]}, "2 times and 3 values"),
        ({"t_s": [0, 1], "wheel0.speed_rad_s": ["a", "b"]}, "no numbers"),
    ],
)
def test_a_dict_that_is_no_log_is_refused_with_its_mend(columns, words):
    with pytest.raises(traction.LogError, match=words) as told:
        traction.Log.of(columns, name="mine")
    assert told.value.mend and "mine" in str(told.value)


def test_a_wrong_file_has_line_column_and_mend(tmp_path):
    file = tmp_path / "bad.csv"
    file.write_text("t_s,wheel0.speed_rad_s\n0.0,1\n0.01,red\n")
    with pytest.raises(traction.LogError) as told:
        traction.Log.read(file)
    assert (told.value.line, told.value.column) == (3, 2) and told.value.mend and str(file) in told.value.file
    assert pickle.loads(pickle.dumps(told.value)).line == 3
    with pytest.raises(traction.FileError):
        traction.Log.read(tmp_path / "nowhere.csv")


def test_other_tables_have_the_same_values(log, tmp_path):
    pytest.importorskip("xarray")
    parquet = pytest.importorskip("pyarrow.parquet")
    data = log.to_xarray(["estimate.speed_m_s", "radar.adc_count"])
    assert data["radar.adc_count"].dims != data["estimate.speed_m_s"].dims and data["estimate.speed_m_s"].attrs["units"] == "m_s"
    log.to_parquet(tmp_path / "log.parquet", ["estimate.speed_m_s"], rate_Hz=10)
    table = parquet.read_table(tmp_path / "log.parquet")
    assert table.schema.field("estimate.speed_m_s").metadata[b"unit"] == b"m_s"
    times, values = table["t_s"].to_numpy(), table["estimate.speed_m_s"].to_numpy()
    speed = log["estimate.speed_m_s"]
    for t, v in zip(times, values, strict=True):  # the latest sample: by hand
        assert v == speed.values[[i for i, s in enumerate(speed.t_s) if s <= t + 1e-9][-1]]
    assert len(times) == 30 and [p.name for p in tmp_path.iterdir()] == ["log.parquet"]


def test_a_notebook_shows_a_log(log):
    assert "estimate.speed_m_s" in log._repr_html_()
