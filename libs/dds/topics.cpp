// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/topics.hpp"

#include "libs/dds/camera_topics.hpp"
#include "libs/dds/driver_topics.hpp"

namespace palpate::dds {

namespace {

template <typename T>
TopicNameAndType NameAndType(const Topic<T>& topic) {
  const dds_topic_descriptor_t& type = idl::MessageTraits<T>::Descriptor();
  const auto& information = type.type_information;
  return {topic.name,
          type.m_typename,
          {reinterpret_cast<const char*>(information.data), information.sz}};
}

}  // namespace

std::vector<TopicNameAndType> AllTopics() {
  return {NameAndType(kDepthImageTopic),
          NameAndType(kDepthCameraInfoTopic),
          NameAndType(kColorImageTopic),
          NameAndType(kColorCameraInfoTopic),
          NameAndType(kFrameInfoTopic),
          NameAndType(kCameraSetupTopic),
          NameAndType(kMarkersTopic),
          NameAndType(kRobotCloudTopic),
          NameAndType(kObjectCloudTopic),
          NameAndType(kPerceptionReportTopic),
          NameAndType(kContactsTopic),
          NameAndType(kJointStatesTopic),
          NameAndType(kRobotCommandTopic),
          NameAndType(kForcesTopic),
          NameAndType(kWrenchTopic),
          NameAndType(kWrenchesTopic),
          NameAndType(kMeshStateTopic),
          NameAndType(kMeshTopic),
          NameAndType(kModelGapTopic),
          NameAndType(kCalibrationTopic),
          NameAndType(kCalibrationRequestTopic),
          NameAndType(kCalibrationStatusTopic),
          NameAndType(kTrueForcesTopic),
          NameAndType(kTrueMeshTopic),
          NameAndType(kTrueMeshStateTopic),
          NameAndType(kBenchStateTopic),
          NameAndType(kComponentStatusTopic),
          NameAndType(kClockExchangeTopic),
          NameAndType(kDiagnosticsTopic),
          NameAndType(kRosoutTopic),
          NameAndType(kClockTopic),
          NameAndType(kTfStaticTopic),
          NameAndType(kExperimentPhaseTopic),
          NameAndType(kExperimentLoadTopic),
          NameAndType(kRobotDescriptionTopic),
          NameAndType(kFurtherDepthImageTopic),
          NameAndType(kFurtherDepthCameraInfoTopic),
          NameAndType(kFurtherColorImageTopic),
          NameAndType(kFurtherColorCameraInfoTopic),
          NameAndType(kFurtherFrameInfoTopic),
          NameAndType(kFurtherCameraSetupTopic),
          NameAndType(kFurtherPerceptionReportTopic),
          NameAndType(kPackedDepthTopic),
          NameAndType(kPackedColorTopic),
          NameAndType(kFurtherPackedDepthTopic),
          NameAndType(kFurtherPackedColorTopic),
          NameAndType(kTfTopic)};
}

}  // namespace palpate::dds
