#!/usr/bin/env python3
"""Python's subprocess and its kin: each line is when something ended, in ms since the beginning,
and what."""

import multiprocessing
import os
import signal
import subprocess
import sys
import time

BEGIN = time.monotonic()


def say(*values):
    print(round((time.monotonic() - BEGIN) * 1e3), *values, flush=True)


def run_programs():
    shell = subprocess.run(
        ["/bin/sh", "-c", "echo out; echo err >&2; sleep 0.2; exit 4"], capture_output=True
    )
    say(shell.returncode, shell.stdout, shell.stderr)
    try:
        subprocess.run(["/bin/sleep", "5"], timeout=0.3)
    except subprocess.TimeoutExpired:
        say("patience is over")
    piped = subprocess.run("printf 'b\\na\\n' | sort", shell=True, capture_output=True)
    say(piped.stdout)


def follow():
    code = "import time\nfor i in range(3):\n    time.sleep(0.1)\n    print(i, flush=True)"
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    for line in child.stdout:
        say("line", line.strip())
    say("ended", child.wait())


def end_one():
    child = subprocess.Popen(["/bin/sleep", "100"])
    time.sleep(0.05)
    say("running", child.poll())
    child.send_signal(signal.SIGTERM)
    say("ended", child.wait())


def fork():
    child = os.fork()
    if child == 0:
        time.sleep(0.1)
        os._exit(7)
    say("fork", os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))


def square(number):
    time.sleep(0.1)
    return number * number


def share_work():
    with multiprocessing.get_context("fork").Pool(2) as pool:
        say("pool", pool.map(square, range(4), chunksize=1))


if __name__ == "__main__":
    run_programs()
    follow()
    end_one()
    fork()
    share_work()
    time.sleep(1e6)
