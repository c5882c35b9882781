// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/genicam/device_setup.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

namespace palpate::capture {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// In the order of preference: exact and cheap ones first.
constexpr const char* kDepthFormats[] = {"Coord3D_C16",  "Disparity16",    "Coord3D_ABC16",
                                         "Coord3D_C32f", "Coord3D_ABC32f", "Coord3D_ABCY16"};
constexpr const char* kSingleImageFormats[] = {"Coord3D_ABCY16", "Coord3D_C16",  "Coord3D_ABC16",
                                               "Disparity16",    "Coord3D_C32f", "Coord3D_ABC32f"};
constexpr const char* kColorFormats[] = {"RGB8",     "BGR8",  "BayerRG8", "BayerGR8", "BayerGB8",
                                         "BayerBG8", "RGBa8", "BGRa8",    "Mono8",    "Mono16"};

using Entries = std::vector<std::pair<std::string, std::int64_t>>;

bool Holds(const Entries& entries, const std::string& name) {
  return std::any_of(entries.begin(), entries.end(),
                     [&](const auto& entry) { return entry.first == name; });
}

int SizeOf(Features& features, const char* name) {
  const auto size = features.Integer(name);
  return size && *size > 0 && *size <= 16384 ? static_cast<int>(*size) : 0;
}

class Configurer {
 public:
  Configurer(Features& features, const DeviceWishes& wishes)
      : features_(features), wishes_(wishes) {}

  DeviceSetup Run() {
    setup_.status = Status::Ok();
    setup_.exposure_s = setup_.gain_dB = kUnknown;
    Unlock();
    ChooseComponents();
    if (!depth_component_.empty() || color_component_.empty()) ChooseMainFormat();
    if (!color_component_.empty()) ChooseColorFormat();
    if (setup_.status.ok()) SetTaking();
    if (setup_.status.ok()) ReadBack();
    for (const std::string& note : features_.Notes()) Note(note);
    return std::move(setup_);
  }

 private:
  bool wants_depth() const { return wishes_.role != DeviceRole::kColorOnly; }
  bool wants_color() const { return wishes_.role != DeviceRole::kDepthOnly; }

  void Refuse(const std::string& message) {
    if (setup_.status.ok()) setup_.status = Status(StatusCode::kInvalidInput, message);
  }
  void Note(const std::string& note) { setup_.notes.push_back(note); }

  /// Sets what is there; a refusal becomes a note.
  bool Try(const char* name, const FeatureValue& value, bool wanted = true) {
    if (!features_.Has(name)) {
      if (wanted) Note(std::string("the camera has no ") + name);
      return false;
    }
    const Status status = features_.Set(name, value);
    if (!status.ok() && wanted) {
      Note(std::string("the camera refuses ") + name + ": " + status.message());
    }
    return status.ok();
  }

  /// A program that was killed may have left the camera streaming, its features locked.
  void Unlock() {
    if (features_.Has("AcquisitionStop")) (void)features_.Execute("AcquisitionStop");
    if (features_.Has("TLParamsLocked")) (void)features_.Set("TLParamsLocked", std::int64_t{0});
  }

  static std::string FirstOf(const Entries& entries, std::initializer_list<const char*> names) {
    for (const char* name : names) {
      if (Holds(entries, name)) return name;
    }
    return "";
  }

  void ChooseComponents() {
    const Entries entries = features_.Choices("ComponentSelector");
    depth_component_ = FirstOf(entries, {"Range", "Disparity"});
    color_component_ = FirstOf(entries, {"Intensity", "Color", "IntensityCombined"});
    if (!wants_depth()) depth_component_.clear();
    if (!wants_color()) color_component_.clear();
    // One image without a name of its own may carry depth too: its pixel format decides.
    if (wants_depth() && depth_component_.empty()) color_component_.clear();
    for (const auto& [name, id] : entries) EnableComponent(name);
    if (features_.Has("ArvGevSCCFGMultipart")) Try("ArvGevSCCFGMultipart", true);
  }

  void EnableComponent(const std::string& name) {
    if (!Select(features_, "ComponentSelector", name)) return;
    const bool wanted = name == depth_component_ || name == color_component_;
    const bool named = !depth_component_.empty() || !color_component_.empty();
    if (named && features_.Has("ComponentEnable") &&
        features_.Bool("ComponentEnable").value_or(!wanted) != wanted) {
      Try("ComponentEnable", wanted, wanted);
    }
  }

  /// The format of the selected component: the wish, else what it has, else the first that is
  /// decoded. Returns what it is then.
  PixelFormat ChooseFormat(const std::string& wish, const char* const* first,
                           const char* const* last, bool (*decoded)(PixelFormat)) {
    const Entries entries = features_.Choices("PixelFormat");
    for (const auto& [name, code] : entries) setup_.codes.Learn(name, code);
    const std::string now = features_.Text("PixelFormat").value_or("");
    if (!wish.empty() && wish != now) Try("PixelFormat", wish);
    if (wish.empty() && !decoded(FormatOfName(now))) {
      const auto* found =
          std::find_if(first, last, [&](const char* name) { return Holds(entries, name); });
      if (found != last) Try("PixelFormat", std::string(*found));
    }
    return FormatOfName(features_.Text("PixelFormat").value_or(""));
  }

  void ChooseMainFormat() {
    if (!depth_component_.empty()) Select(features_, "ComponentSelector", depth_component_);
    if (!wants_depth()) {  // one image, of a colour camera
      main_format_ = ChooseFormat(wishes_.color_format, std::begin(kColorFormats),
                                  std::end(kColorFormats), CarriesColor);
    } else if (depth_component_.empty()) {
      main_format_ = ChooseFormat(wishes_.depth_format, std::begin(kSingleImageFormats),
                                  std::end(kSingleImageFormats), CarriesDepth);
    } else {
      main_format_ = ChooseFormat(wishes_.depth_format, std::begin(kDepthFormats),
                                  std::end(kDepthFormats), CarriesDepth);
    }
    const bool usable = wants_depth() ? CarriesDepth(main_format_) : CarriesColor(main_format_);
    if (usable) return;
    const std::string format = features_.Text("PixelFormat").value_or("no pixel format");
    Refuse(wants_depth() ? "the camera sends no depth: it has no Range or Disparity component and "
                           "no Coord3D pixel format (" +
                               format + "); is it a colour camera?"
                         : "the pixel format " + format + " of the colour camera is not decoded");
  }

  void ChooseColorFormat() {
    Select(features_, "ComponentSelector", color_component_);
    color_format_ = ChooseFormat(wishes_.color_format, std::begin(kColorFormats),
                                 std::end(kColorFormats), CarriesColor);
    if (CarriesColor(color_format_)) return;
    const std::string note = "the intensity format " +
                             features_.Text("PixelFormat").value_or("unknown") + " is not decoded";
    if (!wants_depth()) {
      Refuse(note);
    } else {
      Note(note + ": there is no colour");
    }
  }

  void SetTaking() {
    Try("AcquisitionMode", std::string("Continuous"), false);
    Select(features_, "TriggerSelector", "FrameStart");
    const bool triggered = !wishes_.trigger_source.empty();
    Try("TriggerMode", std::string(triggered ? "On" : "Off"), triggered);
    if (triggered) Try("TriggerSource", wishes_.trigger_source);
    if (wishes_.frame_rate_Hz) {
      Try("AcquisitionFrameRateEnable", true, false);
      Try("AcquisitionFrameRate", *wishes_.frame_rate_Hz);
    }
    if (wishes_.exposure_s) {
      Try("ExposureAuto", std::string("Off"), false);
      Try("ExposureTime", *wishes_.exposure_s * 1e6);
    }
    if (wishes_.gain_dB) {
      Try("GainAuto", std::string("Off"), false);
      Try("Gain", *wishes_.gain_dB);
    }
    if (wishes_.packet_delay_ns) Try("GevSCPD", std::int64_t{*wishes_.packet_delay_ns});
  }

  void ReadBack() {
    const auto exposure_us = features_.Number("ExposureTime");
    setup_.exposure_s = exposure_us ? *exposure_us * 1e-6 : kUnknown;
    setup_.gain_dB = features_.Number("Gain").value_or(kUnknown);
    const double rate_Hz = features_.Number("AcquisitionFrameRate").value_or(0.0);
    const bool sound_rate = std::isfinite(rate_Hz) && rate_Hz >= 0.1 && rate_Hz <= 10000.0;
    setup_.period_s = sound_rate ? 1.0 / rate_Hz : 0.0;
    setup_.components = ListComponents(features_);
    ReadColor();
    if (wants_depth()) ReadDepth();
  }

  void ReadColor() {
    const bool in_main = CarriesColor(main_format_) && color_component_.empty();
    if (!CarriesColor(color_format_) && !in_main) return;
    if (!color_component_.empty()) Select(features_, "ComponentSelector", color_component_);
    setup_.color.width_px = SizeOf(features_, "Width");
    setup_.color.height_px = SizeOf(features_, "Height");
    setup_.color_calibration = ReadColorCalibration(features_);
    if (!setup_.color_calibration.model) return;
    const rgbd::CameraModel sized = setup_.color;
    setup_.color = *setup_.color_calibration.model;
    setup_.color.width_px = sized.width_px;
    setup_.color.height_px = sized.height_px;
  }

  void ReadDepth() {
    if (!depth_component_.empty()) Select(features_, "ComponentSelector", depth_component_);
    const int width = SizeOf(features_, "Width");
    const int height = SizeOf(features_, "Height");
    if (width == 0 || height == 0) {
      Refuse("the camera reports no valid image size (Width, Height)");
      return;
    }
    Scan3dReading reading = ReadScan3d(features_, width, height, wishes_.scan3d);
    setup_.scan3d = reading.description;
    if (wishes_.scan3d.distortion.empty()) {
      setup_.scan3d.camera.distortion = ReadDepthDistortion(features_);
    }
    setup_.depth_format = main_format_;
    setup_.notes.insert(setup_.notes.end(), reading.notes.begin(), reading.notes.end());
    if (!reading.status.ok()) setup_.status = reading.status;
  }

  Features& features_;
  const DeviceWishes& wishes_;
  DeviceSetup setup_;
  std::string depth_component_;
  std::string color_component_;
  PixelFormat main_format_ = PixelFormat::kUnknown;  ///< of the depth, or of the only image
  PixelFormat color_format_ = PixelFormat::kUnknown;
};

}  // namespace

std::vector<ComponentFacts> ListComponents(Features& features) {
  std::vector<ComponentFacts> components;
  std::string first_enabled;
  for (const auto& [name, value] : features.Choices("ComponentSelector")) {
    if (!Select(features, "ComponentSelector", name)) continue;
    const bool enabled = features.Bool("ComponentEnable").value_or(false);
    components.push_back({name, features.Integer("ComponentIDValue").value_or(value), enabled,
                          features.Text("PixelFormat").value_or("")});
    if (enabled && first_enabled.empty()) first_enabled = name;
  }
  if (!first_enabled.empty()) Select(features, "ComponentSelector", first_enabled);
  return components;
}

DeviceSetup ConfigureDevice(Features& features, const DeviceWishes& wishes) {
  return Configurer(features, wishes).Run();
}

}  // namespace palpate::capture
