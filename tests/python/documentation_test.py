# SPDX-License-Identifier: MIT
"""Every example of a docstring; the stub; the time of the import."""
import ast
import doctest
import functools
import importlib
import importlib.util
import inspect
import json
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

MODULES = ("mmmconverter", "mmmconverter._angles", "mmmconverter._recordings", "mmmconverter._models",
           "mmmconverter._conversions", "mmmconverter._studies", "mmmconverter._robots", "mmmconverter._live")

# A user's script as mypy reads it.
TYPED = """
import mmmconverter
result = mmmconverter.convert("walk.c3d", height=1.8, frames=(0, 50))
angle: float = result.joints[0, 0]
for posture in mmmconverter.live("replay:walk.c3d@max", height=1.8):
    print(posture.time + posture.delay)
mmmconverter.convert("walk.c3d", heigth=1.8)  # wrong
mmmconverter.live("replay:walk.c3d", height="tall")  # wrong
mmmconverter.read("walk.c3d").lables  # wrong
"""
TYPES_OF = {**os.environ, "MYPYPATH": str(pathlib.Path(mmmconverter.__file__).parent.parent)}

# Runs the cells of its standard input, one after the other.
NOTEBOOK = """
import ast, json, sys
names = {}
for source in json.load(sys.stdin):
    tree = ast.parse(source)
    last = tree.body[-1]
    if not isinstance(last, ast.Expr):
        exec(source, names)
        continue
    exec(compile(ast.Module(tree.body[:-1], []), "cell", "exec"), names)
    value = eval(compile(ast.Expression(last.value), "cell", "eval"), names)
    print(value._repr_html_() if hasattr(value, "_repr_html_") else repr(value))
"""


def arguments_of(function):
    """How many a compiled function has, as the first line of its docstring says."""
    return len(re.findall(r"(?:\(|, )\w+: ", function.__doc__.splitlines()[0]))


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

    def test_the_notebook_runs(self):
        notebook = json.loads((ROOT / "examples/markers_to_motions.ipynb").read_text())
        self.assertEqual((notebook["nbformat"], len({cell["id"] for cell in notebook["cells"]})),
                         (4, len(notebook["cells"])))
        code = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
        for cell in code:
            self.assertEqual((cell["outputs"], cell["execution_count"]), ([], None))
        # As a notebook does: the value of a cell's last line is shown, as HTML where it can be.
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(ROOT / "examples", pathlib.Path(folder) / "examples")
            run = subprocess.run(
                [sys.executable, "-B", "-c", NOTEBOOK], cwd=folder, capture_output=True, text=True,
                input=json.dumps(["".join(cell["source"]) for cell in code]),
                env={**os.environ, "MPLBACKEND": "Agg", "MPLCONFIGDIR": folder})
            self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
            for file in ("handstand_mmm.xml", "handstand.html"):
                self.assertTrue((pathlib.Path(folder) / file).exists())
        for shown in ("<svg", "<caption>Recording", "<caption>Calibration", "<caption>Dynamics",
                      "<caption>Estimate", "<caption>LabelledRecording", "verdict"):
            self.assertIn(shown, run.stdout)

    def test_everything_public_is_used_in_a_test(self):
        tests = "".join(file.read_text() for file in pathlib.Path(__file__).parent.glob("*_test.py"))
        for name in mmmconverter.__all__:
            thing = getattr(mmmconverter, name)
            if inspect.isfunction(thing):
                self.assertTrue(re.search(rf"mmmconverter\.{name}\b", tests), name)
            for member, value in vars(thing).items() if inspect.isclass(thing) else ():
                is_part = inspect.isfunction(value) or isinstance(
                    value, (property, functools.cached_property, classmethod))
                if is_part and not member.startswith("_"):
                    self.assertTrue(re.search(rf"\.{member}\b", tests), f"{name}.{member}")

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
        for node in ast.walk(stub):  # as many arguments as pybind11 says in the first line
            if isinstance(node, ast.FunctionDef) and node.name in there:
                self.assertEqual(len(node.args.args), arguments_of(getattr(compiled, node.name)), node.name)
            if isinstance(node, ast.ClassDef):
                for one in filter(lambda part: isinstance(part, ast.FunctionDef), node.body):
                    method = getattr(getattr(compiled, node.name), one.name)
                    self.assertEqual(len(one.args.args), arguments_of(method), f"{node.name}.{one.name}")

    def test_options_are_those_of_the_table(self):
        folder = pathlib.Path(mmmconverter.__file__).parent
        compiled = importlib.import_module("mmmconverter._mmmconverter")
        stub = {node.name: [one.target.id for one in node.body]
                for node in ast.parse((folder / "_options.pyi").read_text()).body
                if isinstance(node, ast.ClassDef)}
        for task in compiled.tasks():
            function = getattr(mmmconverter, task)
            keywords = [row[0] for row in compiled.options(task)]
            self.assertTrue(keywords, task)
            arguments = ["model"] if task == "read_model" else []
            self.assertEqual(stub[task.title().replace("_", "") + "Options"],
                             [keyword for keyword in keywords if keyword not in arguments])
            for keyword in keywords:
                self.assertIn(keyword, inspect.signature(function).parameters)
                self.assertTrue(re.search(rf"\b{keyword}\b.* : ", inspect.getdoc(function)), keyword)
        self.assertIn("and_subjects", inspect.signature(mmmconverter.convert).parameters)

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "there is no mypy")
    def test_types(self):
        with tempfile.TemporaryDirectory() as folder:
            script = pathlib.Path(folder, "script.py")
            script.write_text(TYPED)
            run = subprocess.run(
                [sys.executable, "-m", "mypy", "--enable-incomplete-feature=Unpack", "--ignore-missing-imports",
                 f"--cache-dir={folder}", script.name],
                cwd=folder, text=True, capture_output=True, check=False, env=TYPES_OF)
        wrong = [line.split(":")[:2] for line in run.stdout.splitlines() if " error: " in line]
        self.assertEqual(wrong, [[script.name, str(number)] for number, line in enumerate(TYPED.splitlines(), 1)
                                 if "# wrong" in line], run.stdout + run.stderr)

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
