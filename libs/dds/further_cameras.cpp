// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/further_cameras.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "libs/core/config_reader.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/camera_topics.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::dds {

namespace {

FurtherCamera ReadItem(const ConfigNode& item) {
  FurtherCamera camera;
  if (item.kind == ConfigNode::Kind::kMap && item.entries.size() == 1) {
    camera.name = item.entries.front().key;
    camera.T_robot_camera = geometry::ReadPose(item.entries.front().value);
  } else {
    camera.name = ReadText(item);
  }
  static_cast<void>(TopicsOf(camera.name));
  return camera;
}

/// Those of `some` that are not in `others`.
std::vector<std::string> Without(const std::vector<std::string>& some,
                                 const std::vector<std::string>& others) {
  std::vector<std::string> rest;
  std::copy_if(some.begin(), some.end(), std::back_inserter(rest), [&](const std::string& name) {
    return std::find(others.begin(), others.end(), name) == others.end();
  });
  return rest;
}

/// "camera 'back'", "cameras 'back', 'top'".
std::string NamedCameras(const std::vector<std::string>& names) {
  std::string text = names.size() == 1 ? "camera " : "cameras ";
  for (std::size_t k = 0; k < names.size(); ++k) {
    text += (k > 0 ? ", '" : "'") + names[k] + "'";
  }
  return text;
}

}  // namespace

std::vector<FurtherCamera> ReadFurtherCameras(
    const std::vector<std::string>& items,
    const std::function<ConfigNode(const std::string& text, const std::string& name)>& parse) {
  std::vector<FurtherCamera> cameras;
  for (const std::string& item : items) {
    FurtherCamera camera = ReadItem(parse(item, "cameras"));
    if (camera.name.empty()) throw InputError("cameras: an item without a name");
    cameras.push_back(std::move(camera));
  }
  std::sort(cameras.begin(), cameras.end(),
            [](const auto& one, const auto& other) { return one.name < other.name; });
  const auto twice =
      std::adjacent_find(cameras.begin(), cameras.end(),
                         [](const auto& one, const auto& other) { return one.name == other.name; });
  if (twice != cameras.end()) throw InputError("cameras: '" + twice->name + "' is given twice");
  return cameras;
}

std::vector<std::string> NamesOf(const std::vector<FurtherCamera>& cameras) {
  std::vector<std::string> names;
  for (const FurtherCamera& camera : cameras) names.push_back(camera.name);
  return names;
}

std::string TakePoses(const std::vector<FurtherCamera>& calibrated, const std::string& file,
                      std::vector<FurtherCamera>* cameras) {
  for (FurtherCamera& camera : *cameras) {
    if (camera.T_robot_camera) continue;
    const auto known =
        std::find_if(calibrated.begin(), calibrated.end(),
                     [&](const FurtherCamera& other) { return other.name == camera.name; });
    if (known == calibrated.end()) {
      throw InputError("cameras: '" + camera.name + "' is not in " + file +
                       DidYouMean(camera.name, NamesOf(calibrated)) +
                       "; calibrate it, or write its pose behind its name");
    }
    camera.T_robot_camera = known->T_robot_camera;
  }
  CameraMatch match = MatchCameras(NamesOf(*cameras), NamesOf(calibrated));
  match.missing.clear();
  const std::string unknown = Describe(match);
  return unknown.empty() ? unknown : file + ": " + unknown;
}

CameraMatch MatchCameras(const std::vector<std::string>& running,
                         const std::vector<std::string>& calibrated) {
  return {Without(running, calibrated), Without(calibrated, running)};
}

std::string Describe(const CameraMatch& match) {
  std::string text;
  if (!match.missing.empty()) {
    text = "it has no pose of " + NamedCameras(match.missing) +
           ": its poses and depth biases do not count, calibrate all cameras together";
  }
  if (!match.unknown.empty()) {
    text += (text.empty() ? "it has " : "; it has ") + NamedCameras(match.unknown) +
            ", not in the setting 'cameras'";
  }
  return text;
}

}  // namespace palpate::dds
