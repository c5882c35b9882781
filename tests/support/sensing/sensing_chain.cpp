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
      perception_{settings.perception},
      random_{seed, "sensing chain"} {
  for (std::size_t k = 0; k < settings_.cameras; ++k) {
    ideal_.emplace_back(scene, k);
    sight_.emplace_back(scene, k);
  }
  perception_.Open(Cameras());
}

std::vector<std::optional<rgbd::RgbdCamera>> SensingChain::Cameras() const {
  std::vector<std::optional<rgbd::RgbdCamera>> cameras;
  for (std::size_t k = 0; k < settings_.cameras; ++k) cameras.emplace_back(scene_.camera(k));
  return cameras;
}

void SensingChain::Learn(int frames, int postures, double largest_command) {
  scenario::BenchInputs inputs = scene_.Nothing();
  if (!scene_.Start(inputs).ok()) throw RunError("the virtual robot does not hang");
  const int each = frames / (postures + 1);
  for (int k = each * postures; k < frames; ++k) Take(true);
  for (int posture = 0; posture <= postures; ++posture) {
    const Eigen::VectorXd from_m = inputs.displacement_m;
    Eigen::VectorXd to_m = Eigen::VectorXd::Zero(from_m.size());
    if (posture < postures) {
      for (double& cable_m : to_m) cable_m = largest_command * random_.Uniform();
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
      ideal_[0].Contacts(settings_.location_sigma_m, error_m, settings_.weights_given);
  if (all.empty() || settings_.weights_given) return all;
  std::vector<char> is_seen(all.size(), 0);
  for (std::size_t k = 0; k < sight_.size(); ++k) {
    if (IsMissing(k)) continue;
    sight_[k].Look();
    for (std::size_t c = 0; c < all.size(); ++c) {
      const double share = sight_[k].SeenShare(all[c].position_m, kSeenRadius_m);
      if (share >= settings_.seen_share) is_seen[c] = 1;
    }
  }
  std::vector<force_estimation::SeenContact> seen;
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (is_seen[c] != 0) seen.push_back(std::move(all[c]));
  }
  return seen;
}

force_estimation::ShapeFrame SensingChain::PerceiveIdeally() {
  force_estimation::ShapeFrame frame;
  frame.contacts = IdealContacts();
  frame.views.clear();
  for (std::size_t k = 0; k < ideal_.size(); ++k) {
    frame.views.push_back({{}, scene_.T_robot_camera(k)});
    if (!IsMissing(k)) frame.views[k] = ideal_[k].View();
  }
  return frame;
}

/// As palpate-perception and what converts between the processes do.
force_estimation::ShapeFrame SensingChain::Perceive() {
  const Eigen::Matrix3Xi& triangles = model_.body().boundary.DrawnTriangles();
  std::vector<perception::PredictedSurface> predicted(settings_.cameras);
  std::vector<perception::CameraFrame> images(settings_.cameras);
  for (std::size_t k = 0; k < images.size(); ++k) {
    images[k].T_robot_camera = scene_.T_robot_camera(k);
    if (!IsMissing(k)) images[k].images = &scene_.frame(k);
    if (predicted_nodes_m_.cols() == 0) continue;
    predicted[k] =
        perception::MakePredictedSurface(predicted_nodes_m_, triangles, scene_.T_robot_camera(k));
    images[k].predicted = &predicted[k];
  }
  if (faults_.images) {
    faulty_ = scene_.frame();
    faults_.images(&faulty_);
    images[0].images = &faulty_;
  }
  const perception::JointObservation& seen = perception_.Update(scene_.frame().stamp_ns, images);
  force_estimation::ShapeFrame frame;
  frame.views.clear();
  for (std::size_t k = 0; k < images.size(); ++k) {
    frame.views.push_back(
        {seen.views[k].frame.robot, scene_.T_robot_camera(k), seen.views[k].texture});
  }
  for (const perception::DetectedContact& contact : seen.contacts) {
    frame.contacts.push_back(
        force_estimation::InRobotFrame({contact.name, contact.position_m, contact.covariance_m2,
                                        contact.extent_m, contact.point_count},
                                       scene_.T_robot_camera()));
  }
  return frame;
}

void SensingChain::Open() {
  ++epoch_;
  perception_.Open(Cameras());
}

const force_estimation::ForceEstimate& SensingChain::Take(bool untouched) {
  scene_.TakeFrame(settings_.cameras);
  frame_ = settings_.eyes == ChainSettings::Eyes::kIdeal ? PerceiveIdeally() : Perceive();
  frame_.t_s = NsToSeconds(scene_.frame().stamp_ns);
  frame_.cables = scene_.Cables();
  if (faults_.cables) faults_.cables(&frame_.cables);
  frame_.untouched = untouched;
  frame_.epoch = epoch_;
  const force_estimation::ForceEstimate& estimate = estimator_.Update(frame_);
  estimator_.PrepareNext();
  if (force_estimation::PredictsShape(estimate)) {
    predicted_nodes_m_ =
        Eigen::Map<const Eigen::Matrix3Xd>(estimate.x_m.data(), 3, estimate.x_m.size() / 3)
            .cast<float>();
  }
  return estimate;
}

}  // namespace palpate::test_support
