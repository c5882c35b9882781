// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cstdint>
#include <deque>
#include <set>
#include <string>
#include <vector>

#include "tests/components/force_estimation/node/shape_node_fixture.hpp"

namespace palpate::force_estimation {
namespace {

constexpr int kContacts = 200;
constexpr int kSlots = 3;  ///< a slot is held for 1 s, and contacts come every 0.5 s
constexpr std::int64_t kStep_ns = 500'000'000;

std::int64_t StampOf(int contact) { return contact * kStep_ns; }

/// Readers of /forces/wrenches and of the slots' topics.
class WrenchesTest : public ShapeNodeTest {
 protected:
  WrenchesTest() : arrays_(test_.participant.CreateReader(dds::kWrenchesTopic, test_.Waker())) {
    test_.loop.Attach(arrays_, [this] { TakeArrays(); });
    for (int slot = 1; slot <= kSlots; ++slot) {
      auto& reader = slots_.emplace_back(test_.participant.CreateReader(
          dds::kWrenchTopic, test_.Waker(), "slot_" + std::to_string(slot)));
      test_.loop.Attach(reader, [this, &reader] {
        for (const auto& message : reader.Take()) {
          stamped_ns_.insert(dds::StampNs(message.header.stamp));
        }
      });
    }
    EXPECT_TRUE(test_.WaitFor([this] { return arrays_.matched() == 1; }));
  }

  void TakeArrays() {
    for (const auto& message : arrays_.Take()) {
      EXPECT_EQ(message.counter, counter_++);
      for (const auto& wrench : dds::Elements(message.wrenches)) {
        names_.emplace_back(dds::Text(wrench.name));
        topics_.insert(std::string(dds::Text(wrench.topic)));
        EXPECT_EQ(wrench.wrench.force.z, 1.0);
      }
    }
  }
  void Touch(int contact) {
    script_.SetContactName("contact_" + std::to_string(contact));
    Ask({.stamp_ns = StampOf(contact)});
  }
  bool SlotsAreRead() const {
    for (const auto& reader : slots_) {
      if (reader.matched() != 1) return false;
    }
    return true;
  }

  dds::Reader<idl::palpate_msgs::WrenchArray> arrays_;
  std::deque<dds::Reader<idl::geometry_msgs::WrenchStamped>> slots_;
  std::uint64_t counter_ = 0;
  std::vector<std::string> names_;
  std::set<std::string> topics_;
  std::set<std::int64_t> stamped_ns_;
};

TEST_F(WrenchesTest, AnyNumberOfContactsOneAfterAnotherIsPublished) {
  std::vector<std::string> expected;
  for (int contact = 1; contact <= kContacts; ++contact) {
    Touch(contact);
    expected.push_back("contact_" + std::to_string(contact));
    // The writer of a slot appears with the first contact that has it.
    if (contact != kSlots) continue;
    ASSERT_TRUE(test_.WaitFor([this] { return SlotsAreRead(); }));
  }
  EXPECT_TRUE(test_.WaitFor([&] { return names_.size() >= expected.size(); }));
  EXPECT_EQ(names_, expected);
  EXPECT_EQ(topics_, (std::set<std::string>{"/forces/slot_1/wrench", "/forces/slot_2/wrench",
                                            "/forces/slot_3/wrench"}));
  const auto missing = [this] {
    int count = 0;
    for (int contact = kSlots + 1; contact <= kContacts; ++contact) {
      count += stamped_ns_.contains(StampOf(contact)) ? 0 : 1;
    }
    return count;
  };
  EXPECT_TRUE(test_.WaitFor([&] { return missing() == 0; })) << missing();
}

TEST_F(WrenchesTest, AFrameThatIsRefusedHasNoWrench) {
  Touch(1);
  ASSERT_TRUE(test_.WaitFor([this] { return names_.size() == 1; }));
  EXPECT_EQ(AskWithoutCable({.stamp_ns = StampOf(9)}).status, "stale");
  EXPECT_TRUE(test_.WaitFor([this] { return counter_ == 2; }));
  EXPECT_EQ(names_.size(), 1u);
}

}  // namespace
}  // namespace palpate::force_estimation
