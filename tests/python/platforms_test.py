"""Where the compiled module cannot be loaded, one line says what it needs and what works there."""

import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import simbench
from simbench import platforms

PACKAGE = os.path.dirname(simbench.__file__)


class PlatformsTest(unittest.TestCase):
    def refusal(self, change):
        """What importing the package says if its module has these bytes."""
        with tempfile.TemporaryDirectory() as folder:
            package = os.path.join(folder, "simbench")
            shutil.copytree(PACKAGE, package)
            name = os.path.join(package, "_simbench.abi3.so")
            with open(name, "rb") as file:
                module = file.read()
            os.remove(name)
            with open(name, "wb") as file:
                file.write(change(module))
            done = subprocess.run([sys.executable, "-c", "import simbench"], cwd=folder,
                                  env={**os.environ, "PYTHONPATH": folder}, capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        line = done.stderr.splitlines()[-1]
        self.assertRegex(line, r"^ImportError: simbench's compiled module cannot be loaded \(")
        self.assertIn(f"; needed: {platforms.NEEDED}; found: {platforms.found()}. ", line)
        self.assertIn("bin/simbench, needs no library", line)
        self.assertNotIn("During handling", done.stderr)
        return line

    def test_an_older_glibc(self):
        def newer(module):
            return re.sub(rb"\0GLIBC_[0-9.]+(?=\0)", lambda name: re.sub(rb"\d", b"9", name[0]), module)
        self.assertRegex(self.refusal(newer), "`GLIBC_[9.]+' not found")

    def test_another_machine(self):
        s390 = (22).to_bytes(2, "little")  # e_machine of elf(5)
        self.assertIn("cannot open shared object file",
                      self.refusal(lambda module: module[:18] + s390 + module[20:]))

    def test_half_a_file(self):
        self.assertIn("file too short", self.refusal(lambda module: module[:40]))

    def test_what_is_found_is_this_system(self):
        self.assertIn(platform.machine(), platforms.found())
        self.assertIn(platform.python_version(), platforms.found())


if __name__ == "__main__":
    unittest.main()
