/* Octave's and MATLAB's arrays as the JSON of a question.
 *
 * A matrix where a field has one list, or a vector where it has one number, holds a row a configuration: a
 * text
 * "$name" stands in the question in its place, and the array is kept as a column for sinew_run, which reads
 * it where it lies. */
#ifndef SINEW_OCTAVE_JSON_WRITER_H
#define SINEW_OCTAVE_JSON_WRITER_H

#include <stdbool.h>
#include <stddef.h>

#include "field_kinds.h"
#include "mex.h"

enum { MAX_SECTIONS = 100, MAX_COLUMNS = 200 };

/* What the shape of a question depends on. */
typedef struct {
  bool is_serial, is_of_arms;
  size_t input_count;
  size_t section_count; /* of legs of sections those of all legs */
  size_t configuration_sizes[MAX_SECTIONS], change_sizes[MAX_SECTIONS];
} robot_facts;

typedef struct json_node json_node;
void robot_facts_read(robot_facts* facts, const json_node* described);

typedef struct {
  char name[64];
  const mxArray* array;
} json_column;

typedef struct {
  char *text, problem[500]; /* the first thing found wrong, or "" */
  size_t size, room;
  const robot_facts* facts;
  const char* query;
  bool takes_columns;
  bool is_batch; /* a single row is a column, too */
  size_t row_count, column_count;
  json_column columns[MAX_COLUMNS];
  int depth;
} json_writer;

void json_begin(json_writer* out, const robot_facts* facts, const char* query);
void json_put(json_writer* out, const char* text, size_t size);
void json_put_text(json_writer* out, const char* utf8, size_t size); /* with quotes */
void json_put_value(json_writer* out, const char* place, enum field_kind kind, const mxArray* array);
/* Element k of a real array. */
void json_put_number(json_writer* out, const char* place, const mxArray* array, size_t k);
void json_problem(json_writer* out, const char* format, ...);

#endif
