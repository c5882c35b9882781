// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "components/view/experiment/experiment_frames.hpp"
#include "components/view/node/page_feed.hpp"
#include "components/view/node/played_source.hpp"
#include "libs/experiment/images/rgbd_sequence.hpp"
#include "libs/rgbd/rgbd_frame.hpp"

namespace palpate::view {

/// An experiment folder that is shown, and what was found about it.
struct ShownExperiment {
  experiment::Experiment experiment;
  std::optional<EstimatedForces> forces;                      ///< forces.csv
  std::map<std::size_t, experiment::RgbdSequence> sequences;  ///< by recording, of its images
};

/// Plays an experiment into the page: the model under the measured commands, the markers beside it,
/// and images.
class ExperimentSource : public PlayedSource {
 public:
  /// All must outlive this. Throws as ExperimentFrames does.
  ExperimentSource(const ShownExperiment& shown, KnownRobot& robot, PageFeed* feed);

  void Advance(std::int64_t now_ns) override;
  void Play(const PlayRequest& request) override;
  void Seek(const SeekRequest& request) override;
  OutMessage State() const override;

  double position_s() const { return position_s_; }
  double duration_s() const { return frames_.duration_s(); }

 private:
  void Start();
  void Show(const ExperimentInstant& instant);
  void ShowShape(const ExperimentInstant& instant, const ExperimentFrame& frame);
  void ShowForces(const ExperimentInstant& instant, const ExperimentFrame& frame);
  void ShowImages(const ExperimentInstant& instant);
  void ShowImage(const ExperimentInstant& instant, const experiment::RgbdSequence& sequence,
                 std::size_t image);

  const ShownExperiment& shown_;
  KnownRobot& robot_;
  PageFeed* feed_;
  ExperimentFrames frames_;
  std::optional<std::size_t> shown_instant_;
  const experiment::RgbdSequence* shown_sequence_ = nullptr;
  std::size_t shown_image_ = 0;
  rgbd::RgbdFrame image_;
  std::uint64_t counter_ = 0;
  std::uint64_t unread_ = 0;  ///< images
  bool paused_ = false;
  double rate_ = 1.0;
  double position_s_ = 0.0;
  std::optional<std::int64_t> last_ns_;
};

}  // namespace palpate::view
