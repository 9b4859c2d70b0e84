#include "batch.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "columns.h"
#include "interrupt.h"
#include "json_reader.h"
#include "text.h"

enum { CONVERGED = 7 };

static field_shape* shapes(const json_node* list, size_t* count) {
  field_shape* all = calloc(list ? list->size + 1 : 1, sizeof *all);
  field_shape* field = all;
  *count = list ? list->size : 0;
  for (const json_node* node = list ? list->first : NULL; all && node; node = node->next, ++field) {
    const json_node* shape = json_member(node, "shape");
    snprintf(field->name, sizeof field->name, "%s", json_member_text(node, "name"));
    field->size = 1;
    for (const json_node* length = shape ? shape->first : NULL; length; length = length->next) {
      field->size *= (size_t)length->number;
      if (field->rank < 2) field->shape[field->rank++] = (size_t)length->number;
    }
  }
  return all;
}

bool batch_read_fields(object* prepared, const json_node* fields) {
  prepared->inputs = shapes(json_member(fields, "inputs"), &prepared->input_count);
  prepared->outputs = shapes(json_member(fields, "outputs"), &prepared->output_count);
  return prepared->inputs && prepared->outputs;
}

/* Numbers of a row lie row after row in the library's fields, the other way in pages of the host. */
static mxArray* turned_pages(mxArray* array) {
  mxArray* arguments[2] = {array, mxCreateDoubleMatrix(1, 3, mxREAL)};
  mxArray* turned = NULL;
  const double order[3] = {1, 3, 2};
  memcpy(mxGetPr(arguments[1]), order, sizeof order);
  mexCallMATLAB(1, &turned, 2, arguments, "permute");
  return turned;
}

/* The numbers of a real array as doubles: where they lie, or a copy of another class or order. */
static const double* numbers_of(const mxArray* array) {
  if (mxGetNumberOfDimensions(array) == 3) array = turned_pages((mxArray*)array);
  if (mxIsDouble(array)) return mxGetPr(array);
  const size_t count = mxGetNumberOfElements(array);
  double* copy = mxMalloc(count * sizeof *copy + 1);
  for (size_t k = 0; k < count; ++k) copy[k] = array_number(array, k);
  return copy;
}

static const char* class_of(const mxArray* array) {
  if (mxIsNumeric(array) && mxIsSparse(array)) return "sparse matrix";
  return mxIsNumeric(array) && mxIsComplex(array) ? "complex matrix" : mxGetClassName(array);
}

/* Whether it is an array of n x rows x columns, as outputs are that have a matrix a row. */
static bool has_pages(const field_shape* field, const mxArray* array) {
  const mwSize* sizes = mxGetDimensions(array);
  return field->rank == 2 && mxGetNumberOfDimensions(array) == 3 && (size_t)sizes[1] == field->shape[0] &&
         (size_t)sizes[2] == field->shape[1];
}

/* What is wrong with the array of an input, or NULL. A vector serves where a row has one number. */
static const char* misfit(const field_shape* field, const mxArray* array, size_t* rows) {
  static char why[200];
  if (!mxIsNumeric(array) || mxIsComplex(array) || mxIsSparse(array)) {
    snprintf(why, sizeof why, "%s is a %s; give a full matrix of real numbers, one row a configuration.",
             field->name, class_of(array));
    return why;
  }
  const bool is_row = field->size == 1 && mxGetM(array) == 1;
  const size_t columns = is_row ? 1 : mxGetN(array); /* of all pages */
  *rows = is_row ? mxGetN(array) : mxGetM(array);
  if (has_pages(field, array)) return NULL;
  if (mxGetNumberOfDimensions(array) == 2 && (columns == field->size || columns + *rows == 0)) return NULL;
  snprintf(why, sizeof why, "%s has %zu column%s, a row has %zu number%s; give one row a configuration.",
           field->name, columns, columns == 1 ? "" : "s", field->size, field->size == 1 ? "" : "s");
  return why;
}

static bool read_inputs(const object* prepared, const mxArray* const* arrays, sinew_input* inputs,
                        size_t* rows, char* problem, size_t problem_size) {
  for (size_t i = 0; i < prepared->input_count; ++i) {
    size_t here = 0;
    const char* why = misfit(&prepared->inputs[i], arrays[i], &here);
    if (why) return snprintf(problem, problem_size, "%s", why), false;
    if (i > 0 && here != *rows) {
      snprintf(problem, problem_size, "%s has %zu rows and %s has %zu; give as many.",
               prepared->inputs[i].name, here, prepared->inputs[0].name, *rows);
      return false;
    }
    *rows = here;
    inputs[i].data = numbers_of(arrays[i]);
    inputs[i].stride = sizeof(double);
    inputs[i].step = (ptrdiff_t)(here * sizeof(double));
  }
  return true;
}

static mxArray* output_array(const field_shape* field, size_t rows) {
  const mwSize dimensions[3] = {rows, field->rank < 2 ? field->size : field->shape[1], field->shape[0]};
  return mxCreateNumericArray(field->rank < 2 ? 2 : 3, dimensions, mxDOUBLE_CLASS, mxREAL);
}

static mxArray* status_ok(const mxArray* statuses) {
  const size_t rows = mxGetM(statuses);
  mxArray* ok = mxCreateLogicalMatrix(rows, 1);
  mxLogical* to = mxGetLogicals(ok);
  for (size_t r = 0; r < rows; ++r) to[r] = ((const uint8_t*)mxGetData(statuses))[r] == CONVERGED;
  return ok;
}

static void put_field(mxArray* answer, const char* name, mxArray* value) {
  int field = mxGetFieldNumber(answer, name);
  if (field < 0) field = mxAddField(answer, name);
  if (field >= 0) mxSetFieldByNumber(answer, 0, field, value);
}

/* What the library says of rows, in its own words: of a row that is bad input its answer has the message. */
static mxArray* message_of(char* error) {
  if (!error) return text_to_array("", 0);
  json_node* answer = *error == '{' ? json_parse(error, strlen(error)) : NULL;
  const char* message = json_member_text(json_member(answer, "error"), "message");
  if (!*message) message = error;
  mxArray* array = text_to_array(message, strlen(message));
  sinew_free(error);
  return array;
}

static mxArray* answer_of(const object* prepared, mxArray** columns, mxArray* statuses, char* error) {
  mxArray* answer = mxCreateStructMatrix(1, 1, 0, NULL);
  put_field(answer, "ok", status_ok(statuses));
  put_field(answer, "status", statuses);
  put_field(answer, "message", message_of(error));
  for (size_t o = 0; o < prepared->output_count; ++o)
    put_field(answer, prepared->outputs[o].name,
              prepared->outputs[o].rank < 2 ? columns[o] : turned_pages(columns[o]));
  return answer;
}

mxArray* batch_run(object* prepared, const mxArray* const* arrays, size_t input_count, int threads,
                   char* problem, size_t problem_size) {
  if (input_count != prepared->input_count) {
    snprintf(problem, problem_size, "%zu arrays were given for %zu fields; give one for each.", input_count,
             prepared->input_count);
    return NULL;
  }
  size_t rows = 0;
  sinew_input* inputs = mxCalloc(prepared->input_count + 1, sizeof *inputs);
  sinew_output* outputs = mxCalloc(prepared->output_count + 1, sizeof *outputs);
  mxArray** columns = mxCalloc(prepared->output_count + 1, sizeof *columns);
  if (!read_inputs(prepared, arrays, inputs, &rows, problem, problem_size)) return NULL;
  for (size_t o = 0; o < prepared->output_count; ++o) {
    columns[o] = output_array(&prepared->outputs[o], rows);
    outputs[o] = (sinew_output){mxGetPr(columns[o]), sizeof(double), (ptrdiff_t)(rows * sizeof(double))};
  }
  mxArray* statuses = mxCreateNumericMatrix(rows, 1, mxUINT8_CLASS, mxREAL);
  char* error = NULL;
  interrupt_begin(prepared->batch);
  const int32_t code =
      sinew_run(prepared->batch, rows, inputs, outputs, mxGetData(statuses), threads, &error);
  interrupt_end();
  if (code == SINEW_OK) return answer_of(prepared, columns, statuses, error);
  snprintf(problem, problem_size, "%s", error ? error : "an error of the library; please report it");
  sinew_free(error);
  return NULL;
}
