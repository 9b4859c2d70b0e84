/* What calls.py asks in Python, asked in C: prints nanoseconds a question, or a row. Processor time but with
 * two threads.
 *
 *     bench_python_calls one ROBOT QUESTION COUNT MIDDLE RADIUS           rows one by one
 *     bench_python_calls many ROBOT QUESTION COUNT MIDDLE RADIUS THREADS  rows at once
 *     bench_python_calls ask ROBOT QUESTION COUNT                         a question in JSON, again and again
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "sinew.h"

static double now(int threads) {
  struct timespec time;
  clock_gettime(threads > 1 ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e9 * (double)time.tv_sec + (double)time.tv_nsec;
}

/* Rows on a closed walk, as in calls.py. */
static double* walk(size_t rows, double middle, double radius) {
  double* numbers = malloc(rows * 3 * sizeof(double));
  for (size_t i = 0; i < 3 * rows; ++i)
    numbers[i] = middle + radius * sin(6.283185307179586 * (double)(i / 3) / (double)rows +
                                       2.0943951 * (double)(i % 3));
  return numbers;
}

static double ask(const sinew_robot* robot, const char* question, size_t count) {
  sinew_session* session = sinew_session_new(robot);
  sinew_free(sinew_ask(session, question, strlen(question), NULL));
  const double begin = now(1);
  for (size_t k = 0; k < count; ++k) sinew_free(sinew_ask(session, question, strlen(question), NULL));
  const double spent = now(1) - begin;
  sinew_release(session);
  return spent;
}

enum { most_fields = 8, widest = 4 }; /* of these questions' answers */

static double run(sinew_batch* batch, double* in, size_t count, int threads, int is_one_by_one) {
  unsigned char* statuses = malloc(count);
  double* out = malloc(count * most_fields * widest * sizeof(double));
  sinew_input from = {in, 24, 8};
  sinew_output to[most_fields];
  for (size_t o = 0; o < most_fields; ++o) to[o] = (sinew_output){out + count * widest * o, 8 * widest, 8};
  sinew_run(batch, is_one_by_one ? 1 : count, &from, to, statuses, threads, NULL); /* memory is there then */
  const double begin = now(threads);
  if (!is_one_by_one) sinew_run(batch, count, &from, to, statuses, threads, NULL);
  for (size_t k = 0; is_one_by_one && k < count; ++k) {
    from.data = in + 3 * k;
    sinew_run(batch, 1, &from, to, statuses, 1, NULL);
  }
  const double spent = now(threads) - begin;
  free(out), free(statuses);
  return spent;
}

int main(int argc, char** argv) {
  if (argc < 5) return 2;
  const char *mode = argv[1], *question = argv[3];
  const size_t count = strtoul(argv[4], NULL, 10);
  char* error = NULL;
  sinew_robot* robot;
  sinew_batch* batch;
  if (sinew_open(argv[2], strlen(argv[2]), SINEW_FILE, &robot, &error) != SINEW_OK) return puts(error), 1;
  if (strcmp(mode, "ask") == 0) {
    printf("%.1f\n", ask(robot, question, count) / (double)count);
  } else {
    if (argc < 7 || sinew_prepare(robot, question, strlen(question), &batch, &error) != SINEW_OK)
      return puts(error ? error : "?"), 1;
    double* in = walk(count, atof(argv[5]), atof(argv[6]));
    printf("%.1f\n",
           run(batch, in, count, argc > 7 ? atoi(argv[7]) : 1, strcmp(mode, "one") == 0) / (double)count);
    free(in);
    sinew_release(batch);
  }
  sinew_release(robot);
  return 0;
}
