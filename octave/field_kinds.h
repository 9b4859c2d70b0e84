/* Which fields of questions and robots are lists: where these have one element, or one row, Octave's matrices
 * do not tell. docs/protocol.md and docs/robot-files.md have their meanings. */
#ifndef SINEW_OCTAVE_FIELD_KINDS_H
#define SINEW_OCTAVE_FIELD_KINDS_H

#include <stdbool.h>
#include <stddef.h>

enum field_kind {
  FIELD_PLAIN,    /* as it looks: a scalar is a number, a vector a list, a matrix a list of rows */
  FIELD_NUMBER,   /* a number; a vector has one a configuration */
  FIELD_VECTOR,   /* a list of numbers; a matrix has a row a configuration */
  FIELD_LIST,     /* a list, also of one */
  FIELD_ROWS,     /* a list of lists, also of one: a matrix has a row a leg */
  FIELD_SECTIONS, /* the same of sections: a row a section, or a row a configuration of all sections */
};

/* What asks: `robot` in a robot's description, else the name of the query. */
enum field_kind field_kind(const char* query, bool is_serial, bool is_of_arms, const char* name);

/* Whether NaN stands for null there: a tendon of which nothing is given. */
bool field_takes_null(const char* name);

#endif
