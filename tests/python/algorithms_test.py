"""Algorithms in Python: the same rule gives the same scores, mistakes have one clear message."""

import os
import signal
import subprocess
import sys
import tempfile
import time
import traceback
import unittest
from unittest import mock

import command
import simbench

try:
    import numpy
except ImportError:
    numpy = None
needs_numpy = unittest.skipIf(numpy is None, "stamp_all() needs NumPy")

WORLD = "3cam_1host_30fps"
RIG = "18cam_6host_45fps_lan"
CABLELESS = "18cam_6host_30fps_without_trigger"
EXAMPLE = os.path.join(command.SOURCE, "examples", "my_algorithm.py")
# `simbench run --python` starts the interpreter that runs this test.
ENVIRONMENT = {"SIMBENCH_PYTHON": sys.executable}


def row_of(result, pipeline):
    for row in result.data["rows"]:
        if row["pipeline"] == pipeline:
            return row
    raise AssertionError(f"no row {pipeline}")


def values(result, metric):
    """For each row its values, a seed each."""
    return [row[metric]["values"] for row in result.data["rows"]]


def numbers(result, pipeline):
    """All that a row has been given as scores, but not the algorithms' names."""
    row = row_of(result, pipeline)
    names = ("pipeline", "host_sync", "capture_alignment", "device_time", "gathering", "offline")
    return repr({key: value for key, value in row.items() if key not in names})


def scores(pipelines, scenario=WORLD, seeds=3, **options):
    return simbench.run(scenario, pipelines, seeds, progress=False, **options)


class SameRuleTest(unittest.TestCase):
    def check(self, scenario, own, built_in):
        result = scores([own, built_in], scenario)
        self.assertEqual(numbers(result, own), numbers(result, built_in))

    def test_stamp_is_raw_arrival(self):
        @simbench.device_time("test_arrival")
        class Arrival:
            def stamp(self, sample):
                return sample.arrival_ns

        self.check(WORLD, "oracle+test_arrival+yoon2021", "oracle+raw_arrival+yoon2021")
        self.check(
            WORLD,
            "oracle+test_arrival_exposure_corrected+yoon2021",
            "oracle+raw_arrival_exposure_corrected+yoon2021",
        )

    def test_relative_stamps_are_sensor_normalised(self):
        @simbench.device_time("test_relative")
        class Relative:
            relative = True
            first = None

            def stamp(self, sample):
                if self.first is None:
                    self.first = sample.sensor_ns
                return sample.sensor_ns - self.first

        self.check(WORLD, "oracle+test_relative+yoon2021", "oracle+sensor_normalised+yoon2021")

    @needs_numpy
    def test_stamp_all_is_raw_arrival(self):
        @simbench.device_time("test_all")
        class All:
            def stamp_all(self, arrival_ns, sensor_ns):
                assert arrival_ns.dtype == numpy.int64 and len(sensor_ns) == len(arrival_ns)
                assert not (sensor_ns % 1000).any()
                return arrival_ns

        self.check(WORLD, "oracle+test_all+yoon2021", "oracle+raw_arrival+yoon2021")

    def test_gathering_finds_the_same_sets(self):
        @simbench.gathering("test_sets")
        class Sets:
            def __init__(self, setup):
                assert setup.period_ns > 0 and setup.interval_ns > 0
                self.waiting = [[] for _ in range(setup.sources)]

            def push(self, frame):
                self.waiting[frame.source].append(frame)
                if all(self.waiting):
                    return [[queue.pop(0) for queue in self.waiting]]

        result = scores(["oracle+raw_arrival+test_sets", "oracle+raw_arrival+yoon2021"])
        own, built_in = (row["gathering_score"] for row in result.data["rows"])
        for score in ("sets", "pure_sets", "precision", "recall", "set_amd_ms"):
            self.assertEqual(own[score], built_in[score], score)
        self.assertGreater(own["sets"], 0)

    def test_delays_of_a_session_are_metrics(self):
        @simbench.host_sync("test_delays")
        async def measures(host, settings):
            begin = host.steady_ns
            await host.clock.step(0)
            for number in (1, 2):
                host.report_delays(1e6 * host.id, 5e5, 3e6 * number, get_ns=1e3, set_ns=4e6,
                                   pass_number=number, begin_steady_ns=begin)

        result = scores(["test_delays+raw_arrival+yoon2021"], RIG, seeds=2)
        self.assertEqual(values(result, "t_l_ms"), [[3, 3]])  # slaves 1 to 5
        self.assertEqual(values(result, "t_t_ms"), [[0.5, 0.5]])
        self.assertEqual(values(result, "t_d_ms"), [[6, 6]])
        self.assertEqual(values(result, "session_passes"), [[2, 2]])
        self.assertEqual(values(result, "get_time_ms"), [[0.001, 0.001]])
        self.assertEqual(values(result, "set_time_ms"), [[4, 4]])
        self.assertEqual(values(result, "message_time_ms"), [[None, None]])

    def test_host_sync_that_does_nothing_is_free_running(self):
        @simbench.host_sync("test_nothing")
        async def nothing(host, settings):
            assert host.id > 0

        result = scores(["test_nothing+raw_arrival+yoon2021", "free_running+raw_arrival+yoon2021"],
                        RIG, seeds=2)
        own, built_in = values(result, "host_error_ms")
        for found, expected in zip(own, built_in):
            self.assertAlmostEqual(found, expected, delta=0.1)
            self.assertGreater(found, 1)

    def test_a_server_of_ones_own_does_what_the_answerer_does(self):
        async def serve(host, client, settings):
            for _ in range(settings.questions):
                question = await host.channel(client).receive()
                now = await host.clock.now()
                times = [question.received_ns, now]
                await host.channel(client).send(b"".join(t.to_bytes(8, "little") for t in times))

        @simbench.host_sync("test_server", server=serve, questions=8)
        async def follow(host, settings):
            offsets = []
            for _ in range(settings.questions):
                t1 = await host.clock.now()
                await host.channel(0).send(b"?")
                answer = await host.channel(0).receive(timeout_ms=1000)
                t2, t3 = (int.from_bytes(answer.bytes[at : at + 8], "little") for at in (0, 8))
                t4 = answer.received_ns
                offsets.append((t4 - t1 - (t3 - t2), (t2 - t1 + t3 - t4) // 2))
            await host.clock.step(min(offsets)[1])

        @simbench.host_sync("test_answerer", questions=8)
        async def ask(host, settings):
            replies = [await host.channel(0).exchange() for _ in range(settings.questions)]
            await host.clock.step(min(replies, key=lambda r: r.delay_ns).offset_ns)

        result = scores([f"test_{which}+raw_arrival+yoon2021" for which in ("server", "answerer")],
                        RIG, seeds=2)
        for errors_ms in values(result, "host_error_ms"):
            self.assertLess(max(errors_ms), 1)


@mock.patch("warnings.warn")
class CaptureAlignmentTest(unittest.TestCase):
    # Exposures are steered from the first of the 3 s before what is evaluated.
    WORLD = {"/timeline/warm_up_ms": 3000, "/timeline/frames": 120}

    def scores(self, alignments, seeds=2, **options):
        """Pipelines that differ in the alignment alone."""
        pipelines = [
            simbench.pipeline(str(place), base="phase_rate", capture_alignment=alignment)
            for place, alignment in enumerate(alignments)
        ]
        return scores(pipelines, CABLELESS, seeds, set=self.WORLD, **options)

    def test_one_that_does_nothing_is_free_run(self, _):
        seen = set()

        @simbench.capture_alignment("test_idle")
        async def idle(host, camera, settings):
            seen.add((host.id, camera.number))

        result = self.scores([idle, "free_run"])
        self.assertEqual(numbers(result, "0"), numbers(result, "1"))
        self.assertEqual(seen, {(camera // 3, camera) for camera in range(18)})
        self.assertEqual(
            [row["capture_alignment"] for row in result.data["rows"]], ["test_idle", "free_run"]
        )
        self.assertEqual(list(result.table["capture_alignment"]), ["test_idle", "free_run"])

    def test_frames_of_another_length_move_the_exposures(self, _):
        @simbench.capture_alignment("test_grid", dead_band_us=100)
        async def grid(host, camera, settings):
            length, step = camera.frame_length_ns, camera.granularity_ns
            assert camera.shortest_ns < length < camera.longest_ns
            assert length % step == 0 and "adjust_frame" in camera.controls
            while True:
                exposure = await camera.next_frame()
                assert exposure.exposure_ns > 0
                late = (exposure.exposed_ns + length // 2) % length - length // 2
                is_aligned = abs(late) < settings.dead_band_us * 1e3
                if exposure.settled:
                    camera.report(is_aligned)
                    if not is_aligned:
                        by = min(max(-late, camera.shortest_ns - length), camera.longest_ns - length)
                        assert await camera.adjust_frame(by)

        result = self.scores([grid, "free_run"])
        steered, free = values(result, "exposure_spread_median_ms")
        # Each within the dead band and 1 s of 40 ppm.
        self.assertLess(max(steered), 0.3)
        self.assertGreater(min(free), 10)
        self.assertEqual([row["wrong_locks"]["values"] for row in result.data["rows"]][0], [0, 0])
        columns = result.table
        self.assertEqual(
            columns["exposure_spread_median_ms"][0],
            row_of(result, "0")["exposure_spread_median_ms"]["median"],
        )
        self.assertTrue((columns["aligned_1_ms_s"][0], columns["wrong_locks"][0]) >= (0, 0))
        again = self.scores([grid, "free_run"], jobs=2)
        self.assertEqual(numbers(result, "0"), numbers(again, "0"))

    def test_what_a_camera_refuses_is_false(self, _):
        refused = []

        @simbench.capture_alignment("test_refused")
        async def refuse(host, camera, settings):
            refused.append(await camera.set_frame_length(camera.longest_ns + 10**9))
            refused.append(await camera.set_frame_length(camera.frame_length_ns))

        self.scores([refuse], seeds=1)
        self.assertEqual(sorted(refused), [False] * 18 + [True] * 18)

    def test_delays_are_of_a_host_sync_alone(self, _):
        @simbench.capture_alignment("test_delays_of_cameras")
        async def reports(host, camera, settings):
            host.report_delays(1, 2, 3)

        with self.assertRaisesRegex(simbench.InputError, r"report_delays\(\): of a host_sync alone"):
            self.scores([reports], seeds=1)

    def test_datagrams_go_beside_those_of_host_sync(self, _):
        heard = []

        @simbench.capture_alignment("test_messages")
        async def tell(host, camera, settings):
            if camera.number == 0:
                for slave in range(1, 6):
                    await host.channel(slave).send(b"begin")
            elif camera.number % 3 == 0:
                heard.append((await host.channel(0).receive()).bytes)

        self.scores([tell], seeds=1)
        self.assertEqual(heard, [b"begin"] * 5)

    def test_a_base_may_lose_its_alignment(self, _):
        tree = simbench.pipeline("tree", base="phase_rate", capture_alignment="")
        result = scores([tree], CABLELESS, 1, set=self.WORLD)
        self.assertNotIn("capture_alignment", row_of(result, "tree"))
        self.assertLess(values(result, "exposure_spread_median_ms")[0][0], 0.01)

    def test_mistakes(self, _):
        async def sets(host, camera, settings):
            await host.clock.step(5)

        async def fails(host, camera, settings):
            host.failed("why")

        async def stream(host, camera, settings):
            await host.channel(1 if host.id == 0 else 0, stream=True).send(b"")

        async def raises(host, camera, settings):
            await camera.next_frame()
            raise KeyError("lost")

        for function, text in ((sets, "sets no clock"), (fails, r"camera\.report\(\)"),
                               (stream, "allowed: of a capture_alignment datagrams"),
                               (raises, "KeyError: 'lost'")):
            simbench.capture_alignment("test_mistake")(function)
            with self.subTest(text), self.assertRaisesRegex(simbench.InputError, text) as raised:
                self.scores(["test_mistake"], seeds=1)
            self.assertIn("algorithms_test.py:", str(raised.exception))
        with self.assertRaisesRegex(TypeError, "capture_alignment x: found .*async def"):
            simbench.capture_alignment("x")(lambda host, camera, settings: None)
        with self.assertRaisesRegex(TypeError, r"host, camera, settings\) cannot be called"):

            @simbench.capture_alignment("x")
            async def short(host, settings):
                pass

    def test_a_world_without_controls_is_refused(self, _):
        @simbench.capture_alignment("test_needs")
        async def needs(host, camera, settings):
            pass

        mine = simbench.pipeline("mine", base="oracle", capture_alignment=needs)
        with self.assertRaisesRegex(simbench.InputError, "cameras whose frames can be controlled"):
            scores([mine], RIG)

    def test_the_example_aligns(self, _):
        with mock.patch.dict(os.environ, ENVIRONMENT):
            text = command.simbench(
                "run", "--python", EXAMPLE, "--scenario", CABLELESS, "--seeds", "1",
                "--pipelines", "two_way_hull+to_the_grid+two_way_poll_calibrated+yoon2021",
                "--format", "csv",
            )  # fmt: skip
        header, line = (row.split(",") for row in text.splitlines())
        row = dict(zip(header, line))
        self.assertEqual(row["capture_alignment"], "to_the_grid")
        self.assertLess(float(row["exposure_spread_median_ms"]), 0.3)


class ParametersTest(unittest.TestCase):
    def test_scenarios_set_them_and_they_come_as_they_were_declared(self):
        seen = []

        @simbench.device_time("test_parameters", window=30, gain=0.5, naive=False,
                              kind=simbench.Parameter("a", choices=["a", "b"]))
        class Parameters:
            def __init__(self, window, gain, naive, kind):
                seen.append((window, gain, naive, kind))

            def stamp(self, sample):
                return sample.arrival_ns

        name = "oracle+test_parameters+yoon2021"
        scores([name], seeds=1)
        self.assertEqual(set(seen), {(30, 0.5, False, "a")})
        self.assertIs(type(seen[0][0]), int)
        seen.clear()
        scores([name], seeds=1, set={"/algorithms/test_parameters/window": 5,
                                     "/algorithms/test_parameters/kind": "b"})
        self.assertEqual(set(seen), {(5, 0.5, False, "b")})
        for value in (2.5, "many"):
            with self.assertRaisesRegex(simbench.InputError, "allowed: a"):
                scores([name], seeds=1, set={"/algorithms/test_parameters/window": value})

    def test_a_class_without_init_has_them_as_attributes(self):
        @simbench.device_time("test_attributes", delay_ms=40.0)
        class Attributes:
            def stamp(self, sample):
                return sample.arrival_ns - self.delay_ms * 1e6

        def bias_ms(delay_ms):
            result = scores(["oracle+test_attributes+yoon2021"], seeds=1,
                            set={"/algorithms/test_attributes/delay_ms": delay_ms})
            return values(result, "bias_ms")[0][0]

        self.assertAlmostEqual(bias_ms(10) - bias_ms(30), 20, places=6)

    def test_decorating_again_replaces(self):
        results = []
        for delay_ns in (0, 7_000_000):

            @simbench.device_time("test_again")
            class Again:
                later_ns = delay_ns

                def stamp(self, sample):
                    return sample.arrival_ns + self.later_ns

            result = scores(["oracle+test_again+yoon2021"], seeds=1)
            results.append(values(result, "bias_ms")[0][0])
        self.assertAlmostEqual(results[1] - results[0], 7, places=6)

    def test_pipeline_takes_a_base_and_a_class(self):
        @simbench.device_time("test_pipeline")
        class Mine:
            def stamp(self, sample):
                return sample.arrival_ns

        mine = simbench.pipeline("mine", base="yoon2021_both", device_time=Mine)
        result = simbench.run("18cam_6host_45fps", ["yoon2021_both", mine], 1, progress=False)
        self.assertEqual([row["pipeline"] for row in result.data["rows"]], ["yoon2021_both", "mine"])
        self.assertEqual(result.data["rows"][1]["device_time"], "test_pipeline")
        with self.assertRaisesRegex(simbench.InputError, "base: found 'none', allowed: "):
            scores([simbench.pipeline("x", base="none", device_time=Mine)])
        with self.assertRaisesRegex(TypeError, "allowed: the name of an algorithm"):
            simbench.pipeline("x", device_time=str)


class ErrorsTest(unittest.TestCase):
    def fails(self, stamp, text, method="stamp", cause=ValueError):
        cls = type("Wrong", (), {method: stamp})
        cls.__module__ = __name__
        simbench.device_time("test_wrong")(cls)
        for jobs in (1, 2):
            with self.assertRaises(simbench.InputError) as raised:
                scores(["oracle+raw_arrival+yoon2021", "oracle+test_wrong+yoon2021"], jobs=jobs)
            said = str(raised.exception)
            self.assertRegex(said, text)
            self.assertRegex(said, rf"class Wrong\.{method} \(algorithms_test\.py:\d+\)")
            self.assertIn("pipeline oracle+test_wrong+yoon2021, seed 1", said)
            self.assertIsInstance(raised.exception.__cause__, cause)
        return raised.exception

    def test_what_stamp_raises_is_chained_with_its_traceback(self):
        def stamp(self, sample):
            return 1 // 0

        error = self.fails(stamp, "ZeroDivisionError", cause=ZeroDivisionError)
        lines = "".join(traceback.format_tb(error.__cause__.__traceback__))
        self.assertIn("return 1 // 0", lines)

    def test_what_stamp_returns_is_checked(self):
        for value in (None, float("nan"), float("inf"), "soon", 2**80, [1]):
            with self.subTest(value):

                def stamp(self, sample, value=value):
                    return value

                self.fails(stamp, "returned .*; expected the global stamp")

    @needs_numpy
    def test_what_stamp_all_returns_is_checked(self):
        for make, text in (
            (lambda a: a[1:], "of shape"),
            (lambda a: a.astype(numpy.float32), "array of float32"),
            (lambda a: a.astype(float) * numpy.nan, "returned nan for frame 0"),
            (lambda a: a.reshape(1, -1), "of shape"),
            (lambda a: list(a), "returned a list"),
        ):
            with self.subTest(text):

                def stamp_all(self, arrival_ns, make=make):
                    return make(arrival_ns)

                # The default is a local of the test, not a column.
                def columns_only(self, arrival_ns):
                    return stamp_all(self, arrival_ns)

                columns_only.__name__ = "stamp_all"
                self.fails(columns_only, text, method="stamp_all")

    def test_signatures_are_checked_at_decoration(self):
        class NoMethod:
            pass

        class Short:
            def stamp(self):
                return 0

        class Column:
            def stamp_all(self, arrivals):
                return arrivals

        class NoParameter:
            def __init__(self):
                pass

            def stamp(self, sample):
                return 0

        for cls, text in ((NoMethod, "found no method"), (Short, r"stamp\(self, sample\)"),
                          (Column, "arrival_ns"), (NoParameter, "window")):
            with self.assertRaisesRegex(TypeError, text) as raised:
                simbench.device_time("test_signature", window=3)(cls)
            self.assertRegex(str(raised.exception), rf"class {cls.__name__} \(.*_test\.py:\d+\)")
        with self.assertRaisesRegex(TypeError, "async def"):
            simbench.host_sync("test_signature")(lambda host, settings: None)
        with self.assertRaisesRegex(ValueError, "one of simbench's own"):

            @simbench.device_time("raw_arrival")
            class Own:
                def stamp(self, sample):
                    return 0

    def test_sets_are_checked(self):
        for make, text in ((lambda frame: [[frame, frame]], "two sets"), (lambda frame: 5, "5"),
                           (lambda frame: [[1]], "a set with 1"), (lambda frame: [[]], "without")):

            @simbench.gathering("test_wrong_sets")
            class WrongSets:
                def __init__(self, setup):
                    pass

                def push(self, frame):
                    return make(frame)  # noqa: B023

            with self.assertRaisesRegex(simbench.InputError, f"returned .*{text}"):
                scores(["oracle+raw_arrival+test_wrong_sets"])

    def test_coroutines_that_go_wrong(self):
        import asyncio

        async def raises(host, settings):
            await host.sleep_for(5)
            raise KeyError("lost")

        async def sleeps(host, settings):
            await asyncio.sleep(0)

        async def nonsense(host, settings):
            await host.clock.adjust_frequency(1e12)

        async def nowhere(host, settings):
            await host.channel(77).send(b"")

        for function, text in ((raises, "KeyError: 'lost'"), (sleeps, "asyncio does not run here"),
                               (nonsense, "found a rate of"), (nowhere, "found host 77")):
            simbench.host_sync("test_wrong_sync")(function)
            with self.subTest(text), self.assertRaisesRegex(simbench.InputError, text) as raised:
                scores(["test_wrong_sync+raw_arrival+yoon2021"], RIG, seeds=1)
            self.assertIn("algorithms_test.py:", str(raised.exception))
            self.assertIn("seed 1", str(raised.exception))


    def test_servers_that_all_go_wrong_at_once(self):
        async def serve(host, client, settings):
            raise KeyError("no server")

        @simbench.host_sync("test_wrong_server", server=serve)
        async def follow(host, settings):
            await host.sleep_for(5)

        with self.assertRaisesRegex(simbench.InputError, "serve .*KeyError: 'no server'"):
            scores(["test_wrong_server+raw_arrival+yoon2021"], RIG, seeds=1)


class ThreadsTest(unittest.TestCase):
    def test_results_do_not_depend_on_threads(self):
        @simbench.device_time("test_threads", window=10)
        class Mean:
            def __init__(self, window):
                self.offsets, self.window = [], window

            def stamp(self, sample):
                self.offsets = [*self.offsets, sample.arrival_ns - sample.sensor_ns][-self.window :]
                return sample.sensor_ns + sum(self.offsets) // len(self.offsets)

        @simbench.host_sync("test_service", warm_up_s=20)
        async def service(host, settings):
            while True:
                reply = await host.channel(0).exchange()
                await host.clock.step(reply.offset_ns)
                await host.sleep_for(500 + 100 * host.random())

        names = ["test_service+test_threads+yoon2021", "oracle+test_threads+yoon2021"]
        one, two, four = (
            [numbers(scores(names, RIG, 4, jobs=jobs), name) for name in names] for jobs in (1, 2, 4)
        )
        self.assertEqual(one, two)
        self.assertEqual(one, four)

    def test_control_c_ends_a_run(self):
        code = f"""
import sys; sys.path.insert(0, {os.path.dirname(EXAMPLE)!r})
import my_algorithm, simbench
print("begun", flush=True)
simbench.run("18cam_6host_45fps", ["cristian+mean_of_last+in_order"], 100000, progress=False)
"""
        run = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
        run.stdout.readline()
        time.sleep(1)
        run.send_signal(signal.SIGINT)
        _, said = run.communicate(timeout=60)
        self.assertIn("KeyboardInterrupt", said)


@mock.patch.dict(os.environ, ENVIRONMENT)
class CommandLineTest(unittest.TestCase):
    NAMES = "yoon2021_both+mean_of_last+yoon2021,cristian+regression_30+in_order"
    RUN = ("run", "--scenario", "18cam_6host_45fps", "--seeds", "2", "--pipelines", NAMES)

    def test_run_has_the_algorithms_of_the_file(self):
        text = command.simbench(*self.RUN, "--python", EXAMPLE, "--format", "csv")
        self.assertIn("yoon2021_both+mean_of_last+yoon2021", text)
        self.assertEqual(
            text, command.simbench(*self.RUN, "--python", EXAMPLE, "--format", "csv", "--jobs", "2")
        )
        self.assertIn("mean_of_last", command.simbench(*self.RUN, status=2))

    def test_compare_and_gate_work_on_its_archive(self):
        with tempfile.TemporaryDirectory() as folder:
            archive, baseline = os.path.join(folder, "a"), os.path.join(folder, "b.json")
            command.simbench(*self.RUN, "--python", EXAMPLE, "-o", archive)
            command.simbench("gate", archive, "--save-baseline", baseline)
            command.simbench("gate", archive, "--baseline", baseline)
            said = command.simbench("compare", archive, "--pipelines", self.NAMES)
            self.assertIn("mean_of_last", said)

    def test_errors_of_the_file_have_their_line(self):
        with tempfile.TemporaryDirectory() as folder:
            for source, text in (("x = 1\ny = z\n", ":2: NameError"), ("x = (", ":1: SyntaxError")):
                path = os.path.join(folder, "wrong.py")
                with open(path, "w", encoding="utf-8") as file:
                    file.write(source)
                self.assertIn(text, command.simbench(*self.RUN, "--python", path, status=2))
        self.assertIn("no such file", command.simbench(*self.RUN, "--python", "none", status=2))

    def test_errors_of_a_run_name_class_line_pipeline_and_seed(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "wrong.py")
            with open(path, "w", encoding="utf-8") as file:
                file.write("import simbench\n@simbench.device_time('wrong')\nclass Wrong:\n"
                           "    def stamp(self, sample):\n        return sample.nothing\n")
            said = command.simbench("run", "--scenario", WORLD, "--python", path, "--pipelines",
                                    "oracle+wrong+yoon2021", status=2)
        self.assertRegex(said, r"oracle\+wrong\+yoon2021, seed 1: class Wrong\.stamp "
                               r"\(wrong\.py:5\): AttributeError")

    def test_an_interpreter_without_the_package_is_said(self):
        with mock.patch.dict(os.environ, {"SIMBENCH_PYTHON": "/none/python"}):
            said = command.simbench(*self.RUN, "--python", EXAMPLE, status=2)
            self.assertIn("/none/python cannot be started", said)


if __name__ == "__main__":
    unittest.main()
