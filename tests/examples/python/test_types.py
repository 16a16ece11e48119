# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""The type stubs say what the module is."""

import ast
import dataclasses
import os
import re
import subprocess
import sys
import types
import typing
from pathlib import Path

import pytest

import pulsecast

HERE = Path(__file__).parent
PACKAGE = Path(pulsecast.__file__).parent
SETTINGS = [one for one in vars(pulsecast).values() if dataclasses.is_dataclass(one)]


@pytest.fixture(scope="module")
def mypy(tmp_path_factory):
    """Runs a module of mypy, and returns its exit code and lines."""
    folder = tmp_path_factory.mktemp("mypy")

    def run(*arguments):
        done = subprocess.run([sys.executable, "-m", *arguments], cwd=folder, capture_output=True, text=True, check=False,
                              env=os.environ | {"MYPYPATH": str(PACKAGE.parent)})
        return done.returncode, (done.stdout + done.stderr).splitlines()

    return run


# What only pybind11's classes have, and what dataclasses without members have.
ALLOWED = r"""
pulsecast\.(_core\.)?(Batch|Medium|Mesh|RaycastingScene|Simulation|SmoothInterface)
pulsecast\.(_core\.)?(Batch|SmoothInterface)\.(__init__|__pybind11_module_local_.*)
pulsecast\.(_core\.)?(ConicOptic|NoMotion)\.__match_args__
"""


def test_the_stubs_have_what_the_module_has_and_nothing_else(mypy, tmp_path):
    (tmp_path / "allowed").write_text(ALLOWED)
    code, said = mypy("mypy.stubtest", "pulsecast", "--allowlist", tmp_path / "allowed")
    assert code == 0, "\n".join(said)


def test_a_program_is_checked_by_the_stubs(mypy):
    program = HERE / "typed_survey.py"
    code, said = mypy("mypy", "--strict", program)
    wrong = {number for number, line in enumerate(program.read_text().splitlines(), 1) if "  # wrong" in line}
    refused = {int(match[1]) for line in said if (match := re.search(r"typed_survey\.py:(\d+): error", line))}
    assert wrong == refused and len(wrong) > 10, "\n".join(said)
    assert code == 1


def test_that_program_runs():
    said = subprocess.run([sys.executable, HERE / "typed_survey.py"], capture_output=True, text=True, check=True).stdout
    assert re.match(r"[1-9]\d+ points \d", said)


def test_the_package_is_marked_as_typed():
    assert (PACKAGE / "py.typed").exists()


def is_of(value, kind):
    """Whether a value is of a type, with all that is in it."""
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if origin is types.UnionType or origin is typing.Union:
        return any(is_of(value, one) for one in arguments)
    if origin is typing.Literal:
        return value in arguments
    if origin is list:
        return isinstance(value, list) and all(is_of(one, arguments[0]) for one in value)
    if origin is tuple:
        return isinstance(value, tuple) and len(value) == len(arguments) and all(map(is_of, value, arguments))
    if origin is os.PathLike:
        return isinstance(value, os.PathLike)
    if dataclasses.is_dataclass(kind):
        return type(value) is kind and all(is_of(getattr(value, name), of) for name, of in hints(kind).items())
    return type(value) is kind


def hints(settings):
    return typing.get_type_hints(settings, vars(pulsecast) | {"os": os, "Literal": typing.Literal})


@pytest.mark.parametrize("settings", SETTINGS, ids=lambda settings: settings.__name__)
def test_settings_are_of_the_types_they_are_said_to_be(settings):
    assert is_of(settings(), settings)


def test_settings_of_a_document_are_of_the_types_they_are_said_to_be():
    folder = HERE.parent / "pulsecast"
    assert is_of(pulsecast.read_survey(folder / "survey.xml", assets=[folder]), pulsecast.SurveySettings)
    [catalogue] = pulsecast.asset_folders()
    scanners = [one for file in (catalogue / "data").glob("scanners_*.xml") for one in pulsecast.read_assets(file)["scanners"]]
    platforms = pulsecast.read_assets(catalogue / "data" / "platforms.xml")["platforms"]
    assert is_of(scanners, list[pulsecast.ScannerSettings]) and len(scanners) > 30
    assert is_of(platforms, list[pulsecast.PlatformSettings]) and len(platforms) > 5
    assert not is_of([dataclasses.replace(scanners[0], pulse_rates=[1])], list[pulsecast.ScannerSettings])


def defined(tree):
    """Yields the functions of the stubs that the module's C++ has, by their names with their class, and properties with theirs."""
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            yield node.name, node
        elif isinstance(node, ast.ClassDef) and not any("dataclass" in ast.dump(one) for one in node.decorator_list):
            yield from ((f"{node.name}.{method.name}", method) for method in node.body if isinstance(method, ast.FunctionDef))


STUBS = ast.parse((PACKAGE / "_core.pyi").read_text())
FUNCTIONS = dict(defined(STUBS))


def test_members_of_settings_are_annotated_as_those_of_the_classes():
    classes = {node.name: node for node in STUBS.body if isinstance(node, ast.ClassDef)}
    for settings in SETTINGS:
        written = {one.target.id: ast.unparse(one.annotation) for one in classes[settings.__name__].body if isinstance(one, ast.AnnAssign)}
        assert written == {one.name: ast.unparse(ast.parse(one.type)) for one in dataclasses.fields(settings)}


@pytest.mark.parametrize("name", [name for name, node in FUNCTIONS.items() if not node.decorator_list])
def test_functions_have_the_parameters_that_pybind11_knows_of(name):
    first, _, last = name.partition(".")
    bound = getattr(getattr(pulsecast, first), last) if last else getattr(pulsecast, first)
    known = re.match(r"\w+\((.*)\) -> ", bound.__doc__)[1]
    parameters = re.findall(r"(\*|\w+)(?:: [\w:.]+(?:\[[^=\]]*\]+)?)?(?: = ([^,]+))?(?:, |$)", known)
    written = FUNCTIONS[name].args
    plain = [one.arg for one in written.args]
    by_name = (["*"] if written.kwonlyargs else []) + [one.arg for one in written.kwonlyargs] + ([written.kwarg.arg] if written.kwarg else [])
    assert [one for one, _ in parameters] == plain + by_name
    with_default = list(zip(plain[len(plain) - len(written.defaults):], written.defaults)) + [
        (one.arg, value) for one, value in zip(written.kwonlyargs, written.kw_defaults) if value]
    said = {one: ast.unparse(value) for one, value in with_default}
    defaults = {one: value for one, value in parameters if value}
    assert said.keys() == defaults.keys()
    assert all(value in ("...", defaults[one]) for one, value in said.items())


RETURNED = {"int": "int", "float": "float", "bool": "bool", "str": "str", "dict": "dict", "tuple": "tuple", "None": "None", "object": ""}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_return_what_pybind11_knows_of(name):
    first, _, last = name.partition(".")
    bound = getattr(getattr(pulsecast, first), last) if last else getattr(pulsecast, first)
    if isinstance(bound, property):
        known = re.match(r"\(.*\) -> (\S+)", bound.fget.__doc__)[1]
    else:
        known = re.match(r".*\) -> (\S+)", bound.__doc__)[1]
    written = ast.unparse(FUNCTIONS[name].returns)
    if known.startswith("numpy."):
        assert written.startswith("NDArray[")
        assert ("float32" in written) == ("float32" in known)
    elif known.startswith("pulsecast."):
        assert written == known.rpartition(".")[2]
    else:
        assert written.startswith(RETURNED[known])
