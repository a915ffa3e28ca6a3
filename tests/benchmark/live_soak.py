#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""live_soak.py PROGRAM RECORDING [--minutes M] [--cuts N] [--speed S] [--realtime]: `live` for long, with what goes wrong meanwhile.

`serve` plays the recording as QTM. Between it and `live` is a relay that is closed, falls silent, or whose server is
killed, N times. One viewer of the page never reads, one reads; a listener of MVN and a ZeroMQ subscriber die half way,
another subscriber looks at every posture: after each cut it counts the frames until all segments are within 10 mm of
where they were at the same frame of the recording before the first cut. The recording is best one that ends
as it begins; its frames are a whole number of periods, after which the movement is at the same place again.
A process that only sleeps, with real-time priority where the system gives it, notes when it was woken late: in such
a stall nothing of the machine ran for us, and frames that are dropped then are not the program's.
Needs NumPy and libzmq.
"""

import argparse
import json
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

import numpy

from live_peers import Relay, Subscriber, free_port, open_viewer

BACK = 0.010  # [m] of the worst segment
NAP, STALL = 0.0005, 0.003  # [s]
QUIET = 60  # [s] before the first cut, and after the last


def check_period(arguments):
    """Frame numbers go on where the recording begins anew; so must the period."""
    told = subprocess.run([arguments.program, "info", arguments.recording, "--json"], check=True, capture_output=True)
    frames = json.loads(told.stdout)["frames"]
    if frames % arguments.period:
        sys.exit(f"{arguments.recording} has {frames} frames, which is no whole number of periods of {arguments.period}")


class Server:
    def __init__(self, arguments):
        self.arguments, self.port = arguments, 0
        self.start()

    def start(self):
        a = self.arguments
        self.process = subprocess.Popen(
            [a.program, "serve", a.recording, "--as", "qtm", "--loop", "--port", str(self.port), "--speed", str(a.speed)],
            stdout=subprocess.PIPE, text=True)
        for line in self.process.stdout:
            if found := re.search(r"qtm://127.0.0.1:(\d+)", line):
                self.port = int(found.group(1))
                return
        sys.exit("the server does not start")

    def kill(self):
        self.process.kill()
        self.process.wait()


class Live:
    """The program, and what it says with when it says it."""

    def __init__(self, arguments, source_port, folder):
        self.zmq_port, self.mvn = free_port(), socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.mvn.bind(("127.0.0.1", 0))
        self.mvn.setblocking(False)
        self.summary, self.said, self.view = f"{folder}/summary.json", [], None
        self.process = subprocess.Popen(
            [arguments.program, "live", f"qtm://127.0.0.1:{source_port}", "--height", str(arguments.height), "--view",
             "--to", f"zmq://127.0.0.1:{self.zmq_port}", "--to", f"mvn://127.0.0.1:{self.mvn.getsockname()[1]}",
             "-o", f"{folder}/motion.xml", "--summary", self.summary] + ["--realtime"] * arguments.realtime,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=be_usual)
        threading.Thread(target=self.listen, daemon=True).start()
        while self.view is None:
            if self.process.poll() is not None:
                sys.exit("live has ended: " + " ".join(text for _, text in self.said))
            time.sleep(0.05)

    def listen(self):
        for line in self.process.stderr:
            for text in re.split(r"[\r\n]+", line):
                if text.strip():
                    self.said.append((time.monotonic(), text.strip()))
            if found := re.search(r"http://\S+", line):
                self.view = found.group()

    def system(self):
        with open(f"/proc/{self.process.pid}/status", encoding="ascii") as file:
            status = dict(line.split(":", 1) for line in file)
        files = len(os.listdir(f"/proc/{self.process.pid}/fd"))
        return int(status["VmRSS"].split()[0]), int(status["Threads"]), files


def be_urgent():
    """Above the threads of live: what comes late from the server comes at once with the next one, and is dropped."""
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(40))


def be_usual():
    os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


def note_stalls(path):
    """Of this process, until it is killed: when it was woken, and how late [s]."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(60))
    except OSError:
        print("the stalls are those of a usual thread: there is no right to real-time priority")
    with open(path, "w", encoding="ascii", buffering=1) as file:
        last = time.monotonic()
        while True:
            time.sleep(NAP)
            now = time.monotonic()
            if now - last > NAP + STALL:
                file.write(f"{now} {now - last - NAP}\n")
            last = now


class Watch:
    """Looks at every posture."""

    def __init__(self, address, period):
        self.subscriber, self.period = Subscriber(address), period
        self.is_over, self.reference, self.learns = False, {}, True
        self.frames = self.tracked = self.dropped = 0
        self.drops = []  # when, and how many
        self.delays, self.undisturbed = [], 0.0
        self.cut = None  # {"restored": time}; filled with what comes after
        threading.Thread(target=self.run, daemon=True).start()

    def run(self):
        while not self.is_over:
            message = self.subscriber.message()
            if message is not None:
                self.take(*message)

    def take(self, header, arrays):
        self.frames += 1
        self.tracked += header["tracking"]
        if header["dropped"] > self.dropped:
            self.drops.append((header["sent_ns"] / 1e9, header["dropped"] - self.dropped))
        self.dropped = header["dropped"]
        self.delays.append((header["sent_ns"] - header["received_ns"]) / 1e6)
        at, places = header["frame"] % self.period, arrays["segment_positions"]
        if self.learns:
            if at in self.reference:
                self.undisturbed = max(self.undisturbed, self.distance(at, places))
            elif header["tracking"] and self.frames > self.period:
                self.reference[at] = places
            return
        cut = self.cut
        if cut is None or cut["restored"] is None or "back" in cut:
            return
        if "first" not in cut:
            cut["first"], cut["frames"], cut["untold"] = time.monotonic(), 0, 0
        cut["frames"] += 1
        if at not in self.reference:
            cut["untold"] += 1
        elif header["tracking"] and self.distance(at, places) < BACK:
            cut["back"] = cut["frames"]

    def distance(self, at, places):
        return float(numpy.linalg.norm(places - self.reference[at], axis=1).max())


def run_cut(kind, seconds, relay, server, watch, live):
    cut = {"kind": kind, "seconds": seconds, "restored": None, "began": time.monotonic()}
    watch.cut = cut
    if kind == "silent":
        relay.silent = True
    elif kind == "closed":
        relay.close()
    else:
        server.kill()
    time.sleep(seconds)
    if kind == "silent":
        relay.close()  # what has waited since is no stream
        relay.silent = False
        relay.open()
    elif kind == "closed":
        relay.open()
    else:
        server.start()
    cut["restored"] = time.monotonic()
    end = cut["restored"] + 30
    while "back" not in cut and time.monotonic() < end and live.process.poll() is None:
        time.sleep(0.1)
    time.sleep(1)
    cut["said"] = [text for when, text in live.said if when >= cut["began"]]
    return cut


def describe_cut(cut):
    named = [text for text in cut["said"] if "127.0.0.1" in text and "come again" not in text]
    again = [text for text in cut["said"] if "come again" in text]
    waited = cut["first"] - cut["restored"] if "first" in cut else float("nan")
    return (f"| {cut['kind']} | {cut['seconds']} | {len(named)} | {len(again)} | {waited:.1f} | {cut.get('back', 'never')} |"
            f" {named[0] if named else ''} |")


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("recording")
    parser.add_argument("--minutes", type=float, default=60)
    parser.add_argument("--cuts", type=int, default=10)
    parser.add_argument("--speed", type=float, default=1, help="of the recording's own pace")
    parser.add_argument("--height", type=float, default=1.8)
    parser.add_argument("--period", type=int, default=1348, help="frames after which the movement is the same")
    parser.add_argument("--subscribe", help=argparse.SUPPRESS)
    parser.add_argument("--note-stalls", help=argparse.SUPPRESS)
    parser.add_argument("--realtime", action="store_true", help="of live, and of the server and the relay before it")
    arguments = parser.parse_args()
    if arguments.subscribe:  # the one that dies
        subscriber = Subscriber(arguments.subscribe)
        while True:
            subscriber.message()
    if arguments.note_stalls:
        note_stalls(arguments.note_stalls)
    check_period(arguments)

    if arguments.realtime:
        be_urgent()
    with tempfile.TemporaryDirectory(prefix="live_soak_") as folder:
        server = Server(arguments)
        relay = Relay(server.port)
        live = Live(arguments, relay.port, folder)
        zmq = f"tcp://127.0.0.1:{live.zmq_port}"
        stalls = subprocess.Popen([sys.executable, __file__, "", "", "--note-stalls", f"{folder}/stalls"])
        watch = Watch(zmq, arguments.period)
        try:
            soak(arguments, server, relay, live, watch, zmq)
            report_stalls(f"{folder}/stalls", watch)
        finally:
            stalls.kill()
            server.kill()
            if live.process.poll() is None:
                live.process.kill()


def soak(arguments, server, relay, live, watch, zmq):
    start = time.monotonic()
    end = start + 60 * arguments.minutes
    quiet = min(QUIET, 10 * arguments.minutes)
    stalled, reading = open_viewer(live.view), open_viewer(live.view)
    dying = subprocess.Popen([sys.executable, __file__, "", "", "--subscribe", zmq])
    cuts = [start + quiet + (end - start - 2 * quiet) * i / max(1, arguments.cuts) for i in range(arguments.cuts)]
    kinds = [("closed", 0.3), ("silent", 7), ("server", 1), ("closed", 3), ("silent", 20), ("server", 10), ("closed", 45)]
    memory, done, seen_by_mvn, next_minute = [], [], 0, start
    reading.setblocking(False)
    while time.monotonic() < end and live.process.poll() is None:
        now = time.monotonic()
        if now >= next_minute:
            memory.append((round((now - start) / 60), *live.system()))
            print("minute {}: {} kB resident, {} threads, {} files".format(*memory[-1]), watch.frames, "frames", flush=True)
            next_minute += 60
        if dying and now > (start + end) / 2:
            dying.send_signal(signal.SIGKILL)
            dying.wait()
            live.mvn.close()
            dying = None
            print("the listener of MVN and a subscriber are dead", flush=True)
        try:
            while reading.recv(1 << 16):
                pass
        except BlockingIOError:
            pass
        try:
            while dying and live.mvn.recv(2048):
                seen_by_mvn += 1
        except BlockingIOError:
            pass
        if cuts and now >= cuts[0]:
            cuts.pop(0)
            watch.learns = False
            kind, seconds = kinds[len(done) % len(kinds)]
            done.append(run_cut(kind, seconds, relay, server, watch, live))
            print(describe_cut(done[-1]), flush=True)
        time.sleep(0.05)
    before_end = live.system()
    watch.is_over = True
    stalled.close()
    live.process.send_signal(signal.SIGINT)
    out, _ = live.process.communicate(timeout=900)
    report(watch, memory + [("end", *before_end)], done, seen_by_mvn, out, live)


def report_stalls(path, watch):
    """A frame is dropped after the stall in which another came before it was taken."""
    with open(path, encoding="ascii") as file:
        stalls = [tuple(map(float, line.split())) for line in file]
    within = sum(count for when, count in watch.drops if any(-0.05 < when - end < 0.05 for end, _ in stalls))
    longest = max((late for _, late in stalls), default=0)
    print(f"stalls of the machine over {1000 * STALL:g} ms: {len(stalls)}, longest {1000 * longest:.1f} ms; of "
          f"{sum(count for _, count in watch.drops)} dropped frames {within} were within 50 ms of such a stall")


def report(watch, memory, cuts, seen_by_mvn, out, live):
    delays = numpy.array(watch.delays)
    resident = [kilobytes for _, kilobytes, *_ in memory]
    print("\n" + out)
    print(f"frames seen {watch.frames}, tracked {watch.tracked}, dropped {watch.dropped}; MVN packets {seen_by_mvn}")
    print("received to sent, ms: p50 {:.3f}, p99 {:.3f}, p99.9 {:.3f}, longest {:.1f}".format(
        *numpy.quantile(delays, [0.5, 0.99, 0.999, 1])))
    print(f"undisturbed, worst segment from the pass before: {1000 * watch.undisturbed:.2f} mm")
    print("resident, kB: " + " ".join(map(str, resident)))
    print("threads and files: " + " ".join(f"{t}/{f}" for _, _, t, f in memory))
    print("\n| cut | s | named | came again | s until the first frame | frames until back | said |\n|---|---|---|---|---|---|---|")
    for cut in cuts:
        print(describe_cut(cut))
    with open(live.summary, encoding="utf-8") as file:
        summary = json.load(file)
    summary.pop("motions", None)
    print("\n" + json.dumps(summary, indent=1))


if __name__ == "__main__":
    main()
