/// Binary frames of any robot.
#include <gtest/gtest.h>

#include "server/device/wire/frames.hpp"

namespace sinew::server::device {
namespace device_frames_test {

TEST(DeviceFrames, EveryPayloadComesBackAndNoDamageDoes) {
  std::uint32_t random = 1;
  for (std::size_t size = 1; size < 300; ++size) {
    std::string payload;
    for (std::size_t i = 0; i < size; ++i) {
      random = random * 1'664'525 + 1'013'904'223;
      payload += (random >> 29U) == 0 ? '\n' : static_cast<char>(random >> 16U);
    }
    std::string line = encode('P', 65'546, 0x0A0B0C0D, payload);
    ASSERT_EQ(line.find('\n'), line.size() - 1) << size;
    line.pop_back();
    const auto bytes = decode(line);
    ASSERT_TRUE(bytes) << size;
    EXPECT_EQ(bytes->substr(9), payload);
    line[random % line.size()] ^= 4;
    EXPECT_FALSE(decode(line)) << size;
  }
}

TEST(DeviceFrames, AHelloOfWrongSizeIsNone) {
  std::string said("\3\5\3\1\20\15\20\10", 8);
  said += std::string(8, 'h') + std::string(4, 0) + 'p' + '\3' + std::string("\0\24", 2);
  const auto hello = read_hello(said);
  ASSERT_TRUE(hello);
  EXPECT_EQ(hello->drives(), 16u);
  EXPECT_TRUE(hello->has_tension && hello->needs_homing);
  EXPECT_EQ(hello->tension_limit, 20);
  EXPECT_FALSE(read_hello(said + "x"));
  EXPECT_FALSE(read_hello(said.substr(1)));
}

}  // namespace device_frames_test
}  // namespace sinew::server::device
