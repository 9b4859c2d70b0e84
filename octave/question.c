#include "question.h"

#include <string.h>

#include "text.h"

static void put(json_writer* out, const char* text) { json_put(out, text, strlen(text)); }

/* Element k of a cell array that holds names and values in turn; NULL where it is no name. */
static const char* name_at(json_writer* out, const mxArray* pairs, size_t k, const char* what) {
  size_t size = 0;
  const mxArray* name = mxGetCell(pairs, k);
  const char* text = name ? array_to_text(name, &size) : NULL;
  if (!text || size == 0 || strlen(text) != size) {
    json_problem(out, "found a %s where the name of %s should be; names and values come in turn.",
                 name ? mxGetClassName(name) : "double", what);
    return NULL;
  }
  return text;
}

static void put_name(json_writer* out, const char* name) {
  if (out->text[out->size - 1] != '{') put(out, ",");
  json_put_text(out, name, strlen(name));
  put(out, ":");
}

/* Places of an answer as {"legs_0_force": "legs[0].force"}. */
static void put_outputs(json_writer* out, const mxArray* places) {
  put(out, "{");
  const size_t count = mxIsCell(places) ? mxGetNumberOfElements(places) : 1;
  for (size_t k = 0; k < count; ++k) {
    size_t size;
    const mxArray* place = mxIsCell(places) ? mxGetCell(places, k) : places;
    const char* text = place && mxIsChar(place) ? array_to_text(place, &size) : NULL;
    if (!text) {
      json_problem(out, "outputs: give texts, such as {\"pose.position\"}, or a struct of texts.");
      return;
    }
    char name[64];
    size_t length = 0;
    for (const char* c = text; *c && length + 1 < sizeof name; ++c) {
      if (*c == ']') continue;
      name[length++] = strchr(".[ ", *c) ? '_' : *c;
    }
    name[length] = '\0';
    put_name(out, name);
    json_put_text(out, text, size);
  }
  put(out, "}");
}

static void read_threads(json_writer* out, const mxArray* value, int* threads) {
  const double number =
      mxIsDouble(value) && !mxIsSparse(value) && mxGetNumberOfElements(value) == 1 ? mxGetScalar(value) : -1;
  if (!(number >= 0 && number <= 1000 && number == (int)number))
    json_problem(out, "threads: give a whole number, 0 (as many as there are cores) to 1000.");
  else
    *threads = (int)number;
}

static void put_settings(json_writer* out, const mxArray* settings) {
  const bool takes_columns = out->takes_columns;
  out->takes_columns = false;
  put_name(out, "set");
  put(out, "{");
  for (size_t k = 0; k + 1 < mxGetNumberOfElements(settings) && !out->problem[0]; k += 2) {
    const char* path = name_at(out, settings, k, "a path of the robot");
    if (!path) return;
    put_name(out, path);
    json_put_value(out, path, FIELD_PLAIN, mxGetCell(settings, k + 1));
  }
  put(out, "}");
  out->takes_columns = takes_columns;
}

static bool is_of_batches(const char* name) {
  return strcmp(name, "threads") == 0 || strcmp(name, "outputs") == 0 || strcmp(name, "path") == 0;
}

void question_write(json_writer* out, const mxArray* query, const mxArray* fields, const mxArray* settings,
                    int* threads) {
  size_t size;
  const size_t count = mxGetNumberOfElements(fields);
  out->query = array_to_text(query, &size);
  put(out, "{");
  put_name(out, "query");
  json_put_text(out, out->query, size);
  for (size_t k = 0; k < count; k += 2) {
    const char* name = name_at(out, fields, k, "a field");
    if (name && is_of_batches(name)) out->is_batch = true;
  }
  for (size_t k = 0; k < count && !out->problem[0]; k += 2) {
    const char* name = name_at(out, fields, k, "a field");
    const mxArray* value = k + 1 < count ? mxGetCell(fields, k + 1) : NULL;
    if (!value) {
      json_problem(out, "%s: its value is missing; names and values come in turn.", name);
    } else if (strcmp(name, "threads") == 0) {
      read_threads(out, value, threads);
    } else {
      put_name(out, name);
      if (strcmp(name, "outputs") == 0 && !mxIsStruct(value))
        put_outputs(out, value);
      else
        json_put_value(out, name, field_kind(out->query, out->facts->is_serial, out->facts->is_of_arms, name), value);
    }
  }
  if (mxGetNumberOfElements(settings) > 0) put_settings(out, settings);
  put(out, "}");
}
