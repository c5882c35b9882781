// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::calibration {

/// An experiment folder of this test's own with one recording "hang" of two beam markers, removed
/// at its end. Reference in its first two frames, steady in its last three.
class RecordingFolder {
 public:
  RecordingFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) /
            ("palpate_" + std::string(test->name()) + "_" + std::to_string(getpid()));
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_ / "recordings/hang");
    Write("experiment.yaml", "frame: robot\nmarkers_sigma_m: [1.0e-4, 2.0e-4, 3.0e-4]\n");
    Write("recordings/hang/recording.yaml",
          "kind: known_load\n"
          "reference: {window_s: [0, 0.15], shape: undeformed}\nsteady_window_s: [0.95, 1.25]\n");
    Write("recordings/hang/markers.csv", Markers());
    Write("recordings/hang/loads.csv",
          "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N,patch_radius_m\n0,0,0.015,0.03,0,0,-0.5,0.005\n");
  }
  ~RecordingFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  RecordingFolder(const RecordingFolder&) = delete;
  RecordingFolder& operator=(const RecordingFolder&) = delete;

  void Write(const std::string& name, const std::string& text) const {
    WriteFile(path_ / name, text);
  }
  experiment::Experiment Read() const { return experiment::ReadExperiment(path_, app::LoadYaml); }

  /// m0 sinks by 10 mm, 2 mm to and fro; m1 stays, and is not seen at 1.1 s.
  static std::string Markers() {
    return "t_s,marker,x_m,y_m,z_m\n"
           "0.0,m0,0.1,0.2,0.3\n0.0,m1,0,0,0\n"
           "0.1,m0,0.1,0.2,0.3\n0.1,m1,0,0,0\n"
           "1.0,m0,0.1,0.2,0.288\n1.0,m1,0,0,0\n"
           "1.1,m0,0.1,0.2,0.292\n1.1,m1,,,\n"
           "1.2,m0,0.1,0.2,0.290\n1.2,m1,0,0,0\n";
  }

 private:
  std::filesystem::path path_;
};

}  // namespace palpate::calibration
