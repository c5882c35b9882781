# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
# Types of the module in C++. tests/python/stub_test.py compares names and arguments with it.
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
# By name, or one number for each cable in the robot's order, NaN where nothing is known.
Cables = Mapping[str, float] | ArrayLike | None
CableInput = Literal["displacement", "tension"]
Setting = bool | int | float | str | Sequence[str] | Mapping[str, Any]

class InputError(ValueError):
    """Bad settings, files or data; begins with file:line:column where there is a file."""

class RunError(RuntimeError):
    """Sound input, but the work failed while running."""

class SolveError(RunError):
    """No result that may be used."""

    status: str  # "not_converged", "tension_limit", "inverted", ...
    load_fraction: float  # of the way to the new loads that was reached

class Patch:
    """A point or patch of a robot's body."""

    @property
    def centre_m(self) -> Floats: ...  # [3] at rest
    @property
    def normal(self) -> Floats: ...  # [3] outward; zero of a marker
    @property
    def area_m2(self) -> float: ...  # 0: a point
    @property
    def distance_m(self) -> float: ...  # from what was asked for to the body
    @property
    def nodes(self) -> list[int]: ...
    @property
    def weights(self) -> list[float]: ...

class Load:
    """A dead load: its direction stays as the body moves."""

    def __init__(self, patch: Patch, force_N: ArrayLike) -> None: ...
    @property
    def patch(self) -> Patch: ...
    @property
    def force_N(self) -> Floats: ...  # [3]

class Equilibrium:
    """A static equilibrium of a robot."""

    @property
    def robot(self) -> Robot: ...
    @property
    def positions_m(self) -> Floats: ...  # [nodes, 3]
    @property
    def markers_m(self) -> Floats: ...  # [markers, 3]
    @property
    def tension_N(self) -> Floats: ...  # [cables]
    @property
    def displacement_m(self) -> Floats: ...  # [cables] of the body; slack: more than commanded
    @property
    def length_m(self) -> Floats: ...  # [cables] outside of the actuators
    @property
    def iterations(self) -> int: ...
    @property
    def load_steps(self) -> int: ...
    @property
    def residual_N(self) -> float: ...
    @property
    def residual_relative(self) -> float: ...
    @property
    def time_s(self) -> float: ...  # in C++
    def position_m(self, patch: Patch) -> Floats: ...  # [3]

class Robot:
    """A robot file with its finite-element model. Threads take turns with it."""

    gravity_m_s2: Floats  # [3]; may be set
    def __init__(
        self, robot: str, calibration: str = "", *, solver: str = "multifrontal", threads: int = 1
    ) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def file(self) -> str: ...
    @property
    def mesh_hash(self) -> str: ...
    @property
    def element(self) -> str: ...  # "tet4" | "tet10"
    @property
    def cables(self) -> list[str]: ...
    @property
    def markers(self) -> list[str]: ...
    @property
    def parts(self) -> list[str]: ...  # "body", then the regions
    @property
    def notes(self) -> list[str]: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def rest_m(self) -> Floats: ...  # [nodes, 3]
    @property
    def cells(self) -> Ints: ...  # [cells, 4 or 10]
    @property
    def triangles(self) -> Ints: ...  # [triangles, 3] of the surface, for drawing
    def patch(self, position_m: ArrayLike, radius_m: float = 0.0) -> Patch: ...
    def marker(self, name: str) -> Patch: ...
    def youngs_modulus_Pa(self, part: str = "body") -> float: ...
    # Each part has a modulus of its own, also where the robot file gives regions that of the body.
    # One without elements is refused: that of the body where regions have all of them.
    def set_youngs_modulus(self, part: str, youngs_modulus_Pa: float) -> None: ...
    def poissons_ratio(self, part: str = "body") -> float: ...
    def set_poissons_ratio(self, part: str, poissons_ratio: float) -> None: ...
    def set_drive(self, cable: str, offset_m: float = 0.0, gain: float = 0.0) -> None: ...
    def solve(
        self,
        displacement_m: Cables = None,
        tension_N: Cables = None,
        *,
        air_m3: Cables = None,  # pumped into closed chambers, at ambient pressure; 0: at rest
        loads: Sequence[Load] = (),
        start: Equilibrium | None = None,
        cable_input: CableInput = "displacement",
    ) -> Equilibrium: ...

class Compliance:
    """Compliances about an equilibrium, m/N (paper, eqs. (3)-(5)): e observed coordinates, a
    cables, f force components; x, y and z of each patch."""

    @property
    def W_ea(self) -> Floats: ...
    @property
    def W_ef(self) -> Floats: ...
    @property
    def W_aa(self) -> Floats: ...
    @property
    def W_af(self) -> Floats: ...
    @property
    def delta_e_free_m(self) -> Floats: ...
    @property
    def delta_a_free_m(self) -> Floats: ...

def compliance(
    equilibrium: Equilibrium, *, observed: Sequence[Patch] = (), loaded: Sequence[Patch] = ()
) -> Compliance: ...

class Parameter:
    """What an equilibrium depends on; SI units, robot frame."""

    @property
    def name(self) -> str: ...
    @staticmethod
    def youngs_modulus(part: str = "body") -> Parameter: ...
    @staticmethod
    def poissons_ratio(part: str = "body") -> Parameter: ...
    @staticmethod
    def mass_factor() -> Parameter: ...
    @staticmethod
    def gravity_turn(axis: ArrayLike) -> Parameter: ...
    @staticmethod
    def external_force(patch: Patch, direction: ArrayLike) -> Parameter: ...
    @staticmethod
    def cable_offset(cable: str) -> Parameter: ...
    @staticmethod
    def cable_gain(cable: str) -> Parameter: ...
    @staticmethod
    def tension_offset(cable: str) -> Parameter: ...
    @staticmethod
    def cable_friction(cable: str) -> Parameter: ...
    @staticmethod
    def cable_compliance(cable: str) -> Parameter: ...
    @staticmethod
    def pull_point_move(cable: str, direction: ArrayLike) -> Parameter: ...

class Sensitivity:
    """Exact derivatives of an equilibrium, per unit of each parameter p."""

    @property
    def observed_m(self) -> Floats: ...  # [patches, 3, p]
    @property
    def positions_m(self) -> Floats: ...  # [nodes, 3, p]
    @property
    def length_m(self) -> Floats: ...  # [cables, p]
    @property
    def tension_N(self) -> Floats: ...  # [cables, p]

def sensitivity(
    equilibrium: Equilibrium, parameters: Sequence[Parameter], *, observed: Sequence[Patch] = ()
) -> Sensitivity: ...

class KnownLoad:
    """A known external load of a recording."""

    @property
    def t_s(self) -> float: ...
    @property
    def position_m(self) -> Floats: ...
    @property
    def force_N(self) -> Floats: ...
    @property
    def patch_radius_m(self) -> float: ...

class CameraModel:
    """A pinhole camera with OpenCV's rational lens distortion."""

    @property
    def width_px(self) -> int: ...
    @property
    def height_px(self) -> int: ...
    @property
    def K(self) -> Floats: ...  # [3, 3] px; pixel (0, 0) has its centre at 0, 0
    @property
    def distortion(self) -> Floats: ...  # [5] or [8], in OpenCV's order

class Camera:
    """A depth camera and the colour camera beside it. `keys`: `depth` and `color`, dicts with the
    keys of camera.yaml."""

    def __init__(self, **keys: dict[str, Any]) -> None: ...
    @staticmethod
    def read(file: str) -> Camera: ...
    @property
    def depth(self) -> CameraModel: ...
    @property
    def color(self) -> CameraModel | None: ...
    @property
    def depth_unit_m(self) -> float: ...  # of one step
    @property
    def invalid_value(self) -> int: ...  # step of a pixel without depth
    @property
    def color_registered(self) -> bool: ...  # its pixels are those of the depth image
    @property
    def T_depth_color(self) -> Floats: ...  # [4, 4]

class Recording:
    """A recording; NaN where a marker was not seen or a field is empty."""

    @property
    def name(self) -> str: ...
    @property
    def folder(self) -> str: ...
    @property
    def kind(self) -> str: ...
    @property
    def frame(self) -> str: ...  # "robot" | "camera": of the markers
    @property
    def T_robot_camera(self) -> Floats | None: ...  # [4, 4] of its camera; None: not known
    @property
    def notes(self) -> str: ...
    @property
    def steady_window_s(self) -> tuple[float, float] | None: ...
    @property
    def marker_names(self) -> list[str]: ...
    @property
    def marker_t_s(self) -> Floats: ...  # [frames]
    @property
    def markers_m(self) -> Floats: ...  # [frames, markers, 3] as measured
    @property
    def actuation_t_s(self) -> Floats: ...  # [rows]
    @property
    def displacement_m(self) -> dict[str, Floats]: ...  # by cable, [rows]
    @property
    def tension_N(self) -> dict[str, Floats]: ...
    @property
    def loads(self) -> list[KnownLoad]: ...
    @property
    def depth_images(self) -> list[tuple[float, str]]: ...  # time in s, file
    @property
    def color_images(self) -> list[tuple[float, str]]: ...
    @property
    def clouds(self) -> list[tuple[float, str]]: ...
    @property
    def camera(self) -> Camera: ...  # camera.yaml
    # frame: number in depth_images, color_images or clouds; -1 is the last
    def depth_m(self, frame: int) -> NDArray[np.float32]: ...  # [height, width]; NaN: no depth
    def depth_steps(self, frame: int) -> NDArray[np.uint16]: ...  # as in the file
    def color(self, frame: int) -> NDArray[np.uint8]: ...  # [height, width, 3] RGB
    def cloud_m(self, frame: int) -> Floats: ...  # [points, 3] camera frame; NaN: nothing seen

class Experiment:
    """Measured data: a folder, or recorded messages (MCAP, .db3 of rosbag2, or a folder of them),
    which are made into a temporary experiment. `remap`: "FROM:=TO", as --remap of the programs.
    `robot`: the robot file that says which of the joints are chambers; "": the one in the recording."""

    def __init__(self, data: str, *, remap: Sequence[str] = (), robot: str = "") -> None: ...
    @property
    def folder(self) -> str: ...  # that of messages ends with the experiment and its recordings
    @property
    def messages(self) -> list[str]: ...  # what was made of recorded messages
    @property
    def robot(self) -> str | None: ...  # the robot file that it names
    @property
    def notes(self) -> str: ...
    @property
    def recordings(self) -> list[Recording]: ...
    def recording(self, name: str) -> Recording: ...

class ContactForce:
    """The force of one contact."""

    @property
    def name(self) -> str: ...
    @property
    def status(self) -> str: ...
    @property
    def position_m(self) -> Floats: ...  # [3] on the deformed body
    @property
    def force_N(self) -> Floats: ...  # [3] acts on the robot
    @property
    def covariance_N2(self) -> Floats: ...  # [3, 3]
    @property
    def ci95_N(self) -> float: ...  # half-width of the 95 % interval of its size
    @property
    def location_ci95_m(self) -> float: ...  # 0: the location was given
    @property
    def location_covariance_m2(self) -> Floats: ...  # [3, 3] along the surface

class ForceEstimate:
    """The forces of one frame."""

    @property
    def status(self) -> str: ...
    @property
    def message(self) -> str: ...
    @property
    def usable(self) -> bool: ...  # forces were found, or none act
    @property
    def t_s(self) -> float: ...
    @property
    def contacts(self) -> list[ContactForce]: ...
    @property
    def positions_m(self) -> Floats: ...  # [nodes, 3]
    @property
    def marker_residual_m(self) -> Floats: ...  # [markers, 3] measured - model
    @property
    def tension_N(self) -> Floats: ...  # [cables]
    @property
    def displacement_m(self) -> Floats: ...  # [cables]
    @property
    def residual_rms_m(self) -> float: ...
    @property
    def noise_rms_m(self) -> float: ...
    @property
    def chi_squared(self) -> float: ...
    @property
    def degrees_of_freedom(self) -> int: ...
    @property
    def iterations(self) -> int: ...
    @property
    def time_s(self) -> float: ...  # in C++

class MarkerFrame:
    """What was measured at one time."""

    @property
    def t_s(self) -> float: ...
    @property
    def is_reference(self) -> bool: ...

def marker_frames(
    recording: Recording, robot: Robot, *, cable_input: CableInput = "displacement"
) -> list[MarkerFrame]: ...

class MarkerEstimator:
    """Forces from markers, frame by frame, with a model of its own. `settings`: the keys of
    palpate-force-estimation, such as contacts=["tip: 0, 0, 0.1"], marker_sigma_m=1e-4."""

    def __init__(
        self,
        robot: Robot,
        recording: Recording | None = None,
        **settings: Setting,
    ) -> None: ...
    @property
    def robot(self) -> Robot: ...
    def frame(
        self,
        t_s: float,
        markers_m: ArrayLike,
        displacement_m: Cables = None,
        tension_N: Cables = None,
        *,
        sigma_m: float = 0.0,
        reference: Literal["none", "undeformed", "equilibrium"] = "none",
        cable_input: CableInput = "displacement",
    ) -> MarkerFrame: ...
    def update(self, frame: MarkerFrame) -> ForceEstimate: ...

class ImageEstimator:
    """Forces from the images of one camera, frame by frame, with a model of its own, as
    palpate-perception and palpate-force-estimation find them. `recording`: gives the pose of its
    camera and base, its known loads, and cable inputs where update has none. `settings`: the keys
    of palpate-force-estimation, and dicts `shape` and `perception`."""

    def __init__(
        self,
        robot: Robot,
        camera: Camera,
        T_robot_camera: ArrayLike | None = None,  # [4, 4]; None: the calibration's or recording's
        recording: Recording | None = None,
        *,
        bias_frames: Literal["first", "none"] = "first",  # frames that count as contact-free
        **settings: Setting,
    ) -> None: ...
    @property
    def robot(self) -> Robot: ...
    def expect_posture(
        self,
        t_s: float = 0.0,
        displacement_m: Cables = None,
        tension_N: Cables = None,
        *,
        cable_input: CableInput = "displacement",
    ) -> None: ...  # where the next frame shows the robot: its equilibrium under these inputs
    def update(
        self,
        t_s: float,
        depth_steps: NDArray[np.uint16],  # [height, width] in steps of the camera; copied once
        color: NDArray[np.uint8] | None = None,  # [height, width, 3] RGB
        displacement_m: Cables = None,
        tension_N: Cables = None,
        *,
        contact_free: bool = False,  # the frame counts for the depth bias
        cable_input: CableInput = "displacement",
    ) -> ForceEstimate: ...

class RecordingForces:
    """The forces of a recording."""

    @property
    def recording(self) -> Recording: ...
    @property
    def measurement(self) -> str: ...  # "shape" | "markers"
    @property
    def frames(self) -> list[ForceEstimate]: ...
    @property
    def failure(self) -> str | None: ...  # a recording at rest that has forces: the reasons

def estimate(
    robot: Robot,
    recordings: Sequence[Recording],  # of one experiment
    *,
    measurement: Literal["shape", "markers"] | None = None,  # None: shape where it has images
    bias_frames: Literal["recordings", "first", "none"] = "recordings",
    rate_Hz: float = 0.0,  # largest frame rate; 0: all frames
    cable_input: CableInput = "displacement",
    progress: Callable[[str, int, int], object] | None = None,  # what, frames done, of how many
    note: Callable[[str], object] | None = None,  # what palpate estimate would print
    **settings: Setting,
) -> list[RecordingForces]: ...

class FittedValue:
    """An estimated parameter."""

    @property
    def name(self) -> str: ...
    @property
    def unit(self) -> str: ...
    @property
    def value(self) -> float: ...
    @property
    def prior_mean(self) -> float: ...
    @property
    def standard_error(self) -> float: ...
    @property
    def determined(self) -> bool: ...
    @property
    def what_would_tell(self) -> str: ...

class Calibration:
    """Parameters estimated from markers."""

    @property
    def values(self) -> list[FittedValue]: ...
    @property
    def T_robot_camera(self) -> Floats | None: ...  # [4, 4]; None: not estimated
    @property
    def residual_rms_m(self) -> float: ...
    @property
    def chi_squared(self) -> float: ...
    @property
    def degrees_of_freedom(self) -> int: ...
    @property
    def iterations(self) -> int: ...
    def write(self, file: str) -> None: ...  # for palpate --calibration and Robot

def calibrate(
    robot: Robot,
    recordings: Sequence[Recording],
    *,
    parts: Sequence[str] = (),  # empty: the body, or all regions if they have all its elements
    actuator_offsets: bool = True,
    actuator_gains: bool = False,
    marker_bias_m: float = 0.0,
    cable_input: CableInput = "displacement",
    threads: int = 2,
    progress: Callable[[int], object] | None = None,  # iterations done
) -> Calibration: ...
