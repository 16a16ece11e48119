# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""Hooks of MkDocs: pages stay as GitHub shows them. On the site, a file has its place in the repository, without `docs/`: also
files beside docs/ that pages link to. A notebook is a page, too, with formulas as MathML if KaTeX is installed. Headings have GitHub's
anchors, and lists need no blank line before them. With PULSECAST_REFERENCE, the folder of Doxygen's html/, the site has the reference, too."""

import functools
import html
import json
import logging
import os
import posixpath
import re
import shutil
import subprocess
from pathlib import Path

from mkdocs.structure.files import File
from mkdocs.structure.nav import Link

ROOT = Path(__file__).parents[1]
LINK = re.compile(r"\]\(([^)#\s]+)(#[^)\s]*)?\)")
FORMULA = re.compile(r"\$\$(.+?)\$\$|\$([^$\n]+)\$", re.S)
KATEX = shutil.which("katex")
REFERENCE = Path(os.environ["PULSECAST_REFERENCE"]) if "PULSECAST_REFERENCE" in os.environ else None
log = logging.getLogger("mkdocs.plugins.site")


def in_repository(file):
    """Path of a page in the repository."""
    return Path(file.abs_src_path).relative_to(ROOT).as_posix()


def linked(page, target):
    """Path in the repository of what a page links to; empty for addresses, and for code that looks like a link."""
    path = posixpath.normpath(posixpath.join(posixpath.dirname(page), target))
    return "" if ":" in target or not (ROOT / path).is_file() else path


def formula(match):
    """MathML of a formula in TeX."""
    command = [KATEX, "--format", "mathml", *(["--display-mode"] if match[1] else [])]
    found = subprocess.run(command, input=match[1] or match[2], capture_output=True, text=True, check=True,
                           env=os.environ | {"NODE_PATH": "/usr/share/nodejs"}).stdout  # which other builds of Node.js than Debian's do not search
    return re.sub("<annotation.*?</annotation>", "", found.strip(), flags=re.S)


@functools.cache
def notebook(path):
    """Markdown of a notebook: its text, its code, what this printed and drew, and a link to the file."""
    parts = []
    for cell in json.loads(path.read_text())["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(FORMULA.sub(formula, source) if KATEX else source)
        else:
            parts.append(f"```python\n{source}\n```")
        for output in cell.get("outputs", []):
            data = output.get("data", {})
            if "image/png" in data:
                parts.append(f"![what the code above draws](data:image/png;base64,{''.join(data['image/png']).strip()})")
            else:
                parts.append(f"```text\n{''.join(output.get('text') or data['text/plain']).rstrip()}\n```")
    return "\n\n".join([*parts, f'<a href="{path.name}" download>This page as a notebook</a>'])


def source_of(file):
    """Markdown of a page."""
    path = Path(file.abs_src_path)
    return path.read_text() if path.exists() else notebook(path.with_suffix(".ipynb"))


def slug(text, separator):
    return re.sub(r"[^\w -]", "", text.lower(), flags=re.A).replace(" ", "-")


def on_config(config):
    config["mdx_configs"]["toc"] = {"slugify": slug}


def on_files(files, config):
    def add(folder, path):
        if not files.get_file_from_path(path):
            files.append(File(path, str(folder), config["site_dir"], config["use_directory_urls"]))

    for path in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md"):
        add(ROOT, path)
    for path in (ROOT / "docs").rglob("*.ipynb"):
        add(ROOT / "docs", path.relative_to(ROOT / "docs").with_suffix(".md").as_posix())
    for file in list(files.documentation_pages()):
        for target, _ in LINK.findall(source_of(file)):
            path = linked(in_repository(file), target)
            if path and not path.startswith("docs/"):
                add(ROOT, path)
    for file in (REFERENCE / "html").rglob("*") if REFERENCE else ():
        if file.is_file():
            add(REFERENCE.parent, file.relative_to(REFERENCE.parent).as_posix())


def on_nav(nav, config, files):
    if REFERENCE:
        nav.items.append(Link("Reference of C++", f"{REFERENCE.name}/html/index.html"))


def on_page_read_source(page, config):
    return source_of(page.file)


def on_page_markdown(markdown, page, config, files):
    name = in_repository(page.file)
    folder = posixpath.dirname(name.removeprefix("docs/")) or "."

    def moved(match):
        path = re.sub(r"\.ipynb$", ".md", linked(name, match[1]))
        return f"]({posixpath.relpath(path.removeprefix('docs/'), folder)}{match[2] or ''})" if path else match[0]

    pieces = re.split(r"(^```.*?^```$)", markdown, flags=re.M | re.S)
    for i, piece in enumerate(pieces):
        if i % 2:
            pieces[i] = re.sub(r"^```(\w+) .*", r"```\1", piece)
        else:
            pieces[i] = re.sub(r"^(?![-*|#\n]| {2})(.+\n)(?=[-*] |\d\. )", r"\1\n", LINK.sub(moved, piece), flags=re.M)
    return "".join(pieces)


def on_post_build(config):
    """Warns of links of our pages to files that the site does not have, and to anchors that they do not have."""
    site = Path(config["site_dir"])
    anchors, links = {}, []
    for page in site.rglob("*.html"):
        if page.name == "404.html" or REFERENCE and page.is_relative_to(site / REFERENCE.name):
            continue
        text = page.read_text()
        anchors[page] = set(re.findall(r'\bid="([^"]+)"', text))
        links += [(page, html.unescape(link)) for link in re.findall(r'href="([^":]+)"', text)]
    for page, link in links:
        path, _, anchor = link.partition("#")
        target = Path(os.path.normpath(page.parent / path)) if path else page
        target = target / "index.html" if target.is_dir() else target
        if not target.exists() or anchor and anchor not in anchors.get(target, {anchor}):
            log.warning("%s: the link %s leads nowhere", page, link)
