// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <system_error>
#include <utility>

#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/cameras.hpp"
#include "libs/experiment/folders.hpp"
#include "libs/experiment/recording.hpp"
#include "libs/experiment/recording_settings.hpp"
#include "libs/experiment/stamped_files.hpp"

namespace palpate::experiment {

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kKnownEntries = {"recording.yaml", "actuation.csv", "markers.csv",
                                                "loads.csv",      "camera.yaml",   "depth",
                                                "color",          "clouds",        "cameras"};

// A misspelt table would otherwise be taken for an absent one. Other files are ignored.
void RefuseMisspeltEntries(const fs::path& folder) {
  for (const fs::path& entry : EntriesOf(folder)) {
    const std::string name = entry.filename().string();
    const bool known =
        std::find(kKnownEntries.begin(), kKnownEntries.end(), name) != kKnownEntries.end();
    const std::string near = known ? "" : DidYouMean(name, kKnownEntries);
    if (!near.empty()) {
      throw InputError(SourceLocation{entry.string()}, "is no part of a recording" + near);
    }
  }
}

void CheckWindowHoldsFrames(const MarkerTracks& markers, const TimeWindow& window,
                            const std::string& key, const fs::path& file) {
  const bool any =
      std::any_of(markers.frames.begin(), markers.frames.end(),
                  [&](const MarkerFrame& frame) { return window.Contains(frame.t_s); });
  if (any) return;
  throw InputError(SourceLocation{file.string()},
                   "key '" + key + "': no frame of markers.csv (" +
                       FormatNumber(markers.frames.front().t_s) + " to " +
                       FormatNumber(markers.frames.back().t_s) + " s) lies inside the window");
}

void CheckWindows(const Recording& recording, const fs::path& file) {
  if (!recording.markers) return;
  if (recording.reference) {
    CheckWindowHoldsFrames(*recording.markers, recording.reference->window_s, "reference.window_s",
                           file);
  }
  if (recording.steady_window_s) {
    CheckWindowHoldsFrames(*recording.markers, *recording.steady_window_s, "steady_window_s", file);
  }
}

void CopyFiles(const std::vector<StampedFile>& files, const fs::path& folder) {
  if (files.empty()) return;
  CreateFolder(folder);
  for (const StampedFile& file : files) {
    CopyFile(file.file, folder / (std::to_string(file.t_ns) + file.file.extension().string()));
  }
}

/// The images and clouds of a camera, which lie in `folder`.
struct ImageFiles {
  std::vector<StampedFile> depth;
  std::vector<StampedFile> color;
  std::vector<StampedFile> clouds;
  std::optional<fs::path> camera_file;
};

ImageFiles ListImages(const fs::path& folder, const std::optional<double>& frame_rate_Hz) {
  const auto list = [&](const char* images, const std::vector<std::string>& extensions) {
    return ListStampedFiles(
        folder / images,
        {.extensions = extensions, .skip_others = false, .frame_rate_Hz = frame_rate_Hz});
  };
  ImageFiles files{.depth = list("depth", {".png"}),
                   .color = list("color", {".png", ".jpg", ".jpeg"}),
                   .clouds = list("clouds", {".pcd", ".ply"}),
                   .camera_file = {}};
  if (const fs::path file = folder / "camera.yaml"; fs::exists(file)) files.camera_file = file;
  return files;
}

std::vector<CameraFiles> ListCameras(const fs::path& folder,
                                     const std::optional<double>& frame_rate_Hz) {
  std::vector<CameraFiles> cameras;
  if (!fs::is_directory(folder)) return cameras;
  for (const fs::path& entry : EntriesOf(folder)) {
    if (!fs::is_directory(entry)) continue;
    const std::string name = NameOf(entry);
    if (!IsCameraName(name)) {
      throw InputError(SourceLocation{entry.string()},
                       "is no name of a camera: letters, digits and '_', a letter first");
    }
    ImageFiles files = ListImages(entry, frame_rate_Hz);
    cameras.push_back({.name = name,
                       .folder = entry,
                       .depth_images = std::move(files.depth),
                       .color_images = std::move(files.color),
                       .clouds = std::move(files.clouds),
                       .camera_file = std::move(files.camera_file)});
  }
  return cameras;
}

}  // namespace

std::vector<StampedFile> ListClouds(const fs::path& folder) {
  return ListStampedFiles(
      folder, {.extensions = {".pcd", ".ply"}, .skip_others = true, .frame_rate_Hz = {}});
}

Recording ReadRecording(const fs::path& folder, const ConfigLoader& load) {
  if (!fs::is_directory(folder)) {
    throw InputError(SourceLocation{folder.string()}, "is no folder of a recording");
  }
  const fs::path settings = folder / "recording.yaml";
  RefuseMisspeltEntries(folder);
  Recording recording;
  recording.folder = folder;
  recording.name = NameOf(folder);
  const std::optional<double> frame_rate_Hz = ReadRecordingSettings(settings, load, recording);
  if (const fs::path file = folder / "actuation.csv"; fs::exists(file)) {
    recording.actuation = ReadActuation(file);
  }
  if (const fs::path file = folder / "markers.csv"; fs::exists(file)) {
    recording.markers = ReadMarkers(file);
  }
  if (const fs::path file = folder / "loads.csv"; fs::exists(file)) {
    recording.loads = ReadLoads(file);
  }
  ImageFiles images = ListImages(folder, frame_rate_Hz);
  recording.depth_images = std::move(images.depth);
  recording.color_images = std::move(images.color);
  recording.clouds = std::move(images.clouds);
  recording.camera_file = std::move(images.camera_file);
  recording.cameras = ListCameras(folder / "cameras", frame_rate_Hz);
  CheckWindows(recording, settings);
  return recording;
}

void WriteRecording(const Recording& recording, const fs::path& folder) {
  if (fs::exists(folder) && !EntriesOf(folder).empty()) {
    throw InputError(SourceLocation{folder.string()},
                     "holds files already; a recording is never overwritten");
  }
  CreateFolder(folder);
  if (recording.actuation) WriteActuation(*recording.actuation, folder / "actuation.csv");
  if (recording.markers) WriteMarkers(*recording.markers, folder / "markers.csv");
  if (!recording.loads.empty()) WriteLoads(recording.loads, folder / "loads.csv");
  if (recording.camera_file) CopyFile(*recording.camera_file, folder / "camera.yaml");
  CopyFiles(recording.depth_images, folder / "depth");
  CopyFiles(recording.color_images, folder / "color");
  CopyFiles(recording.clouds, folder / "clouds");
  for (const CameraFiles& camera : recording.cameras) {
    const fs::path of_camera = folder / "cameras" / camera.name;
    CreateFolder(of_camera);
    if (camera.camera_file) CopyFile(*camera.camera_file, of_camera / "camera.yaml");
    CopyFiles(camera.depth_images, of_camera / "depth");
    CopyFiles(camera.color_images, of_camera / "color");
    CopyFiles(camera.clouds, of_camera / "clouds");
  }
  // Last, because it is what makes the folder a recording.
  WriteFile(folder / "recording.yaml", FormatRecordingSettings(recording));
}

}  // namespace palpate::experiment
