// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "components/palpate/node/security/security_verb.hpp"
#include "libs/core/file.hpp"
#include "libs/dds/dds_reports.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/topics.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {

/// What Cyclone DDS reports in this process, as long as this lives.
class DdsReports {
 public:
  DdsReports() {
    dds::CountRepeatedDdsReports();  // the first participant would do it, and take the place
    dds_set_log_sink(Keep, this);
  }
  ~DdsReports() { dds_set_log_sink(nullptr, nullptr); }
  DdsReports(const DdsReports&) = delete;
  DdsReports& operator=(const DdsReports&) = delete;

  std::string Text() const {
    const std::lock_guard lock(mutex_);
    return text_;
  }
  bool Has(const std::string& words) const { return Text().find(words) != std::string::npos; }

 private:
  static void Keep(void* self, const dds_log_data_t* data) {
    auto& reports = *static_cast<DdsReports*>(self);
    const std::lock_guard lock(reports.mutex_);
    reports.text_.append(data->message, data->size);
  }

  mutable std::mutex mutex_;
  std::string text_;
};

/// Makes every domain of this process one of its own that meets the others on the network only, as
/// separate processes do: inside one domain Cyclone DDS passes messages on without security.
class SeparateDomains {
 public:
  SeparateDomains() {
    std::string xml = ReadFile(PALPATE_SOURCE_DIR "/tests/system/loopback.xml");
    const std::string place = "<Discovery>";
    xml.insert(xml.find(place) + place.size(),
               "<ExternalDomainId>" + std::to_string(dds::TestDomain()) + "</ExternalDomainId>");
    xml.erase(0, xml.find("<CycloneDDS"));
    old_ = std::getenv("CYCLONEDDS_URI");
    setenv("CYCLONEDDS_URI", xml.c_str(), 1);
  }
  ~SeparateDomains() { setenv("CYCLONEDDS_URI", old_.c_str(), 1); }
  SeparateDomains(const SeparateDomains&) = delete;
  SeparateDomains& operator=(const SeparateDomains&) = delete;

  static std::uint32_t Next() {
    static std::uint32_t next = 100;
    return next++;
  }

 private:
  std::string old_;
};

/// A node in a domain instance of its own.
struct NetworkNode {
  NetworkNode(const std::string& name, const dds::SecuritySettings& security)
      : participant({.domain_id = SeparateDomains::Next(), .node_name = name, .security = security},
                    dds::BuiltInTable()),
        loop(participant) {}

  std::function<void()> Waker() {
    return [this] { loop.Wake(); };
  }

  dds::Participant participant;
  dds::WaitSet loop;
};

/// Sends /forces; the first contact has the sender's name.
class ForceSender {
 public:
  explicit ForceSender(const std::string& name, const dds::SecuritySettings& security = {})
      : name_(name), node_(name, security) {}

  void Send() {
    dds::Message<idl::palpate_msgs::ForceArray> message;
    dds::Resize(message->forces, 1);
    dds::SetText(message->forces._buffer[0].name, name_);
    EXPECT_TRUE(writer_.Write(message));
  }
  unsigned matched() const { return static_cast<unsigned>(writer_.matched()); }

 private:
  std::string name_;
  NetworkNode node_;
  dds::Writer<idl::palpate_msgs::ForceArray> writer_ =
      node_.participant.CreateWriter(dds::kForcesTopic);
};

/// Counts the messages of each sender.
class ForceReceiver {
 public:
  explicit ForceReceiver(const std::string& name, const dds::SecuritySettings& security = {})
      : node_(name, security) {
    node_.loop.Attach(reader_, [this] {
      for (const auto& message : reader_.Take()) {
        for (const auto& force : dds::Elements(message.forces))
          ++count_[std::string(dds::Text(force.name))];
      }
    });
  }

  int CountOf(const std::string& sender) const {
    const auto found = count_.find(sender);
    return found == count_.end() ? 0 : found->second;
  }

  /// Lets `senders` send until `done()`, at most 20 s.
  template <typename Done>
  bool ReceiveUntil(const std::vector<ForceSender*>& senders, const Done& done) {
    const auto deadline = dds::WaitSet::Clock::now() + std::chrono::seconds(20);
    while (!done() && dds::WaitSet::Clock::now() < deadline) {
      for (ForceSender* sender : senders) sender->Send();
      Dispatch();
    }
    return done();
  }
  void Dispatch() {
    node_.loop.DispatchUntil([] { return false; },
                             dds::WaitSet::Clock::now() + std::chrono::milliseconds(20));
  }
  unsigned matched() const { return static_cast<unsigned>(reader_.matched()); }

 private:
  NetworkNode node_;
  dds::Reader<idl::palpate_msgs::ForceArray> reader_ =
      node_.participant.CreateReader(dds::kForcesTopic);
  std::map<std::string, int> count_;
};

/// `palpate security ...`, whose output is dropped.
inline int RunSecurity(SecurityOptions options) {
  testing::internal::CaptureStdout();
  const int code = Security(options);
  testing::internal::GetCapturedStdout();
  return code;
}

/// A keystore with the identities that these tests need.
inline std::filesystem::path MakeKeystore(const test_support::TestFolder& folder,
                                          const std::string& name,
                                          const std::vector<std::string>& identities = {
                                              "force_estimation", "observer", "perception",
                                              "player"}) {
  SecurityOptions options;
  options.action = "init";
  options.keystore = folder / name;
  options.names = identities;
  EXPECT_EQ(RunSecurity(options), 0);
  return folder / name;
}

}  // namespace palpate::command
