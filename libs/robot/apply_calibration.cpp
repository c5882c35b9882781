// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <optional>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/eyelets.hpp"

namespace palpate::robot {

namespace {

std::string ElementName(fem::ElementType element) {
  return element == fem::ElementType::kTet4 ? "tet4" : "tet10";
}

Status Foreign(std::string reason) { return {StatusCode::kInvalidInput, std::move(reason)}; }

/// Nothing where there is none of this name.
std::optional<int> IndexOf(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<int>(found - names.begin());
}

/// Into RobotBody::materials.
std::optional<int> MaterialIndex(const RobotBody& body, const std::string& part) {
  if (part == "body") return 0;
  const std::optional<int> region = IndexOf(body.region_names, part);
  return region ? std::optional<int>(*region + 1) : std::nullopt;
}

}  // namespace

CalibrationFile DescribeForCalibration(const RobotModel& model) {
  const RobotBody& body = model.body();
  CalibrationFile calibration;
  calibration.robot = body.name;
  calibration.mesh_hash = body.mesh_hash;
  calibration.element = ElementName(body.mesh.element_type());
  const fem::Material& material = body.materials.front();
  calibration.model = fem::ToString(material.model);
  calibration.poissons_ratio = body.nominal_poissons_ratio;
  calibration.volumetric = fem::ToString(material.volumetric);
  calibration.c20_over_c10 = material.c20_over_c10;
  calibration.c30_over_c10 = material.c30_over_c10;
  return calibration;
}

Status CheckCalibrated(const CalibrationFile& calibration, const CalibrationFile& present) {
  struct Pair {
    const char* what;
    std::string calibrated, present;
  };
  std::vector<Pair> pairs = {
      {"robot", calibration.robot, present.robot},
      {"element", calibration.element, present.element},
      {"mesh", calibration.mesh_hash, present.mesh_hash},
      {"material", calibration.model, present.model},
      {"Poisson's ratio", FormatNumber(calibration.poissons_ratio),
       FormatNumber(present.poissons_ratio)},
      {"c20_over_c10", FormatNumber(calibration.c20_over_c10), FormatNumber(present.c20_over_c10)},
      {"c30_over_c10", FormatNumber(calibration.c30_over_c10), FormatNumber(present.c30_over_c10)}};
  if (!calibration.volumetric.empty()) {
    pairs.push_back({"volumetric treatment", calibration.volumetric, present.volumetric});
  }
  for (const Pair& pair : pairs) {
    if (pair.calibrated == pair.present) continue;
    return Foreign(std::string("the calibration is for ") + pair.what + " '" + pair.calibrated +
                   "', the robot file gives '" + pair.present +
                   "': calibrate again with this robot file");
  }
  return Status::Ok();
}

void ApplyGeometry(const CalibrationFile& calibration, RobotBody* body) {
  if (calibration.geometry_scale) ScaleBody(calibration.geometry_scale->scale, body);
  const fem::PointLocator locator(body->mesh);
  for (BodyCable& cable : body->cables) {
    for (const CalibratedRoute& route : calibration.cable_routes) {
      const bool of_an_eyelet =
          route.point > 0 && route.point <= static_cast<int>(cable.eyelets.size());
      if (route.cable != cable.name || !of_an_eyelet) continue;
      MoveEyelet(locator, body->scale, route.point - 1, route.moved_m, &cable);
    }
  }
}

namespace {

/// Where the calibration has it, of a robot of scale 1.
Eigen::Vector3d MovedIn(const std::vector<CalibratedRoute>& routes, const std::string& cable,
                        int point) {
  for (const CalibratedRoute& route : routes) {
    if (route.cable == cable && route.point == point) return route.moved_m;
  }
  return Eigen::Vector3d::Zero();
}

/// Every cable and point is there, and the body's eyelets sit where the calibration has them.
Status CheckRoutes(const std::vector<CalibratedRoute>& routes, const RobotBody& body) {
  std::vector<std::string> names;
  for (const BodyCable& cable : body.cables) names.push_back(cable.name);
  for (const CalibratedRoute& route : routes) {
    const std::optional<int> cable = IndexOf(names, route.cable);
    if (!cable) {
      return Foreign("the calibration holds the route of cable '" + route.cable +
                     "', which the robot file does not have" + DidYouMean(route.cable, names));
    }
    const std::size_t points = 1 + body.cables[At(*cable)].eyelets.size();
    if (route.point < static_cast<int>(points)) continue;
    return Foreign("the calibration holds point " + std::to_string(route.point) + " of cable '" +
                   route.cable + "', whose path has " + std::to_string(points) +
                   " points in the robot file");
  }
  for (const BodyCable& cable : body.cables) {
    for (int e = 0; e < static_cast<int>(cable.eyelets.size()); ++e) {
      if (MovedIn(routes, cable.name, e + 1) == EyeletMoved_m(cable, e)) continue;
      return Foreign("the calibration has eyelet " + std::to_string(e + 1) + " of cable '" +
                     cable.name +
                     "' elsewhere than the model: start again with the calibration as a file, or "
                     "calibrate again");
    }
  }
  return Status::Ok();
}

}  // namespace

Status CheckCalibration(const CalibrationFile& calibration, const RobotModel& model) {
  if (Status status = CheckCalibrated(calibration, DescribeForCalibration(model)); !status.ok()) {
    return status;
  }
  const RobotBody& body = model.body();
  for (const CalibratedModulus& modulus : calibration.moduli) {
    if (MaterialIndex(body, modulus.part)) continue;
    return Foreign("the calibration holds a modulus of region '" + modulus.part +
                   "', which the robot file does not have" +
                   DidYouMean(modulus.part, body.region_names));
  }
  for (const CalibratedPoissonsRatio& poissons : calibration.poissons_ratios) {
    if (MaterialIndex(body, poissons.part)) continue;
    return Foreign("the calibration holds Poisson's ratio of region '" + poissons.part +
                   "', which the robot file does not have" +
                   DidYouMean(poissons.part, body.region_names));
  }
  const double scale = calibration.geometry_scale ? calibration.geometry_scale->scale : 1.0;
  if (scale != body.scale) {
    return Foreign("the calibration is for a robot " + FormatNumber(scale) +
                   " times as large as its file says, the model is " + FormatNumber(body.scale) +
                   " times: start again with the calibration as a file, or calibrate again");
  }
  if (Status status = CheckRoutes(calibration.cable_routes, body); !status.ok()) return status;
  const std::vector<std::string> cables = model.ActuatorNames();
  for (const CalibratedDrive& drive : calibration.drives) {
    if (IndexOf(cables, drive.cable)) continue;
    return Foreign("the calibration holds the actuator of cable '" + drive.cable +
                   "', which the robot file does not have" + DidYouMean(drive.cable, cables));
  }
  const std::vector<std::string> chambers = model.ChamberNames();
  for (const CalibratedPressureSensor& sensor : calibration.pressure_sensors) {
    if (IndexOf(chambers, sensor.chamber)) continue;
    return Foreign("the calibration holds the pressure sensor of chamber '" + sensor.chamber +
                   "', which the robot file does not have" + DidYouMean(sensor.chamber, chambers));
  }
  return Status::Ok();
}

void ApplyCalibration(const CalibrationFile& calibration, RobotModel* model) {
  const Status status = CheckCalibration(calibration, *model);
  if (!status.ok()) throw InputError(status.message());
  const std::vector<std::string> cables = model->ActuatorNames();
  for (const CalibratedDrive& drive : calibration.drives) {
    model->SetDrive(IndexOf(cables, drive.cable).value(), drive.drive);
  }
  for (const CalibratedRoute& route : calibration.cable_routes) {
    if (route.point > 0) continue;  // ApplyGeometry's
    const int cable = IndexOf(cables, route.cable).value();
    const RobotBody& body = model->body();
    model->SetPullPoint(cable, body.cables[At(cable)].pull_point_m + body.scale * route.moved_m);
  }
  for (const CalibratedModulus& modulus : calibration.moduli) {
    model->SetYoungsModulus(MaterialIndex(model->body(), modulus.part).value(),
                            modulus.youngs_modulus_Pa);
  }
  for (const CalibratedPoissonsRatio& poissons : calibration.poissons_ratios) {
    model->SetPoissonsRatio(MaterialIndex(model->body(), poissons.part).value(),
                            poissons.poissons_ratio);
  }
  if (calibration.gravity) model->SetGravity(calibration.gravity->gravity_m_s2);
}

double RelativeModulusError(const CalibrationFile& calibration) {
  double largest = 0.0;
  for (const CalibratedModulus& modulus : calibration.moduli) {
    largest = std::max(largest, modulus.standard_error_Pa / modulus.youngs_modulus_Pa);
  }
  return largest;
}

}  // namespace palpate::robot
