"""The package and code of its users pass a strict check of types."""

import os
import shutil
import subprocess
import tempfile
import unittest

import command

USERS_FILE = '''
from typing import List, Optional

import simbench


@simbench.device_time("mean_of_last", window=30)
class MeanOfLast:
    def __init__(self, window: int) -> None:
        self.offsets: List[int] = []
        self.window = window

    def stamp(self, sample: simbench.Sample) -> float:
        self.offsets.append(sample.arrival_ns - sample.sensor_ns)
        last = self.offsets[-self.window :]
        return sample.sensor_ns + sum(last) / len(last)


def best() -> Optional[str]:
    mine = simbench.pipeline("mine", base="yoon2021_both", device_time=MeanOfLast)
    result: simbench.Result = simbench.run("18cam_6host_45fps", ["yoon2021_both", mine], seeds=2)
    sweep = simbench.sweep("3cam_1host_30fps", {"/cameras/exposure_ms": [2, 4.0]}, seeds=2)
    lines: List[str] = [result.answer, sweep.answer, *sweep.metrics]
    gate = simbench.gate(result, simbench.save_baseline(result, "baseline.json"))
    if not gate:
        lines += gate.reasons
    MeanOfLast(window=3).stamp(simbench.Sample(1, 2))
    return simbench.advise("amd<1ms", 3).recommended
'''
MISTAKES = '''
import simbench

simbench.run("18cam_6host_45fps", seeds="many")
simbench.sweep("18cam_6host_45fps", study=1)
count: int = simbench.run("18cam_6host_45fps").answer
simbench.gate("now")
'''


@unittest.skipIf(shutil.which("mypy") is None, "mypy is not installed")
class TypesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.cache = folder.name

    def mypy(self, *arguments):
        config = os.path.join(command.SOURCE, "pyproject.toml")
        done = subprocess.run(
            ["mypy", "--config-file", config, "--cache-dir", self.cache, *arguments],
            capture_output=True, text=True, check=False,
            env={**os.environ, "MYPYPATH": os.path.join(command.SOURCE, "python")},
        )  # fmt: skip
        return done.returncode, done.stdout + done.stderr

    def of_user(self, code):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "mine.py")
            with open(path, "w", encoding="utf-8") as file:
                file.write(code)
            return self.mypy(path)

    def test_the_package(self):
        status, text = self.mypy(os.path.join(command.SOURCE, "python", "simbench"))
        self.assertEqual(status, 0, text)

    def test_a_users_file(self):
        status, text = self.of_user(USERS_FILE)
        self.assertEqual(status, 0, text)

    def test_a_users_mistakes_are_found(self):
        status, text = self.of_user(MISTAKES)
        self.assertEqual(status, 1, text)
        found = [line for line in text.splitlines() if ": error: " in line]
        self.assertEqual([line.split(":")[1] for line in found], ["4", "5", "6", "7"], text)

    def test_the_package_says_that_it_is_typed(self):
        self.assertTrue(
            os.path.exists(os.path.join(command.SOURCE, "python", "simbench", "py.typed"))
        )


if __name__ == "__main__":
    unittest.main()
