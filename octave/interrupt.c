/* The MEX interface has no way to ask for Ctrl-C, so the signal is taken while the library works. That is
 * enough where Ctrl-C is a signal: in Octave, and in MATLAB without its desktop. Octave blocks it in all
 * threads but one of its own, which waits for it; one that does not block it comes first. */
#ifndef _WIN32
#define _POSIX_C_SOURCE 200809L
#endif
#include "interrupt.h"

#include "sinew.h"

#ifdef _WIN32

void interrupt_begin(void* session_or_batch) { (void)session_or_batch; }
void interrupt_end(void) {}

#else

#include <signal.h>
#include <stddef.h>
#include <unistd.h>

static void* volatile working;
static volatile sig_atomic_t was_interrupted;
static struct sigaction host;
static sigset_t host_mask;

static void on_interrupt(int signal) {
  (void)signal;
  was_interrupted = 1;
  sinew_stop(working); /* sets a flag */
}

void interrupt_begin(void* session_or_batch) {
  struct sigaction ours = {.sa_handler = on_interrupt};
  sigemptyset(&ours.sa_mask);
  working = session_or_batch;
  was_interrupted = 0;
  sigset_t interrupt;
  sigemptyset(&interrupt);
  sigaddset(&interrupt, SIGINT);
  sigaction(SIGINT, &ours, &host);
  pthread_sigmask(SIG_UNBLOCK, &interrupt, &host_mask);
}

void interrupt_end(void) {
  pthread_sigmask(SIG_SETMASK, &host_mask, NULL);
  sigaction(SIGINT, &host, NULL);
  working = NULL;
  if (was_interrupted) kill(getpid(), SIGINT); /* to whichever thread the host takes it in */
}

#endif
