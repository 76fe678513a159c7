# SPDX-License-Identifier: MIT
"""pip install ./python: builds the library and the module with CMake, in one file."""
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent


class CMakeBuild(build_ext):
    """Lets CMake build the extension, with the library linked in statically."""

    def build_extension(self, ext):
        target = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve()
        build = pathlib.Path(self.build_temp).resolve() / "cmake"
        subprocess.run(["cmake", "-S", ROOT, "-B", build, "-DCMAKE_BUILD_TYPE=Release",
                        "-DBUILD_SHARED_LIBS=OFF", "-DCREVICE_BUILD_TOOLS=OFF",
                        "-DCREVICE_BUILD_TESTS=OFF", "-DCREVICE_BUILD_EXAMPLES=OFF",
                        "-DCREVICE_VULKAN=OFF", "-DCREVICE_PYTHON=ON",
                        f"-DPython3_EXECUTABLE={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "crevice_python",
                        "--parallel"], check=True)
        built, = (build / "python" / "crevice").glob(f"_crevice*{target.suffix}")
        target.parent.mkdir(parents=True, exist_ok=True)
        self.copy_file(built, target)


def version():
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(crevice VERSION ([\d.]+)", text).group(1)


setup(name="crevice", version=version(), license="MIT", python_requires=">=3.9",
      description="Ambient occlusion from depth and normals", install_requires=["numpy"],
      packages=["crevice"], package_data={"crevice": ["py.typed", "_crevice.pyi"]},
      ext_modules=[Extension("crevice._crevice", [])], cmdclass={"build_ext": CMakeBuild})
