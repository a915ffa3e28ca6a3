# SPDX-License-Identifier: MIT
"""make_reports.py PROGRAM CASES_PROGRAM EXAMPLES FOLDER: the reports that page_test.py opens."""

import pathlib
import subprocess
import sys

# A converter that no one has; its rows must show why.
MISSING = '<ConverterConfig type="MissingConverter"/>'
HOSTILE = "&lt;script>window.hacked=1&lt;/script>"


def main():
    program, cases, examples, folder = sys.argv[1:]
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "missing.xml").write_text(MISSING)
    recording = f"{examples}/handstand.c3d"
    compared = subprocess.run(
        [program, "compare", recording, "-c", "s2kf_default", "-c", "ekf", "-c", folder / "missing.xml",
         "--height", "1.8", "--truth", f"{examples}/handstand_true.xml", "--hide", "0.005", "--repeat", "2",
         "--json", folder / "compare.json", "--report", folder / "compare.html"], check=False)
    if compared.returncode != 1:  # as one of the converters failed
        sys.exit(f"compare: exit code {compared.returncode} instead of 1")
    subprocess.run([program, "convert", recording, "--height", "1.8", "-o", folder / "motion.xml",
                    "--report", folder / "convert.html"], check=True)
    subprocess.run([program, "report", recording, folder / "motion.xml", f"{examples}/handstand_true.xml",
                    "-o", folder / "finished.html"], check=True)
    checked = subprocess.run([program, "check-dynamics", f"{examples}/handstand_true.xml",
                              "--summary", folder / "dynamics.json", "--report", folder / "dynamics.html"], check=False)
    if checked.returncode != 0:
        sys.exit(f"check-dynamics: exit code {checked.returncode} instead of 0")
    biped = pathlib.Path(f"{examples}/robot/biped.urdf").read_text().replace("waist", HOSTILE)
    (folder / "biped.urdf").write_text(biped.replace('name="biped"', f'name="{HOSTILE}"'))
    subprocess.run([program, "retarget", f"{examples}/handstand_true.xml", "--frames", "0:340", "--robot", folder / "biped.urdf",
                    "-o", folder / "robot.xml", "--report", folder / "robot.html"], check=True)
    subprocess.run([cases, folder], check=True)


if __name__ == "__main__":
    main()
