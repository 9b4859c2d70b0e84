/* Prepared questions, and rows run through them. */
#ifndef SINEW_OCTAVE_BATCH_H
#define SINEW_OCTAVE_BATCH_H

#include "objects.h"

/* Fields of a prepared question, as json_reader reads them; false where there is no memory. */
bool batch_read_fields(object* prepared, const json_node* fields);

/* Runs rows through: arrays of the inputs in, a struct of the outputs with ok, status and message out. NULL
 * where the arrays do not fit, with `problem` saying why. */
mxArray* batch_run(object* prepared, const mxArray* const* inputs, size_t input_count, int threads,
                   char* problem, size_t problem_size);

#endif
