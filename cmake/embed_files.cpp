// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// Writes the files of a folder, compressed as gzip, as a C++ source: a build tool.
//
// usage: embed_files FOLDER OUT.cpp
#include <zlib.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

namespace {

[[noreturn]] void Fail(const std::string& message) {
  std::cerr << "embed_files: " << message << '\n';
  std::exit(1);
}

/// The same bytes in every build: no time, no name.
std::string Gzip(const std::string& bytes) {
  constexpr int kGzipWindow = 15 + 16;
  constexpr int kMemory = 9;
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzipWindow, kMemory,
                   Z_DEFAULT_STRATEGY) != Z_OK) {
    Fail("zlib does not start");
  }
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  std::string in = bytes;
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  if (deflate(&stream, Z_FINISH) != Z_STREAM_END) Fail("zlib does not end");
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

std::string ReadWhole(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  if (!in) Fail("cannot read " + file.string());
  return bytes;
}

void WriteArray(const std::string& bytes, std::size_t number, std::ostream& out) {
  constexpr std::size_t kPerLine = 32;
  out << "constexpr unsigned char kFile" << number << "[] = {";
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    out << (i % kPerLine == 0 ? "\n" : "")
        << static_cast<unsigned>(static_cast<unsigned char>(bytes[i])) << ',';
  }
  out << "};\n";
}

}  // namespace

int main(int argc, char** argv) {
  namespace fs = std::filesystem;
  if (argc != 3) Fail("usage: embed_files FOLDER OUT.cpp");
  const fs::path folder = argv[1];
  std::vector<std::string> paths;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) paths.push_back(fs::relative(entry, folder).generic_string());
  }
  std::sort(paths.begin(), paths.end());
  if (paths.empty()) Fail("no files in " + folder.string());
  std::ofstream out(argv[2]);
  out << "// Made by cmake/embed_files.cpp.\n#include <array>\n#include <span>\n"
         "#include <string_view>\n\n"
         "#include \"components/view/serve/page_files.hpp\"\n\nnamespace {\n";
  for (std::size_t i = 0; i < paths.size(); ++i)
    WriteArray(Gzip(ReadWhole(folder / paths[i])), i, out);
  out << "}  // namespace\n\nnamespace palpate::view {\n"
         "std::span<const PageFile> BuiltInPageFiles();\n"
         "std::span<const PageFile> BuiltInPageFiles() {\n"
         "  static const std::array<PageFile, "
      << paths.size() << "> files{{\n";
  for (std::size_t i = 0; i < paths.size(); ++i) {
    out << "      {\"/" << paths[i] << "\", {reinterpret_cast<const char*>(kFile" << i
        << "), sizeof(kFile" << i << ")}},\n";
  }
  out << "  }};\n  return files;\n}\n}  // namespace palpate::view\n";
  out.flush();
  if (!out) Fail(std::string("cannot write ") + argv[2]);
}
