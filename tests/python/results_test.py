"""Runs from Python give what the command gives."""

import csv
import filecmp
import io
import json
import math
import os
import tempfile
import unittest

import command
import numpy
import simbench

SCENARIO = "18cam_6host_45fps"
PIPELINES = ["yoon2021_both", "yoon2021_network", "oracle"]
RUN = ["run", "--scenario", SCENARIO, "--pipelines", ",".join(PIPELINES), "--seeds", "8"]


class ResultsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.result = simbench.run(SCENARIO, PIPELINES, seeds=8)

    def test_a_host_sync_alone_has_the_first_pipelines_other_stages(self):
        r = simbench.run("18cam_6host_45fps", pipelines=["yoon2021_both", "two_way_hull"],
                         seeds=1, set={"/trigger/rate_hz": 30})
        stages = [(row["device_time"], row["gathering"]) for _, row in r.table.iterrows()]
        self.assertEqual(stages[0], stages[1])

    def test_all_numbers_are_the_commands(self):
        expected = json.loads(command.simbench(*RUN, "--no-levers", "--format", "json"))
        self.assertEqual(
            command.without_performance(self.result.data), command.without_performance(expected)
        )

    def test_the_table_has_the_lines_of_csv(self):
        expected = list(csv.DictReader(io.StringIO(command.simbench(*RUN, "--format", "csv"))))
        table = self.result.table
        self.assertEqual(list(table["pipeline"]), PIPELINES)
        self.assertEqual(list(table.columns), list(expected[0]))
        for row, line in zip(table.to_dict("records"), expected):
            for column in ("amd_ms", "amd_ms_p05", "absolute_error_ms", "published_amd_ms"):
                wanted = float(line[column]) if line[column] else math.nan
                self.assertTrue(row[column] == wanted or math.isnan(row[column] + wanted), column)

    def test_seeds_has_every_value(self):
        seeds = self.result.seeds
        amd = seeds[(seeds["metric"] == "amd_ms") & (seeds["pipeline"] == "yoon2021_both")]
        self.assertEqual(list(amd["seed"]), list(range(1, 9)))
        row = self.result.data["rows"][0]
        self.assertEqual(list(amd["value"]), row["amd_ms"]["values"])

    def test_the_text_is_the_commands(self):
        self.assertEqual(self.result.text(), command.simbench(*RUN))
        self.assertEqual(self.result.answer, command.simbench(*RUN, "--quiet"))
        self.assertEqual(repr(self.result) + "\n", command.simbench(*RUN))

    def test_html_has_the_answer_and_a_row_for_each_pipeline(self):
        html = self.result._repr_html_()
        self.assertRegex(html, "yoon2021_both(, with 1 that .*,)? is the best")
        for name in PIPELINES:
            self.assertIn(name, html)

    def test_the_archive_has_the_bytes_of_the_commands(self):
        with tempfile.TemporaryDirectory() as folder:
            ours, theirs = os.path.join(folder, "ours"), os.path.join(folder, "theirs")
            self.result.save(ours)
            command.simbench(*RUN, "--no-levers", "--output", theirs)
            self.assertEqual(sorted(os.listdir(ours)), sorted(os.listdir(theirs)))
            for name in ("frames.csv", "hosts.csv"):
                self.assertTrue(
                    filecmp.cmp(os.path.join(ours, name), os.path.join(theirs, name), False), name
                )
            for name in ("results.json", "manifest.json"):
                documents = []
                for where in (ours, theirs):
                    with open(os.path.join(where, name), encoding="utf-8") as file:
                        document = json.load(file)
                    for of_this_run in ("performance", "command", "started", "finished"):
                        document.pop(of_this_run, None)
                    documents.append(json.dumps(document))
                self.assertEqual(*documents)
            loaded = simbench.load(theirs)
            self.assertTrue(loaded.table.equals(self.result.table))
            self.assertTrue(loaded.seeds.equals(self.result.seeds))
            with self.assertRaises(simbench.OutputError):
                loaded.save(os.path.join(folder, "again"))
            expected = command.simbench("compare", theirs, "--with-baseline", "oracle", "--json")
            self.assertEqual(
                simbench.compare(loaded, baseline="oracle").data, json.loads(expected)
            )

    def test_compare_judges_seed_by_seed(self):
        self.assertEqual(
            set(simbench.compare(self.result, self.result).table["verdict"]), {"no_difference_seen"}
        )
        table = simbench.compare(self.result, pipelines=["yoon2021_network", "oracle"]).table
        amd = table[table["metric"] == "amd_ms"].iloc[0]
        self.assertEqual((amd["pipeline_a"], amd["pipeline_b"]), ("yoon2021_network", "oracle"))
        self.assertEqual(amd["verdict"], "better")

    def test_set_changes_the_world(self):
        changed = simbench.run(
            SCENARIO, ["oracle"], seeds=2, set={"/trigger/rate_hz": 30, "/timeline/frames": 200}
        )
        expected = command.simbench(
            "run", "--scenario", SCENARIO, "--pipelines", "oracle", "--seeds", "2",
            "--set", "/trigger/rate_hz=30", "--set", "/timeline/frames=200", "--format", "json",
        )  # fmt: skip
        self.assertEqual(
            command.without_performance(changed.data),
            command.without_performance(json.loads(expected)),
        )

    def test_plot_draws_what_the_table_says(self):
        axes = self.result.plot()
        names = [label.get_text() for label in axes.get_yticklabels()]
        self.assertEqual(names, ["oracle (limit)", "yoon2021_both (best)", "yoon2021_network"])
        dots = [line.get_xdata()[0] for line in axes.lines if line.get_marker() == "o"]
        self.assertEqual(sorted(dots), sorted(self.result.table["amd_ms"]))
        diamonds = [line.get_xdata()[0] for line in axes.lines if line.get_marker() == "D"]
        published = self.result.table["published_amd_ms"].dropna()
        self.assertEqual(sorted(diamonds), sorted(published))
        self.assertEqual(axes.get_xscale(), "log")


class FailedProgramTest(unittest.TestCase):
    def test_its_row_has_failed_and_has_no_numbers(self):
        with tempfile.TemporaryDirectory() as folder:
            rig = os.path.join(folder, "rig.json")
            programs = {"master": [["python3", "-c", "import time; time.sleep(1e6)"]],
                        "slave": [["python3", "-c", "raise SystemExit(3)"]]}
            with open(rig, "w", encoding="utf-8") as out:
                json.dump({"schema_version": 1, "name": "rig", "summary": "A program that ends.",
                           "base": "9cam_3host_30fps_azure_kinect", "timeline": {"frames": 30},
                           "pipelines": [{"name": "mine", "host_sync": {"program": programs},
                                          "device_time": "regression_30",
                                          "gathering": "yoon2021"}]}, out)
            result = simbench.run(rig, seeds=1)
            clocks = simbench.clocks(rig, seeds=1, duration_s=310)
        for row in (result.table.iloc[0], clocks.table.iloc[0]):
            self.assertEqual(row["standing"], "failed")
            self.assertIn("exited with status 3", row["failed"])
        self.assertTrue(math.isnan(result.table.iloc[0]["amd_ms"]))
        self.assertTrue(math.isnan(clocks.table.iloc[0]["max_te_ms"]))
        self.assertEqual(len(result.data["rows"][0]["program_failures"]), 2)
        self.assertIn("Every pipeline that a rig can run failed", result.answer)


class FramesTest(unittest.TestCase):
    def test_frames_are_a_view_of_the_runs_memory(self):
        run = simbench.run("3cam_1host_30fps", seeds=1)
        rows, _, _ = run._run.frames("raw_arrival", 1, None)
        frames = simbench.tables.array(rows)
        self.assertEqual(frames.__array_interface__["data"][0], rows.address)
        self.assertFalse(frames.flags.owndata)
        self.assertFalse(frames.flags.writeable)
        before = frames["global_ms"].copy()
        del rows, run  # the array keeps the memory
        numpy.testing.assert_array_equal(frames["global_ms"], before)

    def test_frames_give_the_runs_scores(self):
        result = simbench.run(SCENARIO, ["yoon2021_both"], seeds=2)
        frames = result.frames("yoon2021_both", seed=2)
        scored = frames[frames["evaluated"]]
        numpy.testing.assert_array_equal(
            scored["error_ms"], scored["global_ms"] - scored["reference_ms"]
        )
        values = result.data["rows"][0]
        self.assertAlmostEqual(
            numpy.abs(scored["error_ms"]).mean(), values["absolute_error_ms"]["values"][1], 9
        )
        spreads = [
            numpy.ptp(scored["global_ms"][scored["pulse"] == pulse])
            for pulse in numpy.unique(scored["pulse"])
        ]
        self.assertAlmostEqual(numpy.mean(spreads), values["amd_ms"]["values"][1], 9)

    def test_refuses_what_was_not_run(self):
        result = simbench.run("3cam_1host_30fps", ["raw_arrival"], seeds=1)
        with self.assertRaisesRegex(simbench.InputError, "found no pipeline 'oracle', allowed: raw"):
            result.frames("oracle")
        with self.assertRaisesRegex(simbench.InputError, "found no seed 2, allowed: 1 to 1"):
            result.frames("raw_arrival", seed=2)


class ClocksTest(unittest.TestCase):
    def test_all_numbers_are_the_commands(self):
        expected = json.loads(
            command.simbench(
                "clocks", "--scenario", "6host_star", "--pipelines", "chrony", "--seeds", "2",
                "--duration-s", "1200", "--format", "json",
            )  # fmt: skip
        )
        clocks = simbench.clocks("6host_star", ["chrony"], seeds=2, duration_s=1200)
        self.assertEqual(
            command.without_performance(clocks.data), command.without_performance(expected)
        )
        curve = expected["rows"][0]["adev"]
        self.assertEqual(len(clocks.adev), len(curve))
        self.assertGreater(len(clocks.time_errors), 0)
        self.assertEqual(list(clocks.table["pipeline"]), ["chrony"])


if __name__ == "__main__":
    unittest.main()
