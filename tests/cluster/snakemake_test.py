# SPDX-License-Identifier: MIT
"""examples/batch/Snakefile, killed in the midst of its work and run again."""

import subprocess

import batch_runs


class Snakemake(batch_runs.BatchCase):

    def start(self, *options):
        config = [f"program={self.program}", f"manifest={self.manifest}", f"out={self.out}",
                  f"shards={batch_runs.SHARDS}"]
        return subprocess.Popen(
            ["snakemake", "-s", self.examples / "Snakefile", "--cores", "2", *options, "--config", *config],
            cwd=self.out, env=self.environment, start_new_session=True)

    def test_killed_run_is_resumed(self):
        self.cut_power(self.start())
        self.assertEqual(self.start("--unlock").wait(batch_runs.SECONDS), 0)
        self.assertEqual(self.start().wait(batch_runs.SECONDS), 0)
        self.assert_undisturbed()


if __name__ == "__main__":
    batch_runs.main()
