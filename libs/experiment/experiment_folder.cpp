// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <system_error>

#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/cameras.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/experiment/folders.hpp"

namespace palpate::experiment {

namespace {

namespace fs = std::filesystem;

/// Settings of a camera that no recording has are those of another one, misspelt.
void RefuseUnknownCameras(const Experiment& experiment) {
  const std::vector<std::string> names = FurtherCameras(experiment);
  const auto check = [&](const std::vector<CameraSettings>& cameras, const fs::path& file) {
    for (const CameraSettings& camera : cameras) {
      if (std::find(names.begin(), names.end(), camera.name) != names.end()) continue;
      throw InputError(SourceLocation{file.string()},
                       "key 'cameras': no recording has a folder cameras/" + camera.name +
                           DidYouMean(camera.name, names));
    }
  };
  check(experiment.cameras, experiment.folder / "experiment.yaml");
  for (const Recording& recording : experiment.recordings) {
    check(recording.camera_settings, recording.folder / "recording.yaml");
  }
}

Experiment ReadWholeExperiment(const fs::path& folder, const ConfigLoader& load) {
  Experiment experiment = ReadExperimentSettings(folder / "experiment.yaml", load);
  const fs::path recordings = folder / "recordings";
  if (!fs::is_directory(recordings)) {
    throw InputError(SourceLocation{folder.string()}, "has no folder 'recordings'");
  }
  for (const fs::path& entry : EntriesOf(recordings)) {
    if (fs::is_directory(entry)) experiment.recordings.push_back(ReadRecording(entry, load));
  }
  if (experiment.recordings.empty()) {
    throw InputError(SourceLocation{recordings.string()}, "holds no recording");
  }
  RefuseUnknownCameras(experiment);
  return experiment;
}

Experiment ReadSingleRecording(const fs::path& folder, const ConfigLoader& load) {
  const fs::path above = fs::absolute(folder / "..").lexically_normal();
  const fs::path settings = above / ".." / "experiment.yaml";
  Experiment experiment;
  if (NameOf(above) == "recordings" && fs::exists(settings)) {
    experiment = ReadExperimentSettings(settings.lexically_normal(), load);
  }
  experiment.folder = folder;
  experiment.recordings.push_back(ReadRecording(folder, load));
  return experiment;
}

}  // namespace

Experiment ReadExperiment(const fs::path& folder, const ConfigLoader& load) {
  if (!fs::is_directory(folder)) {
    throw InputError(SourceLocation{folder.string()},
                     "is no folder (an experiment or a recording is expected)");
  }
  if (fs::exists(folder / "experiment.yaml")) return ReadWholeExperiment(folder, load);
  if (fs::exists(folder / "recording.yaml")) return ReadSingleRecording(folder, load);
  throw InputError(SourceLocation{folder.string()},
                   "has neither experiment.yaml nor recording.yaml");
}

void WriteExperiment(const Experiment& experiment, const fs::path& folder) {
  if (fs::exists(folder / "experiment.yaml")) {
    throw InputError(SourceLocation{folder.string()},
                     "holds an experiment already; it is never overwritten");
  }
  CreateFolder(folder);
  for (const Recording& recording : experiment.recordings) {
    WriteRecording(recording, folder / "recordings" / recording.name);
  }
  WriteExperimentSettings(experiment, folder / "experiment.yaml");
}

}  // namespace palpate::experiment
