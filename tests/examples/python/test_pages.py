# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""The Python of pages for users runs as it stands there: the blocks of a page one after another, in an empty folder."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[3] / "docs"
PAGES = [*DOCS.glob("for/*.md"), *DOCS.glob("tutorials/*.md"), DOCS / "from-helios.md"]
BLOCKS = {page: re.findall(r"^```python\n(.*?)^```", page.read_text(), re.M | re.S) for page in PAGES}


def unpack_a_drive(folder):
    """What the page's commands leave there."""
    modules = Path(os.environ["PULSECAST_NODE_MODULES"])
    if not (modules / "@mcap" / "core").exists():
        pytest.skip("missing: @mcap/core of npm")
    pytest.importorskip("matplotlib")
    drive = Path(os.environ["PULSECAST_PROGRAM"]).parent / "drive"
    subprocess.run([drive, "--seed", "7", "--output", folder], check=True, capture_output=True)
    subprocess.run(["node", DOCS.parent / "bench" / "odometry" / "unbag.mjs", modules, folder / "drive.mcap", folder], check=True)


@pytest.mark.parametrize("page", [page for page, blocks in BLOCKS.items() if blocks], ids=lambda page: page.stem)
def test_the_python_of_a_page_runs(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    if page.stem == "drive":
        unpack_a_drive(tmp_path)
    names = {}
    for block in BLOCKS[page]:
        exec(compile(block, page, "exec"), names)


def test_the_loop_over_old_surveys_sorts_and_runs_them(tmp_path):
    [loop] = [block for block in re.findall(r"^```sh\n(.*?)^```", (DOCS / "from-helios.md").read_text(), re.M | re.S) if "for f in" in block]
    (tmp_path / "data").mkdir()
    shutil.copytree(DOCS.parent / "examples" / "yard", tmp_path / "surveys")
    document = (tmp_path / "surveys" / "yard.xml").read_text()
    (tmp_path / "surveys" / "fault.xml").write_text(document.replace('"100000"', '"1OO000"'))
    (tmp_path / "surveys" / "note.xml").write_text(document.replace("<leg>", '<leg colour="red">'))
    program = Path(os.environ["PULSECAST_PROGRAM"])
    found = {**os.environ, "PATH": f"{program.parent}:{os.environ['PATH']}"}
    run = subprocess.run(["sh", "-eu"], input=loop, text=True, cwd=tmp_path, capture_output=True, env=found)
    assert run.returncode == 0, run.stderr
    assert (tmp_path / "sound.txt").read_text() == "surveys/yard.xml\n"
    assert (tmp_path / "others.txt").read_text() == "surveys/fault.xml\nsurveys/note.xml\n"
    assert "fault.xml:13:24: " in run.stdout and "note.xml:11:10: " in run.stdout
    assert len(list(tmp_path.glob("output/yard/*/leg000_points.laz"))) == 1


def test_pages_have_python():
    assert sum(map(bool, BLOCKS.values())) >= 3
