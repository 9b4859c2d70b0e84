/* The host's own functions belong to its thread, so the line goes to stderr by another one. */
#ifndef _WIN32
#define _POSIX_C_SOURCE 200809L
#endif
#include "progress.h"

#ifdef _WIN32

void progress_begin(sinew_session* session, const char* question, size_t size) {
  (void)session, (void)question, (void)size;
}
void progress_end(void) {}

#else

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static pthread_t thread;
static pthread_mutex_t guard = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t ended = PTHREAD_COND_INITIALIZER;
static sinew_session* watched;
static int is_running, is_over;

/* The number after a key, which a text of our own has. */
static double number_after(const char* text, const char* key) {
  const char* found = strstr(text, key);
  return found ? strtod(found + strlen(key), NULL) : 0;
}

static void show(void) {
  static const char question[] = "{\"query\": \"progress\"}";
  static const char key[] = "\"part\":\"";
  char* answer = sinew_ask(watched, question, sizeof question - 1, NULL);
  const char* part = answer ? strstr(answer, key) : NULL;
  if (part) {
    part += sizeof key - 1;
    fprintf(stderr, "\r%.*s, step %.0f, error %.3g mm\033[K", (int)strcspn(part, "\""), part,
            number_after(answer, "\"steps\":"), 1e3 * number_after(answer, "\"error\":"));
    fflush(stderr);
  }
  sinew_free(answer);
}

static void* watch(void* nothing) {
  pthread_mutex_lock(&guard);
  while (!is_over) {
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += 200000000;
    if (until.tv_nsec >= 1000000000) until.tv_sec++, until.tv_nsec -= 1000000000;
    pthread_cond_timedwait(&ended, &guard, &until);
    if (!is_over) show();
  }
  pthread_mutex_unlock(&guard);
  return nothing;
}

static int is_fit(const char* question, size_t size) {
  static const char word[] = "\"identify\"";
  const size_t length = sizeof word - 1;
  for (size_t i = 0; i + length <= size && i < 200; ++i)
    if (memcmp(question + i, word, length) == 0) return 1;
  return 0;
}

void progress_begin(sinew_session* session, const char* question, size_t size) {
  is_running = 0;
  if (!is_fit(question, size) || !isatty(STDERR_FILENO)) return;
  watched = session;
  is_over = 0;
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  is_running = pthread_create(&thread, NULL, watch, NULL) == 0;
  pthread_sigmask(SIG_SETMASK, &before, NULL);
}

void progress_end(void) {
  if (!is_running) return;
  pthread_mutex_lock(&guard);
  is_over = 1;
  pthread_cond_signal(&ended);
  pthread_mutex_unlock(&guard);
  pthread_join(thread, NULL);
  is_running = 0;
  fputs("\r\033[K", stderr);
  fflush(stderr);
}

#endif
