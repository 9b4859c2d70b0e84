/// @file target.h
/// What a target supplies, and text made of it.
#ifndef SINEW_FIRMWARE_TARGET_H
#define SINEW_FIRMWARE_TARGET_H

// Of host.cpp, avr.cpp or arm.cpp.
void start();
void put(char c);
void finish();

using Int16 = __INT16_TYPE__;
using Uint16 = __UINT16_TYPE__;
using Int32 = __INT32_TYPE__;
using Uint32 = __UINT32_TYPE__;

inline void put_text(const char* text) {
  while (*text) put(*text++);
}
inline void put_number(Uint32 value) {
  char digits[10];
  unsigned char count = 0;
  do digits[count++] = static_cast<char>('0' + value % 10);
  while (value /= 10);
  while (count > 0) put(digits[--count]);
}
inline void put_hex(Uint32 value) {
  for (int shift = 28; shift >= 0; shift -= 4) put("0123456789abcdef"[(value >> shift) & 15]);
}

#endif
