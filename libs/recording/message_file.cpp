// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/message_file.hpp"

#include <fstream>
#include <string_view>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/recording/reader.hpp"

namespace palpate::recording {

namespace {

class McapMessages : public FileMessages {
 public:
  explicit McapMessages(MessageStream stream) : stream_(std::move(stream)) {}
  const Message* Next() override { return stream_.Next(); }
  std::vector<std::string> Problems() const override { return stream_.problems(); }

 private:
  MessageStream stream_;
};

class McapFile : public MessageFile {
 public:
  explicit McapFile(const std::filesystem::path& file) : reader_(file) {}
  const std::filesystem::path& path() const override { return reader_.path(); }
  std::uint64_t size() const override { return reader_.size(); }
  std::string storage_id() const override { return "mcap"; }
  const Contents& contents() const override { return reader_.contents(); }
  std::unique_ptr<FileMessages> Messages(const MessageFilter& filter) const override {
    return std::make_unique<McapMessages>(reader_.Messages(filter));
  }
  std::vector<StoredMessage> NewestBefore(
      std::int64_t time_ns, const std::function<bool(const Channel&)>& wanted) const override {
    return reader_.NewestBefore(time_ns, wanted);
  }
  std::vector<Attachment> Attachments() const override {
    std::vector<Attachment> attachments;
    for (const AttachmentIndex& index : reader_.contents().attachments) {
      attachments.push_back(reader_.Read(index));
    }
    return attachments;
  }

 private:
  Reader reader_;
};

}  // namespace

bool IsSqlite(const std::filesystem::path& file) {
  constexpr std::string_view kBegin("SQLite format 3\0", 16);
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  std::string begin(kBegin.size(), ' ');
  std::ifstream stream(file, std::ios::binary);
  return stream.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == kBegin;
}

std::unique_ptr<MessageFile> OpenMessageFile(const std::filesystem::path& file) {
  if (IsSqlite(file)) return OpenSqliteFile(file);
  const std::string extension = file.extension().string();
  std::error_code error;
  if (extension == ".zstd" && std::filesystem::exists(file, error)) {
    throw InputError({file.string()},
                     "was compressed as a whole by rosbag2; unpack it with `unzstd --keep " +
                         file.string() + "` and give the result");
  }
  return std::make_unique<McapFile>(file);
}

}  // namespace palpate::recording
