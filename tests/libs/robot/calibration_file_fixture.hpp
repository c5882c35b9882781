// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/robot/calibration_file.hpp"
#include "tests/libs/robot/beam_model.hpp"

namespace palpate::robot {

/// An example of a calibration file of the beam, and what is said of it where it was altered.
class CalibrationFileFixture : public BeamModelTest {
 protected:
  virtual CalibrationFile Example() const = 0;

  std::string ReadRefusal(const std::string& text) const {
    WriteFile(file_, text);
    try {
      ReadCalibrationFile(file_, app::LoadYaml);
    } catch (const InputError& error) {
      return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return {};
  }

  /// The example's file with one text replaced.
  std::string Altered(const std::string& old_text, const std::string& new_text) const {
    WriteCalibrationFile(Example(), file_);
    std::string text = ReadFile(file_);
    const size_t at = text.find(old_text);
    EXPECT_NE(at, std::string::npos) << old_text;
    return text.replace(at, old_text.size(), new_text);
  }

  std::unique_ptr<RobotModel> model_ = Build(FullRobotText());
  std::filesystem::path file_ = folder_ / "calibration.yaml";
};

}  // namespace palpate::robot
