// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/support/sensing/sensing_chain.hpp"

#include <utility>

#include "components/perception/predicted_surface.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"

namespace palpate::test_support {

namespace {

constexpr double kSeenRadius_m = 0.010;
constexpr int kStepsToPosture = 4;
constexpr int kContactsAtOnce = 2;

force_estimation::Config WithTwoContacts(force_estimation::Config config) {
  config.max_contacts = kContactsAtOnce;
  return config;
}

}  // namespace

SensingChain::SensingChain(const robot::RobotDescription& robot, SensingScene& scene,
                           const ChainSettings& settings, std::uint64_t seed)
    : scene_{scene},
      settings_{settings},
      model_{robot::BuildRobotBody(robot)},
      estimator_{model_, WithTwoContacts(settings.config), settings.shape},
      ideal_{scene},
      perception_{settings.perception},
      sight_{scene},
      random_{seed, "sensing chain"} {
  perception_.SetCamera(scene.camera());
}

void SensingChain::Learn(int frames, int postures, double largest_cable_m) {
  scenario::BenchInputs inputs = scene_.Nothing();
  if (!scene_.Start(inputs).ok()) throw RunError("the virtual robot does not hang");
  const int each = frames / (postures + 1);
  for (int k = each * postures; k < frames; ++k) Take(true);
  for (int posture = 0; posture <= postures; ++posture) {
    const Eigen::VectorXd from_m = inputs.displacement_m;
    Eigen::VectorXd to_m = Eigen::VectorXd::Zero(from_m.size());
    if (posture < postures) {
      for (double& cable_m : to_m) cable_m = largest_cable_m * random_.Uniform();
    }
    for (int step = 1; step <= kStepsToPosture && to_m != from_m; ++step) {
      inputs.displacement_m = from_m + (to_m - from_m) * step / kStepsToPosture;
      if (!scene_.Go(inputs).ok()) throw RunError("the virtual robot does not follow its cables");
    }
    for (int k = 0; k < each && posture < postures; ++k) Take(true);
  }
}

std::vector<force_estimation::SeenContact> SensingChain::IdealContacts() {
  const std::map<std::string, Eigen::Vector3d> before_m = std::move(location_error_m_);
  location_error_m_.clear();
  const auto error_m = [&](const std::string& tool) -> Eigen::Vector3d {
    const auto known = before_m.find(tool);
    const Eigen::Vector3d new_m(random_.Normal(), random_.Normal(), random_.Normal());
    const Eigen::Vector3d is_m =
        known != before_m.end() ? known->second : settings_.location_sigma_m * new_m;
    location_error_m_[tool] = is_m;
    return is_m;
  };
  std::vector<force_estimation::SeenContact> all =
      ideal_.Contacts(settings_.location_sigma_m, error_m, settings_.weights_given);
  if (all.empty() || settings_.weights_given) return all;
  sight_.Look();
  std::vector<force_estimation::SeenContact> seen;
  for (force_estimation::SeenContact& contact : all) {
    const double share = sight_.SeenShare(contact.position_m, kSeenRadius_m);
    if (share >= settings_.seen_share) seen.push_back(std::move(contact));
  }
  return seen;
}

/// As palpate-perception and what converts between the processes do.
force_estimation::ShapeFrame SensingChain::Perceive() {
  const rgbd::RgbdFrame* images = &scene_.frame();
  if (faults_.images) {
    faulty_ = *images;
    faults_.images(&faulty_);
    images = &faulty_;
  }
  const perception::Observation& seen =
      perception_.Update(*images, has_prediction_ ? &prediction_ : nullptr);
  force_estimation::ShapeFrame frame;
  frame.cloud = seen.frame.robot;
  frame.T_robot_camera = scene_.T_robot_camera();
  for (const perception::DetectedContact& contact : seen.contacts) {
    frame.contacts.push_back(
        force_estimation::InRobotFrame({contact.name, contact.position_m, contact.covariance_m2,
                                        contact.extent_m, contact.point_count},
                                       frame.T_robot_camera));
  }
  return frame;
}

void SensingChain::Open() {
  ++epoch_;
  perception_.SetCamera(scene_.camera());
}

const force_estimation::ForceEstimate& SensingChain::Take(bool untouched) {
  scene_.TakeFrame();
  if (settings_.eyes == ChainSettings::Eyes::kIdeal) {
    frame_ = ideal_.Frame(IdealContacts());
  } else {
    frame_ = Perceive();
  }
  frame_.t_s = NsToSeconds(scene_.frame().stamp_ns);
  frame_.cables = scene_.Cables();
  if (faults_.cables) faults_.cables(&frame_.cables);
  frame_.untouched = untouched;
  frame_.epoch = epoch_;
  const force_estimation::ForceEstimate& estimate = estimator_.Update(frame_);
  estimator_.PrepareNext();
  if (force_estimation::PredictsShape(estimate)) {
    has_prediction_ = true;
    prediction_ = perception::MakePredictedSurface(
        Eigen::Map<const Eigen::Matrix3Xd>(estimate.x_m.data(), 3, estimate.x_m.size() / 3)
            .cast<float>(),
        model_.body().boundary.DrawnTriangles(), frame_.T_robot_camera);
  }
  return estimate;
}

}  // namespace palpate::test_support
