# SPDX-License-Identifier: MIT
"""examples/batch/gnu_parallel.sh with a shard that is killed, and killed itself."""

import subprocess

import batch_runs


class GnuParallel(batch_runs.BatchCase):

    def start(self):
        return subprocess.Popen(
            [self.examples / "gnu_parallel.sh", self.manifest, self.out, str(batch_runs.SHARDS), "--jobs", "2"],
            env=self.environment, start_new_session=True)

    def test_killed_shard_is_run_again(self):
        run = self.start()
        self.kill(2)
        self.assertEqual(run.wait(batch_runs.SECONDS), 0)
        self.assert_undisturbed()

    def test_killed_run_is_resumed(self):
        self.cut_power(self.start())
        self.assertEqual(self.start().wait(batch_runs.SECONDS), 0)
        self.assert_undisturbed()


if __name__ == "__main__":
    batch_runs.main()
