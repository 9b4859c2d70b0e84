#include "json_writer.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "columns.h"
#include "text.h"

enum { MAX_DEPTH = 100, PLACE_SIZE = 200 };

void json_begin(json_writer* out, const robot_facts* facts, const char* query) {
  memset(out, 0, sizeof *out);
  out->facts = facts;
  out->query = query;
}

void json_problem(json_writer* out, const char* format, ...) {
  if (out->problem[0]) return;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(out->problem, sizeof out->problem, format, arguments);
  va_end(arguments);
}

void json_put(json_writer* out, const char* text, size_t size) {
  if (out->size + size + 1 > out->room) {
    out->room = 2 * (out->size + size) + 256;
    out->text = mxRealloc(out->text, out->room);
  }
  memcpy(out->text + out->size, text, size);
  out->size += size;
  out->text[out->size] = '\0';
}

static void put(json_writer* out, const char* text) { json_put(out, text, strlen(text)); }

void json_put_text(json_writer* out, const char* utf8, size_t size) {
  put(out, "\"");
  for (size_t k = 0; k < size; ++k) {
    char escape[8];
    const unsigned char c = (unsigned char)utf8[k];
    if (c == '"' || c == '\\') {
      snprintf(escape, sizeof escape, "\\%c", c);
      put(out, escape);
    } else if (c < 0x20) {
      snprintf(escape, sizeof escape, "\\u%04x", c);
      put(out, escape);
    } else {
      json_put(out, utf8 + k, 1);
    }
  }
  put(out, "\"");
}

static const char* field_of(const char* place) {
  const char* dot = strrchr(place, '.');
  return dot ? dot + 1 : place;
}

/* int64 and uint64 are written as they are: a double does not hold them all. */
void json_put_number(json_writer* out, const char* place, const mxArray* array, size_t k) {
  char text[40];
  if (mxGetClassID(array) == mxINT64_CLASS) {
    snprintf(text, sizeof text, "%" PRId64, ((const int64_t*)mxGetData(array))[k]);
  } else if (mxGetClassID(array) == mxUINT64_CLASS) {
    snprintf(text, sizeof text, "%" PRIu64, ((const uint64_t*)mxGetData(array))[k]);
  } else {
    const double number = array_number(array, k);
    if (isnan(number) && field_takes_null(field_of(place))) {
      put(out, "null");
      return;
    }
    if (!isfinite(number)) {
      if (mxGetNumberOfElements(array) == 1)
        json_problem(out, "%s is %s; give a finite number.", place, isnan(number) ? "NaN" : "infinite");
      else
        json_problem(out, "%s(%zu, %zu) is %s; give finite numbers.", place, k % mxGetM(array) + 1,
                     k / mxGetM(array) + 1, isnan(number) ? "NaN" : "infinite");
      return;
    }
    snprintf(text, sizeof text, "%.17g", number); /* reads back to the same double */
    for (char* c = text; *c; ++c)
      if (*c == ',') *c = '.'; /* of some locales */
  }
  put(out, text);
}

/* Numbers of one row, or with `step` 1 of a vector. */
static void put_row(json_writer* out, const char* place, const mxArray* array, size_t first, size_t step,
                    size_t count) {
  put(out, "[");
  for (size_t k = 0; k < count; ++k) {
    if (k > 0) put(out, ",");
    json_put_number(out, place, array, first + k * step);
  }
  put(out, "]");
}

static void put_rows(json_writer* out, const char* place, const mxArray* array) {
  const size_t rows = mxGetM(array), columns = mxGetN(array);
  put(out, "[");
  for (size_t r = 0; r < rows; ++r) {
    if (r > 0) put(out, ",");
    put_row(out, place, array, r, rows, columns);
  }
  put(out, "]");
}

static bool is_plain_array(json_writer* out, const char* place, enum field_kind kind, const mxArray* array) {
  const bool has_pages = out->takes_columns && (kind == FIELD_ROWS || kind == FIELD_SECTIONS);
  if (mxIsSparse(array))
    json_problem(out, "%s is sparse; give full(...) of it.", place);
  else if (mxIsComplex(array))
    json_problem(out, "%s is complex; give real numbers.", place);
  else if (mxGetNumberOfDimensions(array) > (has_pages ? 3 : 2))
    json_problem(out, "%s has %d dimensions; give a vector or a matrix.", place,
                 (int)mxGetNumberOfDimensions(array));
  return !out->problem[0];
}

static void put_numbers(json_writer* out, const char* place, enum field_kind kind, const mxArray* array) {
  if (!is_plain_array(out, place, kind, array) || put_as_column(out, place, kind, array)) return;
  const size_t count = mxGetNumberOfElements(array);
  const bool is_vector = mxGetM(array) == 1 || mxGetN(array) == 1;
  if (kind == FIELD_SECTIONS && put_sections(out, place, array)) return;
  if (count > 0 && (kind == FIELD_ROWS || kind == FIELD_SECTIONS || !is_vector))
    put_rows(out, place, array);
  else if (count != 1 || kind == FIELD_VECTOR || kind == FIELD_LIST)
    put_row(out, place, array, 0, 1, count);
  else
    json_put_number(out, place, array, 0);
}

static void put_booleans(json_writer* out, const char* place, enum field_kind kind, const mxArray* array) {
  if (!is_plain_array(out, place, kind, array)) return;
  const mxLogical* values = mxGetLogicals(array);
  const size_t count = mxGetNumberOfElements(array);
  const bool is_list = count != 1 || kind == FIELD_LIST || kind == FIELD_VECTOR;
  if (is_list) put(out, "[");
  for (size_t k = 0; k < count; ++k)
    put(out, k > 0 ? values[k] ? ",true" : ",false" : values[k] ? "true" : "false");
  if (is_list) put(out, "]");
}

static void put_characters(json_writer* out, const char* place, enum field_kind kind, const mxArray* array) {
  size_t size;
  const char* text = array_to_text(array, &size);
  if (!text) {
    json_problem(out, "%s has several rows of characters; give one text, or a cell array of texts.", place);
    return;
  }
  if (kind == FIELD_LIST) put(out, "[");
  json_put_text(out, text, size);
  if (kind == FIELD_LIST) put(out, "]");
}

static void put_members(json_writer* out, const char* place, const mxArray* structs, size_t k) {
  put(out, "{");
  bool is_first = true;
  for (int field = 0; field < mxGetNumberOfFields(structs) && !out->problem[0]; ++field) {
    char inner[PLACE_SIZE];
    const char* name = mxGetFieldNameByNumber(structs, field);
    const mxArray* value = mxGetFieldByNumber(structs, k, field);
    if (!value) continue;
    /* [] in one of several structs is a field that this one lacks */
    if (mxGetNumberOfElements(structs) > 1 && mxIsDouble(value) && mxIsEmpty(value)) continue;
    if (!is_first) put(out, ",");
    is_first = false;
    json_put_text(out, name, strlen(name));
    put(out, ":");
    snprintf(inner, sizeof inner, "%s%s%s", place, *place ? "." : "", name);
    json_put_value(out, inner, field_kind(out->query, out->facts && out->facts->is_serial, out->facts && out->facts->is_of_arms, name), value);
  }
  put(out, "}");
}

/* Elements of a cell or struct array. Those of a list of lists are lists. */
static void put_elements(json_writer* out, const char* place, enum field_kind kind, const mxArray* array) {
  const bool takes_columns = out->takes_columns;
  const enum field_kind inner = kind == FIELD_ROWS || kind == FIELD_SECTIONS ? FIELD_LIST : FIELD_PLAIN;
  out->takes_columns = false;
  put(out, "[");
  for (size_t k = 0; k < mxGetNumberOfElements(array) && !out->problem[0]; ++k) {
    if (k > 0) put(out, ",");
    if (mxIsStruct(array)) {
      put_members(out, place, array, k);
    } else if (!mxGetCell(array, k)) {
      put(out, "[]");
    } else {
      json_put_value(out, place, inner, mxGetCell(array, k));
    }
  }
  put(out, "]");
  out->takes_columns = takes_columns;
}

void json_put_value(json_writer* out, const char* place, enum field_kind kind, const mxArray* array) {
  if (out->problem[0]) return;
  if (++out->depth > MAX_DEPTH) {
    json_problem(out, "%.80s... is nested deeper than %d.", place, MAX_DEPTH);
  } else if (mxIsNumeric(array)) {
    put_numbers(out, place, kind, array);
  } else if (mxIsLogical(array)) {
    put_booleans(out, place, kind, array);
  } else if (mxIsChar(array)) {
    put_characters(out, place, kind, array);
  } else if (mxIsStruct(array) && mxGetNumberOfElements(array) == 1 && kind != FIELD_LIST) {
    put_members(out, place, array, 0);
  } else if (mxIsStruct(array) || mxIsCell(array)) {
    put_elements(out, place, kind, array);
  } else {
    json_problem(out, "%s is a %s; give numbers, text, a cell array or a struct.", place,
                 mxGetClassName(array));
  }
  --out->depth;
}
