// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/app/yaml.hpp"
#include "libs/experiment/experiment.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::calibration {

/// An experiment folder with one recording "hang" of two beam markers. Reference in its first two
/// frames, steady in its last three.
class RecordingFolder {
 public:
  RecordingFolder() {
    Write("experiment.yaml", "frame: robot\nmarkers_sigma_m: [1.0e-4, 2.0e-4, 3.0e-4]\n");
    Write("recordings/hang/recording.yaml",
          "kind: known_load\n"
          "reference: {window_s: [0, 0.15], shape: undeformed}\nsteady_window_s: [0.95, 1.25]\n");
    Write("recordings/hang/markers.csv", Markers());
    Write("recordings/hang/loads.csv",
          "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N,patch_radius_m\n0,0,0.015,0.03,0,0,-0.5,0.005\n");
  }

  void Write(const std::string& name, const std::string& text) const { folder_.Write(name, text); }
  experiment::Experiment Read() const {
    return experiment::ReadExperiment(folder_.path(), app::LoadYaml);
  }

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
  test_support::TestFolder folder_;
};

}  // namespace palpate::calibration
