// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "libs/dds/stamp.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::system_test {

inline constexpr std::chrono::seconds kForcesPatience{40};

/// A force of an estimate, or of the truth.
struct Push {
  std::string name;
  Eigen::Vector3d position_m;
  Eigen::Vector3d force_N;
};

/// What /forces says of a frame.
struct Answer {
  std::int64_t stamp_ns = 0;
  std::string status;
  std::string reason;
  std::vector<Push> pushes;
};

inline std::ostream& operator<<(std::ostream& stream, const Answer& answer) {
  stream << answer.status << " '" << answer.reason << "'";
  for (const Push& push : answer.pushes) {
    stream << ", " << push.name << " " << push.force_N.norm() << " N";
  }
  return stream;
}

inline Answer ToAnswer(const idl::palpate_msgs::ForceArray& message) {
  Answer answer{dds::StampNs(message.header.stamp),
                std::string(dds::Text(message.status)),
                std::string(dds::Text(message.reason)),
                {}};
  for (const auto& force : dds::Elements(message.forces)) {
    answer.pushes.push_back({std::string(dds::Text(force.name)),
                             {force.position_m.x, force.position_m.y, force.position_m.z},
                             {force.force_n.x, force.force_n.y, force.force_n.z}});
  }
  return answer;
}

/// Hears the estimates, the truth, and how the components fare.
class ForceListener {
 public:
  ForceListener()
      : node_("live_listener"),
        forces_(node_.participant.CreateReader(dds::kForcesTopic)),
        truth_(node_.participant.CreateReader(dds::kTrueForcesTopic)),
        reports_(node_.participant.CreateReader(dds::kPerceptionReportTopic)),
        statuses_(node_.participant.CreateReader(dds::kComponentStatusTopic)) {
    node_.loop.Attach(truth_, [this] {
      for (const auto& message : truth_.Take()) {
        Answer truth = ToAnswer(message);
        truths_[truth.stamp_ns] = std::move(truth.pushes);
      }
    });
    node_.loop.Attach(forces_, [this] {
      for (const auto& message : forces_.Take()) {
        last_ = ToAnswer(message);
        ++answers_;
        right_in_a_row_ = IsRight() ? right_in_a_row_ + 1 : 0;
      }
    });
    node_.loop.Attach(reports_, [this] {
      for (const auto& message : reports_.Take()) {
        notes_.clear();
        for (const char* note : dds::Elements(message.notes)) notes_.emplace_back(dds::Text(note));
      }
    });
    node_.loop.Attach(statuses_, [this] {
      for (const auto& message : statuses_.Take()) {
        heard_[std::string(dds::Text(message.component_name))] = true;
      }
    });
  }

  bool Heard(const std::string& component) const { return heard_.contains(component); }
  const Answer& last() const { return last_; }
  int answers() const { return answers_; }  ///< since Forget
  int right_in_a_row() const { return right_in_a_row_; }
  /// Of the last report of perception.
  const std::vector<std::string>& notes() const { return notes_; }
  void Forget() {
    last_ = {};
    answers_ = 0;
    right_in_a_row_ = 0;
  }

  template <typename Condition>
  bool WaitFor(const Condition& condition) {
    return node_.loop.DispatchUntil(condition, dds::WaitSet::Clock::now() + kForcesPatience);
  }

 private:
  static constexpr double kFarthest_m = 6e-3;
  static constexpr double kWorst = 0.25;
  static constexpr std::int64_t kSameTime_ns = 150'000'000;

  /// One push, with a contact's name, where the true one is and about as hard.
  bool IsRight() const {
    const std::vector<Push>* truth = TruthAt(last_.stamp_ns);
    if (last_.status != "ok" || last_.pushes.size() != 1 || !truth || truth->size() != 1) {
      return false;
    }
    const Push& push = last_.pushes[0];
    const Push& is = truth->front();
    return (push.name.starts_with("contact_") || push.name.starts_with("hidden_")) &&
           (push.position_m - is.position_m).norm() <= kFarthest_m &&
           std::abs(push.force_N.norm() - is.force_N.norm()) <= kWorst * is.force_N.norm();
  }
  const std::vector<Push>* TruthAt(std::int64_t stamp_ns) const {
    const auto after = truths_.lower_bound(stamp_ns - kSameTime_ns);
    return after == truths_.end() || after->first > stamp_ns + kSameTime_ns ? nullptr
                                                                            : &after->second;
  }

  dds::TestNode node_;
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  dds::Reader<idl::palpate_msgs::ForceArray> truth_;
  dds::Reader<idl::palpate_msgs::PerceptionReport> reports_;
  dds::Reader<idl::palpate_msgs::ComponentStatus> statuses_;
  std::map<std::int64_t, std::vector<Push>> truths_;
  std::map<std::string, bool> heard_;
  std::vector<std::string> notes_;
  Answer last_;
  int answers_ = 0;
  int right_in_a_row_ = 0;
};

}  // namespace palpate::system_test
