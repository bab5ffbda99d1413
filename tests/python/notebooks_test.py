"""Every notebook of examples/ runs from its first cell to its last; none has outputs committed."""

import ast
import glob
import json
import os
import tempfile
import unittest
import warnings

import command

FOLDER = os.path.join(command.SOURCE, "examples")


def show(value):
    """What a notebook does with the last expression of a cell."""
    if value is None:
        return
    html = getattr(value, "_repr_html_", None)
    shown = html() if html is not None else None
    if shown is None:
        shown = repr(value)
    assert shown


def run_cell(source, name, variables):
    tree = ast.parse(source, name)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, name, "exec"), variables)
    if last is not None:
        show(eval(compile(ast.Expression(last.value), name, "eval"), variables))


class NotebooksTest(unittest.TestCase):
    def test_every_notebook_runs(self):
        notebooks = sorted(glob.glob(os.path.join(FOLDER, "*.ipynb")))
        self.assertTrue(notebooks)
        for path in notebooks:
            with self.subTest(path), tempfile.TemporaryDirectory() as folder:
                with open(path, encoding="utf-8") as file:
                    cells = json.load(file)["cells"]
                back = os.getcwd()
                os.chdir(folder)  # what it writes is gone afterwards
                try:
                    variables = {"__name__": "__main__", "EXAMPLES": FOLDER}
                    with warnings.catch_warnings():
                        warnings.simplefilter("ignore")
                        for number, cell in enumerate(cells, 1):
                            if cell["cell_type"] != "code":
                                continue
                            self.assertEqual(cell["outputs"], [], f"{path}: cell {number}")
                            name = f"{os.path.basename(path)}:{number}"
                            run_cell("".join(cell["source"]), name, variables)
                finally:
                    os.chdir(back)


if __name__ == "__main__":
    unittest.main()
