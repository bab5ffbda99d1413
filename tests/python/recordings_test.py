"""Stamps of other kinds become a recording that simbench reads to the nanosecond."""

import json
import os
import sys
import tempfile
import types
import unittest
import unittest.mock
import warnings

import numpy
import simbench

PERIOD_NS = 33_333_333


class RecordingsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def written(self, source, **options):
        """The streams and the frames of what is written."""
        output = self.path("written.csv")
        if os.path.exists(output):
            os.remove(output)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            count = simbench.write_recording(output, source, **options)
            found = simbench.inspect(output)
        frames = found.frames()
        self.assertEqual(len(frames), count)
        return [stream["camera"] for stream in found.streams], frames

    def test_an_array_for_each_camera(self):
        left = 1_700_000_000_123_456_789 + PERIOD_NS * numpy.arange(50, dtype=numpy.int64)
        right = numpy.stack([left + 7, left + 5_000_001], axis=1)
        cameras, frames = self.written({"left": left, 'ri"ght, 2': right}, unit="ns")
        self.assertEqual(cameras, ["left", 'ri"ght, 2'])
        first = frames[frames["camera"] == 0]
        numpy.testing.assert_array_equal(first["sensor_ns"], left)
        numpy.testing.assert_array_equal(first["arrival_ns"], left)
        second = frames[frames["camera"] == 1]
        numpy.testing.assert_array_equal(second["sensor_ns"], left + 7)
        numpy.testing.assert_array_equal(second["arrival_ns"], left + 5_000_001)

    def test_units_and_dates(self):
        seconds = 0.033333333 * numpy.arange(50) - 0.5
        expected = numpy.rint(seconds * 1e9).astype(numpy.int64)
        for unit, factor in {"s": 1, "ms": 1e3, "us": 1e6, "ns": 1e9}.items():
            _, frames = self.written(seconds * factor, unit=unit)
            numpy.testing.assert_array_equal(frames["sensor_ns"], expected, unit)
        dates = numpy.datetime64("2024-09-03T10:32:22") + numpy.arange(50) * numpy.timedelta64(33, "ms")
        _, frames = self.written(dates)
        self.assertEqual(frames["sensor_ns"][1] - frames["sensor_ns"][0], 33_000_000)
        self.assertEqual(frames["sensor_ns"][0], 1_725_359_542_000_000_000)
        fields = numpy.zeros(50, dtype=[("t_us", "i8"), ("host_ms", "f8")])
        fields["t_us"] = 33_333 * numpy.arange(50)
        fields["host_ms"] = 33.5 * numpy.arange(50)
        _, frames = self.written(fields)
        self.assertEqual(frames["sensor_ns"][2], 66_666_000)
        self.assertEqual(frames["arrival_ns"][2], 67_000_000)

    def test_numpy_files(self):
        stamps = PERIOD_NS * numpy.arange(50)
        numpy.save(self.path("cam0.npy"), stamps)
        numpy.savez(self.path("rig.npz"), left=stamps, right=stamps + 1)
        self.assertEqual(self.written(self.path("cam0.npy"), unit="ns")[0], ["cam0"])
        cameras, frames = self.written(self.path("rig.npz"), unit="ns")
        self.assertEqual(cameras, ["left", "right"])
        self.assertEqual(frames["sensor_ns"][51], PERIOD_NS + 1)

    def test_what_is_no_stamp_is_left_out(self):
        stamps = 0.033 * numpy.arange(50)
        stamps[[3, 7]] = numpy.nan, numpy.inf
        with self.assertWarnsRegex(UserWarning, "2 rows without a stamp left out"):
            self.assertEqual(simbench.write_recording(self.path("a.csv"), stamps, unit="s"), 48)

    def test_xdf(self):
        streams = [
            {"info": {"name": ["camera"]}, "time_stamps": 0.033 * numpy.arange(50)},
            {"info": {"name": ["no samples"]}, "time_stamps": []},
        ]
        with open(self.path("a.xdf"), "wb") as file:
            file.write(b"XDF:")
        module = types.SimpleNamespace(load_xdf=lambda path: (streams, {}))
        with unittest.mock.patch.dict(sys.modules, {"pyxdf": module}):
            cameras, frames = self.written(self.path("a.xdf"))
        self.assertEqual(cameras, ["camera"])
        self.assertEqual(frames["sensor_ns"][1], 33_000_000)
        with unittest.mock.patch.dict(sys.modules, {"pyxdf": None}):
            with self.assertRaisesRegex(simbench.MissingPackage, "needs the package pyxdf"):
                simbench.write_recording(self.path("b.csv"), self.path("a.xdf"))

    def test_lerobot(self):
        os.makedirs(self.path("set/meta"))
        os.makedirs(self.path("set/data/chunk-000"))
        with open(self.path("set/meta/info.json"), "w", encoding="utf-8") as file:
            json.dump({"codebase_version": "v3.0"}, file)
        with open(self.path("set/data/chunk-000/file-000.parquet"), "wb"):
            pass
        rows = {
            "timestamp": [i % 30 / 30 for i in range(60)],
            "episode_index": [i // 30 for i in range(60)],
        }
        read = unittest.mock.Mock(return_value=types.SimpleNamespace(to_pydict=lambda: rows))
        parquet = types.SimpleNamespace(read_table=read)
        modules = {"pyarrow": types.SimpleNamespace(parquet=parquet), "pyarrow.parquet": parquet}
        with unittest.mock.patch.dict(sys.modules, modules):
            cameras, frames = self.written(self.path("set"), episode=1)
            self.assertEqual((cameras, len(frames)), (["set"], 30))
            self.assertEqual(frames["sensor_ns"][1], 33_333_333)
            with self.assertRaisesRegex(simbench.InputError, "found 2, allowed: 0 to 1"):
                simbench.write_recording(self.path("b.csv"), self.path("set"), episode=2)
        with open(self.path("set/meta/info.json"), "w", encoding="utf-8") as file:
            json.dump({"codebase_version": "v9"}, file)
        with self.assertRaisesRegex(simbench.InputError, "found 'v9', allowed: v2 and v3"):
            simbench.write_recording(self.path("b.csv"), self.path("set"))

    def test_bad_input_says_what_is_allowed(self):
        output = self.path("b.csv")
        stamps = numpy.arange(50)
        with open(self.path("broken.npy"), "wb") as file:
            file.write(b"\x93NUMPY")
        for source, options, text in (
            (stamps, {}, "unit: found none, allowed: s, ms, us, ns"),
            (stamps, {"unit": "min"}, "unit: found 'min', allowed: s, ms"),
            (stamps.reshape(10, 5), {"unit": "s"}, r"shape \(10, 5\) and int64, allowed: a stamp"),
            (numpy.array(["a"]), {"unit": "s"}, "found <U1, allowed: numbers or dates"),
            ({"a\nb": stamps}, {"unit": "s"}, "allowed: a name of printable letters"),
            ({}, {}, "found no frame"),
            (numpy.array([]), {"unit": "s"}, "found no frame"),
            (self.path("no.npy"), {"unit": "s"}, "there is no such file"),
            (self.path("broken.npy"), {"unit": "s"}, "broken.npy: "),
            ("rig.bag", {}, "simbench reads other recordings itself"),
        ):
            with self.assertRaisesRegex(simbench.InputError, text):
                simbench.write_recording(output, source, **options)
            self.assertFalse(os.path.exists(output))

    def test_nothing_is_replaced(self):
        stamps = numpy.arange(50)
        numpy.save(self.path("a.npy"), stamps)
        with self.assertRaisesRegex(simbench.OutputError, "File exists"):
            simbench.write_recording(self.path("a.npy"), self.path("a.npy"), unit="ms")
        numpy.testing.assert_array_equal(numpy.load(self.path("a.npy")), stamps)


if __name__ == "__main__":
    unittest.main()
