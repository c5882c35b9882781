// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "components/force_estimation/node/convert.hpp"
#include "components/force_estimation/node/node.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/support/robots.hpp"

namespace palpate::force_estimation {
namespace {

constexpr double kPressure_Pa = 8e3;
const Eigen::Vector3d kTip_m(0.009, 0.0, 0.1);
const Eigen::Vector3d kPush_N(-0.08, 0.0, 0.0);
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::unique_ptr<robot::RobotModel> Finger() {
  return std::make_unique<robot::RobotModel>(
      robot::BuildRobotBody(test_support::QuickRobot("pneumatic_finger")));
}

NodeConfig FingerConfig() {
  NodeConfig config;
  config.frame_tolerance = Config().frame_tolerance;
  config.contacts = {"tip: 0.009, 0, 0.1, 0.004"};
  config.cable_wait_s = 0.05;
  return config;
}

/// The finger under pressure, and what its chamber and its markers report.
struct Finding {
  double volume_m3 = 0.0;
  Eigen::Matrix3Xd markers_m;
};

Finding FingerUnder(double pressure_Pa, const Eigen::Vector3d& push_N) {
  const auto model = Finger();
  const robot::ActuatorTraits& bend = model->traits(0);
  fem::StaticState state = model->RestState();
  const auto result =
      model->Solve({{robot::ActuatorCommand::Kind::kTension, bend.Force_N(pressure_Pa)}},
                   {{model->Patch(kTip_m, 0.004).weights, push_N}}, &state);
  EXPECT_TRUE(result.status.ok()) << result.status.message();
  Finding finding;
  finding.volume_m3 = bend.ReportedDisplacement(model->StateOfActuator(0, state).displacement_m);
  const auto& markers = model->body().markers;
  finding.markers_m.resize(3, static_cast<Eigen::Index>(markers.size()));
  for (std::size_t m = 0; m < markers.size(); ++m) {
    finding.markers_m.col(static_cast<Eigen::Index>(m)) =
        markers[m].point.weights.Position(state.x_m);
  }
  return finding;
}

/// The node of the finger in a thread of its own, and who plays supply, motion capture and reader.
class ChamberNodeTest : public testing::Test {
 protected:
  ChamberNodeTest()
      : node_(FingerConfig(), Finger(), {}, static_cast<int>(dds::TestDomain()),
              dds::BuiltInTable(), {}),
        test_("test"),
        markers_(test_.participant.CreateWriter(dds::kMarkersTopic, test_.Waker())),
        joint_states_(test_.participant.CreateWriter(dds::kJointStatesTopic, test_.Waker())),
        forces_(test_.participant.CreateReader(dds::kForcesTopic, test_.Waker())),
        thread_([this] { node_.Run(); }) {
    test_.loop.Attach(forces_, [this] {
      for (const auto& message : forces_.Take()) {
        Answer& answer = answer_.emplace();
        answer.stamp_ns = dds::StampNs(message.header.stamp);
        answer.status = dds::Text(message.status);
        answer.reason = dds::Text(message.reason);
        for (const auto& force : dds::Elements(message.forces)) {
          answer.force_N = {force.force_n.x, force.force_n.y, force.force_n.z};
        }
      }
    });
    EXPECT_TRUE(test_.WaitFor([this] {
      return markers_.matched() == 1 && joint_states_.matched() == 1 && forces_.matched() == 1;
    }));
  }
  ~ChamberNodeTest() override {
    node_.Stop();
    thread_.join();
  }

  struct Answer {
    std::int64_t stamp_ns = 0;
    std::string status;
    std::string reason;
    Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
  };

  void SendChamber(std::int64_t stamp_ns, const char* name, double volume_m3, double pressure_Pa) {
    dds::Message<idl::sensor_msgs::JointState> message;
    dds::SetHeader(message->header, stamp_ns, "robot");
    dds::Resize(message->name, 1);
    dds::SetText(message->name._buffer[0], name);
    dds::SetNumbers(message->position, &volume_m3, 1);
    dds::SetNumbers(message->effort, &pressure_Pa, 1);
    ASSERT_TRUE(joint_states_.Write(message));
  }

  void SendMarkers(std::int64_t stamp_ns, const Finding& finding, ReferenceShape reference) {
    const std::vector<std::string> names = Finger()->MarkerNames();
    dds::Message<idl::palpate_msgs::MarkerArray3> message;
    dds::SetHeader(message->header, stamp_ns, "robot");
    message->counter = counter_++;
    message->reference_shape = static_cast<std::uint8_t>(reference);
    dds::Resize(message->markers, names.size());
    for (std::size_t m = 0; m < names.size(); ++m) {
      auto& marker = message->markers._buffer[m];
      dds::SetText(marker.name, names[m]);
      const Eigen::Vector3d at_m = finding.markers_m.col(static_cast<Eigen::Index>(m));
      marker.position_m = {at_m.x(), at_m.y(), at_m.z()};
      marker.sigma_m = {1e-5, 1e-5, 1e-5};
      marker.valid = true;
    }
    ASSERT_TRUE(markers_.Write(message));
  }

  Answer AnswerTo(std::int64_t stamp_ns) {
    const bool answered = test_.WaitFor([&] { return answer_ && answer_->stamp_ns == stamp_ns; });
    EXPECT_TRUE(answered);
    return answered ? *answer_ : Answer{};
  }

  ForceEstimationNode node_;
  dds::TestNode test_;
  dds::Writer<idl::palpate_msgs::MarkerArray3> markers_;
  dds::Writer<idl::sensor_msgs::JointState> joint_states_;
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  std::optional<Answer> answer_;
  std::uint64_t counter_ = 0;
  std::thread thread_;
};

TEST_F(ChamberNodeTest, EstimatesAForceUnderAReportedPressureOrVolume) {
  const Finding rest = FingerUnder(0.0, Eigen::Vector3d::Zero());
  const Finding pushed = FingerUnder(kPressure_Pa, kPush_N);
  SendChamber(1'000'000'000, "bend", kNone, 0.0);
  SendMarkers(1'000'000'000, rest, ReferenceShape::kEquilibrium);
  EXPECT_EQ(AnswerTo(1'000'000'000).status, "no_calibration");
  std::int64_t stamp_ns = 1'100'000'000;
  for (const auto& [volume_m3, pressure_Pa] :
       {std::pair(kNone, kPressure_Pa), std::pair(pushed.volume_m3, kNone)}) {
    SendChamber(stamp_ns, "bend", volume_m3, pressure_Pa);
    SendMarkers(stamp_ns, pushed, ReferenceShape::kNone);
    const Answer answer = AnswerTo(stamp_ns);
    EXPECT_EQ(answer.status, "ok") << answer.reason;
    EXPECT_LT((answer.force_N - kPush_N).norm(), 0.01 * kPush_N.norm()) << answer.force_N;
    stamp_ns += 100'000'000;
  }
}

TEST_F(ChamberNodeTest, WithoutTheChambersInputAFrameHasNoForce) {
  const Finding rest = FingerUnder(0.0, Eigen::Vector3d::Zero());
  SendChamber(1'000'000'000, "bent", kNone, 0.0);
  SendMarkers(1'000'000'000, rest, ReferenceShape::kEquilibrium);
  const Answer answer = AnswerTo(1'000'000'000);
  EXPECT_NE(answer.status, "ok");
  EXPECT_NE(answer.status, "no_calibration");
  EXPECT_FALSE(answer.reason.empty());
}

}  // namespace
}  // namespace palpate::force_estimation
