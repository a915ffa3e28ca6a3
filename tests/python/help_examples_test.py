# SPDX-License-Identifier: MIT
"""Every example of a help text does what it says, in a folder that has what it names."""
import os
import pathlib
import re
import shutil
import subprocess
import unittest

import numpy as np

import mmmconverter
from support import Case, ROOT, SAMPLE, run_program

PROGRAM = pathlib.Path(os.environ.get("MMM_CONVERTER_PROGRAM", ROOT / "build/bin/MMMConverterS2KF")).resolve()
# These need a camera system, minutes, or two bodies: their options and files alone are checked.
FAR = ("live qtm:", "live natnet:", "serve ", "evaluate", "--scale-setup", "--setup", "cup.c3d", "both.c3d")
OUTPUTS = ("-o", "--subject-out", "--report", "--summary")


class HelpExamples(Case):

    def commands(self):
        found = re.findall(r"^  ([a-z-]+)  +", run_program("--help").stdout, re.M)
        return [name for name in found if run_program("help", name).returncode == 0]

    def examples(self):
        texts = [run_program("--help").stdout] + [run_program(name, "--help").stdout for name in self.commands()]
        return [line.strip() for text in texts
                for line in re.findall(r"^  (MMMConverterS2KF .*)$", text[text.index("Examples"):], re.M)]

    def make_files(self):
        sample = mmmconverter.read(SAMPLE)
        places = np.array(sample.markers[::6])
        short = mmmconverter.Recording.from_arrays(sample.labels, places, 100 / 6)
        for name in ("walk", "run", "jump", "range_of_motion", "standing", "both", "cup"):
            short.save(self.folder / f"{name}.c3d")
        unlabelled = mmmconverter.Recording.from_arrays([f"*{i}" for i in range(53)], sample.markers[:20], 100)
        unlabelled.save(self.folder / "unlabelled.c3d")
        (self.folder / "recordings").mkdir()
        short.save(self.folder / "recordings/walk.c3d")
        (self.folder / "subjects.csv").write_text("folder,height_m,mass_kg\n.,1.75,70\n")
        for name in ("anna", "ben"):
            person = mmmconverter.calibrate(short, height=1.75, name=name, progress=False)
            person.save(self.folder / f"{name}.xml")
        motion = mmmconverter.convert(short, height=1.75, progress=False)
        (self.folder / "motions").mkdir()
        for name in ("walk_mmm", "jump_mmm", "run", "recording", "motions/a", "motions/b"):
            motion.save(self.folder / f"{name}.xml")
        for file in ("handstand.c3d", "handstand_true.xml"):
            shutil.copy(ROOT / "examples" / file, self.folder)
        for file in (ROOT / "examples/opensim").iterdir():
            if file.is_file():
                shutil.copy(file, self.folder)
        for name in ("g1.urdf", "h1.xml"):
            shutil.copy(ROOT / "examples/robot/biped.urdf", self.folder / name)
        (self.folder / "xml_config").symlink_to(ROOT / "xml_config")
        (self.folder / "objects").mkdir()
        plugin = PROGRAM.parents[1] / "lib/MMMConverterS2KF/plugins/S2KFConverter.so"
        for copy in ("lib/MMMConverterS2KF/plugins/S2KFConverter.so", "build/MyConverter.so"):
            (self.folder / copy).parent.mkdir(parents=True)
            (self.folder / copy).symlink_to(plugin)
        (self.folder / "my.xml").write_text(run_program("print-config", "S2KFConverter").stdout)

    def test_every_example(self):
        self.make_files()
        examples = self.examples()
        self.assertGreater(len(examples), 50)
        environment = {**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}"}
        for example in examples:
            if any(far in example for far in FAR):
                self.check_files(example)
                continue
            # As it stands, but for what would take minutes, and the motion that this file has.
            line = example.replace("--repeat 100", "--repeat 1").replace("--motion 1723", "--motion recording")
            run = subprocess.run(["bash", "-c", line], cwd=self.folder, env=environment, capture_output=True,
                                 text=True)
            with self.subTest(example):
                self.assertEqual(run.returncode, 0, run.stderr)

    def check_files(self, example):
        """No file that is read is written, too."""
        words = example.split()
        outputs = {words[i + 1] for i, word in enumerate(words[:-1]) if word in OUTPUTS}
        inputs = {word for i, word in enumerate(words) if i > 0 and words[i - 1] not in OUTPUTS}
        with self.subTest(example):
            self.assertFalse(outputs & inputs)
            self.assertEqual({word for word in words if word.startswith("--")} -
                             set(re.findall(r"--[a-z-]+", run_program(words[1], "--help").stdout)), set())


if __name__ == "__main__":
    unittest.main()
