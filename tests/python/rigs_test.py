"""Recordings of real cameras from Python give what the commands give."""

import json
import os
import socket
import subprocess
import tempfile
import unittest
import warnings

import command
import numpy
import simbench

def quietly(function, *arguments, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return function(*arguments, **options)


class RigsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.files = []
        for camera in range(2):
            path = os.path.join(cls.folder.name, f"camera{camera}.csv")
            with open(path, "w", encoding="utf-8") as file:
                file.write("Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n")
                for frame in range(1, 1001):
                    sensor = 1000 * camera + 33.333 * frame
                    arrival = 33.333 * frame + 20 + 0.01 * (frame * (7 + camera) % 13)
                    file.write(f"Depth,0,{frame},{sensor:.3f},{arrival:.3f}\n")
            cls.files.append(path)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_replay_is_the_commands(self):
        pipelines = ["raw_arrival", "hull_300+genlock"]
        result = quietly(simbench.replay, self.files, pipelines=pipelines)
        expected = json.loads(
            command.simbench(
                "replay", *self.files, "--pipelines", ",".join(pipelines), "--format", "json"
            )
        )
        self.assertEqual(
            command.without_performance(result.data), command.without_performance(expected)
        )
        self.assertEqual(len(result.table), 2)
        self.assertEqual(len(result.frames("raw_arrival")), 2000)

    def test_inspection_is_the_commands(self):
        found = quietly(simbench.inspect, self.files)
        expected = json.loads(command.simbench("inspect", *self.files, "--format", "json"))
        self.assertEqual(found.data, expected)
        self.assertEqual(len(found.table), 2)

    def test_frames_of_an_inspection_have_the_files_stamps(self):
        found = quietly(simbench.inspect, self.files)
        frames = found.frames(["raw_arrival"])
        self.assertEqual(len(frames), 2000)
        second = frames[frames["camera"] == 1]
        numpy.testing.assert_array_equal(second["counter"], numpy.arange(1, 1001))
        self.assertEqual(second["sensor_ns"][0], 1_033_333_000)
        numpy.testing.assert_allclose(second["global_ms_raw_arrival"], second["arrival_ns"] / 1e6)
        self.assertFalse(frames.flags.owndata)
        with self.assertRaisesRegex(simbench.InputError, "found 'none', allowed: "):
            found.frames(["none"])

    def test_diagnosis_is_the_commands(self):
        found = quietly(simbench.diagnose, self.files)
        expected = json.loads(command.simbench("diagnose", *self.files, "--format", "json"))
        self.assertEqual(found.data, expected)
        self.assertEqual(found.verdict, expected["verdict"]["status"])
        self.assertEqual(len(found.table), 2)
        page = os.path.join(self.folder.name, "rig.html")
        found.save_html(page)
        with open(page, encoding="utf-8") as file:
            self.assertIn(found.reason, file.read())

    def test_a_recording_folder_is_scored(self):
        folder = os.path.join(self.folder.name, "monday")
        command.simbench("record", "--scenario", "3cam_1host_30fps", "--output", folder)
        result = quietly(simbench.replay, folder)
        expected = json.loads(command.simbench("replay", folder, "--format", "json"))
        self.assertEqual(
            command.without_performance(result.data), command.without_performance(expected)
        )
        self.assertGreater(len(result.frames("raw_arrival")), 100)

    def test_a_pack_has_the_stamps_and_no_names(self):
        rig = os.path.join(self.folder.name, "secret.csv")
        with open(rig, "w", encoding="utf-8") as file:
            file.write("Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n")
            file.writelines(f"Depth,0,{i},{33.3 * i:.3f},{33.3 * i + 9:.3f}\n" for i in range(99))
        folder = os.path.join(self.folder.name, "for_you")
        quietly(simbench.diagnose, rig, pack=folder)
        with open(os.path.join(folder, "frames.csv"), encoding="utf-8") as file:
            text = file.read()
        self.assertIn("camera0", text)
        self.assertNotIn("secret", text)

    def test_errors_are_the_commands(self):
        missing = os.path.join(self.folder.name, "none.csv")
        said = command.simbench("diagnose", missing, status=2)
        with self.assertRaises(simbench.InputError) as raised:
            simbench.diagnose(missing)
        self.assertIn(str(raised.exception), said)


class RealRigTest(unittest.TestCase):
    """A node of this machine, whose cameras play a recording."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        with open(cls.path("played.csv"), "w", encoding="utf-8") as file:
            file.write("Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms)\n")
            for frame in range(1, 400):
                due = 33.3333 * (frame - 1)
                file.write(f"Depth,0,{frame},{due + 5:.4f},{due + 6:.4f}\n")
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        cameras = [{"serial": name, "recording": "played.csv"} for name in ("l", "m", "r")]
        with open(cls.path("rig.json"), "w", encoding="utf-8") as file:
            json.dump({"schema_version": 1, "name": "lab",
                       "trigger": {"on_command": "true", "off_command": "true"},
                       "hosts": [{"name": "host0", "address": "127.0.0.1", "port": port,
                                  "cameras": cameras}]}, file)
        node = subprocess.Popen(
            [command.PROGRAM, "node", "--rig", cls.path("rig.json"), "--name", "host0",
             "--journal", cls.path("journal")],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
        )  # fmt: skip
        cls.addClassCleanup(node.stdout.close)
        cls.addClassCleanup(node.wait)
        cls.addClassCleanup(node.terminate)
        node.stdout.readline()  # it listens

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    def options(self):
        return {
            "pipelines": ["raw_arrival"], "backend": "hardware", "rig": self.path("rig.json"),
            "set": {"/timeline/frames": 60, "/timeline/warm_up_ms": 500,
                    "/timeline/wait_before_capture_ms": 100},
        }  # fmt: skip

    def test_a_run_on_a_rig(self):
        result = quietly(simbench.run, "3cam_1host_30fps", **self.options())
        row = result.data["rows"][0]
        self.assertEqual(row["pipeline"], "raw_arrival")
        self.assertEqual(len(row["amd_ms"]["values"]), 1)
        self.assertGreater(row["amd_ms"]["values"][0], 0)
        self.assertEqual(result.table["ground_truth"][0], "genlock_order")
        result.save(self.path("kept"))
        self.assertEqual(simbench.load(self.path("kept")).data, result.data)

    def test_a_recording_of_a_rig(self):
        folder = quietly(simbench.record, "3cam_1host_30fps", self.path("recorded"),
                         **self.options())
        found = quietly(simbench.replay, folder)
        self.assertEqual(list(found.table["pipeline"]), ["raw_arrival"])

    def test_a_rig_that_is_not_there(self):
        options = {**self.options(), "rig": self.path("none.json")}
        with self.assertRaisesRegex(simbench.InputError, "none.json"):
            simbench.run("3cam_1host_30fps", **options)


if __name__ == "__main__":
    unittest.main()
