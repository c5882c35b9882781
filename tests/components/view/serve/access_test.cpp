// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/serve/access.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <string>

#include "components/view/access_settings.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"

namespace palpate::view {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kToken = "0123456789abcdef-_";

AccessRules Rules(const std::string& token = {}) {
  AccessRules rules;
  rules.token = token;
  rules.cookie_name = "palpate_view_8750";
  rules.hosts = {"127.0.0.1", "localhost", "::1"};
  return rules;
}

int StatusOf(const AccessRules& rules, const RequestFacts& request) {
  return Judge(rules, request).status;
}

TEST(Access, TakesThisMachineByItsNamesOnly) {
  for (const char* host : {"127.0.0.1:8750", "localhost:8750", "LOCALHOST", "[::1]:8750"}) {
    EXPECT_EQ(StatusOf(Rules(), {.target = "/", .host = host}), 200) << host;
  }
  // DNS of a foreign name may point to this machine.
  for (const char* host : {"", "evil.example:8750", "localhost.evil.example",
                           "127.0.0.1.evil.example", "10.0.0.7:8750", "[::1", ":8750"}) {
    EXPECT_EQ(StatusOf(Rules(), {.target = "/", .host = host}), 421) << host;
  }
}

TEST(Access, TakesAnyAddressButNoNameWhereItListensOnAll) {
  AccessRules rules = Rules(kToken);
  rules.any_literal_host = true;
  const std::string target = "/?token=" + kToken;
  EXPECT_EQ(StatusOf(rules, {.target = target, .host = "10.0.0.7:8750"}), 200);
  EXPECT_EQ(StatusOf(rules, {.target = target, .host = "robot.example:8750"}), 421);
}

TEST(Access, TakesPagesOfItsOwnPortOnly) {
  RequestFacts request{.target = "/live", .host = "localhost:8750"};
  for (const char* origin : {"", "http://localhost:8750", "HTTP://localhost:8750"}) {
    request.origin = origin;
    // Browsers write the scheme in lower case.
    EXPECT_EQ(StatusOf(Rules(), request), origin[0] == 'H' ? 403 : 200) << origin;
  }
  for (const char* origin : {"http://evil.example", "null", "http://localhost:8751",
                             "http://localhost", "file://", "http://localhost:8750.evil.example"}) {
    request.origin = origin;
    EXPECT_EQ(StatusOf(Rules(), request), 403) << origin;
  }
}

TEST(Access, LetsListedPagesAndThoseOfThisMachineToFoxglove) {
  const AccessRules rules = [] {
    AccessRules made = FoxgloveRules({}, {}, "");
    made.hosts = {"localhost"};
    return made;
  }();
  RequestFacts request{.target = "/", .host = "localhost:8765"};
  for (const char* origin : {"", "http://localhost:8080", "http://127.0.0.1", "http://[::1]:80",
                             "https://app.foxglove.dev", "file://"}) {
    request.origin = origin;
    EXPECT_EQ(StatusOf(rules, request), 200) << origin;
  }
  for (const char* origin :
       {"https://evil.example", "null", "https://app.foxglove.dev.evil.example",
        "http://localhost.evil.example"}) {
    request.origin = origin;
    EXPECT_EQ(StatusOf(rules, request), 403) << origin;
  }
}

TEST(Access, AsksForTheTokenInOneOfThreePlaces) {
  const AccessRules rules = Rules(kToken);
  const std::string target = "/live?a=1&token=" + kToken;
  const std::string cookie = "other=1; palpate_view_8750=" + kToken;
  const std::string header = "Bearer " + kToken;
  const std::string host = "localhost";
  const Verdict by_query = Judge(rules, {.target = target, .host = host});
  EXPECT_TRUE(by_query.granted() && by_query.by_query);
  const Verdict by_cookie = Judge(rules, {.target = "/", .host = host, .cookie = cookie});
  EXPECT_TRUE(by_cookie.granted() && !by_cookie.by_query);
  EXPECT_EQ(StatusOf(rules, {.target = "/", .host = host, .authorization = header}), 200);

  const std::string longer = header + "x";
  const std::string shorter = header.substr(0, header.size() - 1);
  EXPECT_EQ(StatusOf(rules, {.target = "/", .host = host}), 401);
  EXPECT_EQ(StatusOf(rules, {.target = "/?token=", .host = host}), 401);
  EXPECT_EQ(StatusOf(rules, {.target = "/", .host = host, .authorization = longer}), 401);
  EXPECT_EQ(StatusOf(rules, {.target = "/", .host = host, .authorization = shorter}), 401);
  EXPECT_EQ(StatusOf(rules, {.target = "/", .host = host, .cookie = "token=" + kToken}), 401);
}

TEST(Access, ComparesWholeTexts) {
  EXPECT_TRUE(EqualInConstantTime("abc", "abc"));
  EXPECT_TRUE(EqualInConstantTime("", ""));
  for (const char* other : {"", "ab", "abcd", "abd", "abcabc"}) {
    EXPECT_FALSE(EqualInConstantTime(other, "abc")) << other;
  }
  EXPECT_FALSE(EqualInConstantTime("abc", ""));
}

class Settings : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file_); }

  std::filesystem::path TokenFile(const std::string& text) {
    WriteFile(file_, text);
    return file_;
  }
  std::string Refusal(const HttpConfig& config, const std::string& environment = {}) {
    try {
      TokenOf(config, environment);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }

  std::filesystem::path file_ =
      std::filesystem::path(testing::TempDir()) / "palpate_view_access_token";
  HttpConfig config_;
};

TEST_F(Settings, NeedNoTokenOnThisMachine) {
  EXPECT_EQ(TokenOf(config_, ""), "");
  config_.address = "127.3.2.1";
  EXPECT_EQ(TokenOf(config_, ""), "");
  config_.address = "::1";
  EXPECT_EQ(TokenOf(config_, ""), "");
}

TEST_F(Settings, RefuseTheNetworkWithoutAToken) {
  for (const char* address : {"0.0.0.0", "::", "192.168.1.2", "128.0.0.1"}) {
    config_.address = address;
    EXPECT_THAT(Refusal(config_), HasSubstr("set http.token_file")) << address;
    EXPECT_EQ(TokenOf(config_, kToken), kToken);
  }
}

TEST_F(Settings, RefuseTokensThatAreShortOrNoWords) {
  for (const std::string token : {"short", "with space 012345", "slash/0123456789"}) {
    EXPECT_THAT(Refusal(config_, token), HasSubstr(kTokenVariable)) << token;
    EXPECT_THAT(Refusal(config_, token), Not(HasSubstr(token)));
    config_.token_file = TokenFile(token + "\n");
    EXPECT_THAT(Refusal(config_), HasSubstr("http.token_file"));
    config_.token_file.clear();
  }
}

TEST_F(Settings, TakeTheFirstLineOfTheFile) {
  config_.token_file = TokenFile(kToken + "\r\nsecond line\n");
  EXPECT_EQ(TokenOf(config_, "another-token-0123456"), kToken);
  config_.token_file = "/no/such/file";
  EXPECT_THAT(Refusal(config_), HasSubstr("/no/such/file"));
}

TEST_F(Settings, RefuseAnAddressThatIsAName) {
  config_.address = "localhost";
  EXPECT_THAT(Refusal(config_), HasSubstr("127.0.0.1"));
}

}  // namespace
}  // namespace palpate::view
