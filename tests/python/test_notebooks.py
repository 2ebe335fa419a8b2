"""The notebooks run from first to last cell, as they stand."""

from pathlib import Path

import pytest

from conftest import ROOT

nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")


@pytest.mark.parametrize("name", ["your_own_log", "ten_thousand_drives"])
def test_a_notebook_runs(name, tmp_path: Path, monkeypatch):
    pytest.importorskip("ipykernel")
    monkeypatch.setenv("DRIVES", "16")
    book = nbformat.read(ROOT / f"python/notebooks/{name}.ipynb", as_version=4)
    nbclient.NotebookClient(book, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}).execute()
    pages = [
        o.data["text/html"] for cell in book.cells if cell.cell_type == "code" for o in cell.outputs if "text/html" in o.get("data", {})
    ]
    assert len(pages) >= 2 and all(cell.execution_count for cell in book.cells if cell.cell_type == "code")
    if name == "your_own_log":
        assert any("ladder" in page and "<svg" in page for page in pages)
    assert not any(o.output_type == "error" for cell in book.cells if cell.cell_type == "code" for o in cell.outputs)
