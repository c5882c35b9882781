// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/gige_vision/camera_features.hpp"

#include <string>

namespace palpate::gige_vision {
namespace {

using Kind = Feature::Kind;

constexpr double kDefaultExposure_us = 8000.0;
constexpr double kMmInM = 1000.0;

void AddDeviceControl(FeatureTable* table) {
  const std::string category = "DeviceControl";
  const auto text = [&](const char* name, std::uint32_t address, std::size_t size) {
    return Feature(Kind::kText, category, name).At(address, size);
  };
  table->push_back(text("DeviceVendorName", boot::kManufacturer, 32));
  table->push_back(text("DeviceModelName", boot::kModel, 32));
  table->push_back(text("DeviceManufacturerInfo", boot::kManufacturerInfo, 48));
  table->push_back(text("DeviceVersion", boot::kDeviceVersion, 32));
  table->push_back(text("DeviceSerialNumber", boot::kSerial, 16));
  table->push_back(text("DeviceUserID", boot::kUserName, 16).Writable());
  table->push_back(Feature(Kind::kEnumeration, category, "DeviceScanType")
                       .Entries({{"Areascan3D", 2}})
                       .Value(2));
  table->push_back(Feature(Kind::kInteger, category, "DeviceSFNCVersionMajor").Value(2));
  table->push_back(Feature(Kind::kInteger, category, "DeviceSFNCVersionMinor").Value(5));
  table->push_back(
      Feature(Kind::kFloat, category, "DeviceTemperature").Unit("C").Changing().Value(25.0));
  table->push_back(Feature(Kind::kCommand, category, "TimestampLatch"));
  table->push_back(Feature(Kind::kCommand, category, "TimestampReset"));
  table->push_back(
      Feature(Kind::kInteger, category, "TimestampLatchValue").Wide().Unit("ns").Changing());
  table->push_back(Feature(Kind::kInteger, category, "Timestamp").Wide().Unit("ns").Changing());
}

struct ComponentNames {
  const char* component;
  const char* format;
};

ComponentNames NamesOf(ComponentId id) {
  switch (id) {
    case ComponentId::kRange: return {"Range", "Coord3D_C16"};
    case ComponentId::kIntensity: return {"Intensity", "RGB8"};
    case ComponentId::kConfidence: return {"Confidence", "Confidence8"};
  }
  return {"", ""};
}

/// What differs between the components, indexed like ComponentSelector.
struct PerComponent {
  std::vector<std::pair<std::string, std::uint32_t>> names;
  std::vector<std::pair<std::string, std::uint32_t>> format_names;
  std::vector<double> ids, formats, enabled, none;
  std::vector<double> widths, heights;
  std::vector<std::size_t> regions;  ///< the confidence is of the range's pixels
};

PerComponent Collect(const DeviceSettings& settings, const rgbd::RgbdCamera& camera) {
  PerComponent per;
  for (const ComponentId id : Components(settings, camera)) {
    const std::size_t index = per.names.size();
    const rgbd::CameraModel& sensor = id == ComponentId::kIntensity ? camera.color : camera.depth;
    per.names.emplace_back(NamesOf(id).component, static_cast<std::uint32_t>(index));
    per.format_names.emplace_back(NamesOf(id).format, PixelFormatOf(id));
    per.ids.push_back(static_cast<double>(id));
    per.formats.push_back(PixelFormatOf(id));
    per.enabled.push_back(1.0);
    per.none.push_back(0.0);
    per.widths.push_back(sensor.width_px);
    per.heights.push_back(sensor.height_px);
    per.regions.push_back(id == ComponentId::kConfidence ? 0 : index);
  }
  return per;
}

void AddImageFormatControl(const DeviceSettings& settings, const rgbd::RgbdCamera& camera,
                           FeatureTable* table) {
  const std::string category = "ImageFormatControl";
  const std::string selector = "ComponentSelector";
  const PerComponent per = Collect(settings, camera);
  const auto integer = [&](const char* name, const std::vector<double>& values) {
    return Feature(Kind::kInteger, category, name).Values(values).SelectedBy(selector, per.regions);
  };
  table->push_back(Feature(Kind::kEnumeration, category, selector).Entries(per.names).Writable());
  table->push_back(Feature(Kind::kBoolean, category, "ComponentEnable")
                       .Values(per.enabled)
                       .SelectedBy(selector)
                       .Range(0, 1)
                       .Locked());
  table->push_back(
      Feature(Kind::kInteger, category, "ComponentIDValue").Values(per.ids).SelectedBy(selector));
  table->push_back(Feature(Kind::kEnumeration, category, "PixelFormat")
                       .Entries(per.format_names)
                       .Values(per.formats)
                       .SelectedBy(selector)
                       .Locked());
  table->push_back(integer("SensorWidth", per.widths));
  table->push_back(integer("SensorHeight", per.heights));
  table->push_back(integer("WidthMax", per.widths));
  table->push_back(integer("HeightMax", per.heights));
  table->push_back(integer("Width", per.widths).Range(16, 65535).MaxFrom("WidthMax").Locked());
  table->push_back(integer("Height", per.heights).Range(16, 65535).MaxFrom("HeightMax").Locked());
  table->push_back(integer("OffsetX", per.none).Range(0, 65535).MaxFrom("WidthMax").Locked());
  table->push_back(integer("OffsetY", per.none).Range(0, 65535).MaxFrom("HeightMax").Locked());
}

void AddCoordinates(const rgbd::RgbdCamera& camera, FeatureTable* table) {
  const std::string category = "Scan3dControl";
  const std::string selector = "Scan3dCoordinateSelector";
  const double step_mm = camera.depth_unit_m * kMmInM;
  const double invalid = camera.invalid_value;
  const auto of_axes = [&](Kind kind, const char* name, std::vector<double> values) {
    return Feature(kind, category, name).Values(std::move(values)).SelectedBy(selector);
  };
  table->push_back(Feature(Kind::kEnumeration, category, selector)
                       .Entries({{"CoordinateA", 0}, {"CoordinateB", 1}, {"CoordinateC", 2}})
                       .Value(2)
                       .Writable());
  table->push_back(of_axes(Kind::kFloat, "Scan3dCoordinateScale", {1.0, 1.0, step_mm}));
  table->push_back(of_axes(Kind::kFloat, "Scan3dCoordinateOffset", {0.0, 0.0, 0.0}));
  table->push_back(of_axes(Kind::kBoolean, "Scan3dInvalidDataFlag", {0.0, 0.0, 1.0}));
  table->push_back(of_axes(Kind::kFloat, "Scan3dInvalidDataValue", {0.0, 0.0, invalid}));
  table->push_back(of_axes(Kind::kFloat, "Scan3dAxisMin", {0.0, 0.0, 0.0}));
  table->push_back(
      of_axes(Kind::kFloat, "Scan3dAxisMax",
              {camera.depth.width_px - 1.0, camera.depth.height_px - 1.0, 65535.0 * step_mm}));
}

void AddScan3dControl(const rgbd::RgbdCamera& camera, FeatureTable* table) {
  const std::string category = "Scan3dControl";
  const auto constant = [&](const char* name, const char* entry, std::uint32_t value) {
    return Feature(Kind::kEnumeration, category, name).Entries({{entry, value}}).Value(value);
  };
  const auto number = [&](const char* name, double value) {
    return Feature(Kind::kFloat, category, name).Value(value);
  };
  table->push_back(constant("Scan3dOutputMode", "ProjectedC", 3));
  table->push_back(constant("Scan3dDistanceUnit", "Millimeter", 0));
  table->push_back(constant("Scan3dCoordinateSystem", "Cartesian", 0));
  table->push_back(constant("Scan3dCoordinateSystemReference", "Anchor", 0));
  AddCoordinates(camera, table);
  table->push_back(number("Scan3dFocalLength", camera.depth.fx_px).Unit("px"));
  table->push_back(number("Scan3dAspectRatio", camera.depth.fy_px / camera.depth.fx_px)
                       .Tip("Focal length in y over that in x"));
  table->push_back(number("Scan3dPrincipalPointU", camera.depth.cx_px).Unit("px"));
  table->push_back(number("Scan3dPrincipalPointV", camera.depth.cy_px).Unit("px"));
  if (camera.baseline_m > 0.0) {
    table->push_back(number("Scan3dBaseline", camera.baseline_m * kMmInM).Unit("mm"));
  }
}

void AddDistortion(const std::string& name, const rgbd::Distortion& coefficients,
                   FeatureTable* table) {
  const std::string category = "PalpateCalibration";
  table->push_back(Feature(Kind::kEnumeration, category, name + "Selector")
                       .Entries({{"K1", 0},
                                 {"K2", 1},
                                 {"P1", 2},
                                 {"P2", 3},
                                 {"K3", 4},
                                 {"K4", 5},
                                 {"K5", 6},
                                 {"K6", 7}})
                       .Writable());
  table->push_back(Feature(Kind::kFloat, category, name)
                       .Values({coefficients.begin(), coefficients.end()})
                       .SelectedBy(name + "Selector")
                       .Tip("OpenCV's rational model, normalised image"));
}

void AddCalibration(const rgbd::RgbdCamera& camera, FeatureTable* table) {
  const std::string category = "PalpateCalibration";
  AddDistortion("PalpateDepthDistortion", camera.depth.distortion, table);
  if (camera.color.width_px == 0) return;
  const auto number = [&](const char* name, double value) {
    return Feature(Kind::kFloat, category, name).Value(value).Unit("px");
  };
  table->push_back(number("PalpateColorFx", camera.color.fx_px));
  table->push_back(number("PalpateColorFy", camera.color.fy_px));
  table->push_back(number("PalpateColorCx", camera.color.cx_px));
  table->push_back(number("PalpateColorCy", camera.color.cy_px));
  AddDistortion("PalpateColorDistortion", camera.color.distortion, table);
  table->push_back(Feature(Kind::kBoolean, category, "PalpateColorRegistered")
                       .Value(camera.color_registered ? 1.0 : 0.0));
  const Eigen::Vector3d t = camera.T_depth_color.translation();
  const Eigen::Quaterniond q(camera.T_depth_color.rotation());
  table->push_back(
      Feature(Kind::kEnumeration, category, "PalpateDepthColorSelector")
          .Entries({{"Tx", 0}, {"Ty", 1}, {"Tz", 2}, {"Qx", 3}, {"Qy", 4}, {"Qz", 5}, {"Qw", 6}})
          .Writable());
  table->push_back(Feature(Kind::kFloat, category, "PalpateDepthColor")
                       .Values({t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()})
                       .SelectedBy("PalpateDepthColorSelector")
                       .Tip("p_depth = T p_color: translation in m, unit quaternion"));
}

void AddAcquisitionControl(const DeviceSettings& settings, FeatureTable* table) {
  const std::string category = "AcquisitionControl";
  const auto make = [&](Kind kind, const char* name) { return Feature(kind, category, name); };
  table->push_back(make(Kind::kEnumeration, "AcquisitionMode")
                       .Entries({{"Continuous", 0}, {"SingleFrame", 1}, {"MultiFrame", 2}})
                       .Locked());
  table->push_back(make(Kind::kInteger, "AcquisitionFrameCount").Value(1).Range(1, 65535).Locked());
  table->push_back(make(Kind::kCommand, "AcquisitionStart"));
  table->push_back(make(Kind::kCommand, "AcquisitionStop"));
  table->push_back(make(Kind::kBoolean, "AcquisitionFrameRateEnable").Range(0, 1).Writable());
  table->push_back(make(Kind::kFloat, "AcquisitionFrameRate")
                       .Value(settings.rate_hz)
                       .Range(0.1, settings.rate_hz)
                       .Unit("Hz")
                       .Writable());
  table->push_back(make(Kind::kFloat, "ExposureTime")
                       .Value(kDefaultExposure_us)
                       .Range(10.0, 1e6 / settings.rate_hz)
                       .Unit("us")
                       .Writable());
  table->push_back(make(Kind::kEnumeration, "ExposureAuto").Entries({{"Off", 0}}).Writable());
  table->push_back(make(Kind::kFloat, "Gain").Range(0.0, 24.0).Unit("dB").Writable());
  table->push_back(make(Kind::kEnumeration, "GainAuto").Entries({{"Off", 0}}).Writable());
  table->push_back(
      make(Kind::kEnumeration, "TriggerSelector").Entries({{"FrameStart", 0}}).Writable());
  table->push_back(make(Kind::kEnumeration, "TriggerMode")
                       .Entries({{"Off", 0}})
                       .SelectedBy("TriggerSelector")
                       .Writable());
}

}  // namespace

std::vector<ComponentId> Components(const DeviceSettings& settings,
                                    const rgbd::RgbdCamera& camera) {
  std::vector<ComponentId> components = {ComponentId::kRange};
  if (camera.color.width_px > 0) components.push_back(ComponentId::kIntensity);
  if (settings.confidence) components.push_back(ComponentId::kConfidence);
  return components;
}

FeatureTable CameraFeatures(const DeviceSettings& settings, const rgbd::RgbdCamera& camera) {
  FeatureTable table;
  AddDeviceControl(&table);
  AddImageFormatControl(settings, camera, &table);
  AddScan3dControl(camera, &table);
  AddCalibration(camera, &table);
  AddAcquisitionControl(settings, &table);
  return table;
}

FeatureTable TransportFeatures() {
  const std::string category = "TransportLayerControl";
  const auto integer = [&](const char* name) { return Feature(Kind::kInteger, category, name); };
  const auto boolean = [&](const char* name) { return Feature(Kind::kBoolean, category, name); };
  FeatureTable table;
  table.push_back(integer("PayloadSize").Unit("B").Changing());
  table.push_back(integer("TLParamsLocked").Range(0, 1).Writable());
  table.push_back(integer("GevSCPSPacketSize")
                      .At(boot::kStreamPacketSize)
                      .Bits(0, 15)
                      .Range(kMinPacketSize, kMaxPacketSize, 4)
                      .Locked());
  table.push_back(Feature(Kind::kCommand, category, "GevSCPSFireTestPacket")
                      .At(boot::kStreamPacketSize)
                      .Bits(31, 31));
  table.push_back(
      boolean("GevSCPSDoNotFragment").At(boot::kStreamPacketSize).Bits(30, 30).Locked());
  table.push_back(
      integer("GevSCPD").At(boot::kStreamPacketDelay).Range(0, 1e6).Unit("ns").Locked());
  table.push_back(integer("GevSCDA").At(boot::kStreamAddress).Locked());
  table.push_back(integer("GevSCPHostPort").At(boot::kStreamPort).Bits(0, 15).Locked());
  table.push_back(integer("GevSCSP").At(boot::kStreamSourcePort).Bits(0, 15));
  table.push_back(boolean("GevSCCFGMultiPartEnabled")
                      .At(boot::kStreamChannelConfiguration)
                      .Bits(6, 6)
                      .Locked());
  table.push_back(Feature(Kind::kEnumeration, category, "GevGVSPExtendedIDMode")
                      .At(boot::kStreamConfiguration)
                      .Bits(30, 30)
                      .Entries({{"Off", 0}, {"On", 1}})
                      .Locked());
  table.push_back(integer("GevHeartbeatTimeout")
                      .At(boot::kHeartbeatTimeout)
                      .Range(kMinHeartbeatTimeout_ms, kMaxHeartbeatTimeout_ms)
                      .Unit("ms")
                      .Writable());
  table.push_back(
      boolean("GevGVCPHeartbeatDisable").At(boot::kControlConfiguration).Bits(0, 0).Writable());
  table.push_back(integer("GevTimestampTickFrequency").At(boot::kTickFrequencyHigh, 8).Unit("Hz"));
  table.push_back(Feature(Kind::kCommand, category, "GevTimestampControlLatch")
                      .At(boot::kTimestampControl)
                      .Command(kTimestampLatch));
  table.push_back(Feature(Kind::kCommand, category, "GevTimestampControlReset")
                      .At(boot::kTimestampControl)
                      .Command(kTimestampReset));
  table.push_back(integer("GevTimestampValue").At(boot::kTimestampHigh, 8));
  table.push_back(integer("GevCurrentIPAddress").At(boot::kCurrentIp));
  table.push_back(integer("GevCurrentSubnetMask").At(boot::kCurrentMask));
  table.push_back(integer("GevMACAddress").At(boot::kMacHigh, 8));
  table.push_back(boolean("PtpEnable").Range(0, 1).Writable());
  table.push_back(Feature(Kind::kEnumeration, category, "PtpStatus")
                      .Entries({{"Disabled", 3}, {"Slave", 9}})
                      .Value(3)
                      .Changing());
  table.push_back(integer("PtpOffsetFromMaster").Wide().Unit("ns"));
  table.push_back(Feature(Kind::kCommand, category, "PtpDataSetLatch"));
  return table;
}

}  // namespace palpate::gige_vision
