#!/usr/bin/env python3
"""What algorithms in Python cost: a stamp, a vectorised stamp, a pushed frame, a host_sync.

    PYTHONPATH=build/release/python /usr/bin/python3 bench/python_algorithms.py
    valgrind --tool=callgrind /usr/bin/python3 bench/python_algorithms.py PIPELINE FRAMES SEEDS

Each figure is a difference in CPU time of two runs on one thread that differ in one algorithm, by
frame or run; the least of some repetitions counts. The second command runs one pipeline once.
docs/benchmarks.md has measured figures.
"""

import collections
import contextlib
import os
import sys
import time

import simbench
from simbench import _simbench

SCENARIO = "18cam_6host_45fps"
CAMERAS = 18
FRAMES = 4000
SEEDS = 2
REPETITIONS = 9


@simbench.device_time("bench_stamp")
class Stamp:
    def stamp(self, sample):
        return sample.arrival_ns


@simbench.device_time("bench_stamp_all")
class StampAll:
    def stamp_all(self, arrival_ns):
        return arrival_ns


@simbench.device_time("bench_regression")
class Regression:
    """as regression_offline, in two lines of NumPy"""

    def stamp_all(self, sensor_ns, arrival_ns):
        x, y = sensor_ns - sensor_ns[0], (arrival_ns - sensor_ns).astype(float)
        x = (x - x.mean()) / x.std()
        return sensor_ns + y.mean() + x * (x @ (y - y.mean()) / len(x))


@simbench.gathering("bench_push")
class Push:
    def __init__(self, setup):
        pass

    def push(self, frame):
        pass


@simbench.gathering("bench_sets")
class Sets:
    """as yoon2021 where no frame is lost"""

    def __init__(self, setup):
        self.waiting = [collections.deque() for _ in range(setup.sources)]

    def push(self, frame):
        self.waiting[frame.source].append(frame)
        if all(self.waiting):
            return [[queue.popleft() for queue in self.waiting]]


@simbench.host_sync("bench_once", questions=16)
async def once(host, settings):
    replies = [await host.channel(0).exchange() for _ in range(settings.questions)]
    await host.clock.step(min(replies, key=lambda reply: reply.delay_ns).offset_ns)


@simbench.host_sync("bench_service", warm_up_s=60, interval_ms=250)
async def service(host, settings):
    while True:
        reply = await host.channel(0).exchange()
        if abs(reply.offset_ns) > 5e6:
            await host.clock.step(reply.offset_ns)
        else:
            await host.clock.slew(reply.offset_ns / 4)
        await host.sleep_for(settings.interval_ms * (0.9 + 0.2 * host.random()))


@contextlib.contextmanager
def silent():
    kept, null = [os.dup(1), os.dup(2)], os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, 1), os.dup2(null, 2)
    try:
        yield
    finally:
        os.dup2(kept[0], 1), os.dup2(kept[1], 2)
        for descriptor in (*kept, null):
            os.close(descriptor)


def seconds(pipeline, frames, seeds):
    arguments = ["simbench", "run", "--scenario", SCENARIO, "--pipelines", pipeline, "--jobs", "1",
                 "--seeds", str(seeds), "--set", f"/timeline/frames={frames}", "--format", "csv"]
    begin = time.process_time()
    with silent():
        status = _simbench.command_line(arguments)
    if status != 0:
        sys.exit(f"{' '.join(arguments)}: exit status {status}")
    return time.process_time() - begin


def least(pipeline, frames=FRAMES, seeds=SEEDS):
    return min(seconds(pipeline, frames, seeds) for _ in range(REPETITIONS))


def report(what, value, unit, limit=""):
    print(f"{what:58} {value:9.1f} {unit:10} {limit}")


def main():
    frames = FRAMES * CAMERAS * SEEDS
    plain = least("oracle+raw_arrival+yoon2021")
    offline = least("oracle+regression_offline+yoon2021")

    def per_frame(pipeline, base):
        return (least(pipeline) - base) / frames * 1e9

    report("stamp(): arrival", per_frame("oracle+bench_stamp+yoon2021", plain), "ns/frame",
           "aim: 1500")
    report("stamp_all(): arrival, against regression_offline",
           per_frame("oracle+bench_stamp_all+yoon2021", offline), "ns/frame", "aim: 50")
    report("stamp_all(): regression, against regression_offline",
           per_frame("oracle+bench_regression+yoon2021", offline), "ns/frame", "aim: 50")
    genlock = least("oracle+raw_arrival+yoon2021")
    report("push(): nothing, against yoon2021",
           per_frame("oracle+raw_arrival+bench_push", genlock), "ns/frame")
    report("push(): sets, against yoon2021",
           per_frame("oracle+raw_arrival+bench_sets", genlock), "ns/frame")
    seeds = 8
    base = least("oracle+raw_arrival+yoon2021", 480, seeds)
    for name in ("bench_once", "bench_service"):
        cost = least(f"{name}+raw_arrival+yoon2021", 480, seeds)
        report(f"host_sync {name}, a run in all", cost / seeds * 1e3, "ms/run", "aim: 50")
        report(f"host_sync {name}, beyond the oracle's", (cost - base) / seeds * 1e3, "ms/run")
    hull = least("two_way_hull+raw_arrival+yoon2021", 480, seeds)
    report("host_sync two_way_hull (C++), a run in all", hull / seeds * 1e3, "ms/run")


if __name__ == "__main__":
    if len(sys.argv) == 4:
        seconds(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
    else:
        main()
