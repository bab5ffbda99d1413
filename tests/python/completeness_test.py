"""Python has every command and every option of the command line, under their names."""

import inspect
import keyword
import re
import unittest

import command
import simbench

#: Commands that Python has not, and why.
NOT_IN_PYTHON = {
    "explore": "a server of a page; run() has its results",
    "watch": "goes on until it is ended; its events are lines of JSON",
    "node": "a program of its own on each host of a rig",
    "relay": "a program of its own between nodes",
    "keygen": "writes a secret for hosts",
    "code": "describes a trigger for a microcontroller; its JSON is all of it",
    "validate-model": "starts hosts as processes in namespaces of the network",
    "reconstruct": "needs Embree and Open3D, which the module has not",
    "help": "help() of Python",
    "completion": "for shells",
    "manual": "for shells",
}
#: Commands whose functions have other names, and why.
OTHER_NAMES = {"list": ("listing", "list is Python's own")}
#: Options that are no arguments, and what is in their place.
OF_EVERY_COMMAND = {
    "help": "help() of Python",
    "format": "results have all formats",
    "json": "messages are exceptions, warnings and notes",
    "table-columns": "tables are pandas, whose columns can be chosen",
}
ELSEWHERE = {
    ("run", "output"): "Result.save()",
    ("run", "quiet"): "Result.answer",
    ("run", "verbose"): "Result.text(detail=)",
    ("run", "budget"): "budget()",
    ("clocks", "output"): "Clocks.save()",
    ("replay", "output"): "Result.save()",
    ("gate", "save-baseline"): "save_baseline()",
    ("trace", "output"): "Trace.save()",
    ("figure", "list"): "listing('figures')",
}


def commands():
    """The commands that `simbench --help` lists."""
    names = []
    for group in re.split(r"\n\n", command.simbench("--help"))[2:]:
        head, *lines = group.splitlines()
        if re.fullmatch(r"[A-Z].*:", head) and head not in ("Options:", "Start here:"):
            names += [found[1] for line in lines if (found := re.match(r"  ([a-z-]+)\s{2,}", line))]
    return names


def options(name):
    """For each option of `simbench NAME --help` its long names."""
    for line in command.simbench(name, "--help").splitlines():
        if found := re.match(r"  (?:-\w,)?(--[\w-]+(?:,--[\w-]+)*)", line):
            yield [each[2:] for each in found[1].split(",")]


def argument(option):
    name = option.replace("-", "_")
    return name + "_" if keyword.iskeyword(name) else name


class CompletenessTest(unittest.TestCase):
    def test_every_command_is_a_function_or_has_a_reason(self):
        names = commands()
        self.assertGreater(len(names), 20)
        self.assertIn("run", names)
        for name in names:
            if name in NOT_IN_PYTHON:
                continue
            function = OTHER_NAMES.get(name, (argument(name),))[0]
            self.assertIn(function, simbench.__all__, f"simbench {name}")
        for known in (*NOT_IN_PYTHON, *OTHER_NAMES):
            self.assertIn(known, names, "there is no such command any more")

    def test_every_option_is_an_argument_or_has_a_reason(self):
        seen = set()
        for name in set(commands()) - set(NOT_IN_PYTHON):
            function = getattr(simbench, OTHER_NAMES.get(name, (argument(name),))[0])
            arguments = inspect.signature(function).parameters
            for names in options(name):
                seen.add((name, names[0]))
                if names[0] in OF_EVERY_COMMAND or (name, names[0]) in ELSEWHERE:
                    continue
                with self.subTest(f"simbench {name} --{names[0]}"):
                    self.assertTrue(
                        any(argument(each) in arguments for each in names),
                        f"{function.__name__}() has {', '.join(arguments)}",
                    )
        self.assertGreater(len(seen), 150)
        self.assertLessEqual(set(ELSEWHERE), seen, "there is no such option any more")

    def test_a_missing_option_is_found(self):
        self.assertIn(["rank-by"], list(options("run")))
        self.assertIn(["interval-s", "tau0"], list(options("stability")))
        self.assertEqual(argument("from"), "from_")


if __name__ == "__main__":
    unittest.main()
