/* Ctrl-C while the library works. */
#ifndef SINEW_OCTAVE_INTERRUPT_H
#define SINEW_OCTAVE_INTERRUPT_H

/* From here to the end an interrupt (SIGINT) stops what this session or batch does. */
void interrupt_begin(void* session_or_batch);

/* Gives an interrupt that came to the host, which ends what the user runs. */
void interrupt_end(void);

#endif
