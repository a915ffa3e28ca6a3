# SPDX-License-Identifier: MIT
"""A Slurm of one node on this machine, of the user's own, beside any other one that runs here."""

import os
import pathlib
import pwd
import re
import socket
import subprocess
import sys
import tempfile

from batch_runs import until

# No cgroups, so that it runs in a container too; a node takes more jobs than it has cores.
# cred_expire is how long a requeued job waits [s], otherwise 2 minutes.
CONFIGURATION = """
ClusterName=private
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,bf_interval=1
SwitchType=switch/none
MpiDefault=none
SlurmdParameters=config_overrides
NodeName=node NodeHostname={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=node Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [listening.getsockname()[1] for listening in sockets]
    for listening in sockets:
        listening.close()
    return ports


class PrivateSlurm:
    """with PrivateSlurm() as slurm: slurm.run("sinfo"). Its folder is in TMPDIR: sockets need short paths."""

    def __init__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="slurm_"))
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf"),
                            "PATH": os.environ["PATH"] + ":/usr/sbin"}  # where the daemons are
        self.daemons = []

    def __enter__(self):
        try:
            self.start()
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, *_):
        self.stop()

    def start(self):
        for name in ("state", "spool"):
            (self.folder / name).mkdir(mode=0o755)
        key = self.folder / "munge.key"
        key.touch(mode=0o600)
        key.write_bytes(os.urandom(1024))
        controller_port, node_port = free_ports(2)
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            host=socket.gethostname().partition(".")[0], user=pwd.getpwuid(os.getuid()).pw_name,
            folder=self.folder, controller_port=controller_port, node_port=node_port))

        # --force: the folder is open to no other user, and need not be.
        self.spawn("munged", "--foreground", "--force", "--key-file", key, "--socket", self.folder / "munge.socket",
                   "--log-file", self.folder / "munged.log", "--pid-file", self.folder / "munged.pid",
                   "--seed-file", self.folder / "munged.seed")
        self.wait_for((self.folder / "munge.socket").is_socket, "munged")
        self.spawn("slurmctld", "-D")
        self.spawn("slurmd", "-D", "-N", "node")
        self.wait_for(lambda: self.run("sinfo", "-h", "-o", "%T", check=False) == "idle", "Slurm")

    def spawn(self, daemon, *options):
        with open(self.folder / f"{daemon}.out", "wb") as output:
            self.daemons.append(subprocess.Popen([daemon, *options], env=self.environment, stdout=output,
                                                 stderr=output, stdin=subprocess.DEVNULL))

    def wait_for(self, condition, what):
        def ready():
            for daemon in self.daemons:
                if daemon.poll() is not None:
                    raise ChildProcessError(f"{daemon.args[0]} ended with code {daemon.returncode}")
            return condition()

        try:
            until(ready, what)
        except Exception:
            for output in sorted(self.folder.glob("*.out")):
                sys.stderr.write(f"--- {output.name}\n{output.read_text()}")
            raise

    def stop(self):
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in self.daemons:
            daemon.wait()

    def run(self, *command, check=True, **options):
        """Standard output of a command."""
        done = subprocess.run(command, env={**self.environment, **options.pop("env", {})}, check=check,
                              stdout=subprocess.PIPE, stderr=None if check else subprocess.DEVNULL,
                              text=True, **options)
        return done.stdout.strip()

    def job(self, number):
        """What scontrol says of a job, or of an element of an array: job("12_3")["JobState"]."""
        return dict(re.findall(r"(\S+?)=(\S*)", self.run("scontrol", "--oneliner", "show", "job", number)))

    def ended(self, number):
        """The job once it has ended."""
        def ended():
            job = self.job(number)
            return job if job["JobState"] not in ("PENDING", "RUNNING", "COMPLETING", "REQUEUED") else None

        return until(ended, f"the end of job {number}", 0.1)
