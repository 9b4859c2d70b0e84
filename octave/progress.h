/* How far a question is that takes long, in a line on a terminal. */
#ifndef SINEW_OCTAVE_PROGRESS_H
#define SINEW_OCTAVE_PROGRESS_H

#include <stddef.h>

#include "sinew.h"

/* From here to the end a thread shows how far the session is, where the question is a fit and errors go to a
 * terminal. Begin before signals are taken: the thread leaves them to others. */
void progress_begin(sinew_session* session, const char* question, size_t size);
void progress_end(void);

#endif
