# SPDX-License-Identifier: MIT
"""make_undisturbed.py PROGRAM MAKE_DATABASE DATABASE OUT: a database, and one run over it without shards."""

import shutil
import subprocess
import sys

RECORDINGS, LENGTH = "24", "3"  # six a shard; [s]


def main():
    program, make_database, database, out = sys.argv[1:]
    for folder in (database, out):
        shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([make_database, database, RECORDINGS, LENGTH], check=True)
    subprocess.run([program, "batch", f"{database}/manifest.xml", "-o", out], check=True)


if __name__ == "__main__":
    main()
