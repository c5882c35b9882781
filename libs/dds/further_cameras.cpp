// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/further_cameras.hpp"

#include <algorithm>
#include <utility>

#include "libs/core/config_reader.hpp"
#include "libs/core/error.hpp"
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

}  // namespace palpate::dds
