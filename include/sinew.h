/* sinew.h - the C interface of sinew: what every other language binds. Plain C11.
 *
 * A robot is opened once and never changes; any number of threads may use it. A session puts questions to it
 * and belongs to one thread at a time: open one a thread. Questions and answers are JSON, docs/protocol.md
 * has their fields.
 *
 *     sinew_robot* robot;
 *     char* error = NULL;
 *     if (sinew_open("3pfs-g2", 7, SINEW_FILE, &robot, &error) != SINEW_OK) { puts(error); return 1; }
 *     sinew_session* session = sinew_session_new(robot);
 *     const char* question = "{\"query\": \"forward\", \"inputs\": [0.44, 0.42, 0.41]}";
 *     char* answer = sinew_ask(session, question, strlen(question), NULL);
 *     puts(answer);
 *     sinew_free(answer);
 *     sinew_release(session);
 *     sinew_release(robot);
 *
 * Nothing throws. Texts are UTF-8, of `size` bytes where one is given to sinew, ended by 0 where sinew gives
 * one; those belong to the caller and go back by sinew_free. NULL in the place of an object or a text is
 * answered by SINEW_BAD_INPUT, or NULL; so is, mostly, an object of another kind or one that was released,
 * which nobody should count on. A thread that is cancelled (pthread_cancel) ends after the call it is in.
 * Lengths are m, angles rad, forces N, moments N m, in base axes. */
#ifndef SINEW_H
#define SINEW_H

#include <stddef.h>
#include <stdint.h>

#ifdef __GNUC__
#define SINEW_C_API __attribute__((visibility("default")))
#else
#define SINEW_C_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Grows with every function or value that is added, and says so at its place. What is there stays as it is.
 */
#define SINEW_ABI 1
SINEW_C_API int32_t sinew_abi(void); /* of the library that is linked */

typedef struct sinew_robot sinew_robot;
typedef struct sinew_session sinew_session;
typedef struct sinew_batch sinew_batch;

/* What a call says of itself. What came of a question is in its answer. */
enum sinew_code {
  SINEW_OK = 0,
  SINEW_BAD_INPUT = 1, /* the text or an argument; the error says what */
  SINEW_NO_MEMORY = 2,
  SINEW_FAILED = 3 /* an error of the library: please report it */
};

enum sinew_source {
  SINEW_FILE = 0, /* a file's path, or the name of a robot that comes with sinew */
  SINEW_TEXT = 1  /* what a robot file says: YAML or JSON */
};

/* Opens a robot. Where that fails *robot is NULL and *error, if `error` is not NULL, all that is wrong with
 * it, a line each: place, what was found, the rule, the way out. */
SINEW_C_API int32_t sinew_open(const char* source, size_t size, int32_t kind, sinew_robot** robot,
                               char** error);

/* A session for questions to this robot, which stays open as long as one of its sessions does. NULL where
 * there is no memory for it. */
SINEW_C_API sinew_session* sinew_session_new(const sinew_robot* robot);

/* Answers a question, in JSON, on one line. `length`, if it is not NULL, becomes that of the answer in bytes.
 * What is wrong with a question is in the answer: {"error": {"code", "where", "message"}}. NULL where there
 * is no memory for it.
 *
 * While a session answers, any thread may ask it {"query": "progress"}, which tells at once how far it is and
 * disturbs nothing: {"query": "progress", "busy": true}, and of a fit of identify, after its first step,
 * "part", what is being done, "steps" of that so far, and "error", the root mean square distance [m]. */
SINEW_C_API char* sinew_ask(sinew_session* session, const char* question, size_t size, size_t* length);

/* Prepares a question for many rows: a query in which texts "$name" stand for numbers, or for whole lists
 * whose length the robot knows, with "outputs": {"name": "place in the answer"} (numbers, lists or matrices;
 * left out: the usual ones and those of the words of "want", which sinew_fields tells, the residual last
 * where there is one), and "path": "continue" or "anew" (the default). The word of "want" that an output goes
 * with need not be given. What came of a row is in the statuses of sinew_run.
 *
 *     {"query": "forward", "inputs": "$inputs", "outputs": {"position": "pose.position"}, "path": "continue"}
 *     {"query": "forward", "inputs": ["$L1", 0.42, "$L3"], "outputs": {"z": "pose.position[2]"}}
 *
 * Where that fails *batch is NULL and *error says what is wrong: all that would be an error of every row,
 * unknown fields, fields without effect on this robot, lists of a wrong length, in the words of an answer to
 * one row; outputs that no answer has; and what is no column, lists as long as they are, such as those of a
 * shape, and the solutions of "all" where no output names a number of them. What the numbers of a row decide,
 * such as a length out of range, its status says. A batch may be run by several threads at once. */
SINEW_C_API int32_t sinew_prepare(const sinew_robot* robot, const char* question, size_t size,
                                  sinew_batch** batch, char** error);

/* What goes in and comes out of every row, in this order, in JSON:
 *
 *     {"inputs": [{"name": "inputs", "unit": "m", "rank": 1, "shape": [3]}],
 *      "outputs": [{"name": "position", "unit": "m", "rank": 1, "shape": [3]}], "want": [],
 *      "method": "rods in lanes"}
 *
 * Single numbers have rank 0 and shape []. Units are SI, "" of plain numbers. Where those of a field differ
 * all are named, row after row in the order in which they first stand: "N, N m" of a wrench, "N/m, N, N m" of
 * a stiffness, "1, rad/m" of a sensitivity to lengths. There 1 is that of plain numbers, and radians are left
 * out of denominators. NULL where there is no memory for it. */
SINEW_C_API char* sinew_fields(const sinew_batch* batch);

/* A field of all rows as it lies in memory: its first number; how many bytes further the next row's is; and
 * how many bytes the next number of the same row, of a matrix row after row. Of single numbers `step` is not
 * used. */
typedef struct sinew_input {
  const double* data;
  ptrdiff_t stride;
  ptrdiff_t step;
} sinew_input;
typedef struct sinew_output {
  double* data;
  ptrdiff_t stride;
  ptrdiff_t step;
} sinew_output;

/* Computes all rows on so many threads, 0 for as many as there are cores; the bytes do not depend on how
 * many. Each batch starts anew, unlike a session, which goes on warm from question to question, and may
 * differ from it in the last digits. A number that a row has no value of is NaN. `statuses`, if it is not
 * NULL, becomes a status a row: 0 unreachable, 1 left_domain, 2 slack, 3 singular, 4 stalled, 5
 * iteration_limit, 6 unstable, 7 converged, 8 stopped, 9 bad_input (the question does not take these
 * numbers), 10 unsupported (the robot has no answer to it), 255 an error of the library. SINEW_OK also where
 * rows have no solution; *error then has the answer to the first row that is bad input, or says why the first
 * that is unsupported is so, or names a field that has a number in no row that is solved. */
SINEW_C_API int32_t sinew_run(sinew_batch* batch, size_t rows, const sinew_input* inputs,
                              const sinew_output* outputs, uint8_t* statuses, int32_t threads, char** error);

/* Ends what a session answers now, or all runs of a batch, from any thread: the answer says `stopped`, with
 * the best there is, and so do rows not yet computed. What is asked later is answered as ever. The object
 * must not be released meanwhile. */
SINEW_C_API void sinew_stop(void* session_or_batch);

SINEW_C_API void sinew_free(void* text);      /* of a text that sinew gave, or NULL */
SINEW_C_API void sinew_release(void* object); /* of a robot, session or batch, or NULL; once */

#ifdef __cplusplus
}
#endif
#endif /* SINEW_H */
