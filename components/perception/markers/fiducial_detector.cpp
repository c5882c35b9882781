// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/markers/fiducial_detector.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string>

#include "components/perception/markers/color_spots.hpp"
#include "components/perception/markers/fiducial_classifier.hpp"
#include "components/perception/registered_frame.hpp"
#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::perception {

namespace {

void CheckRange(const char* name, double low, double high) {
  if (low <= high) return;
  throw InputError(std::string("min_") + name + " is " + FormatNumber(low) + ", max_" + name +
                   " is " + FormatNumber(high) + "; the first must not be larger");
}

void CheckNames(const FiducialConfig& config) {
  const std::vector<std::string>& names = config.names;
  if (names.empty()) return;
  if (3 * names.size() != config.color_rgb.size()) {
    throw InputError("names has " + std::to_string(names.size()) + " markers, color_rgb " +
                     std::to_string(config.color_rgb.size() / 3) +
                     " colours; must have a name for each, or none");
  }
  std::set<std::string> known;
  for (const std::string& name : names) {
    if (name.empty() || !known.insert(name).second) {
      throw InputError("names has '" + name + "' twice, or an empty one");
    }
  }
}

/// A colour of two spots names neither of them.
void Name(const std::vector<std::string>& names, std::vector<Fiducial>* fiducials) {
  for (std::size_t color = 0; color < names.size(); ++color) {
    const auto is_of_it = [&](const Fiducial& one) { return one.color == static_cast<int>(color); };
    const auto first = std::find_if(fiducials->begin(), fiducials->end(), is_of_it);
    if (first == fiducials->end()) continue;
    if (std::none_of(std::next(first), fiducials->end(), is_of_it)) first->name = names[color];
  }
}

}  // namespace

struct FiducialDetector::Parts {
  explicit Parts(const FiducialConfig& settings) : config{settings}, spots{settings} {}

  FiducialConfig config;
  ColorSpots spots;
  std::optional<Registration> registration;
  std::optional<FiducialClassifier> classifier;
  RegisteredFrame registered;
  FiducialFrame found;
};

FiducialDetector::FiducialDetector(const FiducialConfig& config)
    : parts_{std::make_unique<Parts>(config)} {
  CheckRange("radius_m", config.min_radius_m, config.max_radius_m);
  CheckRange("z_m", config.min_z_m, config.max_z_m);
  CheckNames(config);
}

FiducialDetector::~FiducialDetector() = default;

void FiducialDetector::SetCamera(const rgbd::RgbdCamera& camera) {
  parts_->classifier.reset();
  parts_->registration.emplace(camera);
  parts_->classifier.emplace(parts_->config, *parts_->registration);
  parts_->registered = {};
}

const FiducialFrame& FiducialDetector::Detect(const rgbd::RgbdFrame& frame) {
  PALPATE_CHECK(parts_->registration.has_value());
  FiducialFrame& found = parts_->found;
  found.fiducials.clear();
  found.rejected = {};
  found.status = Status(StatusCode::kInvalidInput, "the camera has no colours");
  if (parts_->registration->camera().color.width_px <= 0) return found;
  found.status = parts_->registration->Register(frame, &parts_->registered);
  if (!found.status.ok()) return found;
  for (const ColorSpot& spot : parts_->spots.Find(parts_->registered)) {
    parts_->classifier->Classify(spot, parts_->registered, &found);
  }
  Name(parts_->config.names, &found.fiducials);
  return found;
}

}  // namespace palpate::perception
