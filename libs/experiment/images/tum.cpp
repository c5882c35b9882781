// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cstdlib>
#include <tuple>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/cloud/scalar.hpp"
#include "libs/experiment/folders.hpp"
#include "libs/experiment/images/rgbd_sequence.hpp"
#include "libs/experiment/stamped_files.hpp"

namespace palpate::experiment {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kLargestGap_ns = 20'000'000;

/// depth.txt or rgb.txt: lines "time_s file", # begins a comment.
std::vector<StampedFile> ReadList(const fs::path& list) {
  const std::string bytes = ReadFile(list);
  std::string_view rest = bytes;
  std::vector<StampedFile> files;
  for (int number = 1; !rest.empty(); ++number) {
    std::string_view line = TakeLine(&rest);
    const std::string_view time = TakeWord(&line);
    if (time.empty() || time.starts_with('#')) continue;
    const std::string_view name = TakeWord(&line);
    const SourceLocation where{list.string(), number, 1};
    StampedFile file;
    if (!ParseSeconds_ns(time, &file.t_ns)) {
      const bool other = time.find_first_of(",;") != std::string_view::npos;
      throw InputError(where, "'" + Excerpt(time) + "' is no time in seconds" +
                                  (other ? "; a blank separates the time from the file" : ""));
    }
    if (name.empty() || !TakeWord(&line).empty()) {
      throw InputError(where, "a line is a time and a file name");
    }
    if (!files.empty() && file.t_ns <= files.back().t_ns) {
      throw InputError(where, "time must rise from line to line");
    }
    file.file = list.parent_path() / name;
    files.push_back(std::move(file));
  }
  if (files.empty()) throw InputError(SourceLocation{list.string()}, "names no image");
  return files;
}

/// Nearest pairs first, as the benchmark's associate.py has it.
std::vector<FrameFiles> Associate(const std::vector<StampedFile>& depth,
                                  const std::vector<StampedFile>& color) {
  std::vector<std::tuple<std::int64_t, std::size_t, std::size_t>> pairs;  // gap, depth, colour
  const auto earlier = [](const StampedFile& file, std::int64_t t_ns) { return file.t_ns < t_ns; };
  for (std::size_t d = 0; d < depth.size(); ++d) {
    const std::int64_t t_ns = depth[d].t_ns;
    auto c = std::lower_bound(color.begin(), color.end(), t_ns - kLargestGap_ns, earlier);
    for (; c != color.end() && c->t_ns <= t_ns + kLargestGap_ns; ++c) {
      pairs.emplace_back(std::abs(c->t_ns - t_ns), d, static_cast<std::size_t>(c - color.begin()));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<bool> depth_used(depth.size()), color_used(color.size());
  std::vector<FrameFiles> frames;
  for (const auto& [gap_ns, d, c] : pairs) {
    if (depth_used[d] || color_used[c]) continue;
    depth_used[d] = color_used[c] = true;
    frames.push_back(
        {.t_ns = depth[d].t_ns, .depth = depth[d].file, .color = color[c].file, .cloud = {}});
  }
  std::sort(frames.begin(), frames.end(),
            [](const FrameFiles& a, const FrameFiles& b) { return a.t_ns < b.t_ns; });
  return frames;
}

}  // namespace

rgbd::RgbdCamera TumCamera() {
  rgbd::RgbdCamera camera;
  camera.depth = {.width_px = 640,
                  .height_px = 480,
                  .fx_px = 525.0,
                  .fy_px = 525.0,
                  .cx_px = 319.5,
                  .cy_px = 239.5};
  camera.depth_unit_m = 1.0 / 5000.0;
  camera.color = camera.depth;
  camera.color_registered = true;
  return camera;
}

RgbdSequence OpenTumFolder(const fs::path& folder, const ConfigLoader& load) {
  RgbdSequence sequence;
  sequence.name = NameOf(folder);
  const fs::path camera = folder / "camera.yaml";
  sequence.camera = fs::exists(camera) ? rgbd::ReadCameraFile(camera, load) : TumCamera();
  const std::vector<StampedFile> depth = ReadList(folder / "depth.txt");
  if (!fs::exists(folder / "rgb.txt")) {
    for (const StampedFile& file : depth) {
      sequence.frames.push_back({.t_ns = file.t_ns, .depth = file.file, .color = {}, .cloud = {}});
    }
    return sequence;
  }
  sequence.frames = Associate(depth, ReadList(folder / "rgb.txt"));
  sequence.unpaired = depth.size() - sequence.frames.size();
  if (sequence.frames.empty()) {
    throw InputError(SourceLocation{folder.string()},
                     "no depth image has a colour image within 20 ms");
  }
  if (sequence.unpaired > 0) {
    sequence.notes.push_back(folder.string() + ": " + std::to_string(sequence.unpaired) +
                             " depth images without a colour image within 20 ms are left out");
  }
  return sequence;
}

}  // namespace palpate::experiment
