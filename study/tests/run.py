# SPDX-License-Identifier: MIT
"""The tests of the study. Usage: run.py TOOL FOLDER [FILE.py] [PYTEST-ARGUMENT...]

Without a file all but test_structure.py, which measures larger pictures.
Exits 77 if a Python module is missing, unless the environment variable CI is set."""
import importlib.util
import os
import shutil
import sys
from pathlib import Path

MODULES = {"numpy": "numpy", "matplotlib": "matplotlib", "jinja2": "jinja2",
           "OpenImageIO": "openimageio", "pytest": "pytest"}


def main(arguments: list[str]) -> int:
    missing = [f"python3-{p}" for m, p in MODULES.items() if not importlib.util.find_spec(m)]
    if missing:
        print(f"missing: apt-get install {' '.join(missing)}")
        return 1 if os.environ.get("CI") else 77
    import pytest
    tool, folder, *rest = arguments
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    os.environ.update(CREVICE_TOOL=os.path.abspath(tool), CREVICE_STUDY=os.path.abspath(folder))
    here = Path(__file__).resolve().parent
    os.chdir(here)
    if not any(word.endswith(".py") for word in rest):
        rest += ["--ignore", "test_structure.py", "."]
    return int(pytest.main(["-q", "-p", "no:cacheprovider", "--rootdir", str(here), *rest]))


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.dont_write_bytecode = True
    sys.exit(main(sys.argv[1:]))
