/* Text between UTF-8 and the host's characters. */
#include "text.h"

#include <stdint.h>
#include <string.h>

/* Length of the sequence that begins with this byte; 1 for what is no UTF-8. */
static size_t sequence_length(unsigned char first) {
  return first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : first >= 0xC0 ? 2 : 1;
}

static uint32_t code_point(const unsigned char* at, size_t length) {
  uint32_t code = length == 1 ? at[0] : at[0] & (0xFFu >> (length + 1));
  for (size_t k = 1; k < length; ++k) code = code << 6 | (at[k] & 0x3Fu);
  return code;
}

/* Characters of the host; `to` may be NULL, to count them. */
static size_t from_utf8(const char* utf8, size_t size, mxChar* to) {
  size_t count = 0;
  const unsigned char* at = (const unsigned char*)utf8;
  for (size_t k = 0; k < size;) {
    size_t length = sequence_length(at[k]);
    if (length > size - k) length = 1;
    const uint32_t code = code_point(at + k, length);
    if (code >= 0x10000) {
      if (to) to[count] = (mxChar)(0xD800 + ((code - 0x10000) >> 10));
      ++count;
    }
    if (to) to[count] = (mxChar)(code >= 0x10000 ? 0xDC00 + (code & 0x3FF) : code);
    ++count;
    k += length;
  }
  return count;
}

mxArray* text_to_array(const char* utf8, size_t size) {
  if (sizeof(mxChar) == 1) {
    const mwSize bytes[2] = {size > 0, size}; /* '' is 0 x 0 */
    mxArray* array = mxCreateCharArray(2, bytes);
    if (size > 0) memcpy(mxGetChars(array), utf8, size);
    return array;
  }
  const size_t count = from_utf8(utf8, size, NULL);
  const mwSize dimensions[2] = {count > 0, count};
  mxArray* array = mxCreateCharArray(2, dimensions);
  if (count > 0) from_utf8(utf8, size, mxGetChars(array));
  return array;
}

size_t utf8_from_code(char* to, uint32_t code) {
  const size_t length = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
  static const unsigned char lead[] = {0, 0, 0xC0, 0xE0, 0xF0};
  for (size_t k = length - 1; k > 0; --k, code >>= 6) to[k] = (char)(0x80 | (code & 0x3F));
  to[0] = (char)(lead[length] | code);
  return length;
}

char* array_to_text(const mxArray* array, size_t* size) {
  const size_t count = mxGetNumberOfElements(array);
  if (!mxIsChar(array) || mxGetNumberOfDimensions(array) > 2 || (count > 0 && mxGetM(array) != 1))
    return NULL;
  char* text = mxMalloc(3 * count + 1);
  const mxChar* from = count > 0 ? mxGetChars(array) : NULL;
  size_t length = 0;
  for (size_t k = 0; k < count; ++k) {
    if (sizeof(mxChar) == 1) {
      text[length++] = (char)from[k];
      continue;
    }
    uint32_t code = (uint32_t)from[k];
    if (code >= 0xD800 && code < 0xDC00 && k + 1 < count)
      code = 0x10000 + ((code & 0x3FF) << 10) + ((uint32_t)from[++k] & 0x3FF);
    length += utf8_from_code(text + length, code);
  }
  text[length] = '\0';
  *size = length;
  return text;
}
