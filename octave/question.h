/* A question as the methods of sinew.m hand it over: a query, and names and values of its fields in turn. */
#ifndef SINEW_OCTAVE_QUESTION_H
#define SINEW_OCTAVE_QUESTION_H

#include "json_writer.h"

/* Writes the question, with `settings` (paths and values in turn) as its `set`. `threads` becomes what a
 * field of that name says. */
void question_write(json_writer* out, const mxArray* query, const mxArray* fields, const mxArray* settings,
                    int* threads);

#endif
