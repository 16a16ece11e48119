# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""The notebooks of docs/tutorials run, what they assert holds, and what they show is what they are kept with."""

import os
import re
from pathlib import Path

import nbclient
import nbformat
import pytest

NOTEBOOKS = sorted((Path(__file__).parents[3] / "docs" / "tutorials").glob("*.ipynb"))


def shown(cell):
    """What a cell of code prints and draws: its text, however it comes in parts, and how many pictures."""
    outputs = [output for output in cell.outputs if output.output_type != "stream" or output.name == "stdout"]  # warnings may come and go
    text = "".join("".join(output.get("text") or output.data.get("text/plain", "")) for output in outputs)
    pictures = sum("image/png" in output.get("data", {}) for output in outputs)
    return re.sub(r"<Figure .*>|[\d,.]+", "", text), pictures  # other processors round otherwise


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_shows_what_it_is_kept_with(path, tmp_path, monkeypatch):
    for variable in ("IPYTHONDIR", "JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "JUPYTER_RUNTIME_DIR", "MPLCONFIGDIR"):
        monkeypatch.setenv(variable, str(tmp_path))
    monkeypatch.setenv("PULSECAST_SOURCE", str(NOTEBOOKS[0].parents[2]))
    monkeypatch.setitem(os.environ, "PYDEVD_DISABLE_FILE_VALIDATION", "1")
    kept = nbformat.read(path, 4)
    run = nbformat.read(path, 4)
    nbclient.NotebookClient(run, timeout=900, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}).execute()
    cells = [(one, other) for one, other in zip(kept.cells, run.cells) if one.cell_type == "code"]
    for one, other in cells:
        assert shown(one) == shown(other), one.source
    assert sum(shown(one)[1] for one, _ in cells) > 0
    assert any("assert" in one.source for one, _ in cells)


def test_there_are_notebooks_and_they_are_small():
    assert len(NOTEBOOKS) >= 5
    assert max(path.stat().st_size for path in NOTEBOOKS) < 300_000
