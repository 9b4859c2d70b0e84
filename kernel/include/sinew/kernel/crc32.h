/// @file crc32.h
/// CRC-32 as zlib, Ethernet and PNG have it: reflected 0x04C11DB7. Freestanding C++14, no includes, no heap.
#ifndef SINEW_KERNEL_CRC32_H
#define SINEW_KERNEL_CRC32_H

namespace sinew {
namespace kernel {

namespace detail {
/// What a byte does to the sum. The bytes of a row stand apart: an 8-bit controller then multiplies no index.
struct Crc32Rows {
  unsigned char byte[4][256];
};
constexpr Crc32Rows make_crc32_rows() {
  Crc32Rows rows{};
  for (unsigned i = 0; i < 256; ++i) {
    __UINT32_TYPE__ row = i;
    for (int bit = 0; bit < 8; ++bit) row = (row & 1) ? (row >> 1) ^ 0xedb88320u : row >> 1;
    for (int k = 0; k < 4; ++k) rows.byte[k][i] = static_cast<unsigned char>(row >> (8 * k) & 0xff);
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

/// The sum of bytes that come one by one.
class Crc32 {
 public:
  /// A byte at once, so that a small controller shifts nothing: 1 KiB for a third of the time that a table of
  /// 16 entries for each half of a byte takes.
  constexpr void add(unsigned char byte) {
    const auto& rows = detail::Crc32Table<>::rows.byte;
    const unsigned char i = static_cast<unsigned char>(state_[0] ^ byte);
    state_[0] = static_cast<unsigned char>(state_[1] ^ rows[0][i]);
    state_[1] = static_cast<unsigned char>(state_[2] ^ rows[1][i]);
    state_[2] = static_cast<unsigned char>(state_[3] ^ rows[2][i]);
    state_[3] = rows[3][i];
  }
  /// All bytes of a text.
  template <class Text>
  constexpr void add_text(const Text& text) {
    for (const char c : text) add(static_cast<unsigned char>(c));
  }
  /// The sum of all bytes so far.
  constexpr __UINT32_TYPE__ value() const {
    return ~(static_cast<__UINT32_TYPE__>(state_[0]) | static_cast<__UINT32_TYPE__>(state_[1]) << 8 |
             static_cast<__UINT32_TYPE__>(state_[2]) << 16 | static_cast<__UINT32_TYPE__>(state_[3]) << 24);
  }

 private:
  unsigned char state_[4] = {0xff, 0xff, 0xff, 0xff};  ///< the least significant first
};

}  // namespace kernel
}  // namespace sinew

#endif
