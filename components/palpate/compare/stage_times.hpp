// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace palpate::command {

/// Events of a frame between its exposure and the receipt of its forces.
enum class Milestone {
  kReceived,    ///< capture has its last packet
  kPublished,   ///< capture has written its images
  kPerceiving,  ///< perception has all its parts
  kPerceived,   ///< perception has written clouds and contacts
  kEstimating,  ///< the estimator has all its parts
  kEstimated,   ///< the estimator has written the forces
  kHeard,       ///< the listener has them
};

/// Durations of the stages between exposure and force, from the stamps of the messages. Memory is
/// bounded: frames that never arrive are dropped.
class StageTimes {
 public:
  static constexpr std::size_t kStages = 7;

  /// The virtual robot has published the state of this stamp, of which the camera takes an image.
  void AddState(std::int64_t stamp_ns) { AddStamp(stamp_ns, &states_ns_); }
  /// `after_exposure_s`: from the frame's stamp to the milestone. The first call for a milestone
  /// counts.
  void Pass(std::int64_t stamp_ns, Milestone milestone, double after_exposure_s);
  /// The frame has its forces: it counts if all its milestones are known.
  void Finish(std::int64_t stamp_ns);

  std::size_t frames() const { return ages_s_.size(); }  ///< with all milestones
  /// [kStages] s, of the stage that ends with the milestone; NaN without frames.
  double Median_s(Milestone milestone) const;

  /// A row for each frame: t_s (since the first), then the time of each stage and the sum, ms.
  std::string ToCsv() const;
  /// How many frames each process had, and how long each stage takes: median, p99, and the mean
  /// over the slowest hundredth of the frames. Lines, each ended; empty without frames.
  std::string ToText() const;

 private:
  using Ages = std::array<double, kStages>;  ///< s after the exposure; NaN: not known
  using Stamps = std::vector<std::int64_t>;

  static void AddStamp(std::int64_t stamp_ns, Stamps* stamps);
  std::vector<double> Stage_s(std::size_t stage, const std::vector<Ages>& frames) const;
  std::vector<Ages> Slowest() const;
  std::string CountsText() const;

  static constexpr std::size_t kMostOpen = 64;

  std::map<std::int64_t, Ages> open_;  ///< by stamp
  Stamps stamps_ns_;                   ///< of the frames with all milestones
  std::vector<Ages> ages_s_;           ///< of the same frames
  Stamps states_ns_;
  Stamps captured_ns_;
  Stamps perceived_ns_;
  Stamps estimated_ns_;
};

}  // namespace palpate::command
