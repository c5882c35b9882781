// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/live_source.hpp"

#include "libs/dds/driver_topics.hpp"

namespace palpate::view {

LiveSource::LiveSource(const Config& config, dds::Participant& participant, dds::WaitSet& loop,
                       PageFeed* feed)
    : loop_(loop),
      feed_(feed),
      meshes_(participant.CreateReader(dds::kMeshTopic)),
      mesh_states_(participant.CreateReader(dds::kMeshStateTopic)),
      forces_(participant.CreateReader(dds::kForcesTopic)),
      model_errors_(participant.CreateReader(dds::kModelGapTopic)),
      reports_(participant.CreateReader(dds::kPerceptionReportTopic)),
      frame_infos_(participant.CreateReader(dds::kFrameInfoTopic)),
      calibrations_(participant.CreateReader(dds::kCalibrationTopic)),
      calibration_statuses_(participant.CreateReader(dds::kCalibrationStatusTopic)),
      setups_(participant.CreateReader(dds::kCameraSetupTopic)),
      markers_(participant.CreateReader(dds::kMarkersTopic)),
      statuses_(participant.CreateReader(dds::kComponentStatusTopic)),
      diagnostics_(participant.CreateReader(dds::kDiagnosticsTopic)),
      cables_(participant.CreateReader(dds::kJointStatesTopic)),
      transforms_(participant.CreateReader(dds::kTfStaticTopic)),
      color_infos_(participant.CreateReader(dds::kColorCameraInfoTopic)),
      robot_clouds_(participant.CreateReader(dds::kRobotCloudTopic)),
      object_clouds_(participant.CreateReader(dds::kObjectCloudTopic)),
      true_meshes_(participant.CreateReader(dds::kTrueMeshTopic)),
      true_mesh_states_(participant.CreateReader(dds::kTrueMeshStateTopic)),
      true_forces_(participant.CreateReader(dds::kTrueForcesTopic)),
      color_images_(participant, dds::kColorImageTopic.name, config.images.max_rate_hz,
                    [&loop] { loop.Wake(); }),
      depth_images_(participant, dds::kDepthImageTopic.name, config.images.max_rate_hz,
                    [&loop] { loop.Wake(); }),
      packed_colors_(participant, dds::kPackedColorTopic.name, config.images.max_rate_hz,
                     [&loop] { loop.Wake(); }),
      packed_depths_(participant, dds::kPackedDepthTopic.name, config.images.max_rate_hz,
                     [&loop] { loop.Wake(); }) {
  Attach(meshes_);
  Attach(mesh_states_);
  Attach(forces_);
  Attach(model_errors_);
  Attach(reports_);
  Attach(frame_infos_);
  Attach(calibrations_);
  Attach(calibration_statuses_);
  Attach(setups_);
  Attach(markers_);
  Attach(statuses_);
  Attach(diagnostics_);
  Attach(cables_);
  Attach(transforms_);
  Attach(color_infos_, &PageFeed::TakeColorInfo);
  Attach(robot_clouds_, &PageFeed::TakeRobotCloud);
  Attach(object_clouds_, &PageFeed::TakeObjectCloud);
  Attach(true_meshes_, &PageFeed::TakeTruth);
  Attach(true_mesh_states_, &PageFeed::TakeTruth);
  Attach(true_forces_, &PageFeed::TakeTruth);
}

template <typename T>
void LiveSource::Attach(dds::Reader<T>& reader) {
  Attach(reader, &PageFeed::Take);
}

template <typename T>
void LiveSource::Attach(dds::Reader<T>& reader, void (PageFeed::*take)(const T&)) {
  loop_.Attach(reader, [this, &reader, take] {
    for (const T& message : reader.Take()) (feed_->*take)(message);
  });
}

void LiveSource::TakeImages(bool wanted) {
  const auto take = [&]<typename T>(ImageTap& tap, void (PageFeed::*feed)(const T&)) {
    const auto image = tap.Take<T>(wanted);
    if (image) (feed_->*feed)(**image);
  };
  take(color_images_, &PageFeed::TakeColorImage);
  take(depth_images_, &PageFeed::TakeDepthImage);
  take(packed_colors_, &PageFeed::TakePackedColor);
  take(packed_depths_, &PageFeed::TakePackedDepth);
}

}  // namespace palpate::view
