/// @file crc32.h
/// CRC-32 as zlib, Ethernet and PNG have it: reflected 0x04C11DB7. Freestanding C++14, no includes, no heap.
#ifndef SINEW_KERNEL_CRC32_H
#define SINEW_KERNEL_CRC32_H

namespace sinew {
namespace kernel {

class Crc32 {
 public:
  constexpr void add(unsigned char byte) {
    // By halves of a byte: 16 entries serve, and a small controller shifts by 4 at once.
    constexpr __UINT32_TYPE__ table[16] = {
        0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac, 0x76dc4190, 0x6b6b51f4, 0x4db26158, 0x5005713c,
        0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c, 0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c};
    state_ ^= byte;
    state_ = (state_ >> 4) ^ table[state_ & 15];
    state_ = (state_ >> 4) ^ table[state_ & 15];
  }
  template <class Text>
  constexpr void add_text(const Text& text) {
    for (const char c : text) add(static_cast<unsigned char>(c));
  }
  constexpr __UINT32_TYPE__ value() const { return ~state_; }

 private:
  __UINT32_TYPE__ state_ = 0xffffffffu;
};

}  // namespace kernel
}  // namespace sinew

#endif
