/* Text between the library, which has UTF-8, and the host: Octave's characters are its bytes, MATLAB's
 * UTF-16. */
#ifndef SINEW_OCTAVE_TEXT_H
#define SINEW_OCTAVE_TEXT_H

#include <stddef.h>
#include <stdint.h>

#include "mex.h"

mxArray* text_to_array(const char* utf8, size_t size);

/* Ended by 0; lasts until the end of the MEX call. NULL where the array is no row of characters. */
char* array_to_text(const mxArray* array, size_t* size);

/* Writes a code point, at most four bytes, and says how many. */
size_t utf8_from_code(char* to, uint32_t code);

#endif
