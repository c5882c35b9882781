// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/images/rgbd_sequence.hpp"

#include <algorithm>

#include "libs/core/error.hpp"
#include "libs/experiment/cloud/point_cloud.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/experiment/folders.hpp"
#include "libs/rgbd/color_image.hpp"
#include "libs/rgbd/png.hpp"

namespace palpate::experiment {

namespace {

namespace fs = std::filesystem;

std::string SizeText(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

template <typename Picture>
void CheckSize(const Picture& image, const rgbd::CameraModel& camera, const fs::path& file) {
  if (image.width_px == camera.width_px && image.height_px == camera.height_px) return;
  throw InputError(SourceLocation{file.string()},
                   "is " + SizeText(image.width_px, image.height_px) + " pixels, its camera has " +
                       SizeText(camera.width_px, camera.height_px));
}

std::vector<FrameFiles> PairImages(const Recording& recording) {
  std::vector<FrameFiles> frames;
  auto color = recording.color_images.begin();
  const auto end = recording.color_images.end();
  for (const StampedFile& depth : recording.depth_images) {
    FrameFiles frame{.t_ns = depth.t_ns, .depth = depth.file, .color = {}, .cloud = {}};
    if (color != end && color->t_ns == depth.t_ns) frame.color = (color++)->file;
    frames.push_back(std::move(frame));
  }
  if (color != end) {
    throw InputError(SourceLocation{color->file.string()}, "has no depth image of the same name");
  }
  return frames;
}

bool HoldsClouds(const fs::path& folder) {
  const std::vector<fs::path> entries = EntriesOf(folder);
  return std::any_of(entries.begin(), entries.end(), [](const fs::path& file) {
    return file.extension() == ".pcd" || file.extension() == ".ply";
  });
}

RgbdSequence OpenCloudFolder(const fs::path& folder, const ConfigLoader& load) {
  Recording recording;
  recording.name = NameOf(folder);
  recording.folder = folder;
  recording.clouds = ListClouds(folder);
  if (const fs::path file = folder / "camera.yaml"; fs::exists(file)) recording.camera_file = file;
  return OpenRecordingImages(recording, load);
}

void FindCloudConvention(RgbdSequence* sequence) {
  constexpr std::size_t kMostLooks = 5;  // the first clouds of a recording may be empty
  for (std::size_t k = 0; k < std::min(kMostLooks, sequence->frames.size()); ++k) {
    const fs::path& file = sequence->frames[k].cloud;
    if (const auto found = ConventionOf(ReadPointCloud(file))) {
      sequence->clouds = *found;
      const std::string note = ToText(*found);
      if (!note.empty()) sequence->notes.push_back(file.string() + ": " + note);
      return;
    }
  }
}

bool HoldsImages(const Recording& recording) {
  return !recording.depth_images.empty() || !recording.clouds.empty();
}

}  // namespace

void RgbdSequence::Read(std::size_t index, rgbd::RgbdFrame* frame) const {
  const FrameFiles& files = frames.at(index);
  if (!files.cloud.empty()) {
    PointCloud cloud = ReadPointCloud(files.cloud);
    ToOpticalFrame(clouds, &cloud);
    *frame = FrameFromCloud(cloud, camera);
    frame->stamp_ns = files.t_ns;
    return;
  }
  frame->stamp_ns = files.t_ns;
  frame->depth = rgbd::ReadDepthPng(files.depth);
  CheckSize(frame->depth, camera.depth, files.depth);
  if (files.color.empty()) {
    frame->color = {};
    return;
  }
  frame->color = rgbd::ReadColorImage(files.color);
  if (camera.color.width_px == 0) {
    throw InputError(SourceLocation{files.color.string()},
                     "is a colour image, and camera.yaml has no 'color'");
  }
  CheckSize(frame->color, camera.color, files.color);
}

RgbdSequence OpenRecordingImages(const Recording& recording, const ConfigLoader& load) {
  const SourceLocation where{recording.folder.string()};
  if (!HoldsImages(recording)) throw InputError(where, "holds neither depth images nor clouds");
  if (!recording.camera_file) {
    throw InputError(where, "has no camera.yaml, so the intrinsics of its images are unknown");
  }
  RgbdSequence sequence;
  sequence.name = recording.name;
  sequence.camera = rgbd::ReadCameraFile(*recording.camera_file, load);
  sequence.frames = PairImages(recording);
  if (!sequence.frames.empty()) return sequence;
  for (const StampedFile& cloud : recording.clouds) {
    sequence.frames.push_back({.t_ns = cloud.t_ns, .depth = {}, .color = {}, .cloud = cloud.file});
  }
  FindCloudConvention(&sequence);
  return sequence;
}

std::vector<RgbdSequence> OpenRgbdSequences(const fs::path& folder, const ConfigLoader& load) {
  if (!fs::is_directory(folder)) {
    throw InputError(SourceLocation{folder.string()}, "is no folder");
  }
  if (fs::exists(folder / "experiment.yaml") || fs::exists(folder / "recording.yaml")) {
    std::vector<RgbdSequence> sequences;
    for (const Recording& recording : ReadExperiment(folder, load).recordings) {
      if (HoldsImages(recording)) sequences.push_back(OpenRecordingImages(recording, load));
    }
    if (!sequences.empty()) return sequences;
    throw InputError(SourceLocation{folder.string()}, "holds neither depth images nor clouds");
  }
  if (fs::exists(folder / "depth.txt")) return {OpenTumFolder(folder, load)};
  if (HoldsClouds(folder)) return {OpenCloudFolder(folder, load)};
  throw InputError(SourceLocation{folder.string()},
                   "is neither an experiment, a recording, a TUM RGB-D folder (depth.txt) nor a "
                   "folder of clouds (.pcd, .ply)");
}

}  // namespace palpate::experiment
