"""A farm by Slurm: one node on this machine, from nothing to a posterior, with pilots that are killed, requeued and timed out."""

import os
import pathlib
import random
import signal
import subprocess
import sys
import time

from farm import Scale, Service, from_nothing, local_run, until, write_job

CONFIGURATION = """ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SlurmctldPort=16817
SlurmdPort=16818
SrunPortRange=17000-17099
ReturnToService=2
SlurmdParameters=config_overrides
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,sched_min_interval=0,bf_interval=2,requeue_delay=1
KillWait=5
MinJobAge=10
NodeName={host} NodeAddr=127.0.0.1 CPUs=8 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO
"""


class Slurm:
    """One node, with its own munge."""

    name, word = "slurm", "slurm "

    def __init__(self, folder):
        folder.mkdir(parents=True)
        (folder / "state").mkdir()
        (folder / "spool").mkdir()
        host = os.uname().nodename.split(".")[0]
        (folder / "slurm.conf").write_text(CONFIGURATION.format(host=host, folder=folder))
        os.environ["SLURM_CONF"] = str(folder / "slurm.conf")
        key = folder / "munge.key"
        key.write_bytes(random.randbytes(1024))
        key.chmod(0o600)
        munge = [f"--key-file={key}", f"--socket={folder}/munge.socket", f"--pid-file={folder}/munge.pid",
                 f"--log-file={folder}/munge.log", f"--seed-file={folder}/munge.seed", "--force"]
        self.daemons = [
            subprocess.Popen(["munged", "--foreground", *munge], stderr=subprocess.DEVNULL),
            subprocess.Popen(["slurmctld", "-D", "-c"], stderr=subprocess.DEVNULL),
            subprocess.Popen(["slurmd", "-D", "-N", host], stderr=subprocess.DEVNULL),
        ]
        until("a node that is idle", lambda: "idle" in _out("sinfo", "-h", "-o", "%T"))

    @staticmethod
    def options(folder):
        """Where a pilot writes its log."""
        return [f"--chdir={folder}"]

    def running(self):
        return self.jobs("RUNNING")

    def present(self):
        return self.jobs("PENDING", "RUNNING", "COMPLETING")

    def jobs(self, *states):
        """Jobs in these states, in the order of their numbers."""
        lines = _out("squeue", "-h", "-r", "-o", "%i %T").splitlines()
        return [job for job, state in map(str.split, lines) if state in states]

    def stop(self):
        subprocess.run(["scancel", "--signal=KILL", "--name=grouser-worker"], capture_output=True)
        for daemon in reversed(self.daemons):
            daemon.send_signal(signal.SIGTERM)
        for daemon in self.daemons:
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()


def _out(*command):
    return subprocess.run(command, capture_output=True, text=True).stdout


def with_faults(slurm, service, folder, job, expected):
    """Pilots are killed, requeued, and reach their time limit."""
    with Scale(service, slurm, folder, "--max", "3", more=["--time=1", "--signal=B:USR1@10"]):
        calibration = service.submit(job)
        until("pilots that run", lambda: len(slurm.running()) == 3 and service.evaluations(calibration) > 5)
        killed = requeued = 0
        while not service.finished(calibration):
            running = slurm.running()
            if running and killed <= requeued:
                killed += subprocess.run(["scancel", "--signal=KILL", "--batch", running[0]]).returncode == 0
            elif running:
                requeued += subprocess.run(["scontrol", "requeue", running[-1]]).returncode == 0
            time.sleep(4)
        assert killed > 0 and requeued > 0, (killed, requeued)
        assert service.posterior(calibration) == expected, "other bits than a local run"
        flags = service.json(f"/v1/calibrations/{calibration}/diagnostics")["flags"]
        until("an empty queue", lambda: not slurm.present())
    print(f"slurm: {killed} killed, {requeued} requeued; the bits of a local run")
    assert not any(flag["kind"] == "worker" for flag in flags), flags
    assert service.metric("grouser_evaluations_refused_total") == 0


def at_the_time_limit(slurm, service, folder, job):
    """A pilot ends before its time limit, by itself where Slurm states it (SLURM_JOB_END_TIME), else at its signal; the next one goes on."""
    logs = folder / "limit"
    logs.mkdir()
    reasons = ("its lifetime is over", "asked to stop")
    with Scale(service, slurm, logs, "--max", "1", more=["--time=1", "--signal=B:USR1@10"]):
        calibration = service.submit(job)
        until("the end of a pilot", lambda: any(reason in log.read_text() for log in logs.glob("grouser-*.log") for reason in reasons))
        done = service.evaluations(calibration)
        until("the next pilot", lambda: service.evaluations(calibration) > done)
        service.cancel(calibration)
        until("an empty queue", lambda: not slurm.present())
    assert service.metric("grouser_leases_failed_total") == 0
    print("slurm: a pilot ends before its time limit and blames no evaluation; the next one goes on")


def main():
    programs, folder = map(pathlib.Path, sys.argv[1:3])
    os.environ["GROUSER_WORKER"] = str(programs / "worker")
    job, long = write_job(folder / "job"), write_job(folder / "long", particles=200)
    expected = local_run(programs, job, folder / "local")
    expected_long = local_run(programs, long, folder / "local-long")
    endless = write_job(folder / "endless", particles=20_000)
    slurm = Slurm(folder / "slurm")
    try:
        service = Service(programs, folder / "service", "--lease-ms", "3000")
        try:
            from_nothing(slurm, service, folder, job, expected)
            at_the_time_limit(slurm, service, folder, endless)
            with_faults(slurm, service, folder, long, expected_long)
        finally:
            service.stop()
    finally:
        slurm.stop()


main()
