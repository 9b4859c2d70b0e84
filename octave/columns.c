#include "columns.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

double array_number(const mxArray* array, size_t k) {
  const void* data = mxGetData(array);
  switch (mxGetClassID(array)) {
    case mxSINGLE_CLASS:
      return (double)((const float*)data)[k];
    case mxINT8_CLASS:
      return ((const int8_t*)data)[k];
    case mxUINT8_CLASS:
      return ((const uint8_t*)data)[k];
    case mxINT16_CLASS:
      return ((const int16_t*)data)[k];
    case mxUINT16_CLASS:
      return ((const uint16_t*)data)[k];
    case mxINT32_CLASS:
      return ((const int32_t*)data)[k];
    case mxUINT32_CLASS:
      return ((const uint32_t*)data)[k];
    case mxINT64_CLASS:
      return (double)((const int64_t*)data)[k];
    case mxUINT64_CLASS:
      return (double)((const uint64_t*)data)[k];
    default:
      return ((const double*)data)[k];
  }
}

static const size_t* section_sizes(const json_writer* out, const char* place) {
  const bool is_of_tendons = strcmp(place, "changes") == 0 || strcmp(place, "tensions") == 0;
  return is_of_tendons ? out->facts->change_sizes : out->facts->configuration_sizes;
}

static size_t whole_robot(const json_writer* out, const char* place) {
  size_t all = 0;
  for (size_t s = 0; s < out->facts->section_count; ++s) all += section_sizes(out, place)[s];
  return all;
}

static bool has_rows(const json_writer* out, const char* place, enum field_kind kind, const mxArray* array) {
  const size_t rows = mxGetM(array), columns = mxGetN(array);
  const bool may_be_one = out->is_batch && out->column_count == 0; /* a batch of one */
  if (!out->takes_columns || columns == 0) return false;
  if (mxGetNumberOfDimensions(array) == 3) return true; /* a row, or a page of rows, a configuration */
  switch (kind) {
    case FIELD_NUMBER:
      return rows * columns != 1 || may_be_one;
    case FIELD_VECTOR: /* vectors are lists, whichever way they lie */
      return columns == 1 && out->facts->input_count != 1 && rows > 1 ? false : rows != 1 || may_be_one;
    case FIELD_SECTIONS:
      return columns == whole_robot(out, place) && (rows != 1 || may_be_one);
    default:
      return false;
  }
}

static void put_column(json_writer* out, const char* place, const mxArray* array) {
  if (out->column_count == MAX_COLUMNS) {
    json_problem(out, "%s: more than %d fields vary from row to row.", place, MAX_COLUMNS);
    return;
  }
  json_column* column = &out->columns[out->column_count++];
  snprintf(column->name, sizeof column->name, "%s", place);
  for (char* c = column->name; *c; ++c)
    if (*c == '.') *c = '_';
  column->array = array;
  json_put(out, "\"$", 2);
  json_put(out, column->name, strlen(column->name));
  json_put(out, "\"", 1);
}

bool put_as_column(json_writer* out, const char* place, enum field_kind kind, const mxArray* array) {
  if (!has_rows(out, place, kind, array)) return false;
  const size_t rows = kind == FIELD_NUMBER ? mxGetNumberOfElements(array) : mxGetM(array);
  if (out->column_count > 0 && rows != out->row_count)
    json_problem(out, "%s has %zu rows and %s has %zu; give one row, or as many.", place, rows,
                 out->columns[0].name, out->row_count);
  out->row_count = rows;
  put_column(out, place, array);
  return true;
}

bool put_sections(json_writer* out, const char* place, const mxArray* array) {
  if (mxGetM(array) != 1 || mxGetN(array) != whole_robot(out, place)) return false;
  const size_t* sizes = section_sizes(out, place);
  for (size_t s = 0, k = 0; s < out->facts->section_count; ++s) {
    json_put(out, s > 0 ? "],[" : "[[", s > 0 ? 3 : 2);
    for (size_t i = 0; i < sizes[s]; ++i, ++k) {
      if (i > 0) json_put(out, ",", 1);
      json_put_number(out, place, array, k);
    }
  }
  json_put(out, "]]", 2);
  return true;
}
