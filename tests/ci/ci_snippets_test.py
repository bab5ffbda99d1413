"""reports/ci/: each snippet is run from an empty repository, by stand-ins of the services, against a
release made of this build."""

import glob
import gzip
import os
import shutil
import subprocess
import sys
import unittest

from machine import SNIPPETS, Machine, Repository, stand_in, text_of
from releases import ARCHIVE, SOURCE, VERSION, WHEEL, Server, make_release, write_sums
from services import GitHub, GitLab, failures

SCENARIO = "18cam_6host_45fps_lan"
MINE = "yoon2021_both+mean_of_last+yoon2021"
GOOD = "return sample.sensor_ns + sum(self.offsets) / len(self.offsets)"
WORSE = "return sample.sensor_ns + self.offsets[-1] + (sample.sensor_ns % 7) * 1_000_000"


def setUpModule():
    global machine, release
    machine = Machine(sys.executable)
    # A job's python3 has pip, which this machine's need not have.
    subprocess.run([sys.executable, "-m", "venv", machine.path("venv")], check=True)
    stand_in(machine.programs, "python3", f'exec "{machine.path("venv", "bin", "python")}" "$@"')
    release = machine.path("release")
    make_release(release)


def tearDownModule():
    machine.close()


class Services:
    """What holds with every service; its test has `service`, `snippet` and `releases`."""

    def setUp(self):
        self.server = Server(release)
        self.addCleanup(self.server.close)
        folder = machine.path(type(self).__name__ + "." + self._testMethodName)
        self.service = self.kind(folder, machine.environment)
        self.repository = Repository(machine, f"{folder}.repository")
        shutil.copy(os.path.join(SOURCE, "examples", "my_algorithm.py"), self.repository.folder)
        for name, path in ((self.snippet, self.kind.file), ("simbench_gate.sh", "ci/simbench_gate.sh")):
            self.repository.write(path, text_of(SNIPPETS, name))
        self.set(self.placeholder, self.server.url)
        self.repository.commit("Nothing but the snippet")

    def set(self, old, new):
        self.repository.edit(self.kind.file, old, new)

    def result(self, run, name):
        return os.path.join(run.artifacts, "simbench_results", name)

    def accept(self, run, scenario=SCENARIO):
        """Commits the baseline as the summary says, out of what was uploaded."""
        shutil.copytree(run.artifacts, self.repository.folder, dirs_exist_ok=True)
        (command,) = [line for line in run.summary.splitlines()
                      if line.startswith("    mkdir") and f"{scenario}.json" in line]
        self.repository.shell(command)
        shutil.rmtree(self.repository.path("simbench_results"))
        self.repository.commit("The first baseline")

    def accepted(self):
        run = self.service.run(self.repository.folder)
        self.assertEqual(run.status, 4, run.log)
        self.accept(run)
        return run

    def test_from_nothing_to_a_passed_gate(self):
        first = self.accepted()
        self.assertIn(f"## {SCENARIO}: no baseline yet", first.summary)
        self.assertIn(f"simbench_gate: {SCENARIO} has no baseline yet", first.log)
        self.assertIn(f"{MINE} is the best of the 2 pipelines", first.log)
        asked = [path for path, _ in self.server.requests]
        self.assertEqual(asked, ["/SHA256SUMS", f"/{WHEEL}"])
        # From then on nothing is fetched: the release may be anywhere, even nowhere.
        self.server.close()
        second = self.service.run(self.repository.folder)
        self.assertEqual(second.status, 0, second.log)
        self.assertIn("gate passed: 8 checks, 8 of them the same", second.log)
        self.assertTrue(second.summary.startswith(f"## {SCENARIO}: gate passed: 8 checks"))
        self.assertEqual(failures(self.result(second, f"{SCENARIO}.xml")), (8, []))
        self.assertEqual(len(self.server.requests), 2)
        # What was uploaded is an archive that the commands take.
        self.assertEqual(sorted(os.listdir(self.result(second, SCENARIO))),
                         ["frames.csv", "hosts.csv", "manifest.json", "results.json"])

    def test_an_algorithm_made_worse_fails(self):
        self.accepted()
        self.repository.edit("my_algorithm.py", GOOD, WORSE)
        self.repository.commit("An idea")
        run = self.service.run(self.repository.folder)
        self.assertEqual(run.status, 3, run.log)
        tests, failed = failures(self.result(run, f"{SCENARIO}.xml"))
        self.assertEqual(tests, 8)
        self.assertIn((f"{SCENARIO}.{MINE}", "AMD"), [entry[:2] for entry in failed])
        self.assertEqual({name for name, _, _ in failed}, {f"{SCENARIO}.{MINE}"})
        self.assertTrue(run.summary.startswith(f"## {SCENARIO}: gate FAILED: {len(failed)} of 8"))
        for _, _, message in failed:
            self.assertIn(f"- FAILED: {message}\n", run.summary)
        self.assertIn(f"simbench_gate: {SCENARIO} became worse", run.log)
        self.accept(run)  # as the summary says, if that is meant
        self.assertEqual(self.service.run(self.repository.folder).status, 0)

    def test_an_algorithm_that_raises_says_where(self):
        self.repository.edit("my_algorithm.py", GOOD, "raise RuntimeError('no idea')")
        self.repository.commit("A mistake")
        run = self.service.run(self.repository.folder)
        self.assertEqual(run.status, 2, run.log)
        self.assertIn(f"## {SCENARIO}: `simbench run` ended with status 2", run.summary)
        for text in (run.log, run.summary):
            self.assertRegex(text, r"my_algorithm.py.*no idea")

    def test_every_scenario_has_its_gate(self):
        self.repository.write("my_rig.json", """{"schema_version": 1, "name": "my_rig",
            "summary": "Ours.", "base": "6cam_2host_30fps", "timeline": {"frames": 60}}""")
        self.set(f"SIMBENCH_SCENARIOS: {SCENARIO}", f"SIMBENCH_SCENARIOS: {SCENARIO} my_rig.json")
        self.set(f"yoon2021_both,{MINE}", MINE)
        self.repository.commit("Two scenarios")
        first = self.service.run(self.repository.folder)
        self.assertEqual(first.status, 4, first.log)
        self.accept(first)
        second = self.service.run(self.repository.folder)
        self.assertEqual(second.status, 4, second.log)  # the other one still has none
        self.assertIn(f"## {SCENARIO}: gate passed", second.summary)
        self.assertIn("## my_rig: no baseline yet", second.summary)
        self.accept(second, "my_rig")
        self.repository.edit("my_algorithm.py", GOOD, WORSE)
        self.repository.commit("An idea")
        third = self.service.run(self.repository.folder)
        self.assertEqual(third.status, 3, third.log)
        for name in (SCENARIO, "my_rig"):
            self.assertIn(f"## {name}: gate FAILED", third.summary)
            self.assertGreater(len(failures(self.result(third, f"{name}.xml"))[1]), 0)

    def test_a_version_that_does_not_exist_is_told_from_those_that_do(self):
        self.set(f"SIMBENCH_VERSION: {VERSION}", "SIMBENCH_VERSION: 99.9.9")
        self.repository.commit("A version of nobody")
        run = self.service.run(self.repository.folder)
        self.assertEqual(run.status, 2, run.log)
        for text in (run.log, run.summary):
            self.assertRegex(text, rf"no simbench 99.9.9 for \w+ \(python\) in .*; there are: .*{WHEEL}")
        self.assertEqual(os.listdir(self.service.caches), [])


class GitHubTest(Services, unittest.TestCase):
    kind, snippet = GitHub, "github-actions.yml"
    placeholder = f"https://github.com/OWNER/REPOSITORY/releases/download/v{VERSION}"


class GitLabTest(Services, unittest.TestCase):
    kind, snippet = GitLab, "gitlab-ci.yml"
    placeholder = f"https://gitlab.com/api/v4/projects/NUMBER/packages/generic/simbench/{VERSION}"

    def test_the_store_learns_who_asks(self):
        self.service.run(self.repository.folder)
        self.assertEqual([headers.get("JOB-TOKEN") for _, headers in self.server.requests],
                         ["secret-of-the-job"] * 2)


class ShellTest(unittest.TestCase):
    """simbench_gate.sh by hand, with built-in algorithms and a folder of releases."""

    def setUp(self):
        self.repository = Repository(machine, f"shell.{self._testMethodName}")
        self.repository.write("simbench_gate.sh", text_of(SNIPPETS, "simbench_gate.sh"))
        self.release = machine.path(f"release.{self._testMethodName}")
        shutil.copytree(release, self.release)
        self.settings = {"SIMBENCH_RELEASES": self.release, "SIMBENCH_VERSION": VERSION,
                         "SIMBENCH_SCENARIOS": "3cam_1host_30fps"}

    def gate(self, arguments="run --no-levers --seeds 2 --set /timeline/frames=30", **settings):
        return self.repository.shell(f"sh simbench_gate.sh {arguments}", check=False,
                                     **{**self.settings, **settings})

    def refused(self, message, *arguments, **settings):
        status, _, err = self.gate(*arguments, **settings)
        self.assertEqual(status, 2, err)
        self.assertRegex(err, message)
        said = [line for line in err.splitlines() if " getting " not in line]
        self.assertEqual(len(said), 1, err)
        summary = text_of(self.repository.path("simbench_results/summary.md"))
        self.assertRegex(summary, message)

    def cached(self):
        return sorted(os.path.basename(path)
                      for path in glob.glob(self.repository.path(".simbench/*")))

    def test_a_folder_of_releases_is_enough(self):
        status, _, err = self.gate()
        self.assertEqual(status, 4, err)
        self.assertIn(f"getting {ARCHIVE} from {self.release}", err)
        (entry,) = self.cached()
        self.assertTrue(entry.startswith(f"simbench-{VERSION}-") and entry.endswith("-program"))
        self.repository.shell(err.split("To make this run the baseline: ")[1])
        shutil.rmtree(self.release)
        status, out, err = self.gate()
        self.assertEqual(status, 0, out + err)
        self.assertNotIn("getting", err)

    def test_clocks_are_gated_too(self):
        clocks = "clocks --duration-s 600 --seeds 1 --pipelines chrony"
        status, _, err = self.gate(clocks, SIMBENCH_SCENARIOS="6host_star")
        self.assertEqual(status, 4, err)
        self.repository.shell(err.split("To make this run the baseline: ")[1])
        status, out, err = self.gate(clocks, SIMBENCH_SCENARIOS="6host_star")
        self.assertEqual(status, 0, out + err)

    def test_the_page_says_what_works(self):
        """The commands of docs/ci.md, as they stand there."""
        page = text_of(SOURCE, "docs", "ci.md")
        blocks = [[line.strip() for line in block.splitlines()] for block in page.split("\n\n")
                  if block.startswith("    ")]
        (python,) = [lines for lines in blocks if "export SIMBENCH_RELEASES" in lines[0]]
        (failed,) = [lines for lines in blocks if lines[0].startswith("gate FAILED")]
        (program,) = [lines for lines in blocks if lines[0].startswith("cc ")]
        for name in ("my_algorithm.py", "cristian.c", "cristian_c.json"):
            self.repository.write(name, text_of(SOURCE, "examples", name))
        self.repository.write("ci/simbench_gate.sh", text_of(SNIPPETS, "simbench_gate.sh"))
        settings = python[0].replace("=/srv/simbench", f"={self.release}")
        status, out, err = self.repository.shell("\n".join([settings, python[1]]), check=False)
        self.assertEqual(status, 4, out + err)
        status, out, err = self.repository.shell("\n".join([settings, *python[2:], python[1]]),
                                                 check=False)
        self.assertEqual(status, 0, out + err)
        self.assertIn("simbench_baselines/18cam_6host_45fps_lan.json",
                      self.repository.shell("git diff --cached --name-only")[1])
        self.repository.edit("my_algorithm.py", "window=30", "window=1")
        status, out, err = self.repository.shell("\n".join([settings, python[1]]), check=False)
        self.assertEqual(status, 3, out + err)
        for stated in " ".join(failed).split(" ... "):
            self.assertIn(stated, " ".join(out.split()))
        status, out, err = self.repository.shell("\n".join(program), check=False, **{
            **self.settings, "SIMBENCH_SCENARIOS": "6host_star"})
        self.assertEqual(status, 4, out + err)
        self.assertIn("mine", out)

    def test_edited_margins_are_kept_in_a_new_baseline(self):
        _, _, err = self.gate()
        accept = err.split("To make this run the baseline: ")[1]
        self.repository.shell(accept)
        self.repository.edit("simbench_baselines/3cam_1host_30fps.json", '"relative":0.02',
                             '"relative":0.5')
        status, _, err = self.gate("run --no-levers --seeds 3 --set /timeline/frames=30")
        self.assertEqual(status, 2, err)  # of other seeds than the baseline
        self.assertIn("ended with status 2",
                      text_of(self.repository.path("simbench_results/summary.md")))
        self.repository.shell(accept)
        self.assertIn('"relative":0.5',
                      text_of(self.repository.path("simbench_baselines/3cam_1host_30fps.json")))
        self.assertEqual(self.gate("run --no-levers --seeds 3 --set /timeline/frames=30")[0], 0)

    def test_a_file_that_is_not_the_released_one_is_not_used(self):
        with open(os.path.join(self.release, ARCHIVE), "ab") as file:
            file.write(b"one byte")
        self.refused(f"{ARCHIVE} from .* is damaged or not the one that was released: its SHA-256 "
                     "is [0-9a-f]{64}, that of SHA256SUMS [0-9a-f]{64}")
        self.assertEqual(self.cached(), [])

    def test_committed_checksums_tell_a_forged_release(self):
        shutil.copy(os.path.join(self.release, "SHA256SUMS"), self.repository.folder)
        with gzip.open(os.path.join(self.release, ARCHIVE)) as file:
            content = file.read()
        with gzip.open(os.path.join(self.release, ARCHIVE), "wb", compresslevel=2) as file:
            file.write(content)
        write_sums(self.release)
        self.refused("not the one that was released", SIMBENCH_SUMS="SHA256SUMS")
        self.assertEqual(self.cached(), [])
        self.assertEqual(self.gate()[0], 4)  # its own checksums agree with it

    def test_a_release_that_cannot_be_unpacked_or_run_leaves_nothing(self):
        whole = os.path.join(self.release, ARCHIVE)
        with open(whole, "r+b") as file:
            file.truncate(100_000)
        write_sums(self.release)
        status, _, err = self.gate()
        self.assertEqual(status, 2)
        self.assertIn(f"{ARCHIVE} cannot be unpacked", err)
        self.assertEqual(self.cached(), [])
        folder = machine.path("unsuitable", ARCHIVE[: -len(".tar.gz")])
        os.makedirs(os.path.join(folder, "bin"))
        stand_in(os.path.join(folder, "bin"), "simbench", "echo 'GLIBC_9.9 not found' >&2; exit 1")
        subprocess.run(["tar", "-czf", whole, "-C", os.path.dirname(folder),
                        os.path.basename(folder)], check=True)
        write_sums(self.release)
        self.refused(f"simbench {VERSION} does not run on this machine: GLIBC_9.9 not found")
        self.assertEqual(self.cached(), [])

    def test_without_a_network_or_a_release(self):
        self.refused("cannot get SHA256SUMS of simbench .* from http://127.0.0.1:1: curl: .*",
                     SIMBENCH_RELEASES="http://127.0.0.1:1")
        self.refused("cannot get SHA256SUMS .*/nowhere/SHA256SUMS': No such file",
                     SIMBENCH_RELEASES="/nowhere")
        server = Server(self.release)
        self.addCleanup(server.close)
        self.refused("cannot get SHA256SUMS .*: 404", SIMBENCH_RELEASES=f"{server.url}/v9")
        self.assertEqual(self.cached(), [])
        os.remove(os.path.join(self.release, ARCHIVE))
        self.refused(f"cannot get {ARCHIVE} .*: No such file")
        self.assertFalse(os.path.exists(self.repository.path(".simbench")))

    def test_a_machine_without_a_release(self):
        programs = machine.path("riscv")
        os.makedirs(programs)
        stand_in(programs, "uname", "echo riscv64")
        path = f"{programs}:{machine.environment['PATH']}"
        self.refused(rf"no simbench {VERSION} for riscv64 \(program\) in .*; there are: .*{ARCHIVE}",
                     PATH=path)

    def test_what_is_missing_is_named(self):
        for name in ("SIMBENCH_RELEASES", "SIMBENCH_VERSION", "SIMBENCH_SCENARIOS"):
            self.refused(f"{name} is not set", **{name: ""})
        self.refused("the first argument is 'sweep'; allowed: run, clocks", "sweep")
        self.refused("the first argument is ''", "")

    def test_an_option_that_simbench_does_not_know(self):
        status, out, _ = self.gate("run --no-such-option")
        self.assertEqual(status, 2)
        self.assertIn("--no-such-option", out)

    def test_shellcheck_has_nothing_to_say(self):
        scripts = glob.glob(os.path.join(SNIPPETS, "*.sh"))
        self.assertEqual(len(scripts), 2)
        subprocess.run(["shellcheck", *scripts], check=True)


if __name__ == "__main__":
    unittest.main()
