"""Archives of every release so far (tests/data/archives/) have their values in Python."""

import json
import os
import shutil
import tempfile
import unittest

import command
import simbench

ARCHIVES = os.path.join(command.SOURCE, "tests", "data", "archives")


def document(*path):
    with open(os.path.join(ARCHIVES, *path), encoding="utf-8") as file:
        return json.load(file)


class ArchivesTest(unittest.TestCase):
    def setUp(self):
        self.versions = sorted(os.listdir(ARCHIVES))
        self.assertIn("0.1.0", self.versions)

    def test_load_has_the_values_of_the_file(self):
        for version in self.versions:
            with self.subTest(version=version):
                result = simbench.load(os.path.join(ARCHIVES, version, "run"))
                rows = document(version, "run", "results.json")["rows"]
                self.assertEqual([row["pipeline"] for row in result.data["rows"]],
                                 [row["pipeline"] for row in rows])
                for here, there in zip(result.data["rows"], rows):
                    for metric in ("amd_ms", "rmdv_ms", "absolute_error_ms"):
                        self.assertEqual(here[metric]["values"], there[metric]["values"], metric)

    def test_compare_and_replay_take_them(self):
        for version in self.versions:
            with self.subTest(version=version):
                compared = simbench.compare(os.path.join(ARCHIVES, version, "run"), baseline="oracle")
                expected = {(pipeline["b"], metric): pipeline[metric]["b"]["median"]
                            for pipeline in document(version, "comparison.json")["pipelines"]
                            for metric in ("amd_ms", "rmdv_ms")}
                found = {(row["pipeline_b"], row["metric"]): row["median_b"]
                         for _, row in compared.table.iterrows()}
                for key, value in expected.items():
                    self.assertEqual(found[key], value)
                replayed = simbench.replay(os.path.join(ARCHIVES, version, "recording"))
                for here, there in zip(replayed.data["rows"],
                                       document(version, "replay.json")["rows"]):
                    self.assertAlmostEqual(here["amd_ms"]["median"], there["amd_ms"]["median"],
                                           delta=1e-9)

    def test_a_newer_format_is_an_input_error_that_names_its_writer(self):
        with tempfile.TemporaryDirectory() as folder:
            copy = os.path.join(folder, "run")
            shutil.copytree(os.path.join(ARCHIVES, "0.1.0", "run"), copy)
            results = document("0.1.0", "run", "results.json")
            results.update(schema_version=99, version="97.0.0")
            with open(os.path.join(copy, "results.json"), "w", encoding="utf-8") as file:
                json.dump(results, file)
            with self.assertRaisesRegex(simbench.InputError, r"a newer simbench \(97\.0\.0\)"):
                simbench.load(copy)


if __name__ == "__main__":
    unittest.main()
