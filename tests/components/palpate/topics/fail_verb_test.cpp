// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/components/palpate/topics/fake_node.hpp"

namespace palpate::command {
namespace {

using testing::AllOf;
using testing::HasSubstr;

dds::ParticipantSettings SettingsOf(const std::string& name, bool allow_faults) {
  Parameter other{"other", 1.0};
  other.fixed_because = "read at start";
  return {.domain_id = static_cast<std::uint32_t>(TestDomain()),
          .node_name = name,
          .parameters = {other},
          .allow_faults = allow_faults};
}

/// A component that writes forces, or nothing.
class FakeComponent {
 public:
  explicit FakeComponent(bool allow_faults, bool writes = true)
      : node_(SettingsOf("palpate_force_estimation", allow_faults)) {
    if (writes) forces_.emplace(node_.participant.CreateWriter(dds::kForcesTopic));
    node_.Run();
  }

  std::string_view fault() const { return dds::ToString(node_.participant.fault()->kind()); }
  double delay_s() const { return node_.participant.fault()->delay_s(); }

 private:
  FakeNode node_;
  std::optional<dds::Writer<idl::palpate_msgs::ForceArray>> forces_;
};

TEST(Fail, MakesAComponentFaultyUntilItEnds) {
  const FakeComponent component(true);
  const Outcome outcome = RunVerb({"fail", "force_estimation", "stuck"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(outcome.output, "/palpate_force_estimation: fault stuck\n");
  EXPECT_EQ(component.fault(), "stuck");
  EXPECT_EQ(RunVerb({"param", "get", "/palpate_force_estimation", "fault"}).output,
            "String value is: stuck\n");
  const auto json = nlohmann::json::parse(
      RunVerb({"fail", "/palpate_force_estimation", "slow", "--delay", "2", "--json"}).output);
  EXPECT_EQ(json.at("successful"), true);
  EXPECT_EQ(component.delay_s(), 2.0);
  EXPECT_EQ(RunVerb({"fail", "force-estimation", "none"}).exit_code, 0);
  EXPECT_EQ(component.fault(), "none");
}

TEST(Fail, IsRefusedUnlessTheSettingsAllowIt) {
  const FakeComponent component(false);
  const Outcome outcome = RunVerb({"fail", "force_estimation", "off"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, AllOf(HasSubstr("dds.allow_faults"), HasSubstr("allow_faults: true"),
                                    HasSubstr("system file")));
}

TEST(Fail, IsRefusedByAComponentWithoutData) {
  const FakeComponent component(true, false);
  const Outcome outcome = RunVerb({"fail", "force_estimation", "off"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("writes no data"));
}

TEST(Fail, NamesWhatWasMeant) {
  const FakeComponent component(true);
  EXPECT_THAT(RunVerb({"fail", "force_estimatoin", "off"}).errors,
              HasSubstr("did you mean 'force_estimation'?"));
  EXPECT_THAT(RunVerb({"fail", "force_estimation", "stcuk"}).errors,
              HasSubstr("did you mean 'stuck'?"));
  EXPECT_THAT(RunVerb({"fail", "/palpate_force_estimatio", "off", "--spin-time", "0.5"}).errors,
              HasSubstr("did you mean '/palpate_force_estimation'?"));
  EXPECT_EQ(RunVerb({"fail", "force_estimation", "off", "--delay", "1"}).exit_code, 2);
  const Outcome range = RunVerb({"fail", "force_estimation", "slow", "--delay", "60"});
  EXPECT_EQ(range.exit_code, 1);
  EXPECT_THAT(range.errors, HasSubstr("0.001 to 10 s"));
}

TEST(Fail, AComponentThatDoesNotRunIsSaid) {
  const Outcome outcome = RunVerb({"fail", "capture", "off", "--spin-time", "0.3"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("no node '/palpate_capture' in domain"));
}

}  // namespace
}  // namespace palpate::command
