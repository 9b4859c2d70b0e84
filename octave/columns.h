/* Arrays with a row a configuration: which ones, and what stands in the question in their place. */
#ifndef SINEW_OCTAVE_COLUMNS_H
#define SINEW_OCTAVE_COLUMNS_H

#include "json_writer.h"

/* Element k of a real numeric array. */
double array_number(const mxArray* array, size_t k);

/* True where the array has a row a configuration: then "$name" was written, and it is a column. */
bool put_as_column(json_writer* out, const char* place, enum field_kind kind, const mxArray* array);

/* True where a row holds all sections of a serial robot: then it was written as a list of sections. */
bool put_sections(json_writer* out, const char* place, const mxArray* array);

#endif
