"""What the tests share: the command line of the same build, and a log that it wrote."""

import json
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
CLI = os.environ.get("TRACTION_CLI", str(ROOT / "build/host/host_tools/cli/traction"))


class Cli:
    """The command line, for what it says of the same thing."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def __call__(self, *words: object, codes: tuple[int, ...] = (0, 1)) -> dict:
        out = self.folder / "answer.json"
        out.unlink(missing_ok=True)
        env = {**os.environ, "TRACTION_ROOT": str(ROOT)}
        done = subprocess.run(
            [CLI, *map(str, words), "--json", str(out), "--quiet"], env=env, capture_output=True, text=True, cwd=self.folder
        )
        assert done.returncode in codes, done.stderr
        self.stderr = done.stderr
        return json.loads(out.read_text()) if out.exists() else {}


@pytest.fixture
def cli(tmp_path: Path) -> Cli:
    return Cli(tmp_path)


@pytest.fixture(scope="session")
def sand_log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Forty seconds on sand with an effect that rover_sand does not know."""
    folder = tmp_path_factory.mktemp("sand")
    Cli(folder)("simulate", "demo_sand", "--effect", "slip_sinkage:coefficient=0.2", "--seed", 7, "--for", 40, "--out", "sand.csv")
    return folder / "sand.csv"


@pytest.fixture(autouse=True)
def shipped_data(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TRACTION_ROOT", str(ROOT))
