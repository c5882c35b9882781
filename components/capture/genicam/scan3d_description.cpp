// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/genicam/scan3d_description.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/text.hpp"

namespace palpate::capture {

namespace {

constexpr double kLeastFocalLength_px = 50.0;
constexpr double kGreatestFocalLength_px = 20000.0;
constexpr double kLeastBaseline_m = 0.005;
constexpr double kGreatestBaseline_m = 2.0;

bool Within(double value, double least, double greatest) {
  return std::isfinite(value) && value >= least && value <= greatest;
}

/// Reads one description, keeping the first refusal.
class Reader {
 public:
  Reader(Features& features, const Scan3dOverrides& overrides)
      : features_(features), overrides_(overrides) {}

  Scan3dReading Read(int width_px, int height_px) {
    reading_.status = Status::Ok();
    ReadMode();
    ReadUnit();
    for (std::size_t axis = 0; axis < 3; ++axis) ReadCoordinate(axis);
    ReadCamera(width_px, height_px);
    ReadBaseline();
    return std::move(reading_);
  }

 private:
  void Refuse(const std::string& message) {
    if (reading_.status.ok()) reading_.status = Status(StatusCode::kInvalidInput, message);
  }
  void Note(std::string note) { reading_.notes.push_back(std::move(note)); }

  void ReadMode() {
    const auto mode = features_.Text("Scan3dOutputMode");
    if (!mode) {
      Note("the camera has no Scan3dOutputMode: ProjectedC is taken");
    } else if (*mode == "DisparityC") {
      reading_.description.mode = OutputMode::kDisparityC;
    } else if (*mode == "CalibratedABC_Grid") {
      reading_.description.mode = OutputMode::kCalibratedAbcGrid;
    } else if (*mode != "ProjectedC") {
      Refuse("Scan3dOutputMode " + *mode +
             " is not decoded (ProjectedC, DisparityC, CalibratedABC_Grid are)");
    }
  }

  void ReadUnit() {
    double& unit_m = reading_.description.distance_unit_m;
    const auto unit = features_.Text("Scan3dDistanceUnit");
    if (overrides_.distance_unit_m) {
      unit_m = *overrides_.distance_unit_m;
    } else if (!unit) {
      Note("the camera has no Scan3dDistanceUnit: millimetres are taken (distance_unit_m)");
    } else if (*unit == "Inch") {
      unit_m = 0.0254;
    } else if (*unit == "Meter" || *unit == "Metre") {
      unit_m = 1.0;
    } else if (*unit == "Pixel") {
      Note("distances in pixels: millimetres are taken for the rest (distance_unit_m)");
    } else if (*unit != "Millimeter") {
      Refuse("unknown Scan3dDistanceUnit '" + *unit + "': give distance_unit_m");
    }
  }

  void ReadCoordinate(std::size_t axis) {
    static constexpr const char* kNames[] = {"CoordinateA", "CoordinateB", "CoordinateC"};
    CoordinateRule& rule = reading_.description.coordinates[axis];
    const bool needed = axis == 2 || reading_.description.mode == OutputMode::kCalibratedAbcGrid;
    if (features_.Has("Scan3dCoordinateSelector") &&
        !Select(features_, "Scan3dCoordinateSelector", kNames[axis])) {
      if (needed) Note(std::string("the camera does not select ") + kNames[axis]);
      // What the features show now is another coordinate's, unless there is only this one.
      if (axis != 2) return;
    }
    ReadScale(axis, needed, &rule);
    // Where the camera says nothing, 0 means no z; x and y may well be 0.
    rule.marks_invalid = features_.Bool("Scan3dInvalidDataFlag").value_or(axis == 2);
    rule.invalid_raw = features_.Number("Scan3dInvalidDataValue").value_or(0.0);
  }

  void ReadScale(std::size_t axis, bool needed, CoordinateRule* rule) {
    rule->scale = features_.Number("Scan3dCoordinateScale").value_or(1.0);
    rule->offset = features_.Number("Scan3dCoordinateOffset").value_or(0.0);
    if (axis == 2 && overrides_.scale_c) rule->scale = *overrides_.scale_c;
    if (needed && !Within(rule->scale, 1e-9, 1e6)) {
      Refuse("Scan3dCoordinateScale is " + FormatNumber(rule->scale) +
             ", not in [1e-9, 1e6]: give coordinate_scale");
    }
    if (needed && !Within(rule->offset, -1e9, 1e9)) {
      Refuse("Scan3dCoordinateOffset is " + FormatNumber(rule->offset) + ", not a sound number");
    }
  }

  /// The override, else the first of the features that holds a number.
  std::optional<double> Find(const std::optional<double>& override_value,
                             std::initializer_list<const char*> names) {
    if (override_value) return override_value;
    for (const char* name : names) {
      if (const auto value = features_.Number(name)) return value;
    }
    return std::nullopt;
  }

  void ReadCamera(int width_px, int height_px) {
    rgbd::CameraModel& camera = reading_.description.camera;
    camera.width_px = width_px;
    camera.height_px = height_px;
    const auto fx = Find(overrides_.fx_px, {"Scan3dFocalLength", "CalibFocalLengthX"});
    CheckFocalLength(fx, "depth.intrinsics_px");
    camera.fx_px = fx.value_or(0.0);
    camera.fy_px = FocalLengthY(camera.fx_px);
    // Principal points are those of the whole sensor image, as region offsets are.
    const double left_px = features_.Number("OffsetX").value_or(0.0);
    const double top_px = features_.Number("OffsetY").value_or(0.0);
    camera.cx_px = PrincipalPoint(overrides_.cx_px, "Scan3dPrincipalPointU", "CalibOpticalCenterX",
                                  left_px, width_px, "depth.intrinsics_px");
    camera.cy_px = PrincipalPoint(overrides_.cy_px, "Scan3dPrincipalPointV", "CalibOpticalCenterY",
                                  top_px, height_px, "depth.intrinsics_px");
    std::copy_n(overrides_.distortion.begin(),
                std::min(overrides_.distortion.size(), camera.distortion.size()),
                camera.distortion.begin());
  }

  double FocalLengthY(double fx_px) {
    if (overrides_.fy_px) return *overrides_.fy_px;
    if (overrides_.fx_px) return fx_px;
    const auto fy = features_.Number("CalibFocalLengthY");
    if (!features_.Has("Scan3dFocalLength") && fy) {
      CheckFocalLength(fy, "depth.intrinsics_px");
      return *fy;
    }
    // SFNC does not say which way round; cameras of square pixels, all that are known, say 1.
    const double aspect = features_.Number("Scan3dAspectRatio").value_or(1.0);
    if (Within(aspect, 0.1, 10.0)) return fx_px * aspect;
    Note("Scan3dAspectRatio " + FormatNumber(aspect) +
         " is absurd: 1 is taken (depth.intrinsics_px)");
    return fx_px;
  }

  void CheckFocalLength(const std::optional<double>& focal_px, const char* setting) {
    if (!focal_px) {
      Refuse(std::string("the camera does not report its focal length: give ") + setting);
    } else if (!Within(*focal_px, kLeastFocalLength_px, kGreatestFocalLength_px)) {
      Refuse("the focal length is " + FormatNumber(*focal_px) + " px, not in [50, 20000]: give " +
             setting);
    }
  }

  double PrincipalPoint(const std::optional<double>& override_px, const char* name,
                        const char* other_name, double first_px, int size_px, const char* setting) {
    if (override_px) return *override_px;
    const double middle_px = 0.5 * (size_px - 1);
    const auto reported = Find({}, {name, other_name});
    if (!reported) {
      Note(std::string("the camera does not report its principal point: the middle is taken (") +
           setting + ")");
      return middle_px;
    }
    if (*reported == 0.0) {
      Note(std::string("the camera reports 0 for its principal point, as where it is not known: ") +
           "the middle is taken (" + setting + ")");
      return middle_px;
    }
    const double point_px = *reported - first_px;
    if (!Within(point_px, -0.5 * size_px, 1.5 * size_px)) {
      Refuse(std::string(name) + " is " + FormatNumber(point_px) + " px of an image of " +
             std::to_string(size_px) + " px: give " + setting);
    }
    return point_px;
  }

  void ReadBaseline() {
    double& baseline_m = reading_.description.baseline_m;
    const auto reported = features_.Number("Scan3dBaseline");
    if (overrides_.baseline_m) {
      baseline_m = *overrides_.baseline_m;
    } else if (reported) {
      baseline_m = PlausibleBaseline(*reported);
    }
    if (reading_.description.mode == OutputMode::kDisparityC && !(baseline_m > 0.0)) {
      Refuse("disparities need the baseline, which the camera does not report: give baseline_m");
    }
  }

  double PlausibleBaseline(double reported) {
    const double in_units_m = reported * reading_.description.distance_unit_m;
    if (Within(in_units_m, kLeastBaseline_m, kGreatestBaseline_m)) return in_units_m;
    if (Within(reported, kLeastBaseline_m, kGreatestBaseline_m)) {
      Note("Scan3dBaseline " + FormatNumber(reported) + " is taken in metres (baseline_m)");
      return reported;
    }
    Note("Scan3dBaseline " + FormatNumber(reported) + " is absurd: unknown (baseline_m)");
    return 0.0;
  }

  Features& features_;
  const Scan3dOverrides& overrides_;
  Scan3dReading reading_;
};

}  // namespace

Scan3dReading ReadScan3d(Features& features, int width_px, int height_px,
                         const Scan3dOverrides& overrides) {
  return Reader(features, overrides).Read(width_px, height_px);
}

}  // namespace palpate::capture
