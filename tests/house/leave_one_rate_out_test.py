#!/usr/bin/env python3
"""The criterion of tools/leave_one_rate_out, by hand-computed numbers, and a study of few points."""

import importlib.machinery
import importlib.util
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).parents[2]


def loaded():
    sys.dont_write_bytecode = True
    loader = importlib.machinery.SourceFileLoader("study", str(ROOT / "tools/leave_one_rate_out"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("study", loader))
    loader.exec_module(module)
    return module


def test_distance(study):
    # ln AMD is -1 and 1: mean 0, standard deviation sqrt(2); the printed value lies one above it.
    amd = {"x": [math.exp(-1), math.exp(1)]}
    expected = (1 / math.sqrt(2)) ** 2 + 2 * math.log(math.sqrt(2))
    assert abs(study.distance({"x": math.e}, amd) - expected) < 1e-12
    # A wide band that holds the value is worse than a narrow one that does.
    narrow = {"x": [math.exp(-0.1), math.exp(0.1)]}
    assert study.distance({"x": 1.0}, narrow) < study.distance({"x": 1.0}, amd)
    # ... and a narrow one beside it is worse than a wide one that holds it.
    assert study.distance({"x": math.e}, narrow) > study.distance({"x": math.e}, amd)


def test_best(study):
    assert study.best({(2,): 1.0, (1,): 1.0, (0,): 3.0}) == (1,)


def test_nested(study):
    assert study.nested({"/a/b": 1, "/a/c/d": 2}) == {"a": {"b": 1, "c": {"d": 2}}}


def test_study(study, simbench):
    """All of it, over two points and a few seeds."""
    with tempfile.TemporaryDirectory() as folder:
        code = ("import importlib.machinery, importlib.util, sys; sys.dont_write_bytecode = True; "
                f"l = importlib.machinery.SourceFileLoader('study', '{ROOT}/tools/leave_one_rate_out'); "
                "m = importlib.util.module_from_spec(importlib.util.spec_from_loader('study', l)); "
                "l.exec_module(m); m.GRID = {'/cameras/exposure_host_periods': [0, 0.2]}; "
                f"sys.argv = ['x', '{folder}/study', '--simbench', '{simbench}', '--seeds', '3', "
                "'--checked-seeds', '4']; m.main()")
        text = subprocess.run([sys.executable, "-c", code], check=True, stdout=subprocess.PIPE,
                              text=True).stdout
        # Two tables of eight printed values in four worlds.
        assert text.count("FPS `yoon2021_both`") == 4, text
        assert text.count("FPS `ntp_last_set` 547.5 |") == 1, text
        assert (pathlib.Path(folder) / "study/fit_to_15_FPS_at_45fps.json").exists()


def main():
    study = loaded()
    test_distance(study)
    test_best(study)
    test_nested(study)
    test_study(study, sys.argv[1])


if __name__ == "__main__":
    main()
