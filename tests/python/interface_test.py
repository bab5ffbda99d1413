"""The public interface: annotated in full, and the stub has what the module has."""

import ast
import inspect
import os
import re
import unittest

import command
import simbench

STUB = os.path.join(command.SOURCE, "python/simbench/_simbench.pyi")


def functions_of(thing):
    """A function, or the public methods of a class, inherited ones too."""
    if inspect.isfunction(thing):
        yield thing
    elif inspect.isclass(thing) and thing.__module__.startswith("simbench."):
        for name, member in inspect.getmembers(thing):
            function = member.fget if isinstance(member, property) else member
            if inspect.isfunction(function) and not name.startswith("_"):
                yield function


class InterfaceTest(unittest.TestCase):
    def test_everything_public_exists_and_explains_itself(self):
        for name in simbench.__all__:
            self.assertTrue(getattr(simbench, name).__doc__, name)

    def test_runs_and_results_are_annotated(self):
        checked = 0
        for name in simbench.__all__:
            for function in functions_of(getattr(simbench, name)):
                if function.__module__ in ("simbench.algorithms", "simbench.host"):
                    continue
                signature = inspect.signature(function)
                self.assertIsNot(signature.return_annotation, inspect.Signature.empty, function)
                for parameter in signature.parameters.values():
                    if parameter.name != "self":
                        self.assertIsNot(
                            parameter.annotation, inspect.Parameter.empty, (function, parameter)
                        )
                checked += 1
        self.assertGreater(checked, 40)

    def test_everything_explains_itself_and_its_arguments(self):
        checked = 0
        for name in simbench.__all__:
            thing = getattr(simbench, name)
            for function in functions_of(thing):
                text = inspect.getdoc(function) or ""
                self.assertTrue(text, f"{name}: {function.__qualname__} explains nothing")
                arguments = [each for each in inspect.signature(function).parameters
                             if each != "self"]
                if not inspect.isfunction(thing):
                    arguments = [each for each in arguments if each not in ("path", "folder")]
                for each in arguments:
                    self.assertRegex(text, rf"\b{each}\b", f"{function.__qualname__}: {each}")
                checked += 1
        self.assertGreater(checked, 120)

    def test_quantities_have_units(self):
        """A number of Python says its unit: in its name, or in its explanation."""
        units = r"\b(ms|s|us|ns|ppm|seconds?|percent|share|without a unit|no unit|frames a second)\b"
        quantities = re.compile(r"(interval|tau|rate|bound|duration|until|from)_?$|_(ms|s|hz|us)$")
        checked = 0
        for name in simbench.__all__:
            thing = getattr(simbench, name)
            if inspect.isclass(thing):
                continue
            for each in inspect.signature(thing).parameters:
                if not quantities.search(each):
                    continue
                if not re.search(r"_(ms|s|hz|us)$", each):
                    self.assertRegex(inspect.getdoc(thing), units, f"{name}: {each}")
                checked += 1
        self.assertGreater(checked, 6)

    def test_the_stub_has_what_the_module_has(self):
        with open(STUB, encoding="utf-8") as file:
            tree = ast.parse(file.read())
        module = simbench._simbench
        stated = {}
        for node in tree.body:
            if isinstance(node, ast.FunctionDef):
                stated[node.name] = set()
            elif isinstance(node, ast.ClassDef):
                names = (
                    each.name if isinstance(each, ast.FunctionDef) else each.target.id
                    for each in node.body
                    if isinstance(each, (ast.FunctionDef, ast.AnnAssign))
                )
                stated[node.name] = {name for name in names if not name.startswith("_")}
        there = {name for name in vars(module) if not name.startswith("_")}
        self.assertEqual(there - {"version", "commit"}, set(stated))
        for name, members in stated.items():
            thing = getattr(module, name)
            if inspect.isclass(thing):
                public = {member for member in vars(thing) if not member.startswith("_")}
                self.assertEqual(public, members, name)


if __name__ == "__main__":
    unittest.main()
