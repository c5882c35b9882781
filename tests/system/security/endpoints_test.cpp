// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <dds/dds.h>
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "libs/dds/access_rights.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/support/test_folder.hpp"
#include "tests/system/process.hpp"
#include "tests/system/security/system_programs.hpp"

/// Each component as a secured process: what it writes and reads is what config/topics.yaml says.
namespace palpate::system_test {
namespace {

using std::chrono::seconds;
using Names = std::set<std::string>;

/// The topics of the writers, or of the readers, of all other participants.
class Endpoints {
 public:
  Endpoints(dds_entity_t participant, dds_entity_t builtin_topic)
      : reader_(dds_create_reader(participant, builtin_topic, nullptr, nullptr), "built-in topic") {
    dds_get_guid(participant, &own_);
  }

  dds_entity_t reader() const { return reader_.handle(); }
  const Names& names() const { return names_; }
  void Forget() { names_.clear(); }

  void Take() {
    std::array<void*, 16> samples{};
    std::array<dds_sample_info_t, 16> infos{};
    dds_return_t count = 0;
    while ((count = dds_take(reader_.handle(), samples.data(), infos.data(), samples.size(),
                             samples.size())) > 0) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        const auto& endpoint = *static_cast<dds_builtintopic_endpoint_t*>(samples[i]);
        const bool alive = infos[i].valid_data && infos[i].instance_state == DDS_IST_ALIVE;
        if (alive && !IsOwn(endpoint.participant_key)) names_.insert(endpoint.topic_name);
      }
      dds_return_loan(reader_.handle(), samples.data(), count);
    }
  }

 private:
  bool IsOwn(const dds_guid_t& key) const { return std::equal(key.v, key.v + 16, own_.v); }

  dds::Entity reader_;
  dds_guid_t own_{};
  Names names_;
};

/// The rights of a component that its endpoints have from the start; those with a name of their own
/// for each contact come later.
Names FromTheStart(const std::vector<std::string>& topics) {
  Names names;
  for (const std::string& topic : topics) {
    if (topic.find('*') == topic.npos) names.insert(topic);
  }
  return names;
}

class EndpointsTest : public testing::Test {
 protected:
  EndpointsTest() {
    const std::filesystem::path keystore = folder_ / "keystore";
    EXPECT_EQ(RunProgram("palpate", {"security", "init", keystore.string()}, folder_ / "init.log"),
              0);
    setenv("PALPATE_SECURITY_DIR", keystore.c_str(), 1);
  }
  ~EndpointsTest() override { unsetenv("PALPATE_SECURITY_DIR"); }

  test_support::TestFolder folder_;
};

TEST_F(EndpointsTest, AreThoseOfTheTable) {
  const dds::TopicTable table = dds::BuiltInTable();
  dds::Participant observer({.domain_id = dds::TestDomain(),
                             .node_name = "observer",
                             .security = {folder_ / "keystore", dds::kObserver}},
                            table);
  dds::WaitSet loop(observer);
  Endpoints written(observer.handle(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION);
  Endpoints read(observer.handle(), DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION);
  loop.Attach(written.reader(), [&] { written.Take(); });
  loop.Attach(read.reader(), [&] { read.Take(); });
  auto statuses = observer.CreateReader(dds::kComponentStatusTopic);
  std::multiset<std::string> reports;  // of which components
  loop.Attach(statuses, [&] {
    for (const auto& report : statuses.Take()) {
      reports.insert(std::string(dds::Text(report.component_name)));
    }
  });

  std::map<std::string, std::vector<WaitingProgram>> programs;
  for (const WaitingProgram& program : WaitingPrograms()) {
    programs[program.component].push_back(program);
  }
  for (const auto& [component, variants] : programs) {
    SCOPED_TRACE(component);
    const dds::TopicNames names("palpate_" + component, "/", {}, table);
    const security::AccessRights rights = dds::RightsOf(table, component, names);
    const Names may_write = FromTheStart(rights.write);
    const Names may_read = FromTheStart(rights.read);
    written.Forget();
    read.Forget();
    // One after the other: two of a component may not write the same topics.
    for (const WaitingProgram& variant : variants) {
      std::vector<std::string> arguments = variant.arguments;
      arguments.insert(arguments.end(), {"--set", "dds.use_sim_time=true"});
      Process process(variant.Program(), arguments,
                      folder_ / (component + std::to_string(&variant - variants.data()) + ".log"));
      reports.clear();
      const auto knows_all = [&] {
        // Its endpoints came into being before its first report, a second ago.
        return reports.count(component) >= 2 &&
               (&variant != &variants.back() ||
                (written.names() == may_write && read.names() == may_read));
      };
      EXPECT_TRUE(loop.DispatchUntil(knows_all, dds::WaitSet::Clock::now() + seconds(60)));
      // An endpoint that the table lacks would have ended it with 1.
      process.Signal(SIGINT);
      const std::optional<int> code = process.Wait(seconds(30));
      EXPECT_TRUE(code == 0 || code == -SIGINT) << process.Output();
    }
    EXPECT_EQ(written.names(), may_write);
    EXPECT_EQ(read.names(), may_read);
  }
}

}  // namespace
}  // namespace palpate::system_test
