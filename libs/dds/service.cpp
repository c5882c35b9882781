// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/service.hpp"

#include <string_view>

#include "libs/core/error.hpp"
#include "libs/dds/qos.hpp"

namespace palpate::dds {

namespace {

/// As ROS 2 has it of services of parameters.
constexpr int kServiceDepth = 1000;

TopicSettings ServiceQos() {
  TopicSettings settings;
  settings.depth = kServiceDepth;
  return settings;
}

/// By this, rmw_cyclonedds finds the two endpoints that belong together.
std::string UserData(ServiceEndpoints::Side side, dds_entity_t request_topic) {
  dds_instance_handle_t id = 0;
  dds_get_instance_handle(request_topic, &id);
  std::string text = side == ServiceEndpoints::Side::kServer ? "serviceid= " : "clientid= ";
  return text + std::to_string(id) + ";";
}

Qos WithUserData(Qos qos, std::string_view data) {
  dds_qset_userdata(qos.get(), data.data(), data.size());
  return qos;
}

void Attach(dds_entity_t wait_set, dds_entity_t entity, std::uint32_t statuses) {
  dds_return_t result = dds_set_status_mask(entity, statuses);
  if (result == DDS_RETCODE_OK) result = dds_waitset_attach(wait_set, entity, 0);
  if (result != DDS_RETCODE_OK) {
    throw RunError(std::string("cannot wait for a service: ") + dds_strretcode(-result));
  }
}

}  // namespace

std::string RequestTopicOf(const std::string& service) { return "rq" + service + "Request"; }

ServiceEndpoints::ServiceEndpoints(Side side, dds_entity_t participant, const std::string& service,
                                   const dds_topic_descriptor_t& request,
                                   const dds_topic_descriptor_t& response)
    : request_topic_(dds_create_topic(participant, &request, RequestTopicOf(service).c_str(),
                                      nullptr, nullptr),
                     "topic of requests of " + service),
      response_topic_(dds_create_topic(participant, &response, ("rr" + service + "Reply").c_str(),
                                       nullptr, nullptr),
                      "topic of replies of " + service) {
  const bool server = side == Side::kServer;
  const std::string id = UserData(side, request_topic_.handle());
  reader_ =
      Entity(dds_create_reader(participant, (server ? request_topic_ : response_topic_).handle(),
                               WithUserData(ReaderQos(ServiceQos()), id).get(), nullptr),
             "reader of " + service);
  writer_ =
      Entity(dds_create_writer(participant, (server ? response_topic_ : request_topic_).handle(),
                               WithUserData(WriterQos(ServiceQos()), id).get(), nullptr),
             "writer of " + service);
  if (server) return;
  wait_set_ = Entity(dds_create_waitset(participant), "a waitset");
  Attach(wait_set_.handle(), reader_.handle(),
         DDS_DATA_AVAILABLE_STATUS | DDS_SUBSCRIPTION_MATCHED_STATUS);
  Attach(wait_set_.handle(), writer_.handle(), DDS_PUBLICATION_MATCHED_STATUS);
}

bool ServiceEndpoints::matched() const {
  dds_publication_matched_status_t writer{};
  dds_subscription_matched_status_t reader{};
  return dds_get_publication_matched_status(writer_.handle(), &writer) == DDS_RETCODE_OK &&
         dds_get_subscription_matched_status(reader_.handle(), &reader) == DDS_RETCODE_OK &&
         writer.current_count > 0 && reader.current_count > 0;
}

std::uint64_t ServiceEndpoints::client_guid() const {
  dds_guid_t guid{};
  dds_get_guid(writer_.handle(), &guid);
  // Of both halves: the first is the same in one process, the second may be in two.
  std::uint64_t id = 0;
  for (std::size_t i = 0; i < sizeof(guid.v); ++i) id = id * 1099511628211ULL + guid.v[i];
  return id;
}

void ServiceEndpoints::Wait(std::chrono::steady_clock::time_point deadline) const {
  const auto left =
      std::chrono::ceil<std::chrono::nanoseconds>(deadline - std::chrono::steady_clock::now());
  (void)dds_waitset_wait(wait_set_.handle(), nullptr, 0, std::max<dds_duration_t>(0, left.count()));
}

}  // namespace palpate::dds
