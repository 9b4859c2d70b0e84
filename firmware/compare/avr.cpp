/// An ATmega2560: UART0 at 1 Mbaud with a clock of 16 MHz. It ends asleep with interrupts off, which ends a
/// simulation too.
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

#include "target.h"

void start() {
  UCSR0A = _BV(U2X0);
  UBRR0 = 1;
  UCSR0B = _BV(TXEN0);
}

void put(char c) {
  while (!(UCSR0A & _BV(UDRE0))) {
  }
  UCSR0A |= _BV(TXC0);  // writing a 1 clears it
  UDR0 = static_cast<unsigned char>(c);
}

void finish() {
  while (!(UCSR0A & _BV(TXC0))) {
  }
  cli();
  sleep_enable();
  sleep_cpu();
}
