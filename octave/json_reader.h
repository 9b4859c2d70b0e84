/* JSON as the library writes it, and what Octave and MATLAB have for it.
 *
 * jsondecode is not used: Octave's reads one double in five wrong in the last digit, and both turn lists
 * around. Here numbers are exact and shapes follow one rule (docs/octave.md). */
#ifndef SINEW_OCTAVE_JSON_READER_H
#define SINEW_OCTAVE_JSON_READER_H

#include <stdbool.h>
#include <stddef.h>

#include "mex.h"

enum json_type { JSON_NULL, JSON_BOOLEAN, JSON_NUMBER, JSON_TEXT, JSON_LIST, JSON_OBJECT };

typedef struct json_node json_node;
struct json_node {
  enum json_type type;
  double number;    /* a boolean's, too */
  const char* text; /* UTF-8, ended by 0 */
  size_t size;      /* bytes of the text, elements of a list, members of an object */
  const char* key;  /* of a member of an object: a name that a struct can have */
  json_node *first, *next;
};

/* The root, or NULL where the text is no JSON. Nodes last until the end of the MEX call. */
json_node* json_parse(const char* text, size_t size);

/* A member of an object, or NULL. */
const json_node* json_member(const json_node* object, const char* key);

/* Text of a member, "" where it has none. */
const char* json_member_text(const json_node* object, const char* key);

mxArray* json_to_array(const json_node* node);

/* An answer, an object, which begins with ok (status is converged), status and message ('' where there is
 * none). */
mxArray* json_to_answer(const json_node* answer);

#endif
