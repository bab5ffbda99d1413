"""A gate tells that an algorithm in Python has become worse."""

import os
import shutil
import tempfile
import unittest

import simbench


class GateTest(unittest.TestCase):
    def test_an_algorithm_that_became_worse_fails(self):
        def run_with(delay_ns):
            @simbench.device_time("of_the_gate")
            class OfTheGate:
                def stamp(self, sample):
                    return sample.arrival_ns + delay_ns * (sample.arrival_ns % 7)

            return simbench.run("3cam_1host_30fps", ["oracle+of_the_gate+yoon2021"], seeds=2)

        folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, folder)
        baseline = simbench.save_baseline(run_with(1000), os.path.join(folder, "before.json"))
        self.assertTrue(simbench.gate(run_with(1000), baseline))
        summary = os.path.join(folder, "gate.md")
        gate = simbench.gate(run_with(1_000_000), baseline, markdown=summary)
        with open(summary, encoding="utf-8") as file:
            self.assertEqual(file.read().rstrip(), gate.text("markdown").rstrip())
        self.assertFalse(gate)
        failed = gate.table[gate.table["outcome"] == "failed"]
        self.assertIn("amd_ms", list(failed["metric"]))
        self.assertEqual(gate.reasons, list(failed["message"]))


if __name__ == "__main__":
    unittest.main()
