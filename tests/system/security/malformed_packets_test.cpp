// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "libs/dds/message.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/support/test_folder.hpp"
#include "tests/system/process.hpp"
#include "tests/system/security/system_programs.hpp"

/// Random bytes on the UDP ports of the running processes: each lives on and still communicates.
namespace palpate::system_test {
namespace {

using std::chrono::seconds;
using Bytes = std::vector<std::uint8_t>;

/// Each port gets a packet so often.
constexpr std::chrono::milliseconds kPeriod{10};

/// Inodes of the sockets that a process holds.
std::set<std::string> SocketsOf(pid_t pid) {
  std::set<std::string> inodes;
  std::error_code error;
  for (const auto& entry :
       std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/fd", error)) {
    const std::string target = std::filesystem::read_symlink(entry.path(), error).string();
    if (target.starts_with("socket:[")) inodes.insert(target.substr(8, target.size() - 9));
  }
  return inodes;
}

/// The UDP ports on which a process listens (proc(5), /proc/net/udp).
std::set<std::uint16_t> UdpPortsOf(pid_t pid) {
  const std::set<std::string> inodes = SocketsOf(pid);
  std::set<std::uint16_t> ports;
  std::ifstream table("/proc/net/udp");
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) {
    std::istringstream fields(line);
    std::vector<std::string> words;
    for (std::string word; fields >> word;) words.push_back(word);
    constexpr std::size_t kLocalAddress = 1;
    constexpr std::size_t kInode = 9;
    if (words.size() <= kInode || !inodes.contains(words[kInode])) continue;
    const std::string& address = words[kLocalAddress];
    ports.insert(
        static_cast<std::uint16_t>(std::stoul(address.substr(address.find(':') + 1), nullptr, 16)));
  }
  return ports;
}

/// Sends random bytes: with the same seed the same.
class RandomSender {
 public:
  RandomSender() : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}
  ~RandomSender() { close(socket_); }
  RandomSender(const RandomSender&) = delete;
  RandomSender& operator=(const RandomSender&) = delete;

  void SendTo(std::uint16_t port) {
    constexpr int kLongest = 1400;
    const int size = std::uniform_int_distribution<int>(0, kLongest)(random_);
    Bytes bytes(static_cast<std::size_t>(size));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random_());
    if (random_() % 2 == 0) PutHeader(&bytes);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&address),
           sizeof(address));
    ++sent_;
  }
  std::uint64_t sent() const { return sent_; }

 private:
  /// That of RTPS 2.1: without it the rest is not looked at.
  static void PutHeader(Bytes* bytes) {
    constexpr std::array<std::uint8_t, 8> kHeader{'R', 'T', 'P', 'S', 2, 1, 1, 16};
    std::copy_n(kHeader.begin(), std::min(kHeader.size(), bytes->size()), bytes->begin());
  }

  int socket_;
  std::mt19937 random_{39};
  std::uint64_t sent_ = 0;
};

/// Which components have reported since the last Forget().
class Statuses {
 public:
  explicit Statuses(const dds::SecuritySettings& security)
      : participant_(
            {.domain_id = dds::TestDomain(), .node_name = "observer", .security = security},
            dds::BuiltInTable()) {
    loop_.Attach(reader_, [this] {
      for (const auto& message : reader_.Take()) {
        components_.insert(std::string(dds::Text(message.component_name)));
      }
    });
  }
  bool WaitFor(const std::set<std::string>& components) {
    components_.clear();
    return loop_.DispatchUntil(
        [&] {
          return std::includes(components_.begin(), components_.end(), components.begin(),
                               components.end());
        },
        dds::WaitSet::Clock::now() + seconds(60));
  }
  std::string Listed() const {
    std::string text;
    for (const std::string& component : components_) text += component + " ";
    return text;
  }

 private:
  dds::Participant participant_;
  dds::WaitSet loop_{participant_};
  dds::Reader<idl::palpate_msgs::ComponentStatus> reader_ =
      participant_.CreateReader(dds::kComponentStatusTopic);
  std::set<std::string> components_;
};

class MalformedPackets : public testing::TestWithParam<bool> {
 protected:
  MalformedPackets() {
    if (!GetParam()) return;
    const std::filesystem::path keystore = folder_ / "keystore";
    EXPECT_EQ(RunProgram("palpate", {"security", "init", keystore.string()}, folder_ / "init.log"),
              0);
    setenv("PALPATE_SECURITY_DIR", keystore.c_str(), 1);
    security_ = {keystore, "observer"};
  }
  ~MalformedPackets() override { unsetenv("PALPATE_SECURITY_DIR"); }

  void StartAll() {
    for (const WaitingProgram& program : WaitingPrograms()) {
      if (!started_.insert(program.component).second) continue;
      // The simulation is late on a busy machine, and with it its reports: it must live on, only.
      if (program.component != "virtual_robot") components_.insert(program.component);
      processes_.push_back(std::make_unique<Process>(program.Program(), program.arguments,
                                                     folder_ / (program.component + ".log")));
    }
  }

  void SurviveFor(seconds duration) {
    StartAll();
    Statuses statuses(security_);
    ASSERT_TRUE(statuses.WaitFor(components_)) << statuses.Listed();
    std::set<std::uint16_t> ports;
    for (const auto& process : processes_) ports.merge(UdpPortsOf(process->pid()));
    ASSERT_GE(ports.size(), 2 * processes_.size());
    RandomSender sender;
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + duration;
    for (auto turn = Clock::now(); turn < end; turn += kPeriod) {
      std::this_thread::sleep_until(turn);
      for (const std::uint16_t port : ports) sender.SendTo(port);
    }
    RecordProperty("packets", std::to_string(sender.sent()));
    for (const auto& process : processes_) {
      EXPECT_EQ(process->Wait(seconds(0)), std::nullopt) << process->Output();
    }
    EXPECT_TRUE(statuses.WaitFor(components_)) << statuses.Listed();
  }

  test_support::TestFolder folder_;
  dds::SecuritySettings security_;
  std::set<std::string> started_;
  std::set<std::string> components_;  ///< that must report before and after
  std::vector<std::unique_ptr<Process>> processes_;
};

TEST_P(MalformedPackets, AreSurvivedForSeconds) { SurviveFor(seconds(2)); }

TEST_P(MalformedPackets, AreSurvivedForTenMinutes) { SurviveFor(seconds(600)); }

INSTANTIATE_TEST_SUITE_P(Domain, MalformedPackets, testing::Bool(),
                         [](const auto& one) { return one.param ? "Secured" : "Plain"; });

}  // namespace
}  // namespace palpate::system_test
