#include "objects.h"

#include <stdlib.h>
#include <time.h>

static object* first;

/* Numbers begin where no earlier load of the MEX file gave any: at the milliseconds of the clock. */
static double next_number(void) {
  static double number;
  if (number == 0) {
    struct timespec now;
    timespec_get(&now, TIME_UTC);
    number = 4096.0 * (double)((now.tv_sec % 1000000000) * 1000 + now.tv_nsec / 1000000);
  }
  return ++number;
}

object* object_new(shared_robot* shared) {
  object* made = calloc(1, sizeof *made);
  if (!made) return NULL;
  made->number = next_number();
  made->shared = shared;
  ++shared->users;
  made->next = first;
  first = made;
  mexLock();
  return made;
}

object* object_find(double number) {
  object* found = first;
  while (found && found->number != number) found = found->next;
  return found;
}

static void release(object* closed) {
  sinew_release(closed->session);
  sinew_release(closed->batch);
  free(closed->inputs);
  free(closed->outputs);
  if (--closed->shared->users == 0) {
    sinew_release(closed->shared->robot);
    free(closed->shared);
  }
  free(closed);
}

void object_close(object* closed) {
  object** at = &first;
  while (*at != closed) at = &(*at)->next;
  *at = closed->next;
  release(closed);
  mexUnlock();
}

void objects_close(void) {
  while (first) {
    object* next = first->next;
    release(first);
    first = next;
  }
}
