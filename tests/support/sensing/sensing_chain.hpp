// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/force_estimation/shape/shape_force_estimator.hpp"
#include "components/perception/joint_perception.hpp"
#include "libs/robot/robot_model.hpp"
#include "libs/scenario/random.hpp"
#include "tests/support/sensing/ideal_perception.hpp"
#include "tests/support/sensing/scene_sight.hpp"
#include "tests/support/sensing/sensing_scene.hpp"

namespace palpate::test_support {

struct ChainSettings {
  /// Who looks at the frames.
  enum class Eyes { kIdeal, kPerception };

  Eyes eyes = Eyes::kIdeal;
  std::size_t cameras = 1;  ///< the first ones of the scene, that are used
  force_estimation::Config config = {};
  force_estimation::ShapeConfig shape = {};
  perception::Config perception = {};
  /// Error of the places of ideal contacts along each axis; drawn when a tool comes, kept as long
  /// as it touches.
  double location_sigma_m = 1.5e-3;
  /// Contacts of which every camera sees less (SceneSight, within 10 mm) have no SeenContact.
  double seen_share = 0.3;
  /// Contacts are given for hung weights, too, wherever the camera is.
  bool weights_given = false;
};

/// What goes wrong on the way to our own perception and to the estimator; empty: nothing.
struct ChainFaults {
  std::function<void(rgbd::RgbdFrame*)> images;  ///< of the first camera
  /// Whether the camera of this number has no image now.
  std::function<bool(std::size_t camera)> is_missing = {};
  std::function<void(std::vector<robot::ActuatorCommand>*)> cables;
};

/// From the cameras' frames of a scene to forces: the robot file's model, which knows nothing of
/// the scene's, behind ideal perception or our own, which is fed with the last predicted surface.
class SensingChain {
 public:
  SensingChain(const robot::RobotDescription& robot, SensingScene& scene,
               const ChainSettings& settings, std::uint64_t seed);

  /// Contact-free frames: at the scene's commands zero, then at `postures`
  /// others, with each actuator commanded by 0 to `largest_command`, of a cable m, of a chamber Pa.
  /// The scene ends at zero.
  void Learn(int frames, int postures = 0, double largest_command = 0.0);

  /// The camera is opened again, as for another recording: contacts are unknown.
  void Open();

  /// Takes a frame of the scene as it is. The estimate holds until the next call.
  const force_estimation::ForceEstimate& Take(bool untouched = false);

  void SetFaults(ChainFaults faults) { faults_ = std::move(faults); }
  /// What our own perception believes of the only camera from now on, be it right or not.
  void TellCamera(const rgbd::RgbdCamera& camera) { perception_.Open({camera}); }

  force_estimation::ShapeForceEstimator& estimator() { return estimator_; }
  /// What the estimator was given last.
  const force_estimation::ShapeFrame& frame() const { return frame_; }
  robot::RobotModel& model() { return model_; }

 private:
  std::vector<force_estimation::SeenContact> IdealContacts();
  force_estimation::ShapeFrame Perceive();
  force_estimation::ShapeFrame PerceiveIdeally();
  bool IsMissing(std::size_t camera) const {
    return faults_.is_missing && faults_.is_missing(camera);
  }
  std::vector<std::optional<rgbd::RgbdCamera>> Cameras() const;

  SensingScene& scene_;
  ChainSettings settings_;
  robot::RobotModel model_;
  force_estimation::ShapeForceEstimator estimator_;
  std::vector<IdealPerception> ideal_;  ///< of each camera, as sight_
  perception::JointPerception perception_;
  std::uint32_t epoch_ = 0;
  Eigen::Matrix3Xf predicted_nodes_m_;  ///< [3 x nodes] robot frame; no columns: unknown
  std::vector<SceneSight> sight_;
  scenario::Random random_;
  std::map<std::string, Eigen::Vector3d> location_error_m_;  ///< of the tools that touch
  force_estimation::ShapeFrame frame_;
  ChainFaults faults_;
  rgbd::RgbdFrame faulty_;
};

}  // namespace palpate::test_support
