"""The wheel: what is in it, what pip makes of it, and what it leaves; progress while it is built."""

import glob
import hashlib
import os
import pty
import subprocess
import sys
import tempfile
import unittest
import venv
import zipfile

import command
import simbench

sys.path.insert(0, os.path.join(command.SOURCE, "python"))
import build_backend  # noqa: E402

PACKAGE = os.path.dirname(simbench.__file__)
MODULE = os.path.realpath(os.path.join(PACKAGE, "_simbench.abi3.so"))
SHIM = os.path.realpath(os.path.join(PACKAGE, "libsimbench_shim.so"))
TAG = build_backend._tag()


def files_below(folder):
    return sorted(os.path.relpath(os.path.join(where, name), folder)
                  for where, _, names in os.walk(folder) for name in names)


class WheelTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def written(self, name, tag=TAG):
        folder = os.path.join(self.folder, name)
        os.mkdir(folder)
        return os.path.join(folder, build_backend.write_wheel(folder, MODULE, SHIM, tag))

    def test_the_same_files_give_the_same_bytes(self):
        digests = set()
        for name in "ab":
            with open(self.written(name), "rb") as file:
                digests.add(hashlib.sha256(file.read()).hexdigest())
        self.assertEqual(len(digests), 1)

    def test_it_has_a_tag_for_each_platform(self):
        wheel = self.written("many", "cp39-abi3-manylinux_2_28_x86_64.linux_x86_64")
        with zipfile.ZipFile(wheel) as archive:
            text = archive.read(f"{build_backend._info()}/WHEEL").decode()
        self.assertIn("Tag: cp39-abi3-manylinux_2_28_x86_64\n"
                      "Tag: cp39-abi3-linux_x86_64\n", text)

    def test_a_script_can_write_one(self):
        done = subprocess.run([sys.executable, build_backend.__file__, self.folder, MODULE, SHIM, TAG],
                              capture_output=True, text=True, check=True)
        name = done.stdout.strip()
        self.assertEqual(name, f"simbench-{simbench.__version__}-{TAG}.whl")
        self.assertTrue(zipfile.is_zipfile(os.path.join(self.folder, name)))

    def check_installed(self, make_environment):
        """pip installs a command that works alone, and removes all that it has installed."""
        place = os.path.join(self.folder, "environment")
        make_environment(place)
        before = files_below(place)
        alone = {"PATH": os.environ["PATH"], "HOME": self.folder, "PYTHONDONTWRITEBYTECODE": "1"}

        def run(name, *arguments):
            done = subprocess.run([os.path.join(place, "bin", name), *arguments], cwd=self.folder,
                                  env=alone, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            return done.stdout

        run("pip", "install", "--no-index", "--disable-pip-version-check", self.written("wheel"))
        self.assertEqual(run("simbench", "--version"), command.simbench("--version"))
        of_run = ("run", "--scenario", "3cam_1host_30fps", "--seeds", "2", "--format", "csv")
        self.assertEqual(run("simbench", *of_run), command.simbench(*of_run))
        said = run("simbench", "clocks", "--scenario", "6host_star", "--seeds", "1",
                   "--program", "mine=" + os.path.join(command.SOURCE, "examples", "cristian.json"))
        self.assertRegex(said, "(?m)^mine ")
        code = "import simbench; print(simbench.__file__, len(simbench.list_scenarios()))"
        self.assertRegex(run("python", "-c", code), rf"^{place}/.* \d+\n")
        run("pip", "uninstall", "--yes", "simbench")
        self.assertEqual(files_below(place), before)

    def test_pip_installs_a_command_and_leaves_nothing(self):
        try:
            import ensurepip  # noqa: F401
        except ImportError:
            self.skipTest("this interpreter makes no environments with pip")
        self.check_installed(lambda place: venv.create(place, with_pip=True))

    def test_pip_of_other_versions_takes_it_too(self):
        others = glob.glob(os.path.expanduser("~/.pyenv/versions/3.*/bin/python3"))
        versions = {tuple(map(int, path.split("/")[-3].split(".")[:2])): path for path in others}
        versions = {version: path for version, path in versions.items() if version >= (3, 9)}
        if not versions:
            self.skipTest("no other interpreter is here")
        oldest = versions[min(versions)]
        self.check_installed(lambda place: subprocess.run([oldest, "-m", "venv", place], check=True))

    def test_an_older_interpreter_is_refused_by_pip(self):
        old = glob.glob(os.path.expanduser("~/.pyenv/versions/3.8.*/bin/python3"))
        if not old:
            self.skipTest("no CPython 3.8 is here")
        done = subprocess.run([old[0], "-m", "pip", "install", "--no-index", "--target", self.folder,
                               self.written("wheel")], capture_output=True, text=True)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("is not a supported wheel on this platform", done.stderr)


class ProgressTest(unittest.TestCase):
    """What tools/build prints goes to the terminal of the process that started the backend."""

    BACKEND = ("import build_backend; "
               "build_backend._run('bash', '-c', 'echo built >&2; test -t 2 && echo seen >&2 || true')")
    PIP = ("import subprocess, sys; "
           "kept = subprocess.run([sys.executable, '-c', sys.argv[1]], capture_output=True); "
           "open(sys.argv[2], 'wb').write(kept.stderr)")

    def outputs(self, stderr):
        with tempfile.NamedTemporaryFile() as kept:
            environment = {**os.environ, "PYTHONPATH": os.path.join(command.SOURCE, "python")}
            subprocess.run([sys.executable, "-c", self.PIP, self.BACKEND, kept.name],
                           stderr=stderr, env=environment, check=True)
            return kept.read().decode()

    def test_a_terminal_sees_it(self):
        master, slave = pty.openpty()
        self.addCleanup(os.close, master)
        kept = self.outputs(slave)
        os.close(slave)
        self.assertEqual(os.read(master, 1000).split(), [b"built", b"seen"])
        self.assertEqual(kept, "")

    def test_else_pip_keeps_it(self):
        with tempfile.TemporaryFile() as log:
            self.assertEqual(self.outputs(log), "built\n")
            self.assertEqual(log.tell(), 0)


@unittest.skipUnless(os.path.realpath(PACKAGE) == os.path.join(build_backend.BUILD, "python/simbench"),
                     "pip builds in build/release")
class SourceTest(unittest.TestCase):
    def test_pip_shares_what_is_built(self):
        with tempfile.TemporaryDirectory() as folder:
            log = os.path.join(build_backend.BUILD, ".ninja_log")
            before = os.path.getsize(log)
            name = build_backend.build_wheel(folder)
            with open(log, encoding="utf-8") as file:
                file.seek(before if os.path.getsize(log) >= before else 0)
                compiled = [line for line in file.read().splitlines()
                            if line.split("\t")[3].endswith(".o")]
            self.assertTrue(os.path.exists(os.path.join(folder, name)))
        self.assertEqual(compiled, [])


if __name__ == "__main__":
    unittest.main()
