// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cstring>
#include <map>
#include <optional>
#include <vector>

#include "components/palpate/recordings/topic_export.hpp"
#include "libs/core/file.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"
#include "libs/fem/mesh_io/write_vtu.hpp"
#include "libs/recording/ros2msg/flatten.hpp"

namespace palpate::command {

namespace {

constexpr const char* kMeshType = "palpate_msgs/msg/Mesh";

template <typename Number>
std::vector<Number> Numbers(recording::CdrReader* reader) {
  const std::string_view bytes = reader->Array(reader->Length(), sizeof(Number));
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

/// nullopt where it is no mesh of tetrahedra.
std::optional<fem::TetMesh> ReadMesh(std::string_view cdr, const offline::MessageType& type,
                                     std::string* hash) {
  recording::CdrReader reader = AtField(cdr, type.name, "mesh_hash", type.definitions);
  *hash = reader.String();
  reader.String();  // element
  const auto nodes_per_cell = static_cast<Eigen::Index>(reader.Bits(1));
  const std::vector<double> nodes_m = Numbers<double>(&reader);
  const std::vector<std::uint32_t> cells = Numbers<std::uint32_t>(&reader);
  const auto node_count = static_cast<Eigen::Index>(nodes_m.size()) / 3;
  const bool whole = reader.ok() && !reader.swaps_bytes() && nodes_m.size() % 3 == 0 &&
                     (nodes_per_cell == 4 || nodes_per_cell == 10) &&
                     cells.size() % static_cast<std::size_t>(nodes_per_cell) == 0;
  if (!whole) return std::nullopt;
  fem::TetMesh mesh;
  mesh.nodes_m = Eigen::Map<const Eigen::Matrix3Xd>(nodes_m.data(), 3, node_count);
  mesh.cells.resize(nodes_per_cell, static_cast<Eigen::Index>(cells.size()) / nodes_per_cell);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i] >= static_cast<std::uint32_t>(node_count)) return std::nullopt;
    mesh.cells.data()[i] = static_cast<int>(cells[i]);
  }
  return mesh;
}

class MeshExport : public TopicExport {
 public:
  MeshExport(offline::MessageType type, std::filesystem::path folder,
             const recording::RecordedMessages& reader, std::int64_t start_ns)
      : type_(std::move(type)), folder_(std::move(folder)), start_ns_(start_ns) {
    recording::MessageFilter filter;
    filter.wanted = [&](const recording::Channel& channel) {
      return reader.SchemaOf(channel).name == kMeshType;
    };
    recording::RecordedStream stream = reader.Messages(filter);
    while (const recording::Message* message = stream.Next()) {
      const auto& schema = reader.SchemaOf(reader.contents().channels.at(message->channel_id));
      const offline::MessageType mesh_type{kMeshType,
                                           recording::ParseRos2msg(kMeshType, schema.data)};
      std::string hash;
      if (auto mesh = ReadMesh(message->data, mesh_type, &hash)) meshes_[hash] = std::move(*mesh);
    }
  }

  std::string Take(const recording::Message& message) override {
    recording::CdrReader reader = AtField(message.data, type_.name, "mesh_hash", type_.definitions);
    const std::string hash(reader.String());
    reader.String();  // status
    const std::vector<float> positions_m = Numbers<float>(&reader);
    const auto mesh = meshes_.find(hash);
    if (mesh == meshes_.end()) return "its mesh (" + hash + ") was not recorded";
    const Eigen::VectorXd rest_m = mesh->second.nodes_m.reshaped();
    if (!reader.ok() || static_cast<Eigen::Index>(positions_m.size()) != rest_m.size()) {
      return "has not the nodes of its mesh";
    }
    const Eigen::VectorXd displacement_m =
        Eigen::Map<const Eigen::VectorXf>(positions_m.data(), rest_m.size()).cast<double>() -
        rest_m;
    std::filesystem::create_directories(folder_);
    const std::string name = std::to_string(offline::StampOf(message, type_)) + ".vtu";
    const fem::VtuField field{"displacement_m", displacement_m.reshaped(3, rest_m.size() / 3)};
    fem::WriteVtu(folder_ / name, mesh->second, rest_m, {{field}, {}});
    steps_ += "<DataSet timestep=\"" + FormatNumber(NsToSeconds(message.log_time_ns - start_ns_)) +
              "\" part=\"0\" file=\"" + name + "\"/>\n";
    return {};
  }

  void Finish() override {
    if (steps_.empty()) return;
    WriteFile(folder_ / "body.pvd",
              "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n"
              "<Collection>\n" +
                  steps_ + "</Collection>\n</VTKFile>\n");
  }

 private:
  offline::MessageType type_;
  std::filesystem::path folder_;
  std::int64_t start_ns_;
  std::map<std::string, fem::TetMesh> meshes_;
  std::string steps_;
};

}  // namespace

std::unique_ptr<TopicExport> MakeMeshExport(offline::MessageType type, std::filesystem::path folder,
                                            const recording::RecordedMessages& reader,
                                            std::int64_t start_ns) {
  return std::make_unique<MeshExport>(std::move(type), std::move(folder), reader, start_ns);
}

}  // namespace palpate::command
