# SPDX-License-Identifier: MIT
"""Every example of a docstring; the stub; the time of the import."""
import ast
import doctest
import importlib
import inspect
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import mmmconverter
from support import ROOT

MODULES = ("mmmconverter", "mmmconverter._recordings", "mmmconverter._models",
           "mmmconverter._conversions", "mmmconverter._studies")


class Documentation(unittest.TestCase):

    def test_examples_are_right(self):
        before = os.getcwd()
        os.chdir(ROOT)
        self.addCleanup(os.chdir, before)
        attempted = 0
        for name in MODULES:
            result = doctest.testmod(importlib.import_module(name),
                                     extraglobs={"mmmconverter": mmmconverter, "np": np})
            self.assertEqual(result.failed, 0, name)
            attempted += result.attempted
        self.assertGreater(attempted, 20)

    def test_the_readme_plots_a_joint(self):
        block = re.search(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.S).group(1)
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(ROOT / "examples", pathlib.Path(folder) / "examples")
            subprocess.run([sys.executable, "-B", "-c", block], cwd=folder, check=True,
                           env={**os.environ, "MPLBACKEND": "Agg", "MPLCONFIGDIR": folder})
            self.assertTrue((pathlib.Path(folder) / "knee.png").read_bytes().startswith(b"\x89PNG"))

    def test_everything_public_is_explained(self):
        for name in mmmconverter.__all__:
            thing = getattr(mmmconverter, name)
            if thing is mmmconverter.Error:
                continue
            self.assertTrue(inspect.getdoc(thing), name)
            if inspect.isclass(thing):
                for member, value in vars(thing).items():
                    if inspect.isfunction(value) and not member.startswith("_"):
                        self.assertTrue(inspect.getdoc(value), f"{name}.{member}")

    def test_the_stub_names_what_there_is(self):
        folder = pathlib.Path(mmmconverter.__file__).parent
        self.assertTrue((folder / "py.typed").exists())
        stub = ast.parse((folder / "_mmmconverter.pyi").read_text())
        compiled = importlib.import_module("mmmconverter._mmmconverter")
        names = {}
        for node in stub.body:
            if isinstance(node, ast.FunctionDef):
                names[node.name] = None
            if isinstance(node, ast.ClassDef):
                names[node.name] = {
                    one.name if isinstance(one, ast.FunctionDef) else one.target.id
                    for one in node.body if isinstance(one, (ast.FunctionDef, ast.AnnAssign))}
        there = {name for name in dir(compiled) if not name.startswith("_")}
        self.assertEqual(set(names), there)
        for name, members in names.items():
            if members is None or name == "Error":
                continue
            of_class = {member for member in vars(getattr(compiled, name))
                        if not member.startswith("_")}
            self.assertEqual(members - {"__init__"}, of_class, name)

    def test_import(self):
        code = ("import time, numpy; began = time.perf_counter(); import mmmconverter; "
                "print(f'import: {1e3 * (time.perf_counter() - began):.0f} ms beside NumPy'); "
                "import sys; print('pandas' in sys.modules)")
        run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        print(run.stdout)
        self.assertTrue(run.stdout.endswith("False\n"))
        self.assertRegex(mmmconverter.__version__, r"^\d+\.\d+\.\d+$")


if __name__ == "__main__":
    unittest.main()
