/// @file board.h
/// The ATmega2560 with what is wired to it: what to change for other wiring. The pins stand in
/// firmware/README.md.
#ifndef SINEW_FIRMWARE_BOARD_H
#define SINEW_FIRMWARE_BOARD_H

#include <avr/eeprom.h>
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/wdt.h>

#include "avr/ring.h"
#include "protocol/arm.h"

#ifndef BAUD
#define BAUD 115200UL
#endif

namespace sinew {
namespace firmware {

class Board {
 public:
  // Pins of the Arduino Mega 2560: 53 LATCH, 52 SCK, 51 MOSI, 50 MISO on port B, 49 ENABLE on port L.
  // LATCH is the SPI's own SS: as an output it keeps the controller the master.
  static constexpr Uint8 latch = _BV(PB0), clock = _BV(PB1), out = _BV(PB2), enabled = _BV(PL0);

  /// The pins first: the drives are disabled before anything else runs.
  void start() {
    PORTL &= static_cast<Uint8>(~enabled);
    DDRL |= enabled;
    PORTB |= latch;
    DDRB |= latch | clock | out;
    SPCR = _BV(SPE) | _BV(MSTR) | _BV(SPR0);  // mode 0, most significant bit first, clock/16
    start_clock();
    start_line();
  }

  void enable(bool on) { on ? PORTL |= enabled : PORTL &= static_cast<Uint8>(~enabled); }

  /// Four bytes a drive, the most significant first, from section 1 tendon 1 on. The rising latch makes the
  /// drives take what they have been sent; what they send is from before.
  void exchange(const Counts& setpoints, Counts& measured) {
    PORTB &= static_cast<Uint8>(~latch);
    for (Uint8 i = 0; i < drive_count; ++i) {
      const Uint32 setpoint = static_cast<Uint32>(setpoints[i]);
      Uint32 answer = swap(static_cast<Uint8>(setpoint >> 24));
      answer = answer << 8 | swap(static_cast<Uint8>(setpoint >> 16));
      answer = answer << 8 | swap(static_cast<Uint8>(setpoint >> 8));
      measured[i] = static_cast<Int32>(answer << 8 | swap(static_cast<Uint8>(setpoint)));
    }
    PORTB |= latch;
  }

  Uint16 milliseconds() {
    cli();  // two bytes
    const Uint16 now = ticks_;
    sei();
    return now;
  }

  Uint8 eeprom_read(Uint16 address) { return eeprom_read_byte(at(address)); }
  void eeprom_write(Uint16 address, Uint8 byte) { eeprom_write_byte(at(address), byte); }

  /// Waits while the ring is full: the line is slower than the controller. A byte that got in is a sign of
  /// life: of many drives a reply may take longer than the watchdog waits.
  void send(char c) {
    while (!replies_.put(static_cast<Uint8>(c))) {
    }
    wdt_reset();
    UCSR0B |= _BV(UDRIE0);
  }
  bool receive(char& c) {
    Uint8 byte = 0;
    if (!requests_.take(byte)) return false;
    c = static_cast<char>(byte);
    return true;
  }

  /// Until the next interrupt, unless something has come.
  void rest() {
    cli();
    if (requests_.empty()) {
      sleep_enable();
      sei();
      sleep_cpu();  // the instruction after sei comes before any interrupt
      sleep_disable();
    }
    sei();
  }

  void on_tick() { ++ticks_; }
  void on_received() {
    const Uint8 faults = UCSR0A & (_BV(FE0) | _BV(DOR0) | _BV(UPE0));
    const Uint8 byte = UDR0;
    // A damaged byte becomes one that no frame has. One that finds the ring full is lost; the checksum tells.
    requests_.put(faults ? 0 : byte);
  }
  void on_sendable() {
    Uint8 byte = 0;
    if (replies_.take(byte))
      UDR0 = byte;
    else
      UCSR0B &= static_cast<Uint8>(~_BV(UDRIE0));
  }

 private:
  /// A tick of 1 ms.
  static void start_clock() {
    static_assert(F_CPU % 64000 == 0 && F_CPU / 64000 <= 256, "the clock divides into milliseconds");
    TCCR0A = _BV(WGM01);
    OCR0A = F_CPU / 64000 - 1;
    TIMSK0 = _BV(OCIE0A);
    TCCR0B = _BV(CS01) | _BV(CS00);
  }
  /// 8 data bits, no parity, 1 stop bit.
  static void start_line() {
    constexpr Uint32 divider = (F_CPU + BAUD * 4) / (BAUD * 8), rate = F_CPU / 8 / divider;
    static_assert(divider >= 1 && divider <= 4096, "a baud rate that the clock can make");
    static_assert((rate > BAUD ? rate - BAUD : BAUD - rate) * 40 <= BAUD, "within 2.5 %");
    UCSR0A = _BV(U2X0);
    UBRR0 = divider - 1;
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UCSR0B = _BV(RXEN0) | _BV(TXEN0) | _BV(RXCIE0);
  }
  static Uint8 swap(Uint8 byte) {
    SPDR = byte;
    while (!(SPSR & _BV(SPIF))) {
    }
    return SPDR;
  }
  static Uint8* at(Uint16 address) { return reinterpret_cast<Uint8*>(address); }

  Ring requests_, replies_;
  volatile Uint16 ticks_ = 0;
};

}  // namespace firmware
}  // namespace sinew

#endif
