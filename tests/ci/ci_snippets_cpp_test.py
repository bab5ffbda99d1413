"""reports/ci/: the snippets for C++, from an empty repository with a program of its own.

A stand-in of simbench's repository has scripts that take the build that is there in place of one of
some minutes; what is installed and built against is real.
"""

import os
import shutil
import sys
import unittest

from machine import SNIPPETS, Machine, Repository, text_of
from releases import BUILD, SOURCE, VERSION
from services import GitHub, GitLab, failures

PROJECT = os.path.join(SOURCE, "tests", "consumer", "project")


def setUpModule():
    global machine, source
    machine = Machine(sys.executable)
    source = Repository(machine, "simbench")
    log = machine.path("source_log")
    source.write("tools/setup", f'#!/bin/sh\necho setup "$@" >> "{log}"\n')
    source.write("tools/build", f"""#!/bin/sh
echo build "$@" >> "{log}"
cd "$(dirname "$0")/.." && mkdir -p build/deps
ln -s "{os.path.join(SOURCE, 'build', 'deps', 'usr')}" build/deps/usr
ln -s "{BUILD}" build/release
""")
    for tool in ("setup", "build"):
        os.chmod(source.path(f"tools/{tool}"), 0o755)
    source.commit()
    source.git("tag", f"v{VERSION}")


def tearDownModule():
    machine.close()


class Services:
    def test_from_nothing_to_a_failed_gate(self):
        log = machine.path("source_log")
        if os.path.exists(log):
            os.remove(log)
        service = self.kind(machine.path(self.kind.__name__), machine.environment)
        repository = Repository(machine, f"{self.kind.__name__}.repository")
        shutil.copytree(PROJECT, repository.folder, dirs_exist_ok=True)
        repository.write(self.kind.file, text_of(SNIPPETS, self.snippet))
        for script in ("simbench_gate.sh", "simbench_libraries.sh"):
            repository.write(f"ci/{script}", text_of(SNIPPETS, script))
        repository.edit(self.kind.file, self.placeholder, source.folder)
        repository.commit("The project and the snippet")

        first = service.run(repository.folder)
        self.assertEqual(first.status, 4, first.log)
        self.assertIn("## my_rig: no baseline yet", first.summary)
        self.assertEqual(text_of(log).splitlines(), ["setup build",
            "build release -DSIMBENCH_BUILD_TESTS=OFF -DSIMBENCH_BUILD_BENCH=OFF"])
        self.assertEqual(text_of(machine.path("apt_log")).splitlines()[-2:],
                         ["update", "install --yes git"])

        # The libraries are in the cache, though the gate did not pass: nobody asks for them again.
        baseline = os.path.join(first.artifacts, "simbench_results", "my_rig.baseline.json")
        repository.write("simbench_baselines/my_rig.json", text_of(baseline))
        repository.edit("main.cc", "int questions = 16;", "int questions = 1;")
        repository.commit("A baseline, and an idea")
        os.rename(source.folder, f"{source.folder}.away")
        try:
            second = service.run(repository.folder)
        finally:
            os.rename(f"{source.folder}.away", source.folder)
        self.assertEqual(second.status, 3, second.log)
        self.assertEqual(text_of(log).splitlines()[2:], ["setup build"])
        tests, failed = failures(os.path.join(second.artifacts, "simbench_results", "my_rig.xml"))
        self.assertEqual(tests, 8)
        self.assertEqual({name for name, _, _ in failed}, {"my_rig.my_host_sync"})
        self.assertIn(f"## my_rig: gate FAILED: {len(failed)} of 8 checks", second.summary)


class GitHubTest(Services, unittest.TestCase):
    kind, snippet = GitHub, "github-actions-cpp.yml"
    placeholder = "https://github.com/OWNER/REPOSITORY.git"


class GitLabTest(Services, unittest.TestCase):
    kind, snippet = GitLab, "gitlab-ci-cpp.yml"
    placeholder = "https://gitlab.com/OWNER/REPOSITORY.git"


class LibrariesTest(unittest.TestCase):
    def refused(self, message, **settings):
        repository = Repository(machine, f"libraries.{len(os.listdir(machine.folder))}")
        repository.write("simbench_libraries.sh", text_of(SNIPPETS, "simbench_libraries.sh"))
        status, out, err = repository.shell("sh simbench_libraries.sh", check=False, **{
            "SIMBENCH_SOURCE": source.folder, "SIMBENCH_VERSION": VERSION, **settings})
        self.assertEqual((status, out), (2, ""), err)
        self.assertIn(message, err)

    def test_what_is_missing_is_named(self):
        self.refused("SIMBENCH_SOURCE is not set", SIMBENCH_SOURCE="")
        self.refused("SIMBENCH_VERSION is not set", SIMBENCH_VERSION="")
        self.refused("Git cannot get the tag v99.9.9 of simbench", SIMBENCH_VERSION="99.9.9")
        self.refused("Git cannot get the tag", SIMBENCH_SOURCE="/nowhere")


if __name__ == "__main__":
    unittest.main()
