#include "server/guard.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <set>
#include <stdexcept>
#include <string>

#include "tests/scratch_folder.h"

namespace simbench::server {
namespace {

const std::string kToken = "0123456789abcdef0123456789abcdef";

RequestHead good() {
  return {.method = "GET",
          .target = "/0123456789abcdef0123456789abcdef/look?x=1",
          .host = "127.0.0.1:8080"};
}

unsigned status_of(const RequestHead& head) { return PageGuard(8080, kToken).judge(head).status; }

TEST(PageGuardTest, TheAddressIsAnsweredAndSplit) {
  const PageGuard guard(8080, kToken);
  EXPECT_EQ(guard.address(), "http://127.0.0.1:8080/" + kToken + "/");
  EXPECT_FALSE(guard.judge(good()));
  const Target target = guard.below_token(good().target);
  EXPECT_EQ(target.path, "look");
  EXPECT_EQ(target.query, "x=1");
  EXPECT_EQ(guard.below_token("/" + kToken + "/").path, "");
}

TEST(PageGuardTest, WhoLacksTheTokenIsRefused) {
  for (const std::string& target :
       {std::string("/"), std::string(""), std::string("*"), "/" + kToken,
        "/" + kToken.substr(1) + "/x", "/" + kToken.substr(0, 31) + "e/",
        std::string("/0123456789ABCDEF0123456789ABCDEF/"), "//" + kToken + "/",
        "http://127.0.0.1:8080/" + kToken + "/"}) {
    RequestHead head = good();
    head.target = target;
    EXPECT_EQ(status_of(head), 403u) << target;
  }
}

// A name that another page makes resolve to 127.0.0.1 comes as the Host.
TEST(PageGuardTest, AReboundNameIsRefused) {
  for (const char* const host :
       {"", "evil.example", "evil.example:8080", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:8081",
        "127.0.0.1:8080.evil.example", "127.0.0.2:8080", "0.0.0.0:8080", "[::1]:8080", "localhost",
        "LOCALHOST:8080"}) {
    RequestHead head = good();
    head.host = host;
    EXPECT_EQ(status_of(head), 421u) << host;
  }
  RequestHead head = good();
  head.host = "localhost:8080";
  EXPECT_EQ(status_of(head), 0u);
}

TEST(PageGuardTest, RequestsOfOtherPagesAreRefused) {
  for (const char* const origin :
       {"null", "http://evil.example", "https://127.0.0.1:8080", "http://127.0.0.1:8081",
        "http://127.0.0.1:8080.evil.example", "file://", "http://"}) {
    RequestHead head = good();
    head.origin = origin;
    EXPECT_EQ(status_of(head), 403u) << origin;
  }
  for (const char* const site : {"cross-site", "same-site", "anything"}) {
    RequestHead head = good();
    head.fetch_site = site;
    EXPECT_EQ(status_of(head), 403u) << site;
  }
  RequestHead own = good();
  own.origin = "http://127.0.0.1:8080";
  own.fetch_site = "same-origin";
  EXPECT_EQ(status_of(own), 0u);
  own.origin = "http://localhost:8080";
  own.fetch_site = "none";
  EXPECT_EQ(status_of(own), 0u);
}

TEST(PageGuardTest, OnlyWhatNoFormSendsIsPosted) {
  RequestHead head = good();
  head.method = "POST";
  for (const char* const type : {"", "text/plain", "application/x-www-form-urlencoded",
                                 "multipart/form-data", "application/jsonp", "Application/json"}) {
    head.content_type = type;
    EXPECT_EQ(status_of(head), 415u) << type;
  }
  for (const char* const type : {"application/json", "application/json; charset=utf-8"}) {
    head.content_type = type;
    EXPECT_EQ(status_of(head), 0u) << type;
  }
  for (const char* const method : {"PUT", "DELETE", "OPTIONS", "TRACE", "CONNECT", "PATCH", ""}) {
    head.method = method;
    EXPECT_EQ(status_of(head), 405u) << method;
  }
}

TEST(PageGuardTest, AFileKeepsAToken) {
  const ScratchFolder folder;
  const std::string path = folder / "token";
  const std::string token = token_in(path);
  EXPECT_EQ(token.size(), 32u);
  EXPECT_EQ(token_in(path), token);
  chmod(path.c_str(), 0644);
  EXPECT_THROW(token_in(path), std::runtime_error);
  chmod(path.c_str(), 0600);
  put(path, "short");
  EXPECT_THROW(token_in(path), std::runtime_error);
  EXPECT_THROW(token_in(folder / "none/token"), std::runtime_error);
}

TEST(PageGuardTest, TokensAreNeverTheSame) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) tokens.insert(new_token());
  EXPECT_EQ(tokens.size(), 100u);
  EXPECT_EQ(tokens.begin()->size(), 32u);
}

}  // namespace
}  // namespace simbench::server
