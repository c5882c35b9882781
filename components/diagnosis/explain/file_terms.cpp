// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/explain/file_terms.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

/// The numbers that faults change, in the units in which people read them.
class ValuesInFiles {
 public:
  ValuesInFiles(const robot::RobotDescription& robot, const robot::CalibrationFile& calibration) {
    constexpr double kKilo = 1e-3;
    constexpr double kMilli = 1e3;
    const std::vector<robot::CalibratedDrive>& drives = calibration.drives;
    Add("E of the body", "kPa", kKilo * robot.material.youngs_modulus_Pa);
    Add("Poisson's ratio of the body", "", robot.material.poissons_ratio);
    if (robot.mass.density_kg_m3) Add("density of the body", "kg/m³", *robot.mass.density_kg_m3);
    if (robot.mass.total_kg) Add("mass of the body", "g", kMilli * *robot.mass.total_kg);
    double creep = 0.0;
    for (const fem::PronyTerm& term : robot.creep) creep += term.g;
    Add("creep of the body", "%", 100.0 * creep);
    Add("relaxation time of the last creep term", "s",
        robot.creep.empty() ? 0.0 : robot.creep.back().tau_s);
    const auto& softening = robot.softening;
    Add("softening of the body (1 / r)", "%", softening ? 100.0 / softening->r : 0.0);
    Add("m of the softening", "J/m³", softening ? softening->m_J_m3 : 0.0);
    for (const robot::RegionSettings& region : robot.regions) {
      const double E_Pa = region.youngs_modulus_Pa.value_or(robot.material.youngs_modulus_Pa);
      Add("E of `" + region.name + "`", "kPa", kKilo * E_Pa);
    }
    for (const robot::CableSettings& cable : robot.cables) {
      const std::string of = " of cable `" + cable.name + "`";
      Add("friction" + of, "", cable.friction_coefficient);
      Add("play" + of, "mm", kMilli * cable.play_m);
      for (int axis = 0; axis < 3; ++axis) {
        Add(std::string(1, "xyz"[axis]) + " of the fixed eyelet" + of, "mm",
            kMilli * cable.path_m(axis, 0));
        Add("mean " + std::string(1, "xyz"[axis]) + " of the eyelets in the body" + of, "mm",
            kMilli * cable.path_m.row(axis).tail(cable.path_m.cols() - 1).mean());
      }
      const auto drive = std::find_if(drives.begin(), drives.end(),
                                      [&](const auto& one) { return one.cable == cable.name; });
      const bool known = drive != drives.end();
      Add("gain of the actuator" + of, "", 1.0 + (known ? drive->drive.gain : 0.0));
      Add("zero offset of the actuator" + of, "mm", known ? kMilli * drive->drive.offset_m : 0.0);
    }
    for (const robot::ChamberSettings& chamber : robot.chambers) {
      AddPressureSensor(chamber.name, calibration.pressure_sensors);
    }
  }

  const std::vector<ChangedValue>& all() const { return all_; }

 private:
  void AddPressureSensor(const std::string& chamber,
                         const std::vector<robot::CalibratedPressureSensor>& sensors) {
    const auto sensor = std::find_if(sensors.begin(), sensors.end(),
                                     [&](const auto& one) { return one.chamber == chamber; });
    const robot::CalibratedNumber none;
    const bool known = sensor != sensors.end();
    const std::string of = " of the pressure sensor of chamber `" + chamber + "`";
    Add("gain" + of, "", 1.0 + (known ? sensor->gain.value_or(none).value : 0.0));
    Add("zero" + of, "Pa", known ? sensor->zero_Pa.value_or(none).value : 0.0);
  }

  void Add(std::string words, std::string unit, double value) {
    all_.push_back({.words = std::move(words), .unit = std::move(unit), .before = value});
  }

  std::vector<ChangedValue> all_;
};

/// None where the fault has no place in the files, or changes what they are a list of.
std::optional<std::vector<ChangedValue>> ValuesWith(const FaultModel& fault,
                                                    const Eigen::VectorXd& z,
                                                    robot::RobotDescription robot) {
  robot::CalibrationFile calibration;
  if (!fault.Extend(z, &robot, &calibration)) return std::nullopt;
  return ValuesInFiles(robot, calibration).all();
}

}  // namespace

std::vector<ChangedValue> ChangesInFiles(const FaultModel& fault, const Eigen::VectorXd& z,
                                         const Eigen::MatrixXd& covariance,
                                         const robot::RobotDescription& robot) {
  constexpr double kOf95 = 1.96;
  const auto after = ValuesWith(fault, z, robot);
  if (!after) return {};
  std::vector<ChangedValue> changes = ValuesInFiles(robot, {}).all();
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(std::ssize(changes), z.size());
  for (Eigen::Index p = 0; p < z.size(); ++p) {
    const double step = std::sqrt(covariance(p, p));
    if (!(step > 0.0)) continue;
    const auto beside = ValuesWith(fault, z + step * Eigen::VectorXd::Unit(z.size(), p), robot);
    for (Eigen::Index k = 0; k < slope.rows(); ++k) {
      slope(k, p) = ((*beside)[At(k)].before - (*after)[At(k)].before) / step;
    }
  }
  for (Eigen::Index k = 0; k < slope.rows(); ++k) {
    ChangedValue& one = changes[At(k)];
    one.after = (*after)[At(k)].before;
    const double half = kOf95 * std::sqrt(slope.row(k) * covariance * slope.row(k).transpose());
    one.ci95_low = one.after - half;
    one.ci95_high = one.after + half;
  }
  // A modulus of the whole body changes that of each region, too: that need not be said.
  std::erase_if(changes, [](const ChangedValue& one) { return one.after == one.before; });
  const bool whole = !changes.empty() && changes.front().words == "E of the body";
  if (whole) changes.resize(1);
  return changes;
}

}  // namespace palpate::diagnosis
