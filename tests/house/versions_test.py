#!/usr/bin/env python3
"""The version of CMakeLists.txt is SemVer and the newest of the changelog; each release has its notes
and its archives; the snippets for CI take the newest."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).parents[2]
NUMBER = r"(?:0|[1-9][0-9]*)"
SEMVER = rf"{NUMBER}\.{NUMBER}\.{NUMBER}"


def numbers(version):
    return tuple(int(number) for number in version.split("."))


class VersionsTest(unittest.TestCase):
    def setUp(self):
        text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
        self.version = re.search(r"^project\(simbench VERSION (\S+)", text, re.M)[1]
        self.changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
        self.headings = re.findall(r"^## (.*)$", self.changelog, re.M)

    def test_the_version_is_semver(self):
        self.assertRegex(self.version, rf"\A{SEMVER}\Z")

    def test_headings_are_versions_with_dates_the_newest_first(self):
        self.assertEqual(self.headings[0], "[Unreleased]")
        versions = []
        for heading in self.headings[1:]:
            found = re.fullmatch(rf"\[({SEMVER})\] - ([0-9]{{4}}-[0-9]{{2}}-[0-9]{{2}})", heading)
            self.assertIsNotNone(found, heading)
            versions.append(found[1])
        self.assertEqual(versions, sorted(set(versions), key=numbers, reverse=True))
        # The program that is built is the release on top, until the next one has its notes.
        self.assertEqual(versions[0], self.version)

    def test_every_release_has_notes_and_archives(self):
        parts = re.split(r"^## \[(\S+)\].*$", self.changelog, flags=re.M)[1:]
        notes = dict(zip(parts[::2], parts[1::2]))
        del notes["Unreleased"]
        archives = {path.name for path in (ROOT / "tests/data/archives").iterdir()}
        self.assertEqual(archives, set(notes))
        for version, text in notes.items():
            self.assertRegex(text, r"(?m)^- ", version)
            self.assertTrue((ROOT / "tests/data/archives" / version / "run/results.json").exists())

    def test_the_snippets_take_the_newest(self):
        snippets = [*(ROOT / "reports/ci").iterdir(), ROOT / "docs/ci.md"]
        stated = [version for path in snippets for version in re.findall(
            r"(?:SIMBENCH_VERSION(?:=|: )|/v|simbench/)([0-9]+\.[0-9.]*[0-9])",
            path.read_text(encoding="utf-8"))]
        self.assertGreaterEqual(len(stated), 9)
        self.assertEqual(set(stated), {self.version})


if __name__ == "__main__":
    unittest.main()
