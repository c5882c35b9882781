#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Dense decompositions of variable size stand in libs/linalg only, which compiles them once.

In any other source one of them costs 2 s (LLT) to 7 s (JacobiSVD) of compile time."""

import re
import sys

import source_tree
from source_tree import Violation

CLASS = re.compile(
    r"\b(?:LLT|LDLT|PartialPivLU|FullPivLU|(?:ColPiv|FullPiv)?HouseholderQR|JacobiSVD|BDCSVD"
    r"|CompleteOrthogonalDecomposition|(?:Generalized)?(?:SelfAdjoint|Complex)?EigenSolver"
    r"|RealSchur|ComplexSchur|RealQZ|HessenbergDecomposition|Tridiagonalization)\b(.*)")
# Eigen::Matrix3d, an alias such as Matrix6d, Eigen::Matrix<double, 6, 6>.
OF_FIXED_SIZE = re.compile(
    r"<(?:Eigen::)?(?:Matrix[1-9][df]|Matrix<(?:double|float), [1-9]\d*, [1-9]\d*>)[,>]")
METHOD = re.compile(
    r"(?:\.|->)(llt|ldlt|lu|partialPivLu|fullPivLu|householderQr|colPivHouseholderQr"
    r"|fullPivHouseholderQr|completeOrthogonalDecomposition|jacobiSvd|bdcSvd|operatorNorm)\(")
DYNAMIC = re.compile(r"\bMatrixX[df][&*]? (\w+)\b")
# Eigen finds these of a matrix of variable size by PartialPivLU.
BY_LU = re.compile(r"(?:\b(\w+)|\bMatrixX[df]\(.*\))\.(inverse|determinant)\(\)")
COMMENT = re.compile(r"//.*")


def check_line(line, dynamic):
    """The rule that a line breaks, or ""; `dynamic`: names of matrices of variable size."""
    for match in CLASS.finditer(line):
        if not OF_FIXED_SIZE.match(match[1]):
            return "a decomposition of variable size: use libs/linalg"
    match = METHOD.search(line)
    if match:
        return (f"the size does not show in .{match[1]}(): use libs/linalg or, for a fixed size, "
                "the class with its type, e.g. Eigen::LDLT<Eigen::Matrix4d>(A)")
    for match in BY_LU.finditer(line):
        if match[1] is None or match[1] in dynamic:
            return f".{match[2]}() of variable size: use libs/linalg"
    return ""


def check_tree(root):
    sources = [path for path in source_tree.list_files(root)
               if path.suffix in source_tree.CPP_SUFFIXES
               and not path.as_posix().startswith("libs/linalg/")]
    violations = []
    for path in sources:
        lines = [COMMENT.sub("", line) for line in source_tree.read_lines(root / path)]
        dynamic = {name for line in lines for name in DYNAMIC.findall(line)}
        for number, line in enumerate(lines, start=1):
            rule = check_line(line, dynamic)
            if rule:
                violations.append(Violation(path.as_posix(), number, rule))
    return violations, len(sources)


def main():
    arguments = source_tree.parse_root(__doc__).parse_args()
    return source_tree.report("check_decompositions", *check_tree(arguments.root))


if __name__ == "__main__":
    sys.exit(main())
