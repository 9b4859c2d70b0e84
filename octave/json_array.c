/* What Octave and MATLAB have for JSON: a number or a boolean is a scalar, a list of numbers a row, a list of
 * such lists of one length a matrix, a list of objects a struct array with the fields of all of them ([] where
 * one lacks a field), a list of anything else a cell row. null among numbers is NaN, alone []. */
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
  for (const json_node* element = list->first; element; element = element->next)
    *to++ = element->number != 0;
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

/* Puts the members of an object into element k of a struct array, adding fields that it lacks. */
static void put_members(mxArray* structs, size_t k, const json_node* object) {
  int guess = 0; /* objects of a list mostly have the same members in the same order */
  for (const json_node* member = object->first; member; member = member->next, ++guess) {
    const char* name = guess < mxGetNumberOfFields(structs) ? mxGetFieldNameByNumber(structs, guess) : NULL;
    int field = name && strcmp(name, member->key) == 0 ? guess : mxGetFieldNumber(structs, member->key);
    if (field < 0) field = mxAddField(structs, member->key);
    if (field >= 0) mxSetFieldByNumber(structs, k, field, json_to_array(member));
  }
}

/* Fields that some elements lack are [], not nothing. */
static void fill_gaps(mxArray* structs, size_t size) {
  const int fields = mxGetNumberOfFields(structs);
  for (size_t k = 0; k < size; ++k)
    for (int field = 0; field < fields; ++field)
      if (!mxGetFieldByNumber(structs, k, field))
        mxSetFieldByNumber(structs, k, field, mxCreateDoubleMatrix(0, 0, mxREAL));
}

static mxArray* struct_row(const json_node* first, size_t size) {
  mxArray* structs = mxCreateStructMatrix(1, size, 0, NULL);
  size_t k = 0;
  for (const json_node* object = first; k < size; object = object->next) put_members(structs, k++, object);
  fill_gaps(structs, size);
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
  static const char* first[] = {"ok", "status", "message"};
  mxArray* value = mxCreateStructMatrix(1, 1, 3, first);
  put_members(value, 0, answer);
  mxSetFieldByNumber(value, 0, 0, mxCreateLogicalScalar(strcmp(json_member_text(answer, "status"), "converged") == 0));
  if (!json_member(answer, "message")) mxSetFieldByNumber(value, 0, 2, text_to_array("", 0));
  return value;
}

mxArray* json_to_array(const json_node* node) {
  switch (node->type) {
    case JSON_BOOLEAN: return mxCreateLogicalScalar(node->number != 0);
    case JSON_NUMBER: return mxCreateDoubleScalar(node->number);
    case JSON_TEXT: return text_to_array(node->text, node->size);
    case JSON_LIST: return list_to_array(node);
    case JSON_OBJECT: return struct_row(node, 1);
    default: return mxCreateDoubleMatrix(0, 0, mxREAL);
  }
}
