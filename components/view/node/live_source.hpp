// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/view/config.hpp"
#include "components/view/node/image_tap.hpp"
#include "components/view/node/page_feed.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::view {

/// Reads what the page shows of a running system. Images come only while somebody looks at them.
class LiveSource {
 public:
  /// All must outlive this. Throws RunError where DDS refuses.
  LiveSource(const Config& config, dds::Participant& participant, dds::WaitSet& loop,
             PageFeed* feed);

  /// To be called often: begins or ends to read images, and takes those that have come.
  void TakeImages(bool wanted);

 private:
  template <typename T>
  void Attach(dds::Reader<T>& reader);
  template <typename T>
  void Attach(dds::Reader<T>& reader, void (PageFeed::*take)(const T&));

  dds::WaitSet& loop_;
  PageFeed* feed_;
  dds::Reader<idl::palpate_msgs::Mesh> meshes_;
  dds::Reader<idl::palpate_msgs::MeshState> mesh_states_;
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  dds::Reader<idl::palpate_msgs::ModelGap> model_errors_;
  dds::Reader<idl::palpate_msgs::PerceptionReport> reports_;
  dds::Reader<idl::palpate_msgs::FrameInfo> frame_infos_;
  dds::Reader<idl::palpate_msgs::Calibration> calibrations_;
  dds::Reader<idl::palpate_msgs::CalibrationStatus> calibration_statuses_;
  dds::Reader<idl::palpate_msgs::CameraSetup> setups_;
  dds::Reader<idl::palpate_msgs::MarkerArray3> markers_;
  dds::Reader<idl::palpate_msgs::ComponentStatus> statuses_;
  dds::Reader<idl::diagnostic_msgs::DiagnosticArray> diagnostics_;
  dds::Reader<idl::sensor_msgs::JointState> cables_;
  dds::Reader<idl::tf2_msgs::TFMessage> transforms_;
  dds::Reader<idl::sensor_msgs::CameraInfo> color_infos_;
  dds::Reader<idl::sensor_msgs::PointCloud2> robot_clouds_;
  dds::Reader<idl::sensor_msgs::PointCloud2> object_clouds_;
  dds::Reader<idl::palpate_msgs::Mesh> true_meshes_;
  dds::Reader<idl::palpate_msgs::MeshState> true_mesh_states_;
  dds::Reader<idl::palpate_msgs::ForceArray> true_forces_;
  ImageTap color_images_;
  ImageTap depth_images_;
  ImageTap packed_colors_;
  ImageTap packed_depths_;
};

}  // namespace palpate::view
