// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/parameter_services.hpp"

#include <gmock/gmock.h>

#include <thread>

#include "libs/core/error.hpp"
#include "libs/dds/parameter_client.hpp"
#include "libs/dds/parameter_messages.hpp"
#include "libs/dds/service.hpp"
#include "rcl_interfaces/srv/ListParameters.hpp"
#include "rcl_interfaces/srv/SetParametersAtomically.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::dds {
namespace {

/// One value of each type.
std::vector<ParameterValue> AllTypes() {
  return {std::monostate(),
          true,
          std::int64_t{-3},
          0.5,
          std::string("text"),
          std::vector<std::uint8_t>{1, 255},
          std::vector<bool>{true, false, true},
          std::vector<std::int64_t>{-1, 2},
          std::vector<double>{0.5, 1e300},
          std::vector<std::string>{"a", ""}};
}

/// A node with one parameter of each type, answering in a thread of its own.
class Answering {
 public:
  Answering() : participant_(Settings(), BuiltInTable()), loop_(participant_) {
    thread_ = std::thread([this] { loop_.Run(); });
  }
  ~Answering() {
    loop_.Stop();
    thread_.join();
  }

 private:
  static ParticipantSettings Settings() {
    ParticipantSettings settings{.domain_id = TestDomain(), .node_name = "answering"};
    for (const ParameterValue& value : AllTypes()) {
      Parameter parameter{"p" + std::to_string(value.index()), value};
      parameter.fixed_because = "read at start";
      settings.parameters.push_back(parameter);
    }
    settings.parameters[2].range = {-5.0, 5.0};
    settings.parameters[3].constraints = "> 0";
    Parameter free{"free", 1.0};
    free.change = [](const ParameterValue&) { return std::string(); };
    settings.parameters.push_back(free);
    return settings;
  }

  Participant participant_;
  WaitSet loop_;
  std::thread thread_;
};

TEST(ParameterServices, CarryValuesOfEveryType) {
  const Answering node;
  const TestNode asking("asking");
  const ParameterClient client(asking.participant.handle(), "/answering", std::chrono::seconds(10));
  std::vector<std::string> names = client.List();
  ASSERT_EQ(names.size(), AllTypes().size() + 3);  // "free", and those of every node
  names.resize(AllTypes().size());
  EXPECT_EQ(client.Get(names), AllTypes());
  EXPECT_EQ(client.Get({"unknown"}).front(), ParameterValue());
}

TEST(ParameterServices, DescribeAndChange) {
  const Answering node;
  const TestNode asking("asking");
  const ParameterClient client(asking.participant.handle(), "/answering", std::chrono::seconds(10));
  const std::vector<Parameter> described = client.Describe({"p2", "p3", "free"});
  ASSERT_EQ(described.size(), 3u);
  EXPECT_EQ(described[0].value.index(), 2u);
  EXPECT_EQ(described[0].range, std::pair(-5.0, 5.0));
  EXPECT_EQ(described[1].constraints, "> 0");
  EXPECT_FALSE(described[1].fixed_because.empty());
  EXPECT_TRUE(described[2].fixed_because.empty());
  EXPECT_EQ(client.Set("p3", 2.0), "read at start");
  EXPECT_EQ(client.Set("free", 2.0), "");
  EXPECT_EQ(client.Get({"free"}).front(), ParameterValue(2.0));
}

/// As a client of rmw_cyclonedds finds its reply: by the header of its request.
TEST(ParameterServices, RepeatTheHeaderOfTheRequest) {
  const Answering node;
  const TestNode asking("asking");
  ServiceClient<idl::rcl_interfaces::ListParameters> client(asking.participant.handle(),
                                                            "/answering/list_parameters");
  Message<idl::rcl_interfaces::ListParameters::Request> request;
  SetTexts(request->prefixes, {"free"});
  std::vector<std::string> names;
  ASSERT_TRUE(client.Call(
      &request,
      [&](const auto& response) {
        EXPECT_EQ(response.client_guid, request->client_guid);
        EXPECT_EQ(response.sequence_number, 1);
        names = TextsOf(response.result.names);
      },
      std::chrono::steady_clock::now() + std::chrono::seconds(10)));
  EXPECT_THAT(names, testing::ElementsAre("free"));
}

TEST(ParameterServices, HaveTheNamesAndTypesOfRos2) {
  EXPECT_EQ(RequestTopicOf("/left/node/get_parameters"), "rq/left/node/get_parametersRequest");
  EXPECT_STREQ(
      idl::MessageTraits<idl::rcl_interfaces::ListParameters::Request>::Descriptor().m_typename,
      "rcl_interfaces::srv::dds_::ListParameters_Request_");
}

TEST(ParameterClient, SaysWhereNobodyAnswers) {
  const TestNode asking("asking");
  const ParameterClient client(asking.participant.handle(), "/nobody",
                               std::chrono::milliseconds(50));
  try {
    client.List();
    FAIL() << "nobody answered";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("node '/nobody' does not answer"));
  }
}

}  // namespace
}  // namespace palpate::dds
