/* What Octave and MATLAB have for JSON: a number or a boolean is a scalar, a list of numbers a row, a list of
 * such lists of one length a matrix, a list of objects a struct array with the fields of all of them ([]
 * where one lacks a field), a list of anything else a cell row. null among numbers is NaN, alone []. */
#include <string.h>

#include "json_reader.h"
#include "text.h"

static bool all(const json_node* list, enum json_type type) {
  for (const json_node* element = list->first; element; element = element->next)
    if (element->type != type && !(type == JSON_NUMBER && element->type == JSON_NULL)) return false;
  return true;
}

static mxArray* number_row(const json_node* list) {
  mxArray* row = mxCreateDoubleMatrix(1, list->size, mxREAL);
  double* to = mxGetPr(row);
  for (const json_node* element = list->first; element; element = element->next) *to++ = element->number;
  return row;
}

static mxArray* boolean_row(const json_node* list) {
  mxArray* row = mxCreateLogicalMatrix(1, list->size);
  mxLogical* to = mxGetLogicals(row);
  for (const json_node* element = list->first; element; element = element->next) *to++ = element->number != 0;
  return row;
}

static bool is_matrix(const json_node* list) {
  const size_t columns = list->first->size;
  for (const json_node* row = list->first; row; row = row->next)
    if (row->type != JSON_LIST || row->size != columns || !all(row, JSON_NUMBER)) return false;
  return columns > 0;
}

static mxArray* matrix(const json_node* list) {
  const size_t rows = list->size, columns = list->first->size;
  mxArray* array = mxCreateDoubleMatrix(rows, columns, mxREAL);
  double* to = mxGetPr(array);
  size_t r = 0;
  for (const json_node* row = list->first; row; row = row->next, ++r) {
    size_t c = 0;
    for (const json_node* element = row->first; element; element = element->next, ++c)
      to[r + c * rows] = element->number;
  }
  return array;
}

static mxArray* cell_row(const json_node* list) {
  mxArray* row = mxCreateCellMatrix(1, list->size);
  size_t k = 0;
  for (const json_node* element = list->first; element; element = element->next)
    mxSetCell(row, k++, json_to_array(element));
  return row;
}

/* Names of fields that objects have between them. Those of a list mostly have the same in the same order. */
typedef struct {
  const char** names;
  int count, room;
} field_names;

static int field_of(const field_names* fields, const char* key, int guess) {
  if (guess < fields->count && strcmp(fields->names[guess], key) == 0) return guess;
  for (int k = 0; k < fields->count; ++k)
    if (strcmp(fields->names[k], key) == 0) return k;
  return -1;
}

static void add_field(field_names* fields, const char* key) {
  if (fields->count == fields->room) {
    fields->room = 2 * fields->room + 8;
    fields->names = mxRealloc(fields->names, (size_t)fields->room * sizeof *fields->names);
  }
  fields->names[fields->count++] = key;
}

static void add_members(field_names* fields, const json_node* object) {
  int guess = 0;
  for (const json_node* member = object->first; member; member = member->next, ++guess)
    if (field_of(fields, member->key, guess) < 0) add_field(fields, member->key);
}

static void put_members(mxArray* structs, const field_names* fields, size_t k, const json_node* object) {
  int guess = 0;
  for (const json_node* member = object->first; member; member = member->next, ++guess)
    mxSetFieldByNumber(structs, k, field_of(fields, member->key, guess), json_to_array(member));
}

/* Fields that an element lacks are [], not nothing. */
static void fill_gaps(mxArray* structs, const field_names* fields, size_t k) {
  for (int field = 0; field < fields->count; ++field)
    if (!mxGetFieldByNumber(structs, k, field))
      mxSetFieldByNumber(structs, k, field, mxCreateDoubleMatrix(0, 0, mxREAL));
}

static mxArray* struct_row(const json_node* first, size_t size) {
  field_names fields = {0};
  const json_node* object = first;
  for (size_t k = 0; k < size; ++k, object = object->next) add_members(&fields, object);
  mxArray* structs = mxCreateStructMatrix(1, size, fields.count, fields.names);
  object = first;
  for (size_t k = 0; k < size; ++k, object = object->next) {
    put_members(structs, &fields, k, object);
    if (size > 1) fill_gaps(structs, &fields, k);
  }
  return structs;
}

static mxArray* list_to_array(const json_node* list) {
  if (list->size == 0) return mxCreateDoubleMatrix(0, 0, mxREAL);
  if (all(list, JSON_NUMBER)) return number_row(list);
  if (all(list, JSON_BOOLEAN)) return boolean_row(list);
  if (all(list, JSON_OBJECT)) return struct_row(list->first, list->size);
  return is_matrix(list) ? matrix(list) : cell_row(list);
}

mxArray* json_to_answer(const json_node* answer) {
  field_names fields = {0};
  add_field(&fields, "ok");
  add_field(&fields, "status");
  add_field(&fields, "message");
  add_members(&fields, answer);
  mxArray* value = mxCreateStructMatrix(1, 1, fields.count, fields.names);
  put_members(value, &fields, 0, answer);
  mxSetFieldByNumber(value, 0, 0,
                     mxCreateLogicalScalar(strcmp(json_member_text(answer, "status"), "converged") == 0));
  if (!json_member(answer, "message")) mxSetFieldByNumber(value, 0, 2, text_to_array("", 0));
  return value;
}

mxArray* json_to_array(const json_node* node) {
  switch (node->type) {
    case JSON_BOOLEAN:
      return mxCreateLogicalScalar(node->number != 0);
    case JSON_NUMBER:
      return mxCreateDoubleScalar(node->number);
    case JSON_TEXT:
      return text_to_array(node->text, node->size);
    case JSON_LIST:
      return list_to_array(node);
    case JSON_OBJECT:
      return struct_row(node, 1);
    default:
      return mxCreateDoubleMatrix(0, 0, mxREAL);
  }
}
