"""The module takes nothing from the interpreter that is not in the stable ABI of CPython 3.9."""

import os
import re
import subprocess
import unittest

import command
import simbench

LIST = os.path.join(command.SOURCE, "tests", "python", "stable_abi.txt")


def listed():
    with open(LIST, encoding="utf-8") as file:
        lines = [line.split() for line in file if not line.startswith("#")]
    return {name: tuple(map(int, version.split("."))) for name, version in lines}


def taken():
    """Symbols of Python that the module needs and does not have."""
    done = subprocess.run(["nm", "-D", "--undefined-only", simbench._simbench.__file__],
                          capture_output=True, text=True, check=True)
    return set(re.findall(r" U (_?Py\w+)", done.stdout))


class StableAbiTest(unittest.TestCase):
    def test_the_module_is_of_no_version(self):
        self.assertEqual(os.path.basename(simbench._simbench.__file__), "_simbench.abi3.so")

    def test_what_it_takes_is_what_is_listed(self):
        self.assertIn("PyModule_Create2", taken())
        self.assertEqual(taken(), set(listed()))

    def test_all_of_it_is_of_3_9_or_older(self):
        self.assertEqual({name for name, version in listed().items() if version > (3, 9)}, set())


if __name__ == "__main__":
    unittest.main()
