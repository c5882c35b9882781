#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""The typed stub names what the module has, with the arguments and defaults that it takes."""

import ast
import pathlib
import re
import unittest

import palpate
from palpate import _engine

STUB = ast.parse(pathlib.Path(palpate.__file__).with_name("_engine.pyi").read_text("utf-8"))
TYPES_ONLY = {"Floats", "Ints", "Cables", "CableInput", "Setting"}


def public(names):
    return {name for name in names if not name.startswith("_")}


def defined(body):
    """Names to nodes: functions, classes and annotated variables."""
    found = {}
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            found[node.name] = node
        elif isinstance(node, ast.AnnAssign):
            found[node.target.id] = node
    return found


def arguments_of(function):
    names = [argument.arg for argument in function.args.args + function.args.kwonlyargs]
    return [name for name in names if name != "self"]


def runtime_arguments(function):
    """From pybind11's text "name(self: X, a: int, *, b: float = 0.0) -> Y"."""
    text = re.sub(r"<[^>]*>", "object", function.__doc__.splitlines()[0])
    inside = text[text.index("(") + 1:text.rindex(")")]
    return [name for name in re.findall(r"(?:^|[(,] ?)(\w+): ", inside) if name != "self"]


class Stub(unittest.TestCase):
    def test_has_the_names_of_the_module(self):
        names = set(defined(STUB.body)) - TYPES_ONLY
        self.assertEqual(public(names), public(vars(_engine)))
        self.assertEqual(public(palpate.__all__), public(names))

    def test_has_the_members_of_each_class(self):
        for name, node in defined(STUB.body).items():
            if not isinstance(node, ast.ClassDef):
                continue
            with self.subTest(name):
                self.assertEqual(public(defined(node.body)), public(vars(getattr(_engine, name))))

    def test_functions_take_the_arguments_of_the_stub(self):
        compared = 0
        for owner, body in [(_engine, STUB.body)] + [
                (getattr(_engine, name), node.body) for name, node in defined(STUB.body).items()
                if isinstance(node, ast.ClassDef)]:
            for name, node in defined(body).items():
                if not isinstance(node, ast.FunctionDef) or any(
                        ast.unparse(one) == "property" for one in node.decorator_list):
                    continue
                with self.subTest(f"{owner.__name__}.{name}"):
                    self.assertEqual(arguments_of(node),
                                     runtime_arguments(getattr(owner, name)))
                    compared += 1
        self.assertGreater(compared, 25)


if __name__ == "__main__":
    unittest.main()
