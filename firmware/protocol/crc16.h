/// @file crc16.h
/// CRC-16 as CCITT-FALSE has it: 0x1021, most significant bit first, begun with 0xFFFF. It guards what goes
/// over SPI: any three wrong bits, and any burst of 16, are found. Freestanding C++14, no heap.
#ifndef SINEW_FIRMWARE_CRC16_H
#define SINEW_FIRMWARE_CRC16_H

#include "protocol/number.h"

namespace sinew {
namespace firmware {

namespace detail {
/// The halves of a row apart: an AVR then multiplies no index.
struct Crc16Rows {
  Uint8 high[256], low[256];
};
constexpr Crc16Rows make_crc16_rows() {
  Crc16Rows rows{};
  for (Uint16 i = 0; i < 256; ++i) {
    Uint16 row = static_cast<Uint16>(i << 8);
    for (Uint8 bit = 0; bit < 8; ++bit)
      row = static_cast<Uint16>(row & 0x8000 ? static_cast<Uint16>(row << 1) ^ 0x1021 : row << 1);
    rows.high[i] = static_cast<Uint8>(row >> 8);
    rows.low[i] = static_cast<Uint8>(row & 0xFF);
  }
  return rows;
}
template <class = void>
struct Crc16Table {
  static constexpr Crc16Rows rows = make_crc16_rows();
};
template <class T>
constexpr Crc16Rows Crc16Table<T>::rows;
}  // namespace detail

class Crc16 {
 public:
  constexpr void add(Uint8 byte) {
    const Uint8 index = static_cast<Uint8>(high_ ^ byte);
    high_ = static_cast<Uint8>(low_ ^ detail::Crc16Table<>::rows.high[index]);
    low_ = detail::Crc16Table<>::rows.low[index];
  }
  constexpr Uint8 high() const { return high_; }
  constexpr Uint8 low() const { return low_; }

 private:
  Uint8 high_ = 0xFF, low_ = 0xFF;
};

}  // namespace firmware
}  // namespace sinew

#endif
