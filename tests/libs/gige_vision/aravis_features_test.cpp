// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/clock.hpp"
#include "libs/core/seconds.hpp"
#include "libs/gige_vision/camera_state.hpp"
#include "libs/gige_vision/description_faults.hpp"
#include "tests/libs/gige_vision/aravis_client.hpp"
#include "tests/libs/gige_vision/test_device.hpp"

namespace palpate::gige_vision {
namespace {

class AravisFeatures : public DeviceTest {
 protected:
  double Selected(AravisClient* client, const std::string& selector, const std::string& entry,
                  const std::string& feature) {
    client->Select(selector, entry);
    return client->Number(feature);
  }
};

TEST_F(AravisFeatures, DeviceIsDiscovered) {
  MakeDevice();
  bool found = false;
  for (int attempt = 0; attempt < 5 && !found; ++attempt) {
    arv_update_device_list();
    for (unsigned i = 0; i < arv_get_n_devices(); ++i) {
      if (settings.serial != arv_get_device_serial_nbr(i)) continue;
      found = true;
      EXPECT_EQ(arv_get_device_address(i), TestAddress());
      EXPECT_EQ(arv_get_device_vendor(i), settings.vendor);
      EXPECT_EQ(arv_get_device_model(i), settings.model);
    }
  }
  EXPECT_TRUE(found);
}

TEST_F(AravisFeatures, EveryFeatureOfTheTableIsReadable) {
  MakeDevice();
  const AravisClient client(TestAddress());
  const std::vector<std::string> names = FeatureNames(device->Describe());
  EXPECT_GT(names.size(), 80u);
  for (const std::string& name : names) {
    ArvGcNode* node = arv_device_get_feature(client.device(), name.c_str());
    ASSERT_TRUE(ARV_IS_GC_FEATURE_NODE(node)) << name;
    if (ARV_IS_GC_COMMAND(node)) continue;
    GError* error = nullptr;
    const char* value = arv_gc_feature_node_get_value_as_string(ARV_GC_FEATURE_NODE(node), &error);
    EXPECT_EQ(error, nullptr) << name << ": " << (error != nullptr ? error->message : "");
    EXPECT_NE(value, nullptr) << name;
    g_clear_error(&error);
  }
}

TEST_F(AravisFeatures, GeometryIsTheCameras) {
  MakeDevice();
  AravisClient client(TestAddress());
  EXPECT_EQ(client.Text("Scan3dOutputMode"), "ProjectedC");
  EXPECT_EQ(client.Text("Scan3dDistanceUnit"), "Millimeter");
  EXPECT_EQ(client.Number("Scan3dFocalLength"), camera.depth.fx_px);
  EXPECT_DOUBLE_EQ(client.Number("Scan3dAspectRatio"), camera.depth.fy_px / camera.depth.fx_px);
  EXPECT_EQ(client.Number("Scan3dPrincipalPointU"), camera.depth.cx_px);
  EXPECT_EQ(client.Number("Scan3dPrincipalPointV"), camera.depth.cy_px);
  EXPECT_DOUBLE_EQ(client.Number("Scan3dBaseline"), 55.0);
  const std::string axis = "Scan3dCoordinateSelector";
  EXPECT_DOUBLE_EQ(Selected(&client, axis, "CoordinateC", "Scan3dCoordinateScale"), 0.1);
  EXPECT_EQ(Selected(&client, axis, "CoordinateA", "Scan3dCoordinateScale"), 1.0);
  EXPECT_EQ(client.Integer("Scan3dInvalidDataFlag"), 0);
  EXPECT_DOUBLE_EQ(Selected(&client, axis, "CoordinateC", "Scan3dAxisMax"), 6553.5);
  EXPECT_EQ(client.Integer("Scan3dInvalidDataFlag"), 1);
  EXPECT_EQ(client.Number("Scan3dInvalidDataValue"), 0.0);
}

TEST_F(AravisFeatures, CalibrationIsTheCameras) {
  MakeDevice();
  AravisClient client(TestAddress());
  EXPECT_EQ(client.Number("PalpateColorFx"), camera.color.fx_px);
  EXPECT_EQ(client.Number("PalpateColorFy"), camera.color.fy_px);
  EXPECT_EQ(client.Number("PalpateColorCx"), camera.color.cx_px);
  EXPECT_EQ(client.Number("PalpateColorCy"), camera.color.cy_px);
  EXPECT_EQ(client.Integer("PalpateColorRegistered"), 0);
  const std::array<const char*, 5> names = {"K1", "K2", "P1", "P2", "K3"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(
        Selected(&client, "PalpateDepthDistortionSelector", names[i], "PalpateDepthDistortion"),
        camera.depth.distortion[i]);
    EXPECT_EQ(
        Selected(&client, "PalpateColorDistortionSelector", names[i], "PalpateColorDistortion"),
        camera.color.distortion[i]);
  }
  const auto pose = [&](const char* entry) {
    return Selected(&client, "PalpateDepthColorSelector", entry, "PalpateDepthColor");
  };
  const Eigen::Vector3d t(pose("Tx"), pose("Ty"), pose("Tz"));
  const Eigen::Quaterniond q(pose("Qw"), pose("Qx"), pose("Qy"), pose("Qz"));
  EXPECT_EQ(t, camera.T_depth_color.translation());
  EXPECT_LT((q.toRotationMatrix() - camera.T_depth_color.rotation()).norm(), 1e-12);
}

TEST_F(AravisFeatures, ComponentsAreSelected) {
  MakeDevice();
  AravisClient client(TestAddress());
  client.Select("ComponentSelector", "Intensity");
  EXPECT_EQ(client.Integer("ComponentIDValue"), 1);
  EXPECT_EQ(client.Text("PixelFormat"), "RGB8");
  EXPECT_EQ(client.Integer("Width"), camera.color.width_px);
  client.Select("ComponentSelector", "Range");
  EXPECT_EQ(client.Integer("ComponentIDValue"), 4);
  EXPECT_EQ(client.Text("PixelFormat"), "Coord3D_C16");
  client.Select("ComponentSelector", "Confidence");
  EXPECT_EQ(client.Integer("ComponentIDValue"), 6);
  EXPECT_EQ(client.Text("PixelFormat"), "Confidence8");
  EXPECT_EQ(client.Integer("Height"), camera.depth.height_px);
}

TEST_F(AravisFeatures, LatchedTimeIsTheHostsToTheNanosecond) {
  MakeDevice();
  AravisClient client(TestAddress());
  bool odd = false;  // a clock that went through doubles would be even
  for (int i = 0; i < 30; ++i) {
    const std::int64_t before_ns = WallNow_ns();
    client.Run("TimestampLatch");
    const std::int64_t after_ns = WallNow_ns();
    const std::int64_t latched_ns = client.Integer("TimestampLatchValue");
    EXPECT_GE(latched_ns, before_ns);
    EXPECT_LE(latched_ns, after_ns);
    EXPECT_EQ(client.Integer("GevTimestampValue"), latched_ns);
    odd = odd || latched_ns % 2 != 0;
  }
  EXPECT_TRUE(odd);
  client.Set("PtpEnable", std::int64_t{1});
  EXPECT_EQ(client.Text("PtpStatus"), "Slave");
  client.Run("TimestampLatch");
  const double tai_from_utc_s = NsToSeconds(client.Integer("TimestampLatchValue") - WallNow_ns());
  EXPECT_NEAR(tai_from_utc_s, 37.0, 5.0);
}

TEST_F(AravisFeatures, SettingsAreKeptAndJudged) {
  MakeDevice();
  AravisClient client(TestAddress());
  client.Set("ExposureTime", 1234.5);
  client.Set("Gain", 6.0);
  EXPECT_EQ(client.Number("ExposureTime"), 1234.5);
  EXPECT_EQ(client.Number("Gain"), 6.0);
  client.Set("GevSCPSPacketSize", std::int64_t{4000});
  EXPECT_EQ(client.Integer("GevSCPSPacketSize"), 4000);
  EXPECT_THROW(client.Set("Width", std::int64_t{5000}), std::runtime_error);
  EXPECT_GT(client.Number("DeviceTemperature"), 20.0);
}

TEST_F(AravisFeatures, MissingParts) {
  camera.color = {};
  camera.baseline_m = 0.0;
  settings.confidence = false;
  MakeDevice();
  const AravisClient client(TestAddress());
  EXPECT_EQ(client.Integer("PayloadSize"), 2 * 90 * 62);
  EXPECT_EQ(arv_device_get_feature(client.device(), "Scan3dBaseline"), nullptr);
  EXPECT_EQ(arv_device_get_feature(client.device(), "PalpateColorFx"), nullptr);
}

TEST(DescriptionFaults, AFeatureTakenOutLeavesNoTrace) {
  const std::string xml =
      CameraState(TestSettings(), TestCamera(), Identity{}, WallNow_ns).description();
  const std::vector<std::string> names = FeatureNames(xml);
  for (const std::string& name : names) {
    const std::string rest = WithoutFeature(xml, name);
    EXPECT_EQ(FeatureNames(rest).size(), names.size() - 1) << name;
    EXPECT_EQ(rest.find(">" + name + "</pFeature>"), std::string::npos) << name;
    EXPECT_EQ(rest.find(">" + name + "</pSelected>"), std::string::npos) << name;
    EXPECT_EQ(rest.find("Name=\"" + name + "\""), std::string::npos) << name;
    EXPECT_EQ(rest.find("Name=\"" + name + "Reg\""), std::string::npos) << name;
  }
  EXPECT_EQ(WithoutFeature(xml, "NoSuchFeature"), xml);
  EXPECT_NE(WithNode(xml, "Gain", "  <Junk/>\n").find("  <Junk/>\n"), std::string::npos);
}

TEST_F(AravisFeatures, FaultsReachTheClient) {
  settings.faults.edit_xml = [](const std::string& xml) {
    return WithNodeType(WithoutFeature(xml, "Scan3dFocalLength"), "Scan3dBaseline", "Integer");
  };
  settings.faults.edit_value = [](const std::string& feature, std::vector<std::uint8_t>* value) {
    if (feature == "Scan3dPrincipalPointU") value->assign(8, 0xff);  // NaN
  };
  MakeDevice();
  AravisClient client(TestAddress());
  EXPECT_EQ(arv_device_get_feature(client.device(), "Scan3dFocalLength"), nullptr);
  EXPECT_TRUE(ARV_IS_GC_INTEGER(arv_device_get_feature(client.device(), "Scan3dBaseline")));
  EXPECT_TRUE(std::isnan(client.Number("Scan3dPrincipalPointU")));
  EXPECT_EQ(client.Number("Scan3dPrincipalPointV"), camera.depth.cy_px);
}

TEST_F(AravisFeatures, ADescriptionThatIsNoneIsServedAllTheSame) {
  settings.faults.edit_xml = [](const std::string&) { return std::string("<Reg"); };
  MakeDevice();
  EXPECT_THROW(AravisClient{TestAddress()}, std::runtime_error);
}

}  // namespace
}  // namespace palpate::gige_vision
