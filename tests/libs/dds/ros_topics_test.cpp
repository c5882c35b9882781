// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "libs/dds/qos.hpp"
#include "tests/libs/dds/test_participant.hpp"

/// What a ROS 2 node finds of our topics in DDS discovery.
namespace palpate::dds {
namespace {

/// A writer as the discovery of another participant tells it.
struct Offered {
  std::string type;
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  std::vector<dds_data_representation_id_t> representations;
};

Offered OfferedBy(const dds_builtintopic_endpoint_t& endpoint) {
  Offered offered;
  offered.type = endpoint.type_name;
  dds_duration_t blocking = 0;
  dds_qget_reliability(endpoint.qos, &offered.reliability, &blocking);
  dds_qget_durability(endpoint.qos, &offered.durability);
  std::uint32_t count = 0;
  dds_data_representation_id_t* ids = nullptr;
  if (dds_qget_data_representation(endpoint.qos, &count, &ids)) {
    offered.representations.assign(ids, ids + count);
    dds_free(ids);
  }
  return offered;
}

/// Discovers writers by their DDS topic name.
class Discovery {
 public:
  Discovery()
      : node_("discovery"),
        reader_(dds_create_reader(node_.participant.handle(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION,
                                  nullptr, nullptr),
                "reader of publications") {
    node_.loop.Attach(reader_.handle(), [this] {
      for (const auto& endpoint : Samples<dds_builtintopic_endpoint_t>(reader_.handle())) {
        offered_[endpoint.topic_name] = OfferedBy(endpoint);
      }
    });
  }

  /// A type without fields: it was not found within 10 s.
  Offered Of(const std::string& dds_topic) {
    node_.WaitFor([&] { return offered_.contains(dds_topic); });
    return offered_[dds_topic];
  }

 private:
  TestNode node_;
  Entity reader_;
  std::map<std::string, Offered> offered_;
};

struct Row {
  const char* dds_topic;
  const char* dds_type;
  bool reliable = true;
  bool latched = false;
};

/// Names, types and QoS of rcl, rviz2, image_pipeline and tf2 (Humble), written out.
constexpr Row kStandard[] = {
    {"rt/camera/depth/image_raw", "sensor_msgs::msg::dds_::Image_"},
    {"rt/camera/depth/camera_info", "sensor_msgs::msg::dds_::CameraInfo_", true, true},
    {"rt/camera/color/image_raw", "sensor_msgs::msg::dds_::Image_"},
    {"rt/camera/color/camera_info", "sensor_msgs::msg::dds_::CameraInfo_", true, true},
    {"rt/perception/robot_cloud", "sensor_msgs::msg::dds_::PointCloud2_"},
    {"rt/robot/joint_states", "sensor_msgs::msg::dds_::JointState_"},
    {"rt/forces/tip/wrench", "geometry_msgs::msg::dds_::WrenchStamped_"},
    {"rt/diagnostics", "diagnostic_msgs::msg::dds_::DiagnosticArray_"},
    {"rt/rosout", "rcl_interfaces::msg::dds_::Log_", true, true},
    {"rt/clock", "rosgraph_msgs::msg::dds_::Clock_", false, false},
    {"rt/tf_static", "tf2_msgs::msg::dds_::TFMessage_", true, true},
    {"rt/robot_description", "std_msgs::msg::dds_::String_", true, true}};

TEST(RosTopics, StandardTopicsAreOfferedAsRos2ExpectsThem) {
  TestNode node("node");
  Participant& participant = node.participant;
  const auto writers = std::make_tuple(
      participant.CreateWriter(kDepthImageTopic), participant.CreateWriter(kDepthCameraInfoTopic),
      participant.CreateWriter(kColorImageTopic), participant.CreateWriter(kColorCameraInfoTopic),
      participant.CreateWriter(kRobotCloudTopic), participant.CreateWriter(kJointStatesTopic),
      participant.CreateWriter(kWrenchTopic, {}, "tip"),
      participant.CreateWriter(kDiagnosticsTopic), participant.CreateWriter(kRosoutTopic),
      participant.CreateWriter(kClockTopic), participant.CreateWriter(kTfStaticTopic),
      participant.CreateWriter(kRobotDescriptionTopic));
  Discovery discovery;
  for (const Row& row : kStandard) {
    const Offered offered = discovery.Of(row.dds_topic);
    EXPECT_EQ(offered.type, row.dds_type) << row.dds_topic;
    EXPECT_EQ(offered.reliability == DDS_RELIABILITY_RELIABLE, row.reliable) << row.dds_topic;
    EXPECT_EQ(offered.durability == DDS_DURABILITY_TRANSIENT_LOCAL, row.latched) << row.dds_topic;
    EXPECT_EQ(offered.representations,
              std::vector<dds_data_representation_id_t>{DDS_DATA_REPRESENTATION_XCDR1})
        << row.dds_topic;
  }
}

TEST(RosTopics, NoTypeHasAKey) {
  for (const dds_topic_descriptor_t* type :
       {&idl::MessageTraits<idl::sensor_msgs::Image>::Descriptor(),
        &idl::MessageTraits<idl::sensor_msgs::CameraInfo>::Descriptor(),
        &idl::MessageTraits<idl::tf2_msgs::TFMessage>::Descriptor(),
        &idl::MessageTraits<idl::rosgraph_msgs::Clock>::Descriptor(),
        &idl::MessageTraits<idl::palpate_msgs::ForceArray>::Descriptor()}) {
    EXPECT_EQ(type->m_nkeys, 0u) << type->m_typename;
  }
}

}  // namespace
}  // namespace palpate::dds
