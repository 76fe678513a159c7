# SPDX-License-Identifier: MIT
"""What the tests share: the tool, and one small run of everything."""
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT))


@pytest.fixture(scope="session")
def tool() -> Path:
    return Path(os.environ["CREVICE_TOOL"])


@pytest.fixture(scope="session")
def folder() -> Path:
    return Path(os.environ["CREVICE_STUDY"])


def study(tool: Path, out: Path, *arguments: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run([sys.executable, "-B", str(ROOT / "study" / "run"), "--tool", str(tool),
                           "-o", str(out), *arguments], text=True, capture_output=True,
                          check=False)


@pytest.fixture(scope="session")
def page(tool: Path, folder: Path) -> Path:
    """The folder of a page with every section, of a small scene."""
    out = folder / "page"
    done = study(tool, out, "builtin:corner", "--quick", "--size", "96x54", "--rays", "16")
    assert done.returncode == 0, done.stderr
    return out


@pytest.fixture(scope="session")
def report(page: Path) -> dict:
    return json.loads((page / "report.json").read_text(encoding="utf-8"))
