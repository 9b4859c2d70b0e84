#include "server/guard.hpp"

#include <gtest/gtest.h>

namespace sinew::server {
namespace guard_test {

Refusal local(Caller caller) { return Guard("127.0.0.1", 8765).judge(caller); }

TEST(Guard, OwnNamesOfThisMachineAreLetIn) {
  for (const char* host : {"127.0.0.1:8765", "localhost:8765", "[::1]:8765"})
    EXPECT_EQ(local({host, "", "", ""}), Refusal::none) << host;
  EXPECT_EQ(local({"127.0.0.1:8765", "http://127.0.0.1:8765", "", ""}), Refusal::none);
}

TEST(Guard, AForeignNameOfThisAddressIsRefused) {  // of a site that lets its name point here
  for (const char* host : {"", "evil.example", "evil.example:8765", "127.0.0.1", "127.0.0.1:80",
                           "127.0.0.1:87650", "localhost.evil.example:8765", "localhost:8765 evil.example"})
    EXPECT_EQ(local({host, "", "", ""}), Refusal::foreign_host) << host;
}

TEST(Guard, PagesOfOtherSitesAreRefused) {
  for (const char* origin : {"http://evil.example", "null", "https://127.0.0.1:8765", "http://127.0.0.1:8766",
                             "http://localhost:8765", "http://127.0.0.1:8765.evil.example"})
    EXPECT_EQ(local({"127.0.0.1:8765", origin, "", ""}), Refusal::foreign_origin) << origin;
}

TEST(Guard, OtherMachinesNeedTheToken) {
  const Guard guard("0.0.0.0", 8765);
  const std::string token = guard.token(), cookie = "a=b; sinew_token=" + token + "; c=d",
                    bearer = "Bearer " + token;
  ASSERT_EQ(token.size(), 32U);
  EXPECT_NE(token, Guard("0.0.0.0", 8765).token());
  EXPECT_EQ(guard.judge({"lab:8765", "", cookie, ""}), Refusal::none);
  EXPECT_EQ(guard.judge({"lab:8765", "http://lab:8765", "", bearer}), Refusal::none);
  EXPECT_EQ(guard.judge({"lab:8765", "http://evil.example", cookie, ""}), Refusal::foreign_origin);
  for (const std::string& wrong :
       {std::string(), std::string("0"), token + "0", token.substr(1), ' ' + token})
    EXPECT_EQ(guard.judge({"lab:8765", "", "sinew_token=" + wrong, ""}), Refusal::no_token) << wrong;
  EXPECT_EQ(guard.judge({"lab:8765", "", "xsinew_token=" + token, ""}), Refusal::no_token);
  EXPECT_EQ(guard.judge({"127.0.0.1:8765", "", "", ""}), Refusal::no_token);
}

TEST(Guard, LoopbackIsThisMachineAlone) {
  for (const char* address : {"127.0.0.1", "127.1.2.3", "localhost", "::1"})
    EXPECT_TRUE(is_loopback(address));
  for (const char* address : {"0.0.0.0", "::", "192.168.1.2", "1127.0.0.1", ""})
    EXPECT_FALSE(is_loopback(address));
}

}  // namespace guard_test
}  // namespace sinew::server
