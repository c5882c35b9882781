// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "idl/message_traits.hpp"
#include "libs/dds/entity.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/reader.hpp"

namespace palpate::dds {

/// The two endpoints of a server or client of a ROS 2 service, as rmw_cyclonedds makes them: topics
/// "rq/<node>/<name>Request" and "rr/<node>/<name>Reply", reliable, volatile.
class ServiceEndpoints {
 public:
  enum class Side { kServer, kClient };

  /// `service`: its ROS name, "/node/get_parameters". Throws RunError where DDS refuses.
  ServiceEndpoints(Side side, dds_entity_t participant, const std::string& service,
                   const dds_topic_descriptor_t& request, const dds_topic_descriptor_t& response);

  dds_entity_t reader() const { return reader_.handle(); }
  dds_entity_t writer() const { return writer_.handle(); }
  /// Whether there is a partner for both.
  bool matched() const;
  /// A number that only requests of this client have.
  std::uint64_t client_guid() const;

  /// Waits until a message or a partner has come, at most until `deadline`.
  void Wait(std::chrono::steady_clock::time_point deadline) const;

 private:
  Entity request_topic_;
  Entity response_topic_;
  Entity reader_;
  Entity writer_;
  Entity wait_set_;
};

/// The topic on which ROS 2 sends requests of a service.
std::string RequestTopicOf(const std::string& service);

/// Answers the requests of one service. `Service`: a type of idl/*/srv.
template <typename Service>
class ServiceServer {
 public:
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  /// Fills the response, whose header is filled already.
  using Answer = std::function<void(const Request&, Response*)>;

  /// Throws RunError where DDS refuses.
  ServiceServer(dds_entity_t participant, const std::string& service, Answer answer)
      : endpoints_(ServiceEndpoints::Side::kServer, participant, service,
                   idl::MessageTraits<Request>::Descriptor(),
                   idl::MessageTraits<Response>::Descriptor()),
        answer_(std::move(answer)) {}

  const ServiceEndpoints& endpoints() const { return endpoints_; }

  /// Answers the requests that wait.
  void Serve() {
    for (const Request& request : Samples<Request>(endpoints_.reader())) {
      Message<Response> response;
      response->client_guid = request.client_guid;
      response->sequence_number = request.sequence_number;
      answer_(request, &*response);
      // A client that gets no answer asks again or says so.
      (void)dds_write(endpoints_.writer(), &*response);
    }
  }

 private:
  ServiceEndpoints endpoints_;
  Answer answer_;
};

/// Asks a service whose requests may be repeated: the first ones are lost where the server has not
/// yet found this client.
template <typename Service>
class ServiceClient {
 public:
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  using Clock = std::chrono::steady_clock;

  /// Throws RunError where DDS refuses.
  ServiceClient(dds_entity_t participant, const std::string& service)
      : endpoints_(ServiceEndpoints::Side::kClient, participant, service,
                   idl::MessageTraits<Request>::Descriptor(),
                   idl::MessageTraits<Response>::Descriptor()) {}

  /// Gives the answer to `take`; false where none has come at `deadline`.
  [[nodiscard]] bool Call(Message<Request>* request,
                          const std::function<void(const Response&)>& take,
                          Clock::time_point deadline) {
    constexpr auto kRepeat = std::chrono::milliseconds(200);
    (*request)->client_guid = endpoints_.client_guid();
    (*request)->sequence_number = ++sequence_number_;
    Clock::time_point repeat = Clock::now();
    for (;;) {
      for (const Response& response : Samples<Response>(endpoints_.reader())) {
        if (response.client_guid != (*request)->client_guid ||
            response.sequence_number != sequence_number_) {
          continue;
        }
        take(response);
        return true;
      }
      const Clock::time_point now = Clock::now();
      if (now >= deadline) return false;
      if (now >= repeat && endpoints_.matched()) {
        (void)dds_write(endpoints_.writer(), &**request);
        repeat = now + kRepeat;
      }
      endpoints_.Wait(std::min(deadline, std::max(repeat, now + std::chrono::milliseconds(10))));
    }
  }

 private:
  ServiceEndpoints endpoints_;
  std::int64_t sequence_number_ = 0;
};

}  // namespace palpate::dds
