#!/usr/bin/env python3
"""Prints what Python can learn of the machine, its time and its chance: two runs of a world must
print the same."""

import datetime
import glob
import os
import platform
import random
import resource
import secrets
import socket
import subprocess
import sys
import tempfile
import threading
import time
import uuid


def say(*values):
    print(*values, flush=True)


def say_times():
    say("time", time.time_ns(), time.monotonic_ns(), time.perf_counter_ns())
    say("CPU time", time.process_time_ns(), time.thread_time_ns(), os.times())
    say("now", datetime.datetime.now(), time.localtime(), time.tzname)
    say("use", resource.getrusage(resource.RUSAGE_SELF))


def say_chance():
    say("uuid", uuid.uuid4(), uuid.uuid1())
    say("random", random.random(), secrets.token_hex(), os.urandom(4).hex())
    say("hash", hash("text"), hash(b"bytes"), list({"red", "green", "blue", "white", "black"}))
    say("objects", id(object()), object(), {object(): 1})


def say_identity():
    say("ids", os.getpid(), os.getppid(), os.getpgrp(), os.getsid(0), os.getuid())
    say("thread", threading.get_native_id(), threading.get_ident())
    say("host", socket.gethostname(), platform.node(), os.getcwd(), os.path.expanduser("~"))
    say("processors", os.cpu_count(), os.sched_getaffinity(0), os.getloadavg())
    say("environment", {name: value for name, value in os.environ.items() if "LD_" not in name})
    say("umask", os.umask(0o22), os.umask(0o22))


def say_files():
    os.makedirs("made/deep", exist_ok=True)
    for name in ("made/z", "made/a", "made/deep/m"):
        with open(name, "w") as file:
            file.write(name)
            say(name, "open", os.fstat(file.fileno()))
        time.sleep(0.02)
        say(name, os.stat(name))
    say("listdir", os.listdir("made"), [entry.inode() for entry in os.scandir("made")])
    say("walk", list(os.walk("made")), glob.glob("made/*"))
    os.utime("made/a", (5, 6))
    say("utime", os.stat("made/a"))
    with tempfile.NamedTemporaryFile() as file, tempfile.TemporaryDirectory() as folder:
        say("temporary", file.name, folder, tempfile.gettempdir(), tempfile.mktemp())
    say("python", sys.executable, os.stat(sys.executable).st_mtime)
    for path in ("/proc/uptime", "/proc/self/status", "/proc/loadavg"):
        try:
            with open(path) as file:
                say(path, file.read())
        except OSError as error:
            say(path, error.strerror)


def say_children():
    code = "import os, time; print(os.getpid(), time.time_ns(), os.times())"
    say("child", subprocess.run([sys.executable, "-c", code], capture_output=True).stdout)
    say("shell", subprocess.check_output("echo $$ $PPID; date +%s.%N; times; pwd", shell=True))
    say("ls", subprocess.check_output(["ls", "-li", "--time-style=full-iso", "made"]).decode())


if __name__ == "__main__":
    say_times()
    say_chance()
    say_identity()
    say_files()
    say_children()
    say("done")
    # It stays open, as logs do, and is written to until the end.
    with open("log", "w") as log:
        while True:
            print(time.time_ns(), file=log, flush=True)
            time.sleep(1)
