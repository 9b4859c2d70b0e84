/* What sinew.m and sinew_batch.m call: robots, questions and rows through sinew.h.
 *
 *     [number, id, message] = sinew_mex('open', source, 'file' or 'text'), with a struct for source 'struct'
 *     [number, ...] = sinew_mex('share', number)             a session of its own on the same robot
 *     [answer, ...] = sinew_mex('ask', number, query, fields, settings)
 *     [answer, ...] = sinew_mex('ask_text', number, json)
 *     [json, ...]   = sinew_mex('json', number, json)        the answer as it is
 *     [number, ...] = sinew_mex('prepare', number, query, fields, settings)
 *     [fields, ...] = sinew_mex('fields', number)
 *     [answer, ...] = sinew_mex('run', number, arrays, threads)
 *     sinew_mex('close', number)
 *
 * Where it fails the first value is [], and id and message are those of the error to raise. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "batch.h"
#include "interrupt.h"
#include "json_reader.h"
#include "progress.h"
#include "question.h"
#include "text.h"

typedef struct {
  mxArray* value;
  char id[32];
  char* message; /* lasts until the end of the call */
} result;

static result failed(const char* id, const char* message) {
  result r = {0};
  snprintf(r.id, sizeof r.id, "sinew:%s", id);
  r.message = mxMalloc(strlen(message) + 1);
  strcpy(r.message, message);
  return r;
}

static result done(mxArray* value) { return (result){.value = value}; }
static result no_memory(void) { return failed("no_memory", "there is not enough memory"); }

/* A message of the library, which has it back. */
static result refused(int32_t code, char* error) {
  const char* id = code == SINEW_NO_MEMORY ? "no_memory" : code == SINEW_FAILED ? "failed" : "bad_input";
  result r = failed(id, error ? error : "an error of the library; please report it");
  sinew_free(error);
  return r;
}

static object* object_of(const mxArray* number) {
  return mxIsDouble(number) && mxGetNumberOfElements(number) == 1 ? object_find(mxGetScalar(number)) : NULL;
}

static result closed(void) {
  return failed("closed", "this robot is closed; open it again with sinew(...).");
}

/* A text of the library as nodes; it goes back. */
static json_node* parsed(char* text, size_t size) {
  json_node* root = text ? json_parse(text, size) : NULL;
  sinew_free(text);
  return root;
}

static char* ask(sinew_session* session, const char* question, size_t size, size_t* length) {
  progress_begin(session, question, size);
  interrupt_begin(session);
  char* answer = sinew_ask(session, question, size, length);
  progress_end();
  interrupt_end();
  return answer;
}

static json_node* asked(sinew_session* session, const char* question, size_t size) {
  size_t length;
  char* answer = ask(session, question, size, &length);
  return parsed(answer, length);
}

static result answered(sinew_session* session, const char* question, size_t size) {
  const json_node* answer = asked(session, question, size);
  if (!answer) return no_memory();
  const json_node* error = json_member(answer, "error");
  if (!error) return done(json_to_answer(answer));
  const char* code = json_member_text(error, "code");
  const bool is_ours = strcmp(code, "internal") == 0 || strcmp(code, "failed") == 0;
  return failed(is_ours ? "failed" : "bad_input", json_member_text(error, "message"));
}

static result robot_object(shared_robot* shared) {
  object* made = object_new(shared);
  if (made) made->session = sinew_session_new(shared->robot);
  if (made && made->session) return done(mxCreateDoubleScalar(made->number));
  if (made) object_close(made);
  return no_memory();
}

static result open_text(const char* source, size_t size, int32_t kind) {
  static const char describe[] = "{\"query\":\"describe\"}";
  char* error = NULL;
  shared_robot* shared = calloc(1, sizeof *shared);
  if (!shared) return no_memory();
  const int32_t code = sinew_open(source, size, kind, &shared->robot, &error);
  if (code != SINEW_OK) {
    free(shared);
    return refused(code, error);
  }
  result made = robot_object(shared);
  if (!made.value) return made;
  object* robot = object_of(made.value);
  robot_facts_read(&shared->facts, asked(robot->session, describe, strlen(describe)));
  return made;
}

static result open_robot(int count, const mxArray* const* in) {
  size_t size, kind_size;
  const char* kind = count == 2 ? array_to_text(in[1], &kind_size) : NULL;
  if (sinew_abi() != SINEW_ABI)
    return failed("failed", "sinew_mex and the library are of different versions");
  if (kind && strcmp(kind, "struct") == 0) {
    json_writer out;
    json_begin(&out, NULL, "robot");
    json_put_value(&out, "", FIELD_PLAIN, in[0]);
    return out.problem[0] ? failed("bad_input", out.problem) : open_text(out.text, out.size, SINEW_TEXT);
  }
  const char* source = kind ? array_to_text(in[0], &size) : NULL;
  if (!source) return failed("bad_input", "give a robot's name, file, text or struct.");
  return open_text(source, size, strcmp(kind, "text") == 0 ? SINEW_TEXT : SINEW_FILE);
}

static result share(int count, const mxArray* const* in) {
  object* robot = count == 1 ? object_of(in[0]) : NULL;
  return robot ? robot_object(robot->shared) : closed();
}

static result prepared(object* robot, const json_writer* out) {
  char* error = NULL;
  object* made = object_new(robot->shared);
  if (!made) return no_memory();
  const int32_t code = sinew_prepare(robot->shared->robot, out->text, out->size, &made->batch, &error);
  if (code != SINEW_OK) {
    object_close(made);
    return refused(code, error);
  }
  char* fields = sinew_fields(made->batch);
  if (fields && batch_read_fields(made, parsed(fields, strlen(fields))))
    return done(mxCreateDoubleScalar(made->number));
  object_close(made);
  return no_memory();
}

static result run_arrays(object* batch, const mxArray* const* arrays, size_t count, int threads) {
  char problem[600] = "";
  mxArray* answer = batch_run(batch, arrays, count, threads, problem, sizeof problem);
  return answer ? done(answer) : failed("bad_input", problem);
}

/* A question whose matrices have a row a configuration. */
static result ask_rows(object* robot, const json_writer* out, int threads) {
  result r = prepared(robot, out);
  if (!r.value) return r;
  object* batch = object_of(r.value);
  const mxArray* arrays[MAX_COLUMNS];
  for (size_t k = 0; k < out->column_count; ++k) arrays[k] = out->columns[k].array;
  r = run_arrays(batch, arrays, out->column_count, threads);
  object_close(batch);
  return r;
}

static result question(int count, const mxArray* const* in, bool is_prepared) {
  object* robot = count == 4 ? object_of(in[0]) : NULL;
  if (!robot || !robot->session) return closed();
  if (!mxIsChar(in[1]) || !mxIsCell(in[2]) || !mxIsCell(in[3]))
    return failed("bad_input", "sinew_mex: give a query, fields and settings.");
  json_writer out;
  int threads = 0;
  json_begin(&out, &robot->shared->facts, "");
  out.takes_columns = !is_prepared;
  question_write(&out, in[1], in[2], in[3], &threads);
  if (out.problem[0]) return failed("bad_input", out.problem);
  if (is_prepared) return prepared(robot, &out);
  return out.column_count > 0 || out.is_batch ? ask_rows(robot, &out, threads)
                                              : answered(robot->session, out.text, out.size);
}

static result ask_fields(int count, const mxArray* const* in) { return question(count, in, false); }
static result prepare(int count, const mxArray* const* in) { return question(count, in, true); }

static result ask_text(int count, const mxArray* const* in) {
  size_t size;
  object* robot = count == 2 ? object_of(in[0]) : NULL;
  if (!robot || !robot->session) return closed();
  const char* text = array_to_text(in[1], &size);
  return text ? answered(robot->session, text, size) : failed("bad_input", "give a question as text.");
}

static result ask_json(int count, const mxArray* const* in) {
  size_t size, length;
  object* robot = count == 2 ? object_of(in[0]) : NULL;
  if (!robot || !robot->session) return closed();
  const char* text = array_to_text(in[1], &size);
  if (!text) return failed("bad_input", "give a question as text.");
  char* answer = ask(robot->session, text, size, &length);
  if (!answer) return no_memory();
  result r = done(text_to_array(answer, length));
  sinew_free(answer);
  return r;
}

static result fields(int count, const mxArray* const* in) {
  object* batch = count == 1 ? object_of(in[0]) : NULL;
  if (!batch || !batch->batch) return closed();
  char* text = sinew_fields(batch->batch);
  const json_node* root = text ? parsed(text, strlen(text)) : NULL;
  return root ? done(json_to_array(root)) : no_memory();
}

static result run(int count, const mxArray* const* in) {
  object* batch = count == 3 ? object_of(in[0]) : NULL;
  if (!batch || !batch->batch) return failed("closed", "this prepared question is closed; prepare it again.");
  const size_t arrays = mxIsCell(in[1]) ? mxGetNumberOfElements(in[1]) : 0;
  const double threads = mxIsDouble(in[2]) && mxGetNumberOfElements(in[2]) == 1 ? mxGetScalar(in[2]) : -1;
  if (!(threads >= 0 && threads <= 1000 && threads == (int)threads))
    return failed("bad_input", "threads: give a whole number, 0 (as many as there are cores) to 1000.");
  const mxArray** given = mxCalloc(arrays + 1, sizeof *given);
  for (size_t k = 0; k < arrays; ++k)
    if (!(given[k] = mxGetCell(in[1], k))) return failed("bad_input", "an array is missing.");
  return run_arrays(batch, given, arrays, (int)threads);
}

static result close_object(int count, const mxArray* const* in) {
  object* open = count == 1 ? object_of(in[0]) : NULL;
  if (open) object_close(open);
  return done(mxCreateDoubleMatrix(0, 0, mxREAL));
}

static const struct {
  const char* name;
  result (*call)(int count, const mxArray* const* in);
} commands[] = {{"open", open_robot},   {"share", share},   {"ask", ask_fields},
                {"ask_text", ask_text}, {"json", ask_json}, {"prepare", prepare},
                {"fields", fields},     {"run", run},       {"close", close_object}};

static result called(int count, const mxArray* const* in) {
  size_t size;
  const char* name = count > 0 ? array_to_text(in[0], &size) : NULL;
  for (size_t k = 0; name && k < sizeof commands / sizeof *commands; ++k)
    if (strcmp(name, commands[k].name) == 0) return commands[k].call(count - 1, in + 1);
  return failed("bad_input", "sinew_mex is called by sinew.m; help sinew says how to ask.");
}

#ifdef __GNUC__
__attribute__((visibility("default")))
#endif
void mexFunction(int output_count, mxArray* out[], int input_count, const mxArray* in[]) {
  mexAtExit(objects_close);
  const result r = called(input_count, in);
  if (output_count < 3 && r.message) mexErrMsgIdAndTxt(r.id, "%s", r.message);
  out[0] = r.value ? r.value : mxCreateDoubleMatrix(0, 0, mxREAL);
  if (output_count > 1) out[1] = text_to_array(r.id, strlen(r.id));
  if (output_count > 2) out[2] = text_to_array(r.message ? r.message : "", r.message ? strlen(r.message) : 0);
}
