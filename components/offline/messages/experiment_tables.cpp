// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/experiment_tables.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/core/names.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/actuator_fault.hpp"

namespace palpate::offline {

namespace {

using experiment::ActuatorQuantity;

/// The number that a table with this time would be read as.
double TableTime(std::int64_t t_ns) { return static_cast<double>(t_ns) / 1e9; }

/// The map from the frame of a message to that of the table, and which frame that is.
struct MeasuredIn {
  experiment::MeasurementFrame frame = experiment::MeasurementFrame::kRobot;
  Eigen::Isometry3d T_frame_measured = Eigen::Isometry3d::Identity();
};

MeasuredIn FrameOfMarkers(const CollectedMarkers& set, const MarkerFrames& frames,
                          const TransformTree& transforms) {
  const std::string frame = FrameName(set.frame_id);
  if (frame == frames.robot) return {};
  if (IndexOf(frame, frames.camera)) return {experiment::MeasurementFrame::kCamera, {}};
  if (const auto T = transforms.Find(frames.robot, frame, set.time.log_ns)) return {{}, *T};
  throw InputError(std::string(kMarkersTopic) + ": markers are in frame '" + frame +
                   "', which no transform on /tf or /tf_static joins with '" + frames.robot +
                   "'; name the robot's frame as robot_frame in the file of phases");
}

std::size_t ColumnOf(const std::string& name, experiment::MarkerTracks* tracks) {
  if (const auto index = tracks->IndexOf(name)) return *index;
  tracks->names.push_back(name);
  tracks->names_where.push_back(SourceLocation{kMarkersTopic});
  return tracks->names.size() - 1;
}

/// Displacements count from the frames that say so.
void AddReference(const std::vector<const CollectedMarkers*>& frames,
                  experiment::Recording* recording) {
  if (recording->reference) return;
  std::optional<experiment::Reference> reference;
  for (const CollectedMarkers* frame : frames) {
    if (frame->reference_shape == 0) continue;
    if (!reference) {
      reference.emplace();
      reference->window_s.begin_s = TableTime(frame->time.t_ns);
      reference->shape = frame->reference_shape == 1 ? experiment::ReferenceShape::kUndeformed
                                                     : experiment::ReferenceShape::kEquilibrium;
    }
    reference->window_s.end_s = TableTime(frame->time.t_ns);
  }
  // A window has a length: what one frame says cannot be told.
  if (reference && reference->window_s.begin_s < reference->window_s.end_s) {
    recording->reference = reference;
  }
}

/// What of a joint no table may hold; empty: nothing.
std::string CheckJoint(const CollectedJoint& joint, bool of_chamber) {
  for (const auto& [word, input, quantity] :
       {std::tuple("position ", joint.position_m, ActuatorQuantity::kDisplacement),
        std::tuple("effort ", joint.effort_N, ActuatorQuantity::kTension)}) {
    if (!input) continue;
    std::string fault = experiment::ActuatorFault(*input, quantity, of_chamber);
    if (!fault.empty()) return word + FormatNumber(*input) + ": " + fault;
  }
  return {};
}

/// Where the wrenches of a frame act, and how they are turned; nullopt: unknown.
std::optional<Eigen::Isometry3d> PlaceOfLoad(const CollectedTopics& topics,
                                             const CollectedWrench& wrench, const PhaseFile& file) {
  auto place = topics.transforms.Find(file.robot_frame, wrench.frame_id, wrench.time.log_ns);
  const bool in_robot_frame = FrameName(wrench.frame_id) == file.robot_frame;
  if (file.load_point_m) {
    if (!place) place = Eigen::Isometry3d::Identity();
    place->translation() = *file.load_point_m;
    return place;
  }
  // The origin of the robot frame is in its base, and no load acts there.
  return in_robot_frame ? std::nullopt : place;
}

}  // namespace

void AddMarkers(const CollectedTopics& topics, const Phase& phase, const MarkerFrames& frames,
                experiment::Recording* recording, std::vector<std::string>* notes) {
  experiment::MarkerTracks tracks;
  std::vector<const CollectedMarkers*> used;
  for (const CollectedMarkers& set : topics.markers) {
    if (!phase.Contains(set.time.t_ns, set.time.segment) || set.markers.empty()) continue;
    const MeasuredIn measured = FrameOfMarkers(set, frames, topics.transforms);
    if (used.empty()) recording->frame = measured.frame;
    if (recording->frame != measured.frame) {
      notes->push_back("markers of another frame than the first are left out");
      continue;
    }
    used.push_back(&set);
    experiment::MarkerFrame& frame = tracks.frames.emplace_back();
    frame.t_s = TableTime(set.time.t_ns);
    std::size_t unnamed = 0;
    for (const CollectedMarker& marker : set.markers) {
      const std::string name = marker.name.empty() ? std::string(experiment::kUnlabelledPrefix) +
                                                         std::to_string(++unnamed)
                                                   : marker.name;
      const std::size_t column = ColumnOf(name, &tracks);
      frame.positions_m.resize(std::max(frame.positions_m.size(), column + 1));
      if (!marker.position_m) continue;
      // Without a transform not even the last bit changes.
      const bool same = measured.T_frame_measured.matrix().isIdentity(0.0);
      frame.positions_m[column] =
          same ? *marker.position_m : measured.T_frame_measured * *marker.position_m;
    }
  }
  if (used.empty()) return;
  for (experiment::MarkerFrame& frame : tracks.frames)
    frame.positions_m.resize(tracks.names.size());
  AddReference(used, recording);
  recording->markers = std::move(tracks);
}

ActuationRows::ActuationRows(const CollectedTopics& topics,
                             const std::map<std::string, std::string>& cables,
                             const std::vector<std::string>& chambers, const TopicRoles& roles)
    : chambers_(chambers) {
  for (const CollectedJoints& set : topics.joints) {
    auto& row = rows_[{set.time.segment, set.time.t_ns}];
    for (CollectedJoint joint : set.joints) {
      const auto cable = cables.find(joint.name);
      if (!cables.empty() && cable == cables.end()) continue;
      const std::string name = cable != cables.end() ? cable->second : joint.name;
      const bool of_chamber = IndexOf(name, chambers_).has_value();
      if (std::string fault = CheckJoint(joint, of_chamber); !fault.empty()) {
        const std::string& topic = roles.names.at(kJointStatesTopic);
        throw InputError(topic + ": joint '" + joint.name + "', " + fault +
                         (of_chamber ? ""
                                     : "; joints are chambers where the robot file says so, given "
                                       "with --robot or attached to the recording") +
                         "; where the joints are no actuators, leave the topic out with --remap " +
                         topic +
                         ":=/unused, or name those that are under `cables` in the file of "
                         "phases");
      }
      joint.name = name;
      row.emplace(joint.name, joint);
    }
  }
}

/// All rows of a segment, one column for each input that a message has.
ActuationRows::Part ActuationRows::PartOf(const Rows& rows,
                                          const std::vector<std::string>& chambers, int segment) {
  Part part;
  std::vector<const std::map<std::string, CollectedJoint>*> joints_of;
  std::vector<std::string> cables;
  for (const auto& [time, joints] : rows) {
    if (segment != Phase::kAnySegment && segment != time.first) continue;
    for (const auto& [name, joint] : joints) {
      if (!IndexOf(name, cables)) cables.push_back(name);
    }
    joints_of.push_back(&joints);
    part.times.push_back(time);
    part.table.t_s.push_back(TableTime(time.second));
  }
  const auto add = [&](const std::string& cable, ActuatorQuantity quantity,
                       std::optional<double> CollectedJoint::*input) {
    experiment::ActuatorColumn column{.cable = cable,
                                      .quantity = quantity,
                                      .samples = {},
                                      .where = {},
                                      .of_chamber = IndexOf(cable, chambers).has_value()};
    bool any = false;
    for (const auto* joints : joints_of) {
      const auto joint = joints->find(cable);
      column.samples.push_back(joint == joints->end() ? std::nullopt : joint->second.*input);
      any = any || column.samples.back().has_value();
    }
    if (any) part.table.columns.push_back(std::move(column));
  };
  for (const std::string& cable : cables) {
    add(cable, ActuatorQuantity::kDisplacement, &CollectedJoint::position_m);
    add(cable, ActuatorQuantity::kTension, &CollectedJoint::effort_N);
  }
  return part;
}

/// The rows of a stretch; where it has none, what held when it began.
experiment::Actuation ActuationRows::RowsWithin(const Part& all, const Phase& phase) {
  experiment::Actuation part;
  part.columns = all.table.columns;
  for (experiment::ActuatorColumn& column : part.columns) column.samples.clear();
  for (std::size_t row = 0; row < all.times.size(); ++row) {
    if (!phase.Contains(all.times[row].second, all.times[row].first)) continue;
    part.t_s.push_back(all.table.t_s[row]);
    for (std::size_t i = 0; i < part.columns.size(); ++i) {
      part.columns[i].samples.push_back(all.table.columns[i].samples[row]);
    }
  }
  const double begin_s = TableTime(phase.begin_ns);
  const bool empty = part.t_s.empty();
  if (empty) part.t_s.push_back(begin_s);
  for (std::size_t i = 0; i < part.columns.size(); ++i) {
    const experiment::ActuatorColumn& column = all.table.columns[i];
    auto& samples = part.columns[i].samples;
    if (empty) samples.push_back(all.table.ValueAt(column, begin_s));
    const bool any = std::any_of(samples.begin(), samples.end(),
                                 [](const auto& sample) { return sample.has_value(); });
    if (!any) samples.front() = all.table.ValueAt(column, part.t_s.front());
  }
  return part;
}

void ActuationRows::AddTo(const Phase& phase, experiment::Recording* recording) {
  auto part = parts_.find(phase.segment);
  if (part == parts_.end())
    part = parts_.emplace(phase.segment, PartOf(rows_, chambers_, phase.segment)).first;
  if (part->second.table.columns.empty()) return;
  recording->actuation = RowsWithin(part->second, phase);
}

void AddLoads(const CollectedTopics& topics, const Phase& phase, const PhaseFile& file,
              const TopicRoles& roles, experiment::Recording* recording,
              std::vector<std::string>* notes) {
  std::map<std::string, experiment::KnownLoad> acting;  // by frame
  std::set<std::string> unknown;
  std::int64_t last_ns = phase.begin_ns;
  const auto write = [&](std::int64_t t_ns) {
    for (auto& [frame, load] : acting) {
      load.t_s = TableTime(t_ns);
      recording->loads.push_back(load);
    }
  };
  for (const CollectedWrench& wrench : topics.wrenches) {
    const std::int64_t t_ns = wrench.time.t_ns;
    if (phase.segment != Phase::kAnySegment && phase.segment != wrench.time.segment) continue;
    if (t_ns > phase.end_ns) break;
    // What acted before the stretch acts from its begin on.
    if (t_ns > last_ns) write(last_ns);
    last_ns = std::max(t_ns, phase.begin_ns);
    const auto place = PlaceOfLoad(topics, wrench, file);
    if (!place) {
      unknown.insert(wrench.frame_id);
      continue;
    }
    experiment::KnownLoad& load = acting[wrench.frame_id];
    load.position_m = place->translation();
    load.force_N = place->linear() * wrench.force_N;
  }
  write(last_ns);
  for (const std::string& frame : unknown) {
    notes->push_back(roles.names.at(kLoadTopic) + " is not used as loads: where frame '" + frame +
                     "' acts on the robot is unknown; publish it below '" + file.robot_frame +
                     "' on /tf_static, or give load_point_m in the file of phases");
  }
}

std::optional<Eigen::Vector3d> MarkerSigma(const std::vector<CollectedMarkers>& frames) {
  std::optional<Eigen::Vector3d> sigma_m;
  for (const CollectedMarkers& frame : frames) {
    for (const CollectedMarker& marker : frame.markers) {
      if (!marker.position_m) continue;
      if (!(marker.sigma_m.array() > 0.0).all() || !marker.sigma_m.allFinite()) return std::nullopt;
      if (!sigma_m) sigma_m = marker.sigma_m;
      if (*sigma_m != marker.sigma_m) return std::nullopt;
    }
  }
  return sigma_m;
}

}  // namespace palpate::offline
