#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Forces from images, of recordings and frame by frame: bit for bit those of `palpate estimate`."""

import pathlib
import tempfile
import unittest

import numpy as np
import palpate
from bag import camera_info, image, transform, write_db3
from project import FOUR_LEG, SOURCE, read_table, run_palpate

# A ball against the hub's flank that the camera sees, after a rest.
SCENARIO = f"""name: push
body: {{mesh_file: {SOURCE}/config/scenarios/four_leg_coarse.msh, refine: 0, element: tet10,
       material: {{youngs_modulus_Pa: 98.0e3}}}}
motion: {{mode: quasi_static, time_step_s: 0.1}}
clutter: 0
tools: [{{name: ball, shape: sphere, radius_m: 0.010, friction_coefficient: 0.3,
         color_rgb: [0.15, 0.30, 0.80]}}]
camera:
  depth: {{width_px: 424, height_px: 240, fx_px: 212.5, fy_px: 212.5, cx_px: 211.5, cy_px: 119.5,
          unit_m: 0.0001, baseline_m: 0.1}}
  color: {{width_px: 424, height_px: 240, fx_px: 212.5, fy_px: 212.5, cx_px: 211.5, cy_px: 119.5,
          registered_to_depth: true}}
  eye_m: [0.343, -0.198, 0.275]
  target_m: [0, 0, 0.065]
  rate_hz: 10
  noise: {{sensor: stereo}}
rest_between_s: 0.5
recordings:
  - {{name: a_rest, kind: rest, duration_s: 0.5}}
  - name: b_push
    kind: free
    duration_s: 1.0
    tools:
      - tool: ball
        path:
          - {{t_s: 0, position_m: [0.0400, -0.0400, 0.103]}}
          - {{t_s: 0.7, position_m: [0.0220, -0.0220, 0.103]}}
          - {{t_s: 1.0, position_m: [0.0220, -0.0220, 0.103]}}
"""


class OfASimulatedPush(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.folder.name)
        (cls.root / "push.yaml").write_text(SCENARIO)
        cls.data = str(cls.root / "data")
        run_palpate("simulate", FOUR_LEG, "--scenario", cls.root / "push.yaml", "--seed", "7",
                    "--out", cls.data, "--tell-camera-pose")
        cls.robot = palpate.Robot(FOUR_LEG)
        cls.experiment = palpate.Experiment(cls.data)
        cls.push = cls.experiment.recording("b_push")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def rows_of_program(self, data, *options):
        table = self.root / "forces.csv"
        said = run_palpate("estimate", FOUR_LEG, "--data", data, "--out", table, *options,
                           allowed=(0, 1))
        return read_table(table), said

    def assert_same(self, rows, estimates):
        """Rows of forces.csv, and of the same frames what Python has."""
        compared = 0
        for estimate in estimates:
            of_frame = [row for row in rows if float(row["t_s"]) == estimate.t_s]
            self.assertTrue(of_frame, estimate.t_s)
            if not estimate.contacts:
                self.assertEqual(of_frame[0]["status"], estimate.status)
            for row, contact in zip(of_frame, estimate.contacts):
                self.assertEqual((row["contact"], row["status"]), (contact.name, contact.status))
                if not row["fx_N"]:
                    continue
                for columns, values in (("fx_N fy_N fz_N", contact.force_N),
                                        ("x_m y_m z_m", contact.position_m)):
                    np.testing.assert_array_equal([float(row[one]) for one in columns.split()],
                                                  values)
                self.assertEqual(float(row["ci95_N"]), contact.ci95_N)
                compared += 1
        return compared

    def test_recordings_have_the_forces_of_the_program_to_the_last_bit(self):
        rows, said = self.rows_of_program(self.data)
        notes, progress = [], []
        found = palpate.estimate(self.robot, self.experiment.recordings, note=notes.append,
                                 progress=lambda *numbers: progress.append(numbers))
        self.assertEqual([one.recording.name for one in found], ["a_rest", "b_push"])
        self.assertEqual([one.measurement for one in found], ["shape", "shape"])
        self.assertEqual([one.failure for one in found], [None, None])
        of_push = [row for row in rows if row["recording"] == "b_push"]
        self.assertGreater(self.assert_same(of_push, found[1].frames), 2)
        self.assert_same([row for row in rows if row["recording"] == "a_rest"], found[0].frames)
        for note in notes:
            self.assertIn(note, said)
        self.assertTrue(any("depth bias" in note for note in notes), notes)
        last = len(found[1].frames)
        self.assertEqual(progress[-1], ("b_push", last, last))

    def test_frames_of_arrays_have_the_forces_of_the_process_to_the_last_bit(self):
        rows, _ = self.rows_of_program(self.data, "--bias-frames", "first", "--recording", "b_push",
                                       "--set", "shape.untouched_frames=2")
        estimator = palpate.ImageEstimator(self.robot, self.push.camera, recording=self.push,
                                           shape={"untouched_frames": 2})
        estimates = [
            estimator.update(t_s, self.push.depth_steps(k), self.push.color(k))
            for k, (t_s, _) in enumerate(self.push.depth_images)]
        self.assertGreater(self.assert_same(rows, estimates), 2)

    def test_poses_and_inputs_may_be_given_as_numbers(self):
        camera = palpate.Camera.read(str(pathlib.Path(self.push.folder, "camera.yaml")))
        by_file = palpate.ImageEstimator(self.robot, camera, recording=self.push)
        found = palpate.ImageEstimator(self.robot, camera, self.push.T_robot_camera)
        inputs = {name: values[0] for name, values in self.push.displacement_m.items()}
        t_s, _ = self.push.depth_images[0]
        by_file.expect_posture(t_s)
        found.expect_posture(t_s, inputs)
        one = by_file.update(t_s, self.push.depth_steps(0), self.push.color(0))
        other = found.update(t_s, self.push.depth_steps(0), self.push.color(0), inputs)
        self.assertEqual(one.status, other.status)
        np.testing.assert_allclose(one.positions_m, other.positions_m, atol=1e-6)

    def test_an_array_with_gaps_is_taken_as_it_is(self):
        t_s, _ = self.push.depth_images[-1]
        steps = self.push.depth_steps(-1)
        wide = np.zeros((steps.shape[0], 2 * steps.shape[1]), np.uint16)
        wide[:, ::2] = steps
        found = []
        for array in (steps, wide[:, ::2]):
            estimator = palpate.ImageEstimator(self.robot, self.push.camera, recording=self.push)
            found.append(estimator.update(t_s, array, self.push.color(-1)))
        np.testing.assert_array_equal(found[0].positions_m, found[1].positions_m)

    def test_what_is_no_image_of_the_camera_is_refused(self):
        estimator = palpate.ImageEstimator(self.robot, self.push.camera, recording=self.push)
        steps, color = self.push.depth_steps(0), self.push.color(0)
        for arrays, words in (
            ((self.push.depth_m(0), color), "depth_steps must be an array of uint16"),
            ((steps.astype(np.int32), color), "of the shape \\(240, 424\\)"),
            ((steps[:-1], color), "as its camera says"),
            ((steps, color[:, :, :2]), "color must be an array of uint8 of the shape"),
        ):
            with self.assertRaisesRegex(palpate.InputError, words):
                estimator.update(0.0, *arrays)
        with self.assertRaisesRegex(palpate.InputError, "camera pose is not known"):
            palpate.ImageEstimator(self.robot, self.push.camera)
        with self.assertRaisesRegex(palpate.InputError, "T_robot_camera is no pose"):
            palpate.ImageEstimator(self.robot, self.push.camera, np.ones((4, 4)))
        with self.assertRaisesRegex(palpate.InputError, "did you mean 'significance'"):
            palpate.ImageEstimator(self.robot, self.push.camera, recording=self.push,
                                   shape={"significanse": 1e-3})
        with self.assertRaisesRegex(palpate.InputError, "bias_frames is 'last'"):
            palpate.estimate(self.robot, [self.push], bias_frames="last")
        with self.assertRaisesRegex(palpate.InputError, "the recording has no markers"):
            palpate.estimate(self.robot, [self.push], measurement="markers")

    def test_what_progress_raises_ends_the_work(self):
        def stop(what, done, total):
            raise KeyboardInterrupt(f"{what}: {done} of {total}")

        with self.assertRaisesRegex(KeyboardInterrupt, "0 of"):
            palpate.estimate(self.robot, self.experiment.recordings, progress=stop)

    def test_messages_of_ros_have_the_forces_of_the_program(self):
        camera, frame = self.push.camera, "camera_optical_frame"
        pose = self.push.T_robot_camera
        messages = [("/tf_static", "tf2_msgs/msg/TFMessage", 10**9,
                     transform("robot", frame, pose[:3, 3], quaternion_of(pose[:3, :3])))]
        for k, (t_s, _) in enumerate(self.push.depth_images):
            t_ns = 10**9 + round(1e9 * t_s)
            for topic, kind, cdr in (
                ("/camera/depth/camera_info", "CameraInfo", camera_info(t_ns, frame, camera.depth)),
                ("/camera/depth/image_raw", "Image",
                 image(t_ns, frame, (self.push.depth_steps(k) // 10).astype("<u2"), "16UC1")),
                ("/camera/color/camera_info", "CameraInfo", camera_info(t_ns, frame, camera.color)),
                ("/camera/color/image_raw", "Image",
                 image(t_ns, frame, self.push.color(k), "rgb8")),
            ):
                messages.append((topic, f"sensor_msgs/msg/{kind}", t_ns, cdr))
        bag = self.root / "bag.db3"
        write_db3(bag, messages)
        with self.assertRaisesRegex(palpate.InputError, "remap means nothing"):
            palpate.Experiment(self.data, remap=["/a:=/b"])
        with self.assertRaisesRegex(palpate.InputError, "holds no depth images"):
            palpate.Experiment(str(bag), remap=["/camera/depth/image_raw:=/none"])

        experiment = palpate.Experiment(str(bag))
        recording, = experiment.recordings
        self.assertEqual(len(recording.depth_images), len(self.push.depth_images))
        np.testing.assert_array_equal(recording.depth_steps(3), self.push.depth_steps(3) // 10)
        np.testing.assert_array_equal(recording.camera.depth.K, camera.depth.K)
        rows, said = self.rows_of_program(str(bag))
        for note in experiment.messages:
            self.assertIn(note, said)
        found, = palpate.estimate(self.robot, [recording])
        self.assertGreater(self.assert_same(rows, found.frames), 2)

        temporary = pathlib.Path(experiment.folder)
        self.assertTrue(temporary.is_dir())
        del experiment, recording, found
        self.assertFalse(temporary.exists())


def quaternion_of(R):
    """x, y, z, w of a rotation matrix."""
    values, vectors = np.linalg.eigh(np.array([
        [R[0, 0] - R[1, 1] - R[2, 2], 0, 0, 0],
        [R[0, 1] + R[1, 0], R[1, 1] - R[0, 0] - R[2, 2], 0, 0],
        [R[0, 2] + R[2, 0], R[1, 2] + R[2, 1], R[2, 2] - R[0, 0] - R[1, 1], 0],
        [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], np.trace(R)]]))
    return vectors[:, np.argmax(values)]


if __name__ == "__main__":
    unittest.main()
