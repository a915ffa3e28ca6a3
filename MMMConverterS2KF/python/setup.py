# SPDX-License-Identifier: MIT
"""The wheel: what CMake builds and installs, with the program, its converters and its data.

Environment: MMM_CONVERTER_BUILD_DIR, a build tree that is there already and has all but the wheel; CMAKE_ARGS, more
arguments for CMake.
"""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

import setuptools
from setuptools.command.build_ext import build_ext

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PACKAGES = pathlib.Path("lib/python3/dist-packages")


def version():
    return re.search(r"project\(\w+ VERSION ([0-9.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]


class CMakeBuild(build_ext):
    """Stages an installation: the package goes where setuptools wants it, the rest beside it as data, at the same paths
    below the environment's folder. The module finds the library there, and the library its converters and data."""

    def run(self):
        build = os.environ.get("MMM_CONVERTER_BUILD_DIR")
        if not build:
            build = str(pathlib.Path(self.build_temp).resolve() / "cmake")
            subprocess.run(
                ["cmake", "-S", SOURCE, "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_INSTALL_LIBDIR=lib",
                 "-DMMM_CONVERTER_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}",
                 *shlex.split(os.environ.get("CMAKE_ARGS", ""))], check=True)
            subprocess.run(["cmake", "--build", build, "--parallel"], check=True)
        staged = pathlib.Path(self.build_temp).resolve() / "staged"
        shutil.rmtree(staged, ignore_errors=True)
        for component in ("program", "python"):
            subprocess.run(["cmake", "--install", build, "--prefix", staged, "--component", component, "--strip"],
                           check=True)
        shutil.copytree(staged / PACKAGES, self.build_lib, dirs_exist_ok=True)
        shutil.rmtree(staged / PACKAGES)
        self.distribution.data_files = self.list_data(staged)

    @staticmethod
    def list_data(staged):
        """A wheel has no links: of the library there is the file by the name that is looked for."""
        for link in [path for path in staged.rglob("*") if path.is_symlink()]:
            file = link.resolve()
            link.unlink()
            if file.exists():
                file.rename(link)
        files = [path for path in staged.rglob("*") if path.is_file()]
        return [(str(path.relative_to(staged).parent), [str(path)]) for path in files]


class WithModule(setuptools.Distribution):
    def has_ext_modules(self):
        return True


setuptools.setup(version=version(), packages=[], distclass=WithModule, cmdclass={"build_ext": CMakeBuild})
