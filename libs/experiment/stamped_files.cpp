// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/stamped_files.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

#include "libs/core/text.hpp"
#include "libs/experiment/folders.hpp"

namespace palpate::experiment {

namespace {

namespace fs = std::filesystem;

/// No depth camera takes 1000 frames a second: names nearer to each other are no nanoseconds.
/// Microseconds are that near from 1 frame a second on.
constexpr std::int64_t kShortestStep_ns = 1'000'000;
constexpr std::int64_t kLargestExponent = 18;
constexpr std::size_t kMostDigits_ns = 19;  // what an int64 holds; the parser refuses the rest

bool AllDigits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(),
                                      [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool ParseWhole(std::string_view text, std::int64_t* value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *value);
  return error == std::errc() && end == text.data() + text.size();
}

std::string LowerCaseExtension(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::int64_t TimeOfFrame_ns(const fs::path& file, double frame_rate_Hz) {
  const std::string stem = file.stem().string();
  const std::size_t last = stem.find_last_not_of("0123456789");
  std::int64_t number = 0;
  if (!ParseWhole(std::string_view(stem).substr(last == std::string::npos ? 0 : last + 1),
                  &number)) {
    throw InputError(SourceLocation{file.string()},
                     "the name must end in the number of the frame, as recording.yaml gives "
                     "frame_rate_Hz");
  }
  return std::llround(static_cast<double>(number) / frame_rate_Hz * 1e9);
}

StampedFile Stamp(const fs::path& file, const FrameNames& names) {
  StampedFile stamped{.t_ns = 0, .file = file};
  if (names.frame_rate_Hz) {
    stamped.t_ns = TimeOfFrame_ns(file, *names.frame_rate_Hz);
    return stamped;
  }
  const std::string stem = file.stem().string();
  const bool is_time = stem.find('.') != std::string::npos ? ParseSeconds_ns(stem, &stamped.t_ns)
                                                           : ParseWhole(stem, &stamped.t_ns);
  if (!is_time) {
    throw InputError(SourceLocation{file.string()},
                     "the name must be the time, in nanoseconds (1712000000.png) or in seconds "
                     "with a point (1.712.png); of numbered frames give frame_rate_Hz in "
                     "recording.yaml");
  }
  return stamped;
}

// What names too near to each other for nanoseconds count, and the remedy. Times since 1970 show
// their unit by their size.
std::string LikelyMeaning(std::int64_t name) {
  constexpr std::int64_t kFirst_s = 1'000'000'000, kLast_s = 3'000'000'000;  // the years 2001, 2065
  const auto is_time = [&](std::int64_t per_s) {
    return name >= kFirst_s * per_s && name < kLast_s * per_s;
  };
  const std::string key = ": give their rate in recording.yaml (frame_rate_Hz: ";
  if (is_time(1)) return "seconds since 1970" + key + "1)";
  if (is_time(1000)) return "milliseconds since 1970" + key + "1000)";
  if (is_time(1'000'000)) return "microseconds since 1970" + key + "1000000)";
  return "numbers of frames" + key + "30)";
}

// Numbers of frames, as 0001 and 0002, would pass for nanoseconds.
void RefuseFrameNumbers(const std::vector<StampedFile>& files) {
  const auto is_whole = [](const StampedFile& file) {
    return AllDigits(file.file.stem().string());
  };
  if (files.empty() || !std::all_of(files.begin(), files.end(), is_whole)) return;
  const std::string first = files.front().file.filename().string();
  const std::int64_t span_ns = files.back().t_ns - files.front().t_ns;
  const auto steps = static_cast<std::int64_t>(files.size()) - 1;
  const bool too_near = steps > 0 && span_ns / steps < kShortestStep_ns;
  const bool padded = first.starts_with('0') && files.front().file.stem().string().size() > 1;
  const bool one_small =
      files.size() == 1 && files[0].t_ns > 0 && (padded || files[0].t_ns < kShortestStep_ns);
  if (!too_near && !one_small) return;
  throw InputError(SourceLocation{files.front().file.parent_path().string()},
                   "names are times in nanoseconds, and " + first +
                       (steps > 0 ? " to " + files.back().file.filename().string() : "") +
                       " look like " + LikelyMeaning(files.front().t_ns) +
                       ", or rename them to their times (1712000000.png, or 1.712.png in seconds)");
}

}  // namespace

bool ParseSeconds_ns(std::string_view text, std::int64_t* t_ns) {
  const std::size_t e = text.find_first_of("eE");
  std::int64_t exponent = 0;
  if (e != std::string_view::npos) {
    std::string_view power = text.substr(e + 1);
    if (power.starts_with('+')) power.remove_prefix(1);
    if (!ParseWhole(power, &exponent) || std::abs(exponent) > kLargestExponent) return false;
    text = text.substr(0, e);
  }
  const std::size_t dot = text.find('.');
  std::string digits(text.substr(0, dot));
  std::int64_t whole = static_cast<std::int64_t>(digits.size()) + exponent + 9;
  if (dot != std::string_view::npos) digits += text.substr(dot + 1);
  if (!AllDigits(digits)) return false;
  // `whole` digits are nanoseconds, the next one rounds them.
  if (whole < 0) {
    digits.insert(0, static_cast<std::size_t>(-whole), '0');
    whole = 0;
  }
  const auto count = static_cast<std::size_t>(whole);
  if (digits.size() < count + 1) digits.resize(count + 1, '0');
  const std::size_t leading = std::min(digits.find_first_not_of('0'), count);
  if (count - leading > kMostDigits_ns) return false;
  *t_ns = 0;
  if (count > leading && !ParseWhole(digits.substr(leading, count - leading), t_ns)) return false;
  if (digits[count] >= '5' && *t_ns < std::numeric_limits<std::int64_t>::max()) ++*t_ns;
  return true;
}

std::vector<StampedFile> ListStampedFiles(const fs::path& folder, const FrameNames& names) {
  std::vector<StampedFile> files;
  if (!fs::is_directory(folder)) return files;
  for (const fs::path& file : EntriesOf(folder)) {
    const bool known = std::find(names.extensions.begin(), names.extensions.end(),
                                 LowerCaseExtension(file)) != names.extensions.end();
    if (known) {
      files.push_back(Stamp(file, names));
    } else if (!names.skip_others) {
      throw InputError(SourceLocation{file.string()},
                       "must end in " + Listed(names.extensions) + ", with its time as its name");
    }
  }
  std::sort(files.begin(), files.end(),
            [](const StampedFile& a, const StampedFile& b) { return a.t_ns < b.t_ns; });
  for (std::size_t i = 1; i < files.size(); ++i) {
    if (files[i].t_ns == files[i - 1].t_ns) {
      throw InputError(SourceLocation{files[i].file.string()},
                       "has the same time as " + files[i - 1].file.filename().string());
    }
  }
  if (!names.frame_rate_Hz) RefuseFrameNumbers(files);
  return files;
}

}  // namespace palpate::experiment
