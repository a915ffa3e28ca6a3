# SPDX-License-Identifier: MIT
"""examples/batch/submit.sh and slurm_array.sbatch on a real Slurm, with shards that are killed."""

import batch_runs
from private_slurm import PrivateSlurm


class Slurm(batch_runs.BatchCase):

    @classmethod
    def setUpClass(cls):
        cls.slurm = cls.enterClassContext(PrivateSlurm())

    def submit(self):
        """Numbers of the array and of the job that merges."""
        return self.slurm.run(self.examples / "submit.sh", self.manifest, self.out, str(batch_runs.SHARDS),
                              "--cpus-per-task=1", env=self.environment, cwd=self.out).split()

    def test_killed_shard_is_submitted_again(self):
        array, merge = self.submit()
        self.kill(2)
        self.assertEqual(self.slurm.ended(f"{array}_2")["ExitCode"], "0:9")
        self.assertEqual(self.slurm.ended(merge)["ExitCode"], "1:0")
        self.assertIn("missing", {entry["state"] for entry in batch_runs.results(self.out)})

        array, merge = self.submit()
        self.assertEqual(self.slurm.ended(merge)["ExitCode"], "0:0")
        self.assert_undisturbed()

    def test_requeued_shard_goes_on(self):
        array, merge = self.submit()
        self.catch(3)
        self.slurm.run("scontrol", "requeue", f"{array}_3")
        self.assertEqual(self.slurm.ended(merge)["ExitCode"], "0:0")
        self.assertEqual(self.slurm.job(f"{array}_3")["Restarts"], "1")
        self.assert_undisturbed()


if __name__ == "__main__":
    batch_runs.main()
