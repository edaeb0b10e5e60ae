"""Importing a module does no work: nothing is compiled, printed, written or waited for."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.xdist_group("imports")  # one process for all

WORK_S = 1.0
"""Processor time that a module, with those of ours that it imports, stays far below: it defines
classes and functions. Compiling a kernel, reading a scan or planning would take longer."""
HEAVY = {"mujoco", "numba", "open3d", "scipy", "plotly", "mcap", "numpy"}

PROBE = """
import importlib, json, sys, time
import ctypes, libusb_package
ctypes.CDLL(str(libusb_package.get_library_path()))
import numba, mujoco, numpy, open3d, plotly.graph_objects, scipy.spatial, scipy.stats  # noqa
import foxglove_schemas_protobuf.Log_pb2, mcap.reader, mcap_protobuf.decoder  # noqa
import pydantic, rich.console, rich.progress, typer.testing, zstandard, yaml  # noqa

took = {}
for name in json.loads(sys.argv[1]):
    begun = time.process_time()
    importlib.import_module(name)
    took[name] = time.process_time() - begun
compiled = [
    f"{name}.{key}"
    for name in took
    for key, value in vars(sys.modules[name]).items()
    if getattr(value, "signatures", None)
]
json.dump({"took": took, "compiled": compiled}, sys.stderr)
"""


def modules(root: Path) -> list[str]:
    files = sorted((root / "inspect_cli").rglob("*.py"))
    names = [".".join(file.relative_to(root).with_suffix("").parts) for file in files]
    return [n.removesuffix(".__init__") for n in names if not n.endswith(".__main__")]


@pytest.fixture(scope="module")
def probe(root: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, object]:
    """What a fresh process sees when it imports every module in turn."""
    folder = tmp_path_factory.mktemp("nowhere")
    done = subprocess.run(
        [sys.executable, "-c", PROBE, json.dumps(modules(root))],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": str(root), "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        check=True,
    )
    left_behind = [str(path) for path in folder.rglob("*")]
    return json.loads(done.stderr) | {"printed": done.stdout, "left_behind": left_behind}


def test_nothing_is_printed_or_written(probe: dict[str, object]) -> None:
    assert probe["printed"] == ""
    assert probe["left_behind"] == []


def test_nothing_is_compiled(probe: dict[str, object]) -> None:
    assert probe["compiled"] == []


def test_no_module_works(probe: dict[str, dict[str, float]]) -> None:
    slow = {name: took for name, took in probe["took"].items() if took > WORK_S}
    assert slow == {}


@pytest.mark.parametrize("module", ["inspect_cli.cli", "inspect_cli.schema.loading"])
def test_what_every_command_needs_stays_light(module: str, root: Path) -> None:
    code = f"import sys, {module}; print(*{{name.partition('.')[0] for name in sys.modules}})"
    loaded = subprocess.run(
        [sys.executable, "-c", code], cwd=root, capture_output=True, text=True, check=True
    ).stdout.split()
    assert not HEAVY & set(loaded)
