// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "libs/experiment/experiment.hpp"

namespace palpate::player {

/// Inputs of one cable at one time; what was not recorded is absent.
struct CableInput {
  std::string cable;
  std::optional<double> displacement_m;
  std::optional<double> tension_N;
};

struct Marker {
  std::string name;
  std::optional<Eigen::Vector3d> position_m;          ///< absent: not seen
  Eigen::Vector3d sigma_m = Eigen::Vector3d::Zero();  ///< along the frame's axes; 0: unknown
};

enum class MarkerReference { kNone, kUndeformed, kEquilibrium };

struct MarkerSet {
  uint64_t counter = 0;  ///< from 0 in each recording
  MarkerReference reference = MarkerReference::kNone;
  experiment::MeasurementFrame frame = experiment::MeasurementFrame::kRobot;
  std::vector<Marker> markers;
};

/// What happened at one time of a recording: cable inputs (linear between the rows of
/// actuation.csv), and the markers where they were measured at that time.
struct Event {
  std::string recording;
  double t_s = 0.0;
  std::vector<CableInput> cables;  ///< empty: the recording has no actuation.csv
  std::optional<MarkerSet> markers;
};

/// Turns an experiment into events: recording after recording in the order of their names, each in
/// the order of time, with one event for each marker frame and each row of actuation.csv.
class ExperimentPlayer {
 public:
  /// `recording`: the only one to play; empty: all that have markers. `in_robot_frame`: markers are
  /// mapped to the robot frame; else they stay as measured. Throws InputError where there is no
  /// such recording (with "did you mean"), none has markers, or the mapping is unknown.
  ExperimentPlayer(experiment::Experiment experiment, const std::string& recording,
                   bool in_robot_frame);

  ExperimentPlayer(ExperimentPlayer&&) = default;
  ExperimentPlayer(const ExperimentPlayer&) = delete;  // tracks point into the experiment

  /// The next event; nullopt at the end of the last recording.
  std::optional<Event> Next();
  /// Goes back to the first event of the recording that Next() is in.
  void RewindRecording();
  /// Goes back to the first event of all.
  void RewindAll();

  bool has_cables() const;

 private:
  /// A recording as it is played.
  struct Track {
    const experiment::Recording* recording;
    Eigen::Isometry3d T_frame_measured;
    experiment::MeasurementFrame frame;
    Eigen::Vector3d sigma_m;
    std::vector<double> times_s;  ///< of all events, rising
  };

  Track MakeTrack(const experiment::Recording& recording, bool in_robot_frame) const;
  MarkerSet MarkersOf(const Track& track, const experiment::MarkerFrame& frame) const;

  experiment::Experiment experiment_;
  std::vector<Track> tracks_;
  size_t track_ = 0;
  size_t event_ = 0;
  uint64_t marker_frame_ = 0;  ///< the next one of the track
};

}  // namespace palpate::player
