/// @file timer.h
/// Cycles of the ATmega2560 by two of its own timers, so that the part itself measures as the simulator does:
/// timer 1 counts every cycle, timer 3 every 1024th, and together they tell up to 67 million.
#ifndef SINEW_FIRMWARE_TIMER_H
#define SINEW_FIRMWARE_TIMER_H

#include <avr/io.h>

namespace timer {

inline void start() {
  TCCR1A = TCCR3A = 0;
  TCCR1B = TCCR3B = 0;
  GTCCR = (1 << TSM) | (1 << PSRSYNC);  // holds the prescaler, so that both begin together
  TCNT1 = 0;
  TCNT3 = 0;
  TCCR1B = 1 << CS10;
  TCCR3B = (1 << CS32) | (1 << CS30);
  GTCCR = 0;
}

/// Cycles since `start`, with a constant of its own that `Stopwatch` takes off.
inline unsigned long stop() {
  const unsigned fine = TCNT1;
  const unsigned coarse = TCNT3;
  // What is fine says all below 65536; what is coarse is off by less than half of that.
  const unsigned long about = static_cast<unsigned long>(coarse) << 10;
  const unsigned difference = fine - static_cast<unsigned>(about);
  return about + static_cast<unsigned long>(static_cast<long>(static_cast<int>(difference)));
}

}  // namespace timer

#endif
