/* What is open: robots with their sessions, and prepared questions, each under a number that is given once.
 */
#ifndef SINEW_OCTAVE_OBJECTS_H
#define SINEW_OCTAVE_OBJECTS_H

#include "json_writer.h"
#include "sinew.h"

typedef struct shared_robot {
  sinew_robot* robot;
  robot_facts facts;
  int users;
} shared_robot;

typedef struct field_shape {
  char name[64];
  size_t size; /* numbers a row */
  int rank;
  size_t shape[2];
} field_shape;

typedef struct object {
  double number;
  shared_robot* shared;
  sinew_session* session; /* of a robot */
  sinew_batch* batch;     /* of a prepared question */
  field_shape *inputs, *outputs;
  size_t input_count, output_count;
  struct object* next;
} object;

/* A new object that uses this robot; NULL where there is no memory. While there is one, the MEX file stays.
 */
object* object_new(shared_robot* shared);
object* object_find(double number); /* or NULL */
void object_close(object* closed);
void objects_close(void);

#endif
