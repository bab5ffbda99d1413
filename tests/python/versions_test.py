"""One module serves every version of CPython from 3.9 on, with the same results."""

import glob
import json
import os
import subprocess
import sys
import tempfile
import unittest

import command

# Without NumPy, which other interpreters rarely have.
CODE = """
import hashlib, json, sys
import simbench

@simbench.device_time("mean", window=10, gain=1.0, kind=simbench.Parameter("a", choices=["a"]))
class Mean:
    def __init__(self, window, gain, kind):
        self.offsets, self.window = [], window

    def stamp(self, sample):
        self.offsets = [*self.offsets, sample.arrival_ns - sample.sensor_ns][-self.window:]
        return sample.sensor_ns + sum(self.offsets) / len(self.offsets)

    def on_adjustment(self, adjustment):
        self.offsets.clear()

@simbench.gathering("queues")
class Queues:
    def __init__(self, setup):
        self.waiting = [[] for _ in range(setup.sources)]

    def push(self, frame):
        self.waiting[frame.source].append(frame)
        if all(self.waiting):
            return [tuple(queue.pop(0) for queue in self.waiting)]

@simbench.host_sync("asks", questions=8)
async def asks(host, settings):
    try:
        await host.channel(77).send(b"")
    except ValueError as error:
        refused.add(str(error))
    replies = [await host.channel(0).exchange(b"x") for _ in range(settings.questions)]
    await host.clock.step(min(replies, key=lambda reply: reply.delay_ns).offset_ns)

@simbench.host_sync("fails")
async def fails(host, settings):
    await host.sleep_for(1)
    raise KeyError("lost")

def text_of(kind, function):
    try:
        function()
    except kind as error:
        return str(error)

def digest(result):
    text = result._run.csv() + result._run.tidy_csv()
    return hashlib.sha256(text.encode()).hexdigest()

refused = set()
rig = "6cam_2host_30fps"
names = ["asks+mean+queues", "oracle+mean+yoon2021"]
module = simbench._simbench
seen = {
    "plain": digest(simbench.run("3cam_1host_30fps", seeds=2)),
    "own": digest(simbench.run(rig, names, seeds=2, jobs=2)),
    "refused": sorted(refused),
    "failed": text_of(simbench.InputError, lambda: simbench.run(rig, ["fails+mean+queues"], 1)),
    "input": text_of(simbench.InputError, lambda: simbench.run("none")),
    "types": [text_of(TypeError, lambda: module.load_archive(5)),
              text_of(TypeError, lambda: module.load_archive()),
              text_of(TypeError, module.Run),
              text_of(TypeError, lambda: module.RunRequest(1)),
              text_of(TypeError, lambda: module.RunRequest(seeds=1)),
              text_of(TypeError, lambda: setattr(module.RunRequest(), "seeds", -1)),
              text_of(AttributeError, lambda: setattr(simbench.Sample(1, 2), "sensor_ns", 3))],
    "sample": repr(simbench.Sample(1, 2, exposure_us=4)),
    "command": module.command_line(["simbench", "list"]),
}
with open(sys.argv[1], "w") as file:
    json.dump(seen, file)
"""


def interpreters():
    """Every CPython from 3.9 on that is on PATH or pyenv has, a path for each version."""
    here = [sys.executable]
    for folder in os.environ.get("PATH", "").split(os.pathsep):
        here += sorted(glob.glob(os.path.join(folder, "python3.[0-9]*")))
    here += sorted(glob.glob(os.path.expanduser("~/.pyenv/versions/3.*/bin/python3")))
    found = {}
    for path in here:
        code = "import sys; print(sys.implementation.name, *sys.version_info[:2])"
        try:
            done = subprocess.run([path, "-c", code], capture_output=True, text=True, timeout=60)
        except (OSError, subprocess.TimeoutExpired):
            continue
        words = done.stdout.split()
        if done.returncode == 0 and words[0] == "cpython":
            found.setdefault((int(words[1]), int(words[2])), path)
    return {version: path for version, path in found.items() if version >= (3, 9)}


class VersionsTest(unittest.TestCase):
    maxDiff = None

    def test_results_are_those_of_this_interpreter(self):
        others = interpreters()
        if len(others) < 2:
            self.skipTest("one interpreter is here")
        wanted = self.seen_by(sys.executable)
        self.assertRegex(wanted["failed"], "KeyError: 'lost'")
        self.assertIn("found host 77", wanted["refused"][0])
        for version, path in sorted(others.items()):
            with self.subTest(version):
                self.assertEqual(self.seen_by(path), wanted)

    def seen_by(self, interpreter):
        path = os.path.join(self.folder.name, "seen.json")
        done = subprocess.run([interpreter, "-c", CODE, path], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""), interpreter)
        with open(path, encoding="utf-8") as file:
            return json.load(file)

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)


if __name__ == "__main__":
    unittest.main()
