"""Functions that are commands give what the commands give."""

import csv
import io
import json
import math
import os
import random
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import warnings

import command
import numpy
import simbench

SCENARIO = "3cam_1host_30fps"
JITTER = "/usb/delivery_jitter_transfers"
EXPOSURE = "/cameras/exposure_ms"


def quietly(function, *arguments, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return function(*arguments, **options)


def without_speed(data):
    """Without the members that tell how fast the runs were, at any depth."""
    if isinstance(data, dict):
        return {name: without_speed(value) for name, value in data.items()
                if name != "performance"}
    return [without_speed(each) for each in data] if isinstance(data, list) else data


class CommandsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls._folder.cleanup)
        cls.now = cls.path("now")
        command.simbench("run", "--scenario", SCENARIO, "--seeds", "4", "--pipelines",
                         "oracle,raw_arrival", "--output", cls.now)
        cls.recording = cls.path("recording")
        command.simbench("record", "--scenario", SCENARIO, "--pipelines", "oracle", "--output",
                         cls.recording)

    @classmethod
    def path(cls, name):
        return os.path.join(cls._folder.name, name)

    def content(self, path):
        with open(path, "rb") as file:
            return file.read()

    def check_refused(self, function, text):
        with self.assertRaisesRegex(simbench.InputError, text):
            function()


class SweepTest(CommandsTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.folder = cls.path("sweep")
        cls.text = command.simbench(
            "sweep", "--scenario", SCENARIO, "--sweep", f"{JITTER}=0,0.5,1", "--sweep",
            f"{EXPOSURE}=2,4", "--pipelines", "oracle,raw_arrival", "--seeds", "3", "--output",
            cls.folder,
        )  # fmt: skip
        cls.sweep = simbench.sweep(
            SCENARIO, {JITTER: [0, 0.5, 1], EXPOSURE: "2,4"}, ["oracle", "raw_arrival"], seeds=3
        )

    def test_the_results_are_the_commands(self):
        with open(os.path.join(self.folder, "sweep.csv"), encoding="utf-8") as file:
            lines = list(csv.DictReader(file))
        table = self.sweep.table
        self.assertEqual(list(table.columns), list(lines[0]))
        self.assertEqual(len(table), 3 * 2 * 2 * 3)
        for row, line in zip(table.to_dict("records"), lines):
            self.assertEqual(row["amd_ms"], float(line["amd_ms"]))
        self.assertEqual(self.sweep.text(), self.text)
        self.assertIn("<table>", self.sweep._repr_html_())
        self.check_refused(lambda: self.sweep.text("x"), "format: found 'x', allowed: table, ")
        self.assertTrue(" ".join(self.text.split()).startswith(" ".join(self.sweep.answer.split())))
        self.assertEqual(len(self.sweep.hosts), len(table))  # one host

    def test_the_saved_folder_has_the_bytes_of_the_commands(self):
        saved = self.path("saved")
        self.sweep.save(saved)
        names = set(os.listdir(self.folder)) - {"lock"}
        self.assertEqual(set(os.listdir(saved)), names)
        for name in names - {"sweep.svg"}:  # gnuplot dates it
            self.assertEqual(self.content(os.path.join(saved, name)),
                             self.content(os.path.join(self.folder, name)), name)
        again = command.simbench(
            "sweep", "--scenario", SCENARIO, "--sweep", f"{JITTER}=0,0.5,1", "--sweep",
            f"{EXPOSURE}=2,4", "--pipelines", "oracle,raw_arrival", "--seeds", "3", "--output",
            saved,
        )  # fmt: skip
        self.assertEqual(again, self.text)
        with self.assertRaises(simbench.OutputError):
            self.sweep.save(saved)

    def test_the_dataset_has_the_values_of_the_table_at_their_places(self):
        try:
            import xarray
        except ImportError:
            self.skipTest("xarray is not installed")
        dataset = self.sweep.dataset
        self.assertIsInstance(dataset, xarray.Dataset)
        self.assertEqual(dataset["amd_ms"].dims, (JITTER, EXPOSURE, "pipeline", "seed"))
        self.assertEqual(dataset["amd_ms"].shape, (3, 2, 2, 3))
        self.assertEqual(dataset["amd_ms"].attrs["units"], "ms")
        self.assertEqual(set(dataset.data_vars), set(self.sweep.metrics))
        checked = 0
        for row in self.sweep.table.to_dict("records"):
            at = {name: row[name] for name in (JITTER, EXPOSURE, "pipeline", "seed")}
            found = float(dataset["absolute_error_ms"].sel(at))
            self.assertEqual(found, row["absolute_error_ms"])
            checked += 1
        self.assertEqual(checked, 36)

    def test_parameters_that_vary_together_share_an_axis(self):
        sweep = simbench.sweep(SCENARIO, f"{JITTER}=0,1+{EXPOSURE}=2,4", ["raw_arrival"], seeds=2)
        self.assertEqual(sweep.axes, [{JITTER: [0, 1], EXPOSURE: [2, 4]}])
        self.assertEqual(len(sweep.table), 4)
        dataset = sweep.dataset
        self.assertEqual(dataset["amd_ms"].shape, (2, 1, 2))
        self.assertEqual(list(dataset[EXPOSURE].values), [2, 4])
        self.assertEqual(dataset[EXPOSURE].dims, (JITTER,))
        self.assertFalse(bool(dataset["amd_ms"].isnull().any()))

    def test_the_clocks_alone(self):
        sweep = simbench.sweep("6host_star", {"/network/latency_exponential_ms": [0.02, 0.06]},
                               ["ntp", "chrony"], seeds=2, clocks=True, duration_s=600)
        self.assertEqual(sweep.data["ranked_by"], "clock_spread_ms")
        self.assertEqual(sweep.dataset["clock_spread_ms"].shape, (2, 2, 2))

    def test_words_are_an_axis_too(self):
        median = "/evaluation/rmdv_median"
        sweep = simbench.sweep("18cam_6host_45fps", {median: ["upper_middle", "mean_of_middle_two"]},
                               ["yoon2021_both"], seeds=2)
        rmdv = sweep.dataset["rmdv_ms"]
        self.assertEqual(rmdv.shape, (2, 1, 2))
        self.assertLess(float(rmdv.sel({median: "mean_of_middle_two"}).mean()),
                        float(rmdv.sel({median: "upper_middle"}).mean()))
        axes = sweep.plot()
        self.assertEqual([label.get_text() for label in axes.get_xticklabels()],
                         ["upper_middle", "mean_of_middle_two"])

    def test_plot_draws_the_medians(self):
        axes = self.sweep.plot("absolute_error_ms")
        curves = {line.get_label(): line for line in axes.lines}
        self.assertEqual(len(curves), 4)
        line = curves[f"raw_arrival, {EXPOSURE}=4.0"]
        self.assertEqual(list(line.get_xdata()), [0, 0.5, 1])
        table = self.sweep.table
        chosen = table[(table["pipeline"] == "raw_arrival") & (table[EXPOSURE] == 4)]
        medians = [chosen[chosen[JITTER] == x]["absolute_error_ms"].median() for x in (0, 0.5, 1)]
        numpy.testing.assert_allclose(line.get_ydata(), medians)
        self.check_refused(lambda: self.sweep.plot("none"), "metric: found 'none', allowed: amd_ms")

    def test_a_study_needs_no_scenario(self):
        self.assertIn("gathering_interval", simbench.listing("studies"))
        self.check_refused(lambda: simbench.sweep(study="none"), "study: found 'none', allowed: ")

    def test_bad_input_is_the_commands(self):
        run = lambda **options: simbench.sweep(SCENARIO, **options)
        self.check_refused(lambda: run(), "found neither --study nor both")
        self.check_refused(lambda: run(sweep={JITTER: []}), f"found no value of {JITTER}, allowed")
        self.check_refused(lambda: run(sweep={JITTER: [0]}, seeds=0), "seeds: found '0', allowed: ")
        self.check_refused(lambda: run(sweep={JITTER: [0]}, jobs=-1), "jobs: found -1, allowed: ")
        self.check_refused(lambda: run(sweep={"/none": [0]}), "/none")
        self.check_refused(lambda: run(sweep={JITTER: [0]}, pipelines=["none"]), "found \"none\"")


class StabilityTest(CommandsTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.file = cls.path("errors.csv")
        noise = random.Random(1)
        with open(cls.file, "w", encoding="utf-8") as file:
            file.write("time_s,error_ns\n")
            file.writelines(f"{i},{noise.gauss(0, 30):.3f}\n" for i in range(600))

    def test_all_numbers_are_the_commands(self):
        found = simbench.stability(self.file, limit=["max_te=1us", "adev@1s=1e-6"], settle=True)
        arguments = ["stability", self.file, "--limit", "max_te=1us,adev@1s=1e-6", "--settle"]
        self.assertEqual(found.data, json.loads(command.simbench(*arguments, "--format", "json")))
        for format in ("table", "markdown", "csv"):
            self.assertEqual(found.text(format), command.simbench(*arguments, "--format", format))
        self.assertIs(found.passed, True)
        self.assertEqual(list(found.verdicts["judgement"]), ["passes", "passes"])
        file = found.data["files"][0]
        self.assertEqual(list(found.adev["value"]), [point["value"] for point in file["adev"]])
        self.assertEqual(found.table["rms_te_ms"][0], file["rms_te_ms"])
        self.assertIn(" ".join(found.answer.split()), " ".join(found.text().split()))
        self.assertIn("<table>", found._repr_html_())

    def test_white_noise_has_the_deviations_of_white_noise(self):
        # ADEV of white time noise of sigma at tau0: sqrt(3) sigma / tau0.
        value = simbench.stability(self.file).adev["value"][0]
        self.assertAlmostEqual(value / (math.sqrt(3) * 30e-9), 1, 1)

    def test_a_broken_limit_is_no_exception(self):
        self.assertIs(simbench.stability(self.file, limit=["max_te=1ns"]).passed, False)
        self.assertIsNone(simbench.stability(self.file).passed)

    def test_options_go_to_the_command(self):
        later = simbench.stability(self.file, from_=100, until=200)
        self.assertEqual(later.table["points"][0], 101)
        self.check_refused(lambda: simbench.stability(self.file, unit="parsec"), "unit: found 'parsec'")
        self.check_refused(lambda: simbench.stability([]), "files: found an empty list, allowed: ")
        self.check_refused(lambda: simbench.stability(self.path("none")), "No such file")
        self.check_refused(lambda: simbench.stability(self.file, limit="a"), "limit: found the text")

    def test_dataset_and_plot(self):
        found = simbench.stability(self.file)
        axes = found.plot("tdev_ms")
        self.assertEqual(axes.get_ylabel(), "TDEV, ms")
        dataset = found.dataset
        self.assertEqual(dataset["mtie_ms"].dims, ("file", "tau_s"))
        first = found.mtie_ms.iloc[0]
        self.assertEqual(float(dataset["mtie_ms"].sel(file=self.file, tau_s=1)), first["value"])
        series = simbench.clock_series(self.file)
        self.assertEqual(list(series["name"]), ["time_s", "error_ns"])


class CertifyTest(CommandsTest):
    WORLD = {"/cameras/count": 6, "/hosts/count": 2, "/timeline/frames": 20,
             "/timeline/warm_up_ms": 200}
    ARGUMENTS = ["certify", "18cam_6host_45fps_lan", "--pipelines", "two_way_hull",
                 "--estimated-stamp-ms", "0.02", *(
        f"--set={name}={value}" for name, value in WORLD.items())]

    def certify(self, **options):
        return quietly(simbench.certify, "18cam_6host_45fps_lan", pipelines=["two_way_hull"],
                       estimated_stamp_ms=0.02, set=self.WORLD, **options)

    def test_all_numbers_are_the_commands(self):
        found = self.certify(within="5ms", host_rate_ppm=20)
        arguments = [*self.ARGUMENTS, "--within", "5ms", "--host-rate-ppm", "20"]
        self.assertEqual(found.data, json.loads(command.simbench(*arguments, "--json")))
        for format in ("table", "markdown", "latex"):
            self.assertEqual(found.text(format), command.simbench(*arguments, "--format", format))
        self.assertEqual(found.assumptions["host_rate_ppm"], 20)
        self.assertEqual(found.table["truth_outside"][0], 0)
        self.assertEqual(found.table["certified_p95_ms"][0],
                         found.data["rows"][0]["certified_ms"]["p95"])
        self.assertGreater(found.weakest["width_ms"][0], 0)
        self.assertEqual(len(found.contradictions), 0)
        self.assertIn("<table>", found._repr_html_())

    def test_what_is_not_met_is_no_exception(self):
        self.assertIs(self.certify(within="1us", require=1).passed, False)
        self.assertIs(self.certify(within="5ms", require=100).passed, True)

    def test_a_wrong_assumption_is_a_row(self):
        found = self.certify(host_rate_ppm=0, camera_rate_ppm=0)
        self.assertEqual(found.table["contradicted"][0], 1)
        self.assertGreater(len(found.contradictions["chain"][0]), 1)

    def test_refuses_what_the_command_refuses(self):
        self.check_refused(lambda: self.certify(within="1"), "within: found '1'")


class FitTest(CommandsTest):
    def test_fit_and_ranking_are_the_commands(self):
        ours, theirs = self.path("ours/model.json"), self.path("theirs/model.json")
        os.makedirs(os.path.dirname(ours))
        os.makedirs(os.path.dirname(theirs))
        fit = quietly(simbench.fit, self.recording, ours, rank=True, seeds=2)
        arguments = ["fit", self.recording, "--format", "json", "--output", theirs]
        expected = json.loads(command.simbench(*arguments))
        for document in (expected, fit.fit):
            self.assertEqual(os.path.basename(document.pop("model")), "model.json")
        self.assertEqual(fit.fit, expected)
        ranking = json.loads(command.simbench(*arguments, "--rank", "--seeds", "2"))
        self.assertEqual(command.without_performance(fit.data),
                         command.without_performance(ranking))
        self.assertEqual(self.content(ours), self.content(theirs))
        self.assertEqual(fit.model["base"], SCENARIO)
        self.assertEqual(len(fit.ranking), len(ranking["rows"]))
        self.assertEqual(set(fit.table["check"]), {"whole", "hold_out"})
        self.assertIs(fit.holds, True)
        saved = self.path("saved.json")
        fit.save(saved)
        self.assertEqual(self.content(saved), self.content(theirs))

    def test_bad_input(self):
        self.check_refused(lambda: simbench.fit([]), "inputs: found an empty list")
        self.check_refused(lambda: simbench.fit(self.recording, pipeline="none"), "allowed oracle")


class AdviseTest(CommandsTest):
    def test_advice_is_the_commands(self):
        advice = simbench.advise("amd<50ms", 3, hosts=1, seeds=8)
        arguments = ["advise", "--require", "amd<50ms", "--cameras", "3", "--hosts", "1", "--seeds",
                     "8"]
        self.assertEqual(advice.data, json.loads(command.simbench(*arguments, "--format", "json")))
        self.assertEqual(advice.text(), command.simbench(*arguments))
        pipelines = advice.data["options"][0]["pipelines"]
        self.assertEqual(list(advice.table["amd_ms"]),
                         [each["medians"]["amd_ms"] for each in pipelines])
        self.assertIsNone(advice.recommended)
        self.assertIsNone(advice.rare)

    def test_bad_input(self):
        self.check_refused(lambda: simbench.advise([], 3), "require: found an empty list")
        self.check_refused(lambda: simbench.advise("amd<", 3), "require: found 'amd<'")
        self.check_refused(lambda: simbench.advise("amd<1ms", 0), "cameras: found 0, allowed: ")


class GateTest(CommandsTest):
    def test_a_gate_is_true_where_it_passes_and_says_why_not(self):
        baseline = simbench.save_baseline(self.now, self.path("baseline.json"))
        gate = simbench.gate(self.now, baseline)
        self.assertTrue(gate)
        self.assertEqual(gate.reasons, [])
        arguments = ["gate", self.now, "--baseline", baseline]
        self.assertEqual(gate.data, json.loads(command.simbench(*arguments, "--format", "json")))
        self.assertEqual(gate.text("junit"), command.simbench(*arguments, "--format", "junit"))
        more = simbench.run(SCENARIO, ["oracle", "raw_arrival", "genlock"], seeds=4)
        junit = self.path("gate.xml")
        failed = simbench.gate(self.now, simbench.save_baseline(more, self.path("m.json")),
                               junit=junit)
        self.assertFalse(failed)
        self.assertFalse(failed.passed)
        self.assertEqual(failed.reasons,
                         ["the pipeline genlock of the baseline is not in the result"])
        self.assertIn(b"<testsuite", self.content(junit))

    def test_a_result_needs_no_archive(self):
        result = simbench.run(SCENARIO, ["oracle", "raw_arrival"], seeds=4)
        baseline = simbench.save_baseline(result, self.path("of_result.json"))
        self.assertTrue(simbench.gate(self.now, baseline))
        self.assertTrue(simbench.gate(result, baseline))

    def test_bad_input_is_an_exception(self):
        missing = self.path("none.json")
        self.check_refused(lambda: simbench.gate(self.now, missing), "baseline .*: no such file")
        baseline = simbench.save_baseline(self.now, self.path("b.json"))
        self.check_refused(lambda: simbench.gate(self.now, baseline, mode="x"), "mode: found 'x'")
        other = simbench.run(SCENARIO, ["oracle"], seeds=2)
        self.check_refused(lambda: simbench.gate(other, baseline), "seeds")


class FilesTest(CommandsTest):
    def test_a_trace_is_the_commands(self):
        trace = simbench.trace(SCENARIO, "raw_arrival", seed=2, to_ms=200)
        arguments = ["trace", "--scenario", SCENARIO, "--pipeline", "raw_arrival", "--seed", "2",
                     "--to-ms", "200"]
        self.assertEqual(trace.text(), command.simbench(*arguments))
        self.assertGreater(len(trace.data["traceEvents"]), 4)
        table = simbench.trace(SCENARIO, "raw_arrival", seed=2, format="csv")
        text = command.simbench(*arguments[:-2], "--format", "csv")
        self.assertEqual(table.text(), text)
        self.assertEqual(len(table.table), len(list(csv.DictReader(io.StringIO(text)))))
        self.check_refused(lambda: trace.table, "found a trace of the format chrome")
        self.check_refused(lambda: simbench.trace(SCENARIO, format="x"), "format: found 'x'")
        trace.save(self.path("trace.json"))
        self.assertEqual(self.content(self.path("trace.json")).decode(), trace.text())

    def test_a_recording_is_the_commands(self):
        folder = simbench.record(SCENARIO, self.path("ours"), pipelines=["oracle"])
        found = simbench.replay(folder)
        self.assertEqual(command.without_performance(found.data),
                         command.without_performance(simbench.replay(self.recording).data))
        self.check_refused(lambda: simbench.record(SCENARIO, folder), "")
        self.check_refused(lambda: simbench.record(SCENARIO, self.path("r"), repeats=0), "repeats")

    def test_a_replayed_recording_can_be_kept(self):
        found = simbench.replay(self.recording)
        found.save(self.path("replayed"))
        theirs = self.path("replayed_by_the_command")
        command.simbench("replay", self.recording, "--output", theirs)
        for name in ("frames.csv", "hosts.csv"):
            self.assertEqual(self.content(os.path.join(self.path("replayed"), name)),
                             self.content(os.path.join(theirs, name)))

    def test_a_figure_is_the_commands(self):
        ours, theirs = self.path("ours.csv"), self.path("theirs.csv")
        self.assertEqual(simbench.figure("distributions", ours, self.now), ours)
        command.simbench("figure", "distributions", self.now, "--output", theirs)
        self.assertEqual(self.content(ours), self.content(theirs))
        simbench.figure("fig5", ours, scenario=SCENARIO, seed=2)
        command.simbench("figure", "fig5", "--scenario", SCENARIO, "--seed", "2", "--output", theirs)
        self.assertEqual(self.content(ours), self.content(theirs))
        self.check_refused(lambda: simbench.figure("fig5", self.path("a.png")), "output: found ")
        self.check_refused(lambda: simbench.figure("none", ours), "none")

    def test_a_report_says_where_it_is(self):
        written = simbench.report(self.now, budget_seeds=0, seeds_in_detail=1)
        self.assertEqual(written, self.now + ".html")
        self.assertIn(b"<!doctype html>", self.content(written))
        result = simbench.load(self.now)
        self.check_refused(lambda: simbench.report(result), "output: found none for a Result")
        both = simbench.report([result, simbench.run(SCENARIO, ["oracle"], seeds=1)],
                               self.path("both.html"), budget_seeds=0, seeds_in_detail=1)
        self.assertEqual(both, self.path("both.html"))
        self.check_refused(lambda: simbench.report([]), "archives: found an empty list")

    def test_matched_frames_have_every_nanosecond(self):
        table = simbench.export(self.recording)
        text = command.simbench("export", self.recording)
        lines = list(csv.DictReader(io.StringIO(text)))
        self.assertEqual(len(table), len(lines))
        self.assertEqual([int(value) for value in table["arrival_ns"]],
                         [int(line["arrival_ns"]) for line in lines])
        output = self.path("sets.csv")
        simbench.export(self.recording, output, complete=True, device_time="raw_arrival")
        expected = command.simbench("export", self.recording, "--complete", "--device-time",
                                    "raw_arrival")
        self.assertEqual(self.content(output).decode(), expected)
        self.check_refused(lambda: simbench.export(self.recording, device_time="none"),
                           "device_time: found 'none'")


class RunsTest(CommandsTest):
    def test_a_budget_is_the_commands(self):
        budget = simbench.budget(SCENARIO, ["raw_arrival"], seeds=2)
        arguments = ["run", "--scenario", SCENARIO, "--pipelines", "raw_arrival", "--seeds", "2",
                     "--budget"]
        self.assertEqual(budget.data, json.loads(command.simbench(*arguments, "--format", "json")))
        self.assertEqual(budget.text(), command.simbench(*arguments))
        table = budget.table
        amd = table[table["metric"] == "amd_ms"].set_index("part")["mean"]
        self.assertAlmostEqual(amd["total"], amd.drop("total").sum(), 9)

    def test_options_of_a_run(self):
        run = simbench.run(SCENARIO, seeds=2, rank_by="rmdv_ms", no_levers=True)
        expected = command.simbench("run", "--scenario", SCENARIO, "--seeds", "2", "--rank-by",
                                    "rmdv_ms", "--no-levers")
        self.assertEqual(run.text(), expected)
        with self.assertRaisesRegex(simbench.InputError, "rig"):
            simbench.run(SCENARIO, backend="hardware")

    def test_compare_has_the_commands_name_of_a_baseline(self):
        result = simbench.load(self.now)
        found = simbench.compare(result, with_baseline="oracle")
        expected = command.simbench("compare", self.now, "--with-baseline", "oracle", "--json")
        self.assertEqual(found.data, json.loads(expected))
        self.assertEqual(simbench.compare(result, baseline="oracle").data, found.data)
        page = self.path("compared.html")
        simbench.compare(self.now, with_baseline="oracle", html=page)
        theirs = self.path("theirs.html")
        command.simbench("compare", self.now, "--with-baseline", "oracle", "--html", theirs)
        mine = self.content(page)
        self.assertIn(b"compared_distributions", mine)
        self.assertEqual(mine, self.content(theirs).replace(f" --html {theirs}".encode(), b""))
        with self.assertRaisesRegex(simbench.InputError, "with_baseline: found two results"):
            simbench.compare(result, result, with_baseline="oracle")

    def test_programs_are_rows(self):
        with tempfile.TemporaryDirectory() as folder:
            rig = os.path.join(folder, "mine.json")
            with open(rig, "w", encoding="utf-8") as out:
                ended = ["python3", "-c", "raise SystemExit(3)"]
                json.dump({"host_sync": {"program": {"master": [ended], "slave": [ended]}}}, out)
            logs = os.path.join(folder, "logs")
            result = quietly(
                simbench.run, "9cam_3host_30fps_azure_kinect", seeds=1, pipelines=["oracle"],
                program=f"mine={rig}", program_log=logs, set={"/timeline/frames": 30},
            )  # fmt: skip
            self.assertEqual(list(result.table["pipeline"]), ["oracle", "mine"])
            self.assertIn("exited with status 3", result.table["failed"][1])
            self.assertEqual(os.listdir(logs), ["mine"])
            clocks = quietly(simbench.clocks, "9cam_3host_30fps_azure_kinect", ["mine"], seeds=1,
                             program=[f"mine={rig}"])
            self.assertEqual(list(clocks.table["standing"]), ["failed"])
        self.check_refused(lambda: simbench.run(SCENARIO, seeds=1, program="none"),
                           "program none: found no file")

    def test_programs_run_beside_algorithms_in_python(self):
        rig = self.path("rig.json")
        ended = ["python3", "-c", "raise SystemExit(3)"]
        with open(rig, "w", encoding="utf-8") as out:
            json.dump({"host_sync": {"program": {"master": [ended], "slave": [ended]}}}, out)
        done = subprocess.run(
            [sys.executable, "-m", "simbench", "run", "--scenario", "9cam_3host_30fps_azure_kinect",
             "--seeds", "1", "--pipelines", "oracle", "--program", f"mine={rig}", "--format",
             "json"],
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        self.assertIn("exited with status 3", done.stdout, done.stderr)

    def test_algorithms_of_a_file(self):
        file = os.path.join(command.SOURCE, "examples", "my_algorithm.py")
        code = f"import simbench; print(simbench.listing('algorithms', python={file!r}))"
        done = command.python(code)  # what is registered stays in its process
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("'cristian'", done.stdout)
        self.assertNotIn("cristian", simbench.listing("algorithms"))
        self.check_refused(lambda: simbench.run(SCENARIO, python=self.path("no.py")), "no such file")

    def test_a_reading_of_columns(self):
        log = self.path("log.csv")
        with open(log, "w", encoding="utf-8") as file:
            file.write("t_camera,t_host,id\n")
            for frame in range(600):
                for camera in "ab":
                    file.write(f"{33_333 * frame},{0.033333 * frame + 0.02:.6f},{camera}\n")
        columns = "sensor=t_camera:us,arrival=t_host:s,camera=id"
        for function, name in ((simbench.inspect, "inspect"), (simbench.diagnose, "diagnose"),
                               (simbench.replay, "replay")):
            found = quietly(function, log, columns=columns)
            expected = json.loads(command.simbench(name, log, "--columns", columns, "--format",
                                                   "json"))
            self.assertEqual(command.without_performance(found.data),
                             command.without_performance(expected), name)
        times = quietly(simbench.inspect, log, columns=columns, device_times=["raw_arrival"])
        expected = command.simbench("inspect", log, "--columns", columns, "--device-times",
                                    "raw_arrival", "--format", "json")
        self.assertEqual(times.data, json.loads(expected))
        page = self.path("rig.html")
        quietly(simbench.diagnose, log, columns=columns, html=page)
        self.assertIn(b"<!doctype html>", self.content(page))
        self.check_refused(lambda: simbench.replay(self.recording, genlock=True), "genlock")

    def test_nothing_is_no_recording(self):
        for function in (simbench.diagnose, simbench.inspect, simbench.replay, simbench.export):
            with self.subTest(function.__name__):
                self.check_refused(lambda: function([]), ": found an empty list, allowed: one path")

    def test_studies_are_the_commands(self):
        reality = simbench.reality([simbench.reality(seeds=1).data["recordings"][0]["name"]], seeds=1)
        name = reality.data["recordings"][0]["name"]
        expected = command.simbench("reality", name, "--seeds", "1", "--format", "json")
        self.assertEqual(reality.data, json.loads(expected))
        self.assertEqual(len(reality.table), len(reality.data["recordings"][0]["rows"]))
        paper = simbench.paper(2, no_table_4=True)
        expected = command.simbench("paper", "--seeds", "2", "--no-table-4", "--format", "json")
        self.assertEqual(without_speed(paper.data), without_speed(json.loads(expected)))

    def test_names_and_parameters(self):
        for what in ("scenarios", "algorithms", "cameras", "parts", "studies", "figures"):
            expected = command.simbench("list", what, "--format", "names").split()
            self.assertEqual(simbench.listing(what), expected)
        below = simbench.describe(SCENARIO, "/trigger", set={"/trigger/rate_hz": 60})
        expected = command.simbench("describe", SCENARIO, "/trigger", "--format", "names").split()
        self.assertEqual(list(below["pointer"]), expected)
        self.assertEqual(below["value"][0], "60")
        algorithm = json.loads(command.simbench("describe", "two_way_hull", "--format", "json"))[0]
        self.assertEqual(list(simbench.describe("two_way_hull")["name"]),
                         [each["name"] for each in algorithm["parameters"]])
        self.check_refused(lambda: simbench.describe("none"), "none")

    def test_validate_names_every_wrong_file(self):
        wrong = [self.path("a.json"), self.path("b.json")]
        for path in wrong:
            with open(path, "w", encoding="utf-8") as file:
                file.write("{")
        with self.assertRaises(simbench.InputError) as raised:
            simbench.validate(wrong)
        self.assertEqual(len(str(raised.exception).splitlines()), 2)
        right = os.path.join(command.SOURCE, "scenarios", f"{SCENARIO}.json")
        self.assertEqual(simbench.validate(right), [])


if __name__ == "__main__":
    unittest.main()
