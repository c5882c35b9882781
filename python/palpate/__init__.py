# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Finite-element models of soft robots, and forces on them from measured markers.

SI units, robot frame; names end in their unit. Points are arrays of shape (n, 3). Arrays that an
object hands out are read-only views of its memory.
"""

from palpate._engine import (
    Calibration,
    Camera,
    CameraModel,
    Compliance,
    ContactForce,
    Equilibrium,
    Experiment,
    FittedValue,
    ForceEstimate,
    InputError,
    KnownLoad,
    Load,
    MarkerEstimator,
    MarkerFrame,
    Parameter,
    Patch,
    Recording,
    Robot,
    RunError,
    Sensitivity,
    SolveError,
    __version__,
    calibrate,
    compliance,
    marker_frames,
    sensitivity,
)

__all__ = [
    "Calibration",
    "Camera",
    "CameraModel",
    "Compliance",
    "ContactForce",
    "Equilibrium",
    "Experiment",
    "FittedValue",
    "ForceEstimate",
    "InputError",
    "KnownLoad",
    "Load",
    "MarkerEstimator",
    "MarkerFrame",
    "Parameter",
    "Patch",
    "Recording",
    "Robot",
    "RunError",
    "Sensitivity",
    "SolveError",
    "__version__",
    "calibrate",
    "compliance",
    "marker_frames",
    "sensitivity",
]
