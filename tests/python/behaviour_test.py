"""What the package does besides numbers: errors, progress, threads, Ctrl-C, missing packages."""

import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import command
import simbench

LONG = "simbench.run('leaderboard_lan', seeds=1000, progress=False)"


class ErrorsTest(unittest.TestCase):
    def check(self, arguments, function):
        said = command.simbench(*arguments, status=2)
        with self.assertRaises(simbench.InputError) as raised:
            function()
        self.assertIn(str(raised.exception), said)

    def test_the_message_is_the_commands(self):
        run = ["run", "--scenario", "3cam_1host_30fps"]
        self.check(["run", "--scenario", "none"], lambda: simbench.run("none"))
        self.check(
            [*run, "--pipelines", "none"], lambda: simbench.run("3cam_1host_30fps", ["none"])
        )
        self.check(
            [*run, "--set", "/trigger/rate_hz=-1"],
            lambda: simbench.run("3cam_1host_30fps", set={"/trigger/rate_hz": -1}),
        )
        self.check(["compare", "/none", "/none"], lambda: simbench.compare("/none", "/none"))

    def test_values_out_of_range_are_refused(self):
        for name, value in (("seeds", 0), ("seeds", 1.5), ("jobs", -1), ("pipelines", "oracle")):
            with self.assertRaisesRegex(simbench.InputError, f"{name}: found .*, allowed: "):
                simbench.run("3cam_1host_30fps", **{name: value})

    def test_kinds_of_errors(self):
        self.assertTrue(issubclass(simbench.InputError, ValueError))
        self.assertTrue(issubclass(simbench.OutputError, OSError))
        result = simbench.run("3cam_1host_30fps", ["oracle"], seeds=1, keep_pulses=False)
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaisesRegex(simbench.OutputError, "keep_pulses"):
                result.save(os.path.join(folder, "never_written"))
            self.assertEqual(os.listdir(folder), [])

    def test_doubts_are_warnings(self):
        with self.assertWarnsRegex(UserWarning, "exposure"):
            result = simbench.run(
                "3cam_1host_30fps", ["oracle"], seeds=1, set={"/cameras/exposure_ms": 36}
            )
        self.assertIn("exposure", result.notes[0])


class ThreadsTest(unittest.TestCase):
    def test_other_threads_go_on(self):
        ticks = 0
        stop = threading.Event()

        def tick():
            nonlocal ticks
            while not stop.wait(0.001):
                ticks += 1

        thread = threading.Thread(target=tick)
        thread.start()
        simbench.run("18cam_6host_45fps", seeds=32)
        stop.set()
        thread.join()
        self.assertGreater(ticks, 50)

    def test_runs_beside_each_other_are_the_same(self):
        data = [None] * 4

        def run(place):
            data[place] = simbench.run("3cam_1host_30fps", seeds=4).seeds

        threads = [threading.Thread(target=run, args=(place,)) for place in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for other in data[1:]:
            self.assertTrue(other.equals(data[0]))

    def test_commands_beside_each_other_are_the_same(self):
        found = [None] * 4

        def work(place):
            if place % 2:
                found[place] = simbench.run("3cam_1host_30fps", seeds=4).seeds.to_csv()
            else:
                found[place] = simbench.sweep("3cam_1host_30fps", "/cameras/exposure_ms=2,4",
                                              ["oracle"], seeds=4).table.to_csv()

        threads = [threading.Thread(target=work, args=(place,)) for place in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertIsNotNone(found[0])
        self.assertEqual(found[2], found[0])
        self.assertEqual(found[3], found[1])

    def test_nothing_of_a_command_is_on_standard_output(self):
        code = (
            "import simbench\n"
            "simbench.sweep('3cam_1host_30fps', '/cameras/exposure_ms=2,4', ['oracle'], seeds=2)\n"
            "simbench.trace('3cam_1host_30fps', to_ms=50)\n"
        )
        done = command.python(code)
        self.assertEqual((done.stdout, done.stderr), ("", ""))

    def test_control_c_ends_a_command_and_the_next_one_runs(self):
        code = """
import simbench, time
print("ready", flush=True)
try:
    simbench.sweep("leaderboard_lan", "/cameras/exposure_ms=2,4", seeds=1000, output="kept")
except KeyboardInterrupt:
    print("interrupted")
print(len(simbench.sweep("3cam_1host_30fps", "/cameras/exposure_ms=2,4", ["oracle"], 2).table))
"""
        with tempfile.TemporaryDirectory() as folder:
            process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE,
                                       text=True, cwd=folder)
            self.assertEqual(process.stdout.readline(), "ready\n")
            log = os.path.join(folder, "kept", "runs.log")
            while not (os.path.exists(log) and os.path.getsize(log) > 0):
                time.sleep(0.05)
            process.send_signal(signal.SIGINT)
            output, _ = process.communicate(timeout=120)
            self.assertEqual(output, "interrupted\n4\n")
            self.assertEqual(process.returncode, 0)
            self.assertGreater(os.path.getsize(log), 0)

    def test_control_c_ends_a_run(self):
        code = f"""
import simbench, time
print("ready", flush=True)
start = time.monotonic()
try:
    {LONG}
except KeyboardInterrupt:
    print("interrupted")
print(len(simbench.run("3cam_1host_30fps", ["oracle"], seeds=2).table))
"""
        process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
        self.assertEqual(process.stdout.readline(), "ready\n")
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=60)
        self.assertEqual(output, "interrupted\n1\n")
        self.assertEqual(process.returncode, 0)


class ProgressTest(unittest.TestCase):
    def test_progress_counts_to_the_end(self):
        seen = []
        request = simbench.results.request_of("run", "18cam_6host_45fps", None, 16, 1, None, 0)
        simbench._simbench.simulate(request, lambda done, total: seen.append((done, total)))
        self.assertEqual(seen[-1][0], seen[-1][1])
        self.assertEqual(seen, sorted(seen))

    def test_an_exception_of_the_report_ends_the_run(self):
        def refuse(done, total):
            raise RuntimeError("enough")

        request = simbench.results.request_of("run", "18cam_6host_45fps", None, 500, 1, None, 0)
        with self.assertRaisesRegex(RuntimeError, "enough"):
            simbench._simbench.simulate(request, refuse)

    def test_nobody_looks_nothing_is_shown(self):
        code = "import simbench; simbench.run('18cam_6host_45fps', seeds=400)"
        self.assertEqual(command.python(code).stderr, "")

    def test_a_command_reports_its_progress_and_can_be_ended(self):
        seen = []
        line = ["simbench", "advise", "--require=amd<50ms", "--cameras=3", "--seeds=8"]
        simbench._simbench.run_command(line, ["json"], None, lambda *done: seen.append(done))
        self.assertEqual(seen[-1][0], seen[-1][1])
        self.assertEqual(seen, sorted(seen))

        def refuse(done, total):
            raise RuntimeError("enough")

        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaisesRegex(RuntimeError, "enough"):
                simbench._simbench.run_command(
                    ["simbench", "sweep", "--scenario=leaderboard_lan", "--seeds=500",
                     "--sweep=/cameras/exposure_ms=2,4", f"--output={folder}/s"],
                    [], None, refuse,
                )  # fmt: skip

    def test_a_notebook_without_widgets_has_a_bar_and_no_warning(self):
        code = (
            "import sys, types\n"
            "class ZMQInteractiveShell: config = {'IPKernelApp': {}}\n"
            "shell = ZMQInteractiveShell()\n"
            "sys.modules['IPython'] = types.ModuleType('IPython')\n"
            "sys.modules['IPython'].get_ipython = lambda: shell\n"
            "sys.modules['ipywidgets'] = None\n"
            "sys.modules['IPython.html'] = None\n"
            "import simbench, simbench.progress\n"
            "simbench.progress._PATIENCE_S = 0\n"
            "simbench.run('18cam_6host_45fps', seeds=64)"
        )
        for flag in ("always", "error"):
            done = command.python(code, PYTHONWARNINGS=flag)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertNotIn("Warning", done.stderr)
            self.assertRegex(done.stderr, r"\d+/\d+")

    def test_work_of_several_parts_is_drawn_without_a_warning(self):
        code = (
            "import simbench, simbench.progress\n"
            "simbench.progress._PATIENCE_S = 0\n"
            "bar = simbench.progress.Progress(True, 'run').__enter__()\n"
            "for done, total in ((1, 9), (8, 9), (1, 4), (3, 4), (2, 2)): bar.callback(done, total)\n"
            "bar.__exit__(None, None, None)\n"
        )
        done = command.python(code, PYTHONWARNINGS="error")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, r"\d+/4")

    def test_a_bar_where_wanted(self):
        code = (
            "import simbench, simbench.progress\n"
            "simbench.progress._PATIENCE_S = 0\n"
            "simbench.run('18cam_6host_45fps', seeds=300, progress=True)"
        )
        self.assertRegex(command.python(code).stderr, r"\d+/\d+")


class CommandTest(unittest.TestCase):
    """`python3 -m simbench`, which pip installs as `simbench`, in what depends on where a program is."""

    def run_module(self, *arguments):
        return subprocess.run([sys.executable, "-m", "simbench", *arguments], capture_output=True,
                              text=True, stdin=subprocess.DEVNULL, cwd=command.SOURCE)

    def test_real_programs_find_their_library(self):
        done = self.run_module("clocks", "--scenario", "6host_star", "--pipelines", "oracle",
                               "--program", "mine=examples/cristian.json", "--seeds", "1")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, "(?m)^mine ")

    def test_nodes_are_started_as_the_interpreter(self):
        done = self.run_module("validate-model", "--scenario", "6node_relay", "--repeats", "1",
                               "--pipelines", "yoon2021_neither")
        self.assertRegex(done.stdout, r"(?m)^yoon2021_neither +amd_ms +1/", done.stderr)

    def test_a_closed_pipe_ends_it(self):
        reader, writer = os.pipe()
        os.close(reader)
        done = subprocess.run([sys.executable, "-m", "simbench", "list"], stdout=writer,
                              stderr=subprocess.PIPE, text=True)
        os.close(writer)
        self.assertEqual((done.returncode, done.stderr), (-signal.SIGPIPE, ""))


class MissingPackagesTest(unittest.TestCase):
    def run_without(self, packages, code):
        block = f"import sys\nfor name in {packages!r}: sys.modules[name] = None\n"
        done = command.python(block + "import simbench\n" + code)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_lists_without_pandas(self):
        out = self.run_without(
            ["pandas"],
            "r = simbench.run('3cam_1host_30fps', ['oracle'], seeds=2)\n"
            "print(type(r.table).__name__, r.table[0]['pipeline'], len(r.seeds) > 2)\n"
            "print(len(r.frames('oracle')) > 0)",
        )
        self.assertEqual(out, "list oracle True\nTrue\n")

    def test_a_sweep_without_pandas_and_xarray(self):
        out = self.run_without(
            ["pandas", "xarray", "matplotlib"],
            "s = simbench.sweep('3cam_1host_30fps', '/cameras/exposure_ms=2,4', ['oracle'], 2)\n"
            "print(type(s.table).__name__, len(s.table), s.table[0]['/cameras/exposure_ms'])\n"
            "for wanted in (s.to_xarray, s.plot):\n"
            "    try: wanted()\n"
            "    except simbench.MissingPackage as error: print(error)",
        )
        self.assertRegex(out, r"^list 4 2.0\nto_xarray\(\) needs xarray, .*\nplot\(\) needs matpl")

    def test_frames_and_plot_say_what_is_missing(self):
        out = self.run_without(
            ["numpy", "pandas", "matplotlib", "tqdm"],
            "r = simbench.run('3cam_1host_30fps', ['oracle'], seeds=2)\n"
            "for wanted in (lambda: r.frames('oracle'), r.plot):\n"
            "    try: wanted()\n"
            "    except simbench.MissingPackage as error: print(error)",
        )
        self.assertRegex(out, r"^frames\(\) needs NumPy, .*\nplot\(\) needs matplotlib, .*\n$")


if __name__ == "__main__":
    unittest.main()
