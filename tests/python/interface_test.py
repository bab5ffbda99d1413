"""The public interface: annotated in full, and the stub has what the module has."""

import ast
import inspect
import os
import unittest

import command
import simbench

STUB = os.path.join(command.SOURCE, "python/simbench/_simbench.pyi")


def functions_of(thing):
    """A function, or the public methods of a class."""
    if inspect.isfunction(thing):
        yield thing
    elif inspect.isclass(thing) and thing.__module__.startswith("simbench."):
        for name, member in vars(thing).items():
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
