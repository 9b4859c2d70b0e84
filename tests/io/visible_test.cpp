#include "io/document/visible.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace visible_test {

using sinew::visible, sinew::visible_line;

TEST(Visible, WhatSteersATerminalIsSpelledOut) {
  EXPECT_EQ(visible("\x1b[31m\x07\x7f\r"), "\\u001b[31m\\u0007\\u007f\\u000d");
  EXPECT_EQ(visible("\xc2\x9b"
                    "31m\xe2\x80\xae\xe2\x81\xa6\xe2\x80\xa8"),
            "\\u009b31m\\u202e\\u2066\\u2028");
  EXPECT_EQ(visible(std::string_view("a\0b", 3)), "a\\u0000b");
}

TEST(Visible, OtherTextStaysAsItIs) {
  for (const char* text : {"", "κ₁ [1/m]", "naïve ‖U‖", "🙂", "line\n\ttab", "\\u001b"})
    EXPECT_EQ(visible(text), text);
}

/// Texts are looked at in stretches: what is to be spelled out may stand anywhere in one.
TEST(Visible, WhateverItStandsBetween) {
  const std::pair<std::string, std::string> each[] = {
      {"\x1f", "\\u001f"}, {" ", " "},   {"~", "~"}, {"\x7f", "\\u007f"},        {"\x80", "\\x80"},
      {"\xff", "\\xff"},   {"\n", "\n"}, {"κ", "κ"}, {"\xe2\x80\xae", "\\u202e"}};
  for (const auto& [text, spelled] : each)
    for (const auto& [other, spelled_other] : each)
      for (std::size_t before = 0; before < 18; ++before)
        for (const std::size_t after : {0U, 1U, 7U, 8U, 9U}) {
          const std::string left(before, 'a'), right(after, '!');
          EXPECT_EQ(visible(left + text + right + other), left + spelled + right + spelled_other);
        }
}

TEST(Visible, ALineStaysOne) { EXPECT_EQ(visible_line("a\nb\tc"), "a\\nb\\tc"); }

TEST(Visible, BytesThatAreNoTextAreNumbers) {
  EXPECT_EQ(visible("\xff\xc2"), "\\xff\\xc2");
  EXPECT_EQ(visible("\xe2\x80"), "\\xe2\\x80");
  EXPECT_EQ(visible("\xc0\xaf"), "\\xc0\\xaf");  // overlong
}

}  // namespace visible_test
