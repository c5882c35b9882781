// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"
#include "libs/experiment/cloud/cloud_convention.hpp"
#include "libs/experiment/recording.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/rgbd/rgbd_frame.hpp"

namespace palpate::experiment {

/// One frame set on disk: a depth image, perhaps with a colour image, or a cloud.
struct FrameFiles {
  std::int64_t t_ns = 0;
  std::filesystem::path depth;
  std::filesystem::path color;  ///< empty: none
  std::filesystem::path cloud;  ///< .pcd, .ply; then there is no depth image
};

/// Depth and colour frames on disk, read one at a time.
struct RgbdSequence {
  std::string name;  ///< of the folder
  rgbd::RgbdCamera camera;
  std::vector<FrameFiles> frames;  ///< by rising time, at least one
  std::size_t unpaired = 0;        ///< TUM: depth images without a colour image near in time
  CloudConvention clouds;          ///< in which all clouds are read
  std::vector<std::string> notes;  ///< what was assumed, for a person

  /// Buffers of `frame` are used again. Throws InputError, naming the file, where an image cannot
  /// be read or has another size than its camera.
  void Read(std::size_t index, rgbd::RgbdFrame* frame) const;
};

/// Whatever `folder` is: a recording (or an experiment: its recordings that hold images, one after
/// the other, in the order of their names), a TUM RGB-D folder, or a folder of .pcd or .ply files
/// named by their time in nanoseconds, with camera.yaml. Throws InputError where it is none of
/// them.
std::vector<RgbdSequence> OpenRgbdSequences(const std::filesystem::path& folder,
                                            const ConfigLoader& load);

/// depth/ and color/ (same name: one frame set), else clouds/, and camera.yaml of a recording. The
/// first cloud that holds points shows the convention of all. Throws InputError where there are no
/// images, or a colour image has no depth image.
RgbdSequence OpenRecordingImages(const Recording& recording, const ConfigLoader& load);

/// A folder of the TUM RGB-D benchmark (J. Sturm et al., A benchmark for the evaluation of RGB-D
/// SLAM systems, IROS 2012): depth.txt and rgb.txt name images by their time in s. Each depth image
/// goes with the colour image nearest in time, within 20 ms, none used twice; those left over are
/// dropped and counted. Without rgb.txt: depth alone. The camera is camera.yaml of the folder, else
/// the benchmark's nominal one (TumCamera). Throws InputError with file:line:column.
RgbdSequence OpenTumFolder(const std::filesystem::path& folder, const ConfigLoader& load);

/// 640x480, f 525 px, centre (319.5, 239.5), 5000 steps a metre, colour registered to depth.
rgbd::RgbdCamera TumCamera();

}  // namespace palpate::experiment
