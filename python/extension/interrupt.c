/* Ctrl-C while the library computes. Python's own handler only notes that it happened, and looks at the note
 * between instructions; for as long as one of them is a solve, a handler before it stops the solve. */
#include <pthread.h>
#include <stdatomic.h>

#include "sinew_module.h"

static unsigned long main_thread;
static _Atomic(void*) computing; /* by the main thread: there is one at a time */
static atomic_int was_interrupted;
static struct sigaction python_handler;

static void forked(void) { main_thread = PyThread_get_thread_ident(); }

int prepare_interrupts(void) {
  PyObject* threading = PyImport_ImportModule("threading");
  PyObject* main = threading ? PyObject_CallMethod(threading, "main_thread", NULL) : NULL;
  PyObject* ident = main ? PyObject_GetAttrString(main, "ident") : NULL;
  if (ident) main_thread = PyLong_AsUnsignedLong(ident);
  Py_XDECREF(threading);
  Py_XDECREF(main);
  Py_XDECREF(ident);
  if (PyErr_Occurred()) return -1;
  pthread_atfork(NULL, NULL, forked);
  return 0;
}

static void stop(int signal, siginfo_t* information, void* context) {
  void* object = atomic_load(&computing);
  atomic_store(&was_interrupted, 1);
  if (object) sinew_stop(object);
  if (python_handler.sa_flags & SA_SIGINFO)
    python_handler.sa_sigaction(signal, information, context);
  else
    python_handler.sa_handler(signal);
}

static int is_waiting(const struct sigaction* handler) {
  return handler->sa_handler != SIG_DFL && handler->sa_handler != SIG_IGN;
}

void begin_interruptible(Interrupt* interrupt, void* session_or_batch) {
  interrupt->is_active = 0;
  if (PyThread_get_thread_ident() != main_thread) return;
  if (!is_waiting(&python_handler)) sigaction(SIGINT, NULL, &python_handler);
  if (!is_waiting(&python_handler)) return; /* the process ends, or nothing happens */
  struct sigaction ours = {.sa_sigaction = stop, .sa_flags = SA_SIGINFO | SA_ONSTACK};
  sigemptyset(&ours.sa_mask);
  atomic_store(&was_interrupted, 0);
  atomic_store(&computing, session_or_batch);
  interrupt->is_active = sigaction(SIGINT, &ours, &interrupt->previous) == 0;
  if (interrupt->is_active && is_waiting(&interrupt->previous)) {
    python_handler = interrupt->previous;
  } else {
    end_interruptible(interrupt);
    interrupt->is_active = 0;
  }
}

int end_interruptible(Interrupt* interrupt) {
  if (!interrupt->is_active) return 0;
  sigaction(SIGINT, &interrupt->previous, NULL);
  atomic_store(&computing, NULL);
  return atomic_load(&was_interrupted);
}
