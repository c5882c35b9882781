// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/recorded_camera.hpp"

#include <algorithm>
#include <set>

#include "components/offline/messages/message_type.hpp"
#include "libs/core/error.hpp"
#include "libs/core/names.hpp"
#include "libs/core/text.hpp"
#include "libs/geometry/frames.hpp"
#include "libs/recording/ros_names.hpp"

namespace palpate::offline {

namespace {

/// ROS images of 16 bits are in mm.
constexpr double kMillimetre_m = 1e-3;
/// What 16 bits resolve of kFarthest_m.
constexpr double kFinestUnit_m = 1e-4;

std::string WithoutVariant(std::string topic) {
  for (const std::string suffix : {"/compressedDepth", "/compressed"}) {
    if (topic.ends_with(suffix)) topic.resize(topic.size() - suffix.size());
  }
  return topic;
}

class CameraFinder {
 public:
  CameraFinder(const recording::RecordedMessages& recorded, const TopicRoles& roles,
               const CollectedTopics& topics, std::vector<std::string>* notes)
      : recorded_(recorded), roles_(roles), topics_(topics), notes_(notes) {}

  RecordedCamera Find(const std::string& robot_frame) {
    RecordedCamera found;
    found.frame_ids = {std::string(geometry::kCameraDepthOpticalFrame)};
    const auto& images = topics_.depth.empty() ? topics_.points : topics_.depth;
    if (!images.empty()) {
      found.frame_ids.push_back(FrameName(images.front().frame_id));
      SetDepth(images.front(), &found.camera);
      if (!topics_.color.empty() && !topics_.depth.empty()) SetColor(&found);
    }
    SetPose(robot_frame, images.empty() ? 0 : images.front().time.log_ns, &found);
    return found;
  }

 private:
  const std::string& TopicOf(std::uint16_t channel) const {
    return recorded_.contents().channels.at(channel).topic;
  }

  [[noreturn]] static void RefuseChange(const std::string& topic, const std::string& what) {
    throw InputError(topic + ": the camera changes during the recording: " + what +
                     "; make a recording of each part");
  }

  /// One experiment has one camera. What comes before the camera is calibrated does not count.
  void RefuseOtherInfos(const CollectedInfo& used, bool by_p) const {
    const auto model = [&](const CollectedInfo& info) {
      return by_p ? info.rectified : info.model;
    };
    const rgbd::CameraModel last = model(used);
    for (const CollectedInfo& info : topics_.infos) {
      const bool sound = (by_p ? info.rectified_fault : info.fault).empty();
      if (info.channel != used.channel || !sound || model(info) == last) continue;
      const rgbd::CameraModel first = model(info);
      std::string what = "principal point or distortion";
      if (first.fx_px != last.fx_px) {
        what =
            "fx is " + FormatNumber(first.fx_px) + " px, later " + FormatNumber(last.fx_px) + " px";
      }
      if (first.width_px != last.width_px || first.height_px != last.height_px) {
        what = "images are " + std::to_string(first.width_px) + " x " +
               std::to_string(first.height_px) + " pixels, later " + std::to_string(last.width_px) +
               " x " + std::to_string(last.height_px);
      }
      RefuseChange(recording::RosTopicName(TopicOf(info.channel)), what);
    }
  }

  void RefuseOtherSetups() const {
    const CollectedSetup& last = topics_.setups.back();
    for (const CollectedSetup& setup : topics_.setups) {
      const auto& names = roles_.names;
      const auto topic = names.find(setup.knows_color ? kCameraSetupTopic : kFrameInfoTopic);
      if (setup.depth_unit_m != last.depth_unit_m) {
        RefuseChange(topic->second, "the depth step is " + FormatNumber(setup.depth_unit_m) +
                                        " m, later " + FormatNumber(last.depth_unit_m) + " m");
      }
      if (setup.invalid_value != last.invalid_value) {
        RefuseChange(topic->second, "the invalid value is " + std::to_string(setup.invalid_value) +
                                        ", later " + std::to_string(last.invalid_value));
      }
    }
  }

  /// The last message of a topic; nullptr: there is none.
  const CollectedInfo* InfoOf(const std::string& topic) const {
    const CollectedInfo* last = nullptr;
    for (const CollectedInfo& info : topics_.infos) {
      if (recording::RosTopicName(TopicOf(info.channel)) == topic) last = &info;
    }
    return last;
  }

  const CollectedInfo* RemappedInfo(const std::string& role) const {
    for (const auto& [from, to] : roles_.remapped) {
      if (to == role) return InfoOf(from);
    }
    return nullptr;
  }

  /// The only topic of camera information with the frame of the image.
  const CollectedInfo* InfoOfFrame(const std::string& frame_id) const {
    const CollectedInfo* found = nullptr;
    std::set<std::string> names;
    for (const CollectedInfo& info : topics_.infos) {
      if (info.frame_id != frame_id) continue;
      found = &info;
      names.insert(TopicOf(info.channel));
    }
    return names.size() == 1 ? found : nullptr;
  }

  const CollectedInfo* FindInfo(const std::string& image_role, const std::string& info_role,
                                const std::string& frame_id) const {
    if (const CollectedInfo* info = RemappedInfo(info_role)) return info;
    const std::string image = WithoutVariant(roles_.names.at(image_role));
    const std::string beside = image.substr(0, image.rfind('/')) + "/camera_info";
    if (const CollectedInfo* info = InfoOf(beside)) return info;
    if (const CollectedInfo* info = InfoOfFrame(frame_id)) return info;
    const auto named = roles_.names.find(info_role);
    return named == roles_.names.end() ? nullptr : InfoOf(named->second);
  }

  /// Empty: done; else why not. An image called image_rect has no distortion, and P holds.
  std::string SetModel(const CollectedInfo& info, const std::string& image_role,
                       rgbd::CameraModel* model) const {
    const std::string image = WithoutVariant(roles_.names.at(image_role));
    const bool rectified = image.substr(image.rfind('/') + 1).starts_with("image_rect");
    const bool by_p = rectified && info.rectified_fault.empty();
    RefuseOtherInfos(info, by_p);
    *model = by_p ? info.rectified : info.model;
    const std::string& fault = by_p ? info.rectified_fault : info.fault;
    return fault.empty() ? "" : recording::RosTopicName(TopicOf(info.channel)) + ": " + fault;
  }

  [[noreturn]] void RefuseWithoutInfo(const std::string& image_role, const std::string& info_role,
                                      const std::string& frame_id) const {
    std::set<std::string> names;
    for (const CollectedInfo& info : topics_.infos)
      names.insert(recording::RosTopicName(TopicOf(info.channel)));
    std::string why = roles_.names.at(image_role) +
                      ": no intrinsics: the recording has no "
                      "sensor_msgs/CameraInfo beside it, nor one of its frame '" +
                      frame_id + "'";
    why += names.empty() ? "; record it, too"
                         : "; name one of " + Listed({names.begin(), names.end()}) +
                               " with --remap NAME:=" + info_role;
    throw InputError(why);
  }

  void SetDepth(const CollectedImage& image, rgbd::RgbdCamera* camera) {
    const std::string role = topics_.depth.empty() ? kPointsTopic : kDepthTopic;
    const CollectedInfo* info = FindInfo(role, kDepthInfoTopic, image.frame_id);
    if (info == nullptr) RefuseWithoutInfo(role, kDepthInfoTopic, image.frame_id);
    if (std::string fault = SetModel(*info, role, &camera->depth); !fault.empty()) {
      throw InputError(fault);
    }
    camera->depth_unit_m = kMillimetre_m;
    if (!topics_.setups.empty()) {
      RefuseOtherSetups();
      const CollectedSetup& setup = topics_.setups.back();
      camera->depth_unit_m = setup.depth_unit_m;
      camera->invalid_value = setup.invalid_value;
      camera->baseline_m = setup.baseline_m;
    }
    if (topics_.has_ranges) {
      camera->invalid_value = 0;
      camera->depth_unit_m = topics_.ranges_are_millimetres ? kMillimetre_m : kFinestUnit_m;
    } else if (topics_.depth.empty() && topics_.setups.empty()) {
      camera->depth_unit_m = kFinestUnit_m;
    }
    notes_->push_back(std::to_string(topics_.depth.size() + topics_.points.size()) +
                      (topics_.depth.empty() ? " clouds of " : " depth images of ") +
                      roles_.names.at(role) + ", intrinsics of " +
                      recording::RosTopicName(TopicOf(info->channel)) + ", depth in steps of " +
                      FormatNumber(camera->depth_unit_m) + " m");
  }

  void SetColor(RecordedCamera* found) {
    rgbd::RgbdCamera& camera = found->camera;
    const std::string& topic = roles_.names.at(kColorTopic);
    const CollectedImage& image = topics_.color.front();
    const CollectedInfo* info = FindInfo(kColorTopic, kColorInfoTopic, image.frame_id);
    std::string fault = "the recording has no sensor_msgs/CameraInfo of it";
    rgbd::CameraModel model;
    if (info != nullptr) fault = SetModel(*info, kColorTopic, &model);
    if (!fault.empty()) {
      notes_->push_back(topic + " is left out: " + fault);
      return;
    }
    const std::string& depth_frame = topics_.depth.front().frame_id;
    const bool same = model == camera.depth && image.frame_id == depth_frame;
    const auto T_depth_color =
        topics_.transforms.Find(depth_frame, image.frame_id, image.time.log_ns);
    const bool told = !topics_.setups.empty() && topics_.setups.back().knows_color;
    if (told) {
      camera.color_registered = topics_.setups.back().color_registered;
      camera.T_depth_color = topics_.setups.back().T_depth_color;
    } else if (same) {
      camera.color_registered = true;
    } else if (T_depth_color) {
      camera.T_depth_color = *T_depth_color;
    } else {
      notes_->push_back(topic + " is left out: no transform on /tf or /tf_static joins '" +
                        image.frame_id + "' with '" + depth_frame +
                        "'; record /tf_static, or let the driver align depth to colour");
      return;
    }
    camera.color = model;
    if (camera.color_registered && !(camera.color == camera.depth)) camera.color_registered = false;
    found->use_color = true;
    notes_->push_back(std::to_string(topics_.color.size()) + " colour images of " + topic +
                      (camera.color_registered ? ", registered to depth" : ""));
  }

  void SetPose(const std::string& robot_frame, std::int64_t log_ns, RecordedCamera* found) {
    if (topics_.T_robot_camera) {
      found->T_robot_camera = topics_.T_robot_camera;
      found->T_robot_camera_error = topics_.T_robot_camera_error;
      notes_->push_back(std::string("camera pose of ") + kCalibrationTopic);
      return;
    }
    for (const std::string& frame : found->frame_ids) {
      found->T_robot_camera = topics_.transforms.Find(robot_frame, frame, log_ns);
      if (!found->T_robot_camera) continue;
      notes_->push_back("camera pose of /tf and /tf_static, from '" + robot_frame + "' to '" +
                        frame + "'");
      return;
    }
    if (topics_.depth.empty() && topics_.points.empty()) return;
    std::string why = "no camera pose: /calibration and /tf say none between '" + robot_frame +
                      "' and '" + found->frame_ids.back() + "'";
    const std::vector<std::string> frames = topics_.transforms.Frames();
    if (!frames.empty()) {
      why += " (frames: " + Listed(frames) + "); robot_frame in the file of phases names another";
    }
    notes_->push_back(why);
  }

  const recording::RecordedMessages& recorded_;
  const TopicRoles& roles_;
  const CollectedTopics& topics_;
  std::vector<std::string>* notes_;
};

}  // namespace

RecordedCamera FindCamera(const recording::RecordedMessages& recorded, const TopicRoles& roles,
                          const CollectedTopics& topics, const std::string& robot_frame,
                          std::vector<std::string>* notes) {
  return CameraFinder(recorded, roles, topics, notes).Find(robot_frame);
}

}  // namespace palpate::offline
