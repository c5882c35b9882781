// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "libs/app/child_process.hpp"
#include "libs/core/file.hpp"
#include "tests/components/palpate/test_robot.hpp"
#include "tests/support/measured_data.hpp"

namespace palpate::command {
namespace {

namespace fs = std::filesystem;

fs::path BeamFolder() { return test_support::MeasuredDataFolder() / "silicone_beam"; }

/// A measured silicone beam that sags under its own weight and under 52 g at its tip, from when it
/// has rung down (Dubied et al., RA-L 2022; measured data, not part of the project).
class MeasuredBeam : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(BeamFolder())) GTEST_SKIP() << "no measured beam in " << BeamFolder();
    Import("beam_gravity_V2_a.c3d", "gravity_a", "hold", "0:0.6", "2.5:4.95");
    Import("beam_load52_V2_a.c3d", "load52g_a", "known_load", "0:0.35", "3:5.95");
    folder_.Write("exp/recordings/load52g_a/loads.csv",
                  "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N,patch_radius_m\n"
                  "0,0,0.015,0.03,0,0,-0.51,0.005\n");
  }

  void Palpate(const std::vector<std::string>& words) {
    app::ChildProcess program(PALPATE_BINARY_DIR "/bin/palpate", words, {}, folder_ / "log");
    ASSERT_EQ(program.Wait(), 0) << ReadFile(folder_ / "log");
  }

  void Import(const std::string& file, const std::string& recording, const std::string& kind,
              const std::string& held, const std::string& settled) {
    std::vector<std::string> words = {"import", (BeamFolder() / file).string()};
    const auto option = [&](const std::string& name, const std::string& value) {
      words.insert(words.end(), {name, value});
    };
    if (!fs::exists(folder_ / "exp")) option("--markers-sigma", "1e-5");
    option("--out", (folder_ / "exp").string());
    option("--recording", recording);
    option("--robot", "beam");
    option("--kind", kind);
    option("--markers", "Tip-1,Tip-2,Tip-3");
    option("--rest-window", held);
    option("--rest-shape", "undeformed");
    option("--steady-window", settled);
    option("--rate", "10");
    words.emplace_back("--register");
    Palpate(words);
  }

  /// Of a beam of this modulus.
  nlohmann::json Diagnose(const std::string& youngs_modulus_Pa) {
    const std::string config = PALPATE_SOURCE_DIR "/config/robots/";
    std::string robot = ReadFile(config + "beam.yaml");
    robot = std::regex_replace(robot, std::regex("250.0e3"), youngs_modulus_Pa);
    robot = std::regex_replace(robot, std::regex("beam\\.msh"), config + "beam.msh");
    const fs::path file = folder_.Write("beam.yaml", robot);
    Palpate({"diagnose", file.string(), "--data", (folder_ / "exp").string(), "--out",
             (folder_ / "diagnosis").string()});
    return nlohmann::json::parse(ReadFile(folder_ / "diagnosis/verdict.json"));
  }

  TestFolder folder_;
};

/// What of a recording's error stays where all but this recording were fitted.
double StaysHeldOut(const nlohmann::json& verdict, const std::string& recording) {
  for (const auto& one : verdict["recordings"]) {
    const auto& rms_m = one["residual_m_rms"];
    if (one["name"] == recording) {
      return rms_m["heldout_after"].get<double>() / rms_m["before"].get<double>();
    }
  }
  ADD_FAILURE() << "no recording " << recording;
  return 1.0;
}

TEST_F(MeasuredBeam, OfADataSheetsModulusNeedsAnother) {
  // The tensile modulus of a data sheet; the beam's authors fit 264 to 293 kPa.
  const nlohmann::json verdict = Diagnose("120.0e3");
  ASSERT_FALSE(verdict["causes"].empty()) << verdict["reason"];
  const auto& cause = verdict["causes"][0];
  EXPECT_EQ(cause["id"], "youngs_modulus");
  const double factor = cause["parameters"]["factor"]["value"].get<double>();
  EXPECT_GT(factor, 260.0 / 120.0 * 0.9);
  EXPECT_LT(factor, 293.0 / 120.0 * 1.1);
  for (const char* recording : {"gravity_a", "load52g_a"}) {
    EXPECT_LT(StaysHeldOut(verdict, recording), 0.1) << recording;
  }
  // Forces of half the size become right with the modulus.
  const auto& force_N = verdict["force_error_N_rms"];
  EXPECT_GT(force_N["before"], 0.2);
  EXPECT_LT(force_N["after"], 0.5 * force_N["before"].get<double>());
}

TEST_F(MeasuredBeam, OfTheRightModulusCreeps) {
  const nlohmann::json verdict = Diagnose("263.8e3");
  ASSERT_FALSE(verdict["causes"].empty()) << verdict["reason"];
  EXPECT_EQ(verdict["causes"][0]["id"], "viscoelastic_creep");
  for (const char* recording : {"gravity_a", "load52g_a"}) {
    EXPECT_LT(StaysHeldOut(verdict, recording), 0.5) << recording;
  }
}

}  // namespace
}  // namespace palpate::command
