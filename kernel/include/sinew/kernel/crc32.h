/// @file crc32.h
/// CRC-32 as zlib, Ethernet and PNG have it: reflected 0x04C11DB7. Freestanding C++14, no includes, no heap.
#ifndef SINEW_KERNEL_CRC32_H
#define SINEW_KERNEL_CRC32_H

namespace sinew {
namespace kernel {

namespace detail {
/// What a byte does to the sum is what its halves do, added: 16 entries for each.
struct Crc32Rows {
  __UINT32_TYPE__ low[16], high[16];
};
constexpr __UINT32_TYPE__ crc32_row(unsigned byte) {
  __UINT32_TYPE__ row = byte;
  for (int bit = 0; bit < 8; ++bit) row = (row & 1) ? (row >> 1) ^ 0xedb88320u : row >> 1;
  return row;
}
constexpr Crc32Rows make_crc32_rows() {
  Crc32Rows rows{};
  for (unsigned i = 0; i < 16; ++i) {
    rows.low[i] = crc32_row(i);
    rows.high[i] = crc32_row(i << 4);
  }
  return rows;
}

/// In memory once: of a table within the function, avr-g++ makes a copy on the stack for each byte. A
/// template, so that all translation units share it.
template <class = void>
struct Crc32Table {
  static constexpr Crc32Rows rows = make_crc32_rows();
};
template <class T>
constexpr Crc32Rows Crc32Table<T>::rows;
}  // namespace detail

class Crc32 {
 public:
  constexpr void add(unsigned char byte) {
    // A byte at once, so that a small controller shifts nothing.
    using Table = detail::Crc32Table<>;
    const unsigned char index = static_cast<unsigned char>(byte ^ (state_ & 0xff));
    state_ = (state_ >> 8) ^ Table::rows.low[index & 15] ^ Table::rows.high[index >> 4];
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
