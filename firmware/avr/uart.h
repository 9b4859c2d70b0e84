/// @file uart.h
/// UART0 with a ring of 255 bytes each way: one side puts, the other takes, and neither waits for the other.
/// Its interrupts are in assembly: of a byte each ten microseconds in both directions, those of avr-g++ would
/// take half of the time that there is. They touch three or four registers and, as no instruction of theirs
/// changes a flag, not SREG.
#ifndef SINEW_FIRMWARE_UART_H
#define SINEW_FIRMWARE_UART_H

#include <avr/interrupt.h>
#include <avr/io.h>

#include "protocol/number.h"

#ifndef BAUD
#define BAUD 115200UL
#endif

namespace sinew {
namespace firmware {

class Uart {
 public:
  /// 8 data bits, no parity, 1 stop bit.
  static void start() {
    constexpr Uint32 divider = (F_CPU + BAUD * 4) / (BAUD * 8), rate = F_CPU / 8 / divider;
    static_assert(divider >= 1 && divider <= 4096, "a baud rate that the clock can make");
    static_assert((rate > BAUD ? rate - BAUD : BAUD - rate) * 40 <= BAUD, "within 2.5 %");
    UCSR0A = _BV(U2X0);
    UBRR0 = divider - 1;
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UCSR0B = silent;
  }

  /// Bytes that can be put.
  static Uint8 room() { return static_cast<Uint8>(out_tail - next - 1); }
  static void put(Uint8 byte) { out[next++] = byte; }  // an index is one byte and wraps by itself
  /// Lets go what was put.
  static void flush() {
    out_head = next;
    UCSR0B = sending;
  }

  /// Bytes that have come and stand in a row: how many.
  static Uint8 received(const volatile Uint8*& bytes) {
    const Uint8 tail = in_tail, head = in_head;
    bytes = in + tail;
    return static_cast<Uint8>(head >= tail ? head - tail : 0 - tail);
  }
  /// Makes room.
  static void drop(Uint8 bytes) { in_tail = static_cast<Uint8>(in_tail + bytes); }
  static bool has_received() { return in_head != in_tail; }

  /// Of UCSR0B: all that it is ever set to.
  static constexpr Uint8 silent = _BV(RXEN0) | _BV(TXEN0) | _BV(RXCIE0), sending = silent | _BV(UDRIE0);

  // Rings begin where the lower byte of an address is 0.
  static volatile Uint8 in[256], out[256];
  static volatile Uint8 in_head, in_tail, out_head, out_tail;

 private:
  static Uint8 next;
};

alignas(256) volatile Uint8 Uart::in[256];
alignas(256) volatile Uint8 Uart::out[256];
volatile Uint8 Uart::in_head = 0, Uart::in_tail = 0, Uart::out_head = 0, Uart::out_tail = 0;
Uint8 Uart::next = 0;

}  // namespace firmware
}  // namespace sinew

/// A byte has come. A damaged one becomes 0, which ends no frame, and one that finds the ring full is lost:
/// in both cases the checksum tells.
ISR(USART0_RX_vect, ISR_NAKED) {
  using sinew::firmware::Uart;
  asm volatile(
      "push r24             \n\t"
      "push r25             \n\t"
      "push r30             \n\t"
      "push r31             \n\t"
      "lds  r24, %[status]  \n\t"
      "lds  r25, %[data]    \n\t"
      "sbrc r24, %[framing] \n\t"
      "ldi  r25, 0          \n\t"
      "sbrc r24, %[overrun] \n\t"
      "ldi  r25, 0          \n\t"
      "lds  r30, %[head]    \n\t"
      "ldi  r31, hi8(%[in]) \n\t"
      "st   Z+, r25         \n\t"  // where there is always room
      "lds  r24, %[tail]    \n\t"
      "cpse r30, r24        \n\t"
      "sts  %[head], r30    \n\t"
      "pop  r31             \n\t"
      "pop  r30             \n\t"
      "pop  r25             \n\t"
      "pop  r24             \n\t"
      "reti                 \n\t" ::[status] "n"(_SFR_MEM_ADDR(UCSR0A)),
      [data] "n"(_SFR_MEM_ADDR(UDR0)), [framing] "n"(FE0), [overrun] "n"(DOR0), [head] "i"(&Uart::in_head),
      [tail] "i"(&Uart::in_tail), [in] "i"(Uart::in));
}

/// A byte may go; without one this falls silent.
ISR(USART0_UDRE_vect, ISR_NAKED) {
  using sinew::firmware::Uart;
  asm volatile(
      "push r24              \n\t"
      "push r30              \n\t"
      "push r31              \n\t"
      "lds  r30, %[tail]     \n\t"
      "lds  r24, %[head]     \n\t"
      "cpse r30, r24         \n\t"
      "rjmp 1f               \n\t"
      "ldi  r24, %[silent]   \n\t"
      "sts  %[control], r24  \n\t"
      "rjmp 2f               \n\t"
      "1:                    \n\t"
      "ldi  r31, hi8(%[out]) \n\t"
      "ld   r24, Z+          \n\t"
      "sts  %[data], r24     \n\t"
      "sts  %[tail], r30     \n\t"
      "2:                    \n\t"
      "pop  r31              \n\t"
      "pop  r30              \n\t"
      "pop  r24              \n\t"
      "reti                  \n\t" ::[control] "n"(_SFR_MEM_ADDR(UCSR0B)),
      [silent] "n"(Uart::silent), [data] "n"(_SFR_MEM_ADDR(UDR0)), [head] "i"(&Uart::out_head),
      [tail] "i"(&Uart::out_tail), [out] "i"(Uart::out));
}

#endif
